"""The local theory as exact power series at one point of the tau-axis, one body of code for every contact order.

Not here: the points and their jets (`contact`), finite flights (`flights`), the paper's own steps in sympy
(`paper.routes`), verdicts on the paper (`paper.claims`).
"""

from typing import TYPE_CHECKING, Any

from singimpact.handed_on import names_of as _names_of
from singimpact.theory.formulas import (
    chatter_limit as chatter_limit,
    dynamics_on_gamma as dynamics_on_gamma,
    fibre as fibre,
    gamma as gamma,
    v_c as v_c,
    v_c_on_arrays as v_c_on_arrays,
)
from singimpact.theory.impact_sheet import Sheet as Sheet

if TYPE_CHECKING:
    from singimpact.theory.grazing import grazing_map as grazing_map
    from singimpact.theory.multipliers import r_of_lambda as r_of_lambda
    from singimpact.theory.plane_forms import normal_form as normal_form


_FILES = {
    "completion": "leaves rho_names symbolic_completion symbolic_curve",
    "contact_points": "multiplier",
    "fixed_points": "as_dict swan tangency",
    "frozen": "CURVED MOVED PLACES completion_module curve_functions sheet_functions",
    "gamma_series": "invariant_curve multiplier_across restitution_of",
    "grazing": "grazing_map",
    "impact_sheet": "Sheet generic_sheet iota sheet",
    "multipliers": (
        "DG_on_ray P Q eigenvalues_on_gamma lambda_ launch_velocity leading_coefficient minimal_polynomial "
        "mu_of_lambda of_m r_of_lambda series"
    ),
    "notation": "by_degree factored in_powers latex",
    "plane_forms": "fold_form normal_form",
}
_value_of = _names_of(__name__, _FILES)


def __getattr__(name: str) -> Any:
    """A name of a file that loads sympy, or of those that tests use."""
    try:
        return _value_of(name)
    except AttributeError:
        offer = ", ".join(_PUBLIC)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}: it has {offer}") from None


_PUBLIC = [
    "Sheet",
    "chatter_limit",
    "dynamics_on_gamma",
    "fibre",
    "gamma",
    "grazing_map",
    "normal_form",
    "r_of_lambda",
    "v_c",
    "v_c_on_arrays",
]


def __dir__() -> list[str]:
    return _PUBLIC
