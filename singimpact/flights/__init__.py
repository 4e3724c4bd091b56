"""One flight: first hit F, impact map G, x and x' along the way; statuses, conditions, any number of digits.

States are read once (`states`), flown in doubles by what `compiled_model` binds of `kernels/`, and come back as
`results`; a flight that ends in no plain hit goes to `undecided` and `no_return/`, one with digits to `enclosures/`.
Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
