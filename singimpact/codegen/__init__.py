"""Source from mathematics: a vector field to the text of its Taylor recurrence, a series to a function, text to code.

`taylor_recurrence` (x'' = g - f to a recurrence), `disc` and `radii` (bounds of it on complex discs), `scalar` (an
expression), `polynomial_source` (polynomials and series), `over_lists` (text over any numbers), `javascript` (text for
a browser), `lowering` (text for LLVM), `object_code` (machine code, emitted and loaded).
Not here: the expressions themselves (`algebra`), what a kernel is for (`flights`), frozen formulas (`generated`).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
