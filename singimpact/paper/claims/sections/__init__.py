"""The claims in the paper's order, a pair of files a section; `SECTIONS` is file -> the names of its Python file.

`SECTION.py` has the statements as printed in the form that verifiers take, mutants beside them, and `SECTION.toml`
their words.  Not here: how they are run (`claims.engine`).
"""

from singimpact.handed_on import names_of

FILES = (
    "section2",
    "section3",
    "section4",
    "section4a_arc",
    "section4a_blowup",
    "section4a_multipliers",
    "section4b",
    "section4b_leaves",
    "section5",
    "section6",
    "section6_regions",
    "section6_loops",
)
SECTIONS = {file: names_of(__name__, {file: "CLAIMS TRIALS"}) for file in FILES}
