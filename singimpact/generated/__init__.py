"""Source that `derivations/freeze.py` wrote: formulas in the jets of a contact, free of any model; never edited by hand.

Not here: anything a person writes.  The formulas come from `theory`, their translation into source from `codegen`.
"""

from singimpact.handed_on import names_of

_FILES = {
    "completion": "chatter_terms linear_chatter_terms",
}
__getattr__ = names_of(__name__, _FILES)
