"""Any formula, series or table as LaTeX, PDF, Markdown or HTML; certificates as files for Coq.

Not here: pictures (`scenes`), the mathematics that is shown (`theory`), the words about the paper (`paper.sections`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "coq_files": "KINDS LEMMAS Writer coq_file",
    "coq_flights": "coq_flight",
    "document_steps": "CompileError Mark Section Step claims_of compiled equations_of",
    "rendering": "PAGE as_data as_files as_latex as_markdown as_text latex_text lines_of width",
}
__getattr__ = names_of(__name__, _FILES)
