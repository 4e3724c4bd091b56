"""Text of numba without machine code beside it, in a process of its own."""

import hashlib
import subprocess
import sys

import pytest

COMPILE = """
import sys
from singimpact.codegen import object_code
from singimpact.flights.compilers import KernelCompiler
from numba.core.codegen import JITCodeLibrary
if sys.argv[1] == "text alone":
    object_code.without_machine_code()
    assert JITCodeLibrary._finalize_specific.__module__ == object_code.__name__
text = KernelCompiler(True).text("taylor_entry")
sys.stdout.buffer.write(object_code.emitted(text, "taylor_entry"))
"""


@pytest.mark.slow
def test_object_code_is_the_same_when_numba_links_nothing():
    made = [
        subprocess.run([sys.executable, "-c", COMPILE, how], capture_output=True, check=True).stdout
        for how in ("text alone", "all")
    ]
    one, other = (hashlib.sha256(code).hexdigest() for code in made)
    assert len(made[0]) > 500
    assert one == other
