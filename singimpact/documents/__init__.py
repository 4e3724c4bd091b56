"""Any formula, series or table as LaTeX, PDF, Markdown or HTML.

Not here: pictures (`scenes`), the mathematics that is shown (`theory`), the words about the paper (`paper.sections`).
Files: `steps` (what a document is: sections of steps), `series` (the series of the theory as data and as steps),
`sympy_source` (expressions as a Python file), `arranging` (an expression laid out as a sum), `breaking` (long lines
of LaTeX), `escape`, `rendering` (templates), `formats` (as one text or as files), `compiling` (LaTeX into a PDF).
"""

from singimpact.handed_on import names_of

_FILES = {
    "arranging": "by_degree factored in_powers",
    "breaking": "PAGE lines_of width",
    "compiling": "CompileError compiled",
    "escape": "latex",
    "formats": "as_files as_text",
    "rendering": "as_data as_latex as_markdown",
    "steps": "Mark Section Step claims_of equations_of",
}
__getattr__ = names_of(__name__, _FILES)
