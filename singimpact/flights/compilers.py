"""Texts of LLVM: of the package's kernels by numba, and of what a model adds to them without it.

Kernels use much of Python, and numba takes half a minute for them: their object code comes with the package, see
`shipped`.  The recurrence of a user's f and g and his law of restitution are plain arithmetic, which `codegen.lowering`
writes down in a tenth of a second.
"""

import ast
import inspect
import math
import types
from functools import lru_cache, partial
from typing import Any

from singimpact.codegen import radii
from singimpact.codegen.over_lists import FUNCTIONS
from singimpact.flights.bind import (
    ADDRESSES,
    IN_STEPS,
    LAW,
    MODULES,
    RECURRENCE,
    Emitted,
    constants,
    functions_of,
)
from singimpact.flights.kernels import recurrence

UNWRAPPED: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
Built = Any
"""Types, values and builders of numba and LLVM, which give them no types."""
INLINED = {"quarters", "in_quarter", "swung", "answered", "moved_wave", "at_the_hit", "rounded", "is_rough"}
"""Functions in loops over the states of a batch: a call would keep the loop scalar."""
LEVEL = 3
"""Of numba's own passes: without them batches of states take three times as long."""


def text_of_model(emitted: Emitted) -> str:
    """The text of LLVM of what a model adds: its law, or its recurrence with the bounds that go with it.

    Examples
    --------
    >>> "define double" in text_of_model(Emitted(rho="def law(v, w):\\n    return w[0] * v"))
    True
    """
    from llvmlite import ir

    from singimpact.codegen.lowering import NOTHING, REAL, WHOLE, lowered

    functions = {**_trees_of_bounds(), **_trees(emitted.flow), **_trees(emitted.rho)}
    address = REAL.as_pointer()
    if emitted.rho:
        return lowered(functions, constants(), LAW, ir.FunctionType(REAL, [REAL, address]))
    takes = ir.FunctionType(NOTHING, [WHOLE.as_pointer(), *[address] * 6])
    return lowered(functions, constants(), RECURRENCE, takes)


@lru_cache(maxsize=1)
def _trees_of_bounds() -> dict[str, ast.FunctionDef]:
    return {**_trees(inspect.getsource(radii)), **_trees(inspect.getsource(recurrence))}


def _trees(text: str) -> dict[str, ast.FunctionDef]:
    return {tree.name: tree for tree in ast.parse(text).body if isinstance(tree, ast.FunctionDef)}


class KernelCompiler:
    """numba's view of the kernels; its inner functions are compiled once for all entries.

    Parameters
    ----------
    steps : the kernels of models that are flown in Taylor steps.
    """

    def __init__(self, steps: bool) -> None:
        import numba

        module = types.ModuleType("singimpact_kernels")
        self.space = vars(module)
        self.space |= {**{name: getattr(math, name) for name in FUNCTIONS}, **constants()}
        # without wrappers for Python, compiling takes a third less
        inner: Any = partial(numba.njit, error_model="numpy", **UNWRAPPED)
        for name, function in _chosen(steps).items():
            bound = types.FunctionType(function.__code__, self.space, name)
            self.space[name] = bound if name.endswith("_entry") else inner(bound, forceinline=name in INLINED)
        self.space |= _of_addresses()

    def text(self, entry: str) -> str:
        """An entry as text of LLVM; it takes seconds."""
        import numba
        from numba import types as kinds

        address, sizes = kinds.CPointer(kinds.float64), kinds.CPointer(kinds.int64)
        takes = kinds.int64(sizes, *[address] * (ADDRESSES - 2), kinds.CPointer(kinds.int8))
        # the same level in every process: one name of an entry stands for one object code
        settings: Any = numba.config
        before, settings.OPT = settings.OPT, type(settings.OPT)(LEVEL)
        try:
            text: str = numba.cfunc(takes, error_model="numpy")(self.space[entry]).inspect_llvm()
        finally:
            settings.OPT = before
        return text


