"""Names that `documents` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.documents.coq_files import KINDS as KINDS, LEMMAS as LEMMAS, Writer as Writer, coq_file as coq_file
from singimpact.documents.coq_flights import coq_flight as coq_flight
from singimpact.documents.document_steps import (
    CompileError as CompileError,
    Mark as Mark,
    Section as Section,
    Step as Step,
    claims_of as claims_of,
    compiled as compiled,
    equations_of as equations_of,
    require_latex as require_latex,
)
from singimpact.documents.rendering import (
    PAGE as PAGE,
    as_data as as_data,
    as_files as as_files,
    as_latex as as_latex,
    as_markdown as as_markdown,
    as_text as as_text,
    environment as environment,
    latex_text as latex_text,
    lines_of as lines_of,
    width as width,
    wrapping as wrapping,
)
from singimpact.documents.series_documents import (
    SeriesRequest as SeriesRequest,
    series_formulas as series_formulas,
    series_section as series_section,
    series_text as series_text,
)
