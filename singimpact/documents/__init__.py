"""Any formula, series or table as LaTeX, PDF, Markdown or HTML; certificates as files for Coq.

Not here: pictures (`scenes`), the mathematics that is shown (`theory`), the words about the paper (`paper.sections`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
