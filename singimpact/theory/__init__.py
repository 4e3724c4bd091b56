"""The local theory as exact power series at one point of the tau-axis, one body of code for every contact order.

Not here: the points and their jets (`contact`), finite flights (`flights`), verdicts on the paper (`claims`).
The paper's own steps, a second route in sympy: `implicit_route` (sections 2, 3), `fold_route` (4), `swan_route` (5).
"""

from singimpact.theory.sheet import Sheet as Sheet
from singimpact.theory.sheet import v_c as v_c
