"""Source that `derivations/freeze.py` wrote: formulas in the jets of a contact, free of any model; never edited by hand.

Not here: anything a person writes.  The formulas come from `theory`, their translation into source from `codegen`.
Files: `completion` (the chatter that is left).
"""