def _chosen(steps: bool) -> dict[str, Any]:
    """The functions of all kernels by name, those for Taylor steps in their places."""
    functions = {
        name: function
        for module in MODULES
        for name, function in functions_of(module).items()
        if name not in ("block", "beyond", "called", LAW)
    }
    if steps:
        functions |= {name: functions[other] for name, other in IN_STEPS.items()}
        functions |= {"restart": functions["state_kept"]}
        functions |= {name: functions[f"called_{name}"] for name in recurrence.PARTS}
    return functions


def _of_addresses() -> dict[str, Built]:
    """`layout.block` over an address; `orbits.law` and `recurrence.called` at an address."""
    import numba
    from llvmlite import ir
    from numba import types as kinds
    from numba.core import cgutils
    from numba.extending import intrinsic

    whole, number = ir.IntType(64), ir.DoubleType()

    @intrinsic
    def moved(_typing: Built, address: Built, count: Built) -> Built:
        def emit(_context: Built, builder: Built, _signature: Built, given: Built) -> Built:
            return builder.gep(given[0], [given[1]])

        return address(address, count), emit

    def block(flat: Built, at: Built, shape: Built) -> Built:
        return numba.carray(moved(flat, at), shape)  # type: ignore[call-arg]

    def last_address(builder: Built, numbers: Built, called: Built) -> Built:
        """The function at the address that an array of numbers ends with."""
        last = builder.sub(builder.extract_value(numbers.shape, 0), ir.Constant(whole, 1))
        at = builder.fptoui(builder.load(builder.gep(numbers.data, [last])), whole)
        return builder.inttoptr(at, called.as_pointer())

    @intrinsic
    def law(_typing: Built, velocity: Built, w: Built) -> Built:
        def emit(context: Built, builder: Built, signature: Built, given: Built) -> Built:
            numbers = context.make_array(signature.args[1])(context, builder, given[1])
            called = ir.FunctionType(number, [number, number.as_pointer()])
            return builder.call(last_address(builder, numbers, called), [given[0], numbers.data])

        return kinds.float64(velocity, w), emit

    @intrinsic
    def called(
        _typing: Built, _job: Built, _numbers: Built, p: Built, launch: Built, X: Built, W: Built, A: Built
    ) -> Built:
        def emit(context: Built, builder: Built, signature: Built, values: Built) -> Built:
            pairs = zip(signature.args[2:], values[2:], strict=True)
            arrays = [context.make_array(kind)(context, builder, value) for kind, value in pairs]
            rows = [builder.extract_value(arrays[3].shape, axis) for axis in (0, 1)]
            sizes = written(builder, whole, [*cgutils.unpack_tuple(builder, values[0], 2), *rows])
            numbers = written(builder, number, cgutils.unpack_tuple(builder, values[1], 4))
            takes = ir.FunctionType(ir.VoidType(), [whole.as_pointer(), *[number.as_pointer()] * 6])
            builder.call(
                last_address(builder, arrays[0], takes), [sizes[0], numbers[0], *(array.data for array in arrays)]
            )
            return cgutils.pack_array(builder, [builder.load(address) for address in numbers])

        four, two = kinds.UniTuple(kinds.float64, 4), kinds.UniTuple(kinds.int64, 2)
        return four(two, four, p, launch, X, W, A), emit

    def written(builder: Built, kind: Built, values: Built) -> Built:
        """Places of values in memory, one after the other."""
        memory = cgutils.alloca_once(builder, kind, len(values))
        places = [builder.gep(memory, [ir.Constant(whole, at)]) for at in range(len(values))]
        for place, value in zip(places, values, strict=True):
            builder.store(value, place)
        return places

    bound: Built = numba.njit(**UNWRAPPED)(block)
    onwards: Built = numba.njit(**UNWRAPPED)(lambda flat, at: moved(flat, at))  # type: ignore[call-arg]
    return {"block": bound, "beyond": onwards, LAW: law, "called": called}
