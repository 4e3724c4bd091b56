"""Machine code kept as object files: emitted once by LLVM, loaded in milliseconds without the compiler.

A file is named by a digest of all its sources, of llvmlite and of the processor, and its bytes are verified against
their own digest before they are mapped.
"""

import ctypes
import os
import re
from collections.abc import Callable
from functools import lru_cache
from typing import Any

NEVER_CALLED = r"(NRT_|Py|_Py|numba_)"
"""How names begin that compiled code would call to raise an exception: it raises none, so they end the process."""


def emitted(text: str, entry: str, machine: Any = None) -> bytes:
    """The object code of a module of LLVM whose one function to be called is an `entry`.

    All other functions become internal, so that LLVM inlines them and drops arguments that nothing reads.  They are
    named by their order: numba's names depend on what its process has compiled before.

    Parameters
    ----------
    text : of numba, which gives the entry a longer name, or of `codegen.lowering`. machine : another one than this.
    """
    import llvmlite.binding as llvm

    machine = machine or _machine()
    module = llvm.parse_assembly(_closed(text))
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    module.verify()
    for at, function in enumerate(module.functions):
        if function.is_declaration:
            continue
        if function.name.startswith("cfunc.") and entry in function.name:
            function.name = entry
        elif function.name != entry:
            function.linkage, function.name = "internal", f"f{at}"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=3))
    builder.getModulePassManager().run(module, builder)
    return bytes(machine.emit_object(module))


def _closed(text: str) -> str:
    """A module that calls nothing of Python or numba: what is declared for exceptions ends the process.

    The names are defined inside the module: given to the loader they would replace those of other code in the process.
    """
    defined = re.sub(
        rf"(?m)^declare (.*@{NEVER_CALLED}[^\n]*)$",
        r"define internal \1 {\n  call void @abort()\n"
        r"  unreachable\n}",
        text,
    )
    defined = re.sub(
        rf"(?m)^(@{NEVER_CALLED}\w*) = external (.*)global (\S+).*$", r"\1 = internal global \4 0", defined
    )
    return defined if "declare void @abort()" in defined else f"{defined}\ndeclare void @abort()\n"


@lru_cache(maxsize=1)
def _machine() -> Any:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return machine_of(llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten())


def machine_of(triple: str, processor: str, features: str) -> Any:
    """The machine of a platform, whose part of LLVM has been initialized; names are those of LLVM."""
    import llvmlite.binding as llvm

    target = llvm.Target.from_triple(triple)
    return target.create_target_machine(cpu=processor, features=features, opt=3, reloc="pic", codemodel="default")


WITHOUT_EFFECT = {"NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT", "NUMBA_NUM_THREADS", "NUMBA_OPT", "NUMBA_THREADING_LAYER"}
"""Settings of numba that change no code, or that are set anew for each text."""


def settings_of_numba() -> list[tuple[str, str]]:
    """Settings in the environment that change the code which numba makes."""
    names = sorted(name for name in os.environ if name.startswith("NUMBA_") and name not in WITHOUT_EFFECT)
    return [(name, os.environ[name]) for name in names]


def processor() -> str:
    """The processor and its features, on which object code depends beside its sources."""
    from importlib.metadata import version

    import llvmlite
    import llvmlite.binding as llvm

    features = llvm.get_host_cpu_features().flatten()
    numba = version("numba")
    return f"{settings_of_numba()} {numba} {llvmlite.__version__} {llvm.get_host_cpu_name()} {features}"


_LOADED: list[Any] = []  # engines own the code: they live as long as the process


def loaded(code: bytes, entry: str, addresses: int) -> tuple[Callable[..., int], Callable[..., int]]:
    """The function `entry` of object code, of so many addresses: without the interpreter's lock, and with it.

    Raises
    ------
    ValueError : it is not object code, or it has no function of this name.
    """
    import llvmlite.binding as llvm

    held = llvm.ObjectFileRef.from_data(code)
    if not getattr(held, "_ptr", True):  # LLVM cannot read it; adding it would end the process
        raise ValueError("it is not object code")
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    _LOADED.append((engine, held))  # before anything is refused: the end of an engine would end the machine of all
    engine.add_object_file(held)
    engine.finalize_object()
    address = engine.get_function_address(entry)
    if not address:
        raise ValueError(f"it has no function {entry}")
    takes = [ctypes.c_void_p] * addresses
    free = ctypes.CFUNCTYPE(ctypes.c_int64, *takes)(address)
    holding = ctypes.PYFUNCTYPE(ctypes.c_int64, *takes)(address)
    return free, holding
