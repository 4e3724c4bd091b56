"""Names that `theory` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.theory.completion import (
    leaves as leaves,
    rho_names as rho_names,
    symbolic_completion as symbolic_completion,
    symbolic_curve as symbolic_curve,
)
from singimpact.theory.contact_points import (
    Place as Place,
    multiplier as multiplier,
    place as place,
    points_of as points_of,
)
from singimpact.theory.fixed_points import as_dict as as_dict, swan as swan, tangency as tangency
from singimpact.theory.formulas import (
    LIMITS as LIMITS,
    chatter_limit as chatter_limit,
    dynamics_on_gamma as dynamics_on_gamma,
    fibre as fibre,
    gamma as gamma,
    v_c as v_c,
    v_c_on_arrays as v_c_on_arrays,
)
from singimpact.theory.frozen import (
    COMMAND as COMMAND,
    CURVED as CURVED,
    MOVED as MOVED,
    PLACES as PLACES,
    completion_module as completion_module,
    curve_functions as curve_functions,
    sheet_functions as sheet_functions,
)
from singimpact.theory.gamma_series import (
    invariant_curve as invariant_curve,
    multiplier_across as multiplier_across,
    restitution_of as restitution_of,
)
from singimpact.theory.grazing import grazing_map as grazing_map
from singimpact.theory.impact_sheet import Sheet as Sheet, generic_sheet as generic_sheet, iota as iota, sheet as sheet
from singimpact.theory.multipliers import (
    DG_on_ray as DG_on_ray,
    P as P,
    Q as Q,
    eigenvalues_on_gamma as eigenvalues_on_gamma,
    lambda_ as lambda_,
    launch_velocity as launch_velocity,
    leading_coefficient as leading_coefficient,
    minimal_polynomial as minimal_polynomial,
    mu_of_lambda as mu_of_lambda,
    of_m as of_m,
    r_of_lambda as r_of_lambda,
    series as series,
)
from singimpact.theory.notation import (
    by_degree as by_degree,
    factored as factored,
    in_powers as in_powers,
    latex as latex,
)
from singimpact.theory.plane_forms import (
    HIGHEST as HIGHEST,
    HIGHEST_NUMBERS as HIGHEST_NUMBERS,
    FoldForm as FoldForm,
    cubic_terms as cubic_terms,
    fold_form as fold_form,
    normal_form as normal_form,
)
from singimpact.theory.power_series import TRUST as TRUST, PowerSeries as PowerSeries
