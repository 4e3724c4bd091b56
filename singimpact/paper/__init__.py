"""The paper, checked. A study of your own oscillator does not need this sub-package.

Not here: the theory for any oscillator (`theory`), flights and orbits (`flights`, `dynamics`), formulas as text
(`documents`), pictures of a user's model (`scenes`).
Rooms: `claims/` (statements, verifiers, verdicts), `trials/` (true orbits and surfaces on which claims are tried),
`routes/` (the paper's own steps in sympy), `figures/` (1 to 17), `sections/` (the words of the derivations and errata).
"""

from singimpact.handed_on import names_of

__getattr__ = names_of(__name__)
