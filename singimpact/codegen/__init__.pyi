"""Names that `codegen` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.codegen.javascript import translated as translated
from singimpact.codegen.lowering import REAL as REAL, WHOLE as WHOLE, Unsupported as Unsupported, lowered as lowered
from singimpact.codegen.object_code import emitted as emitted, loaded as loaded
from singimpact.codegen.over_lists import FUNCTIONS as FUNCTIONS
from singimpact.codegen.polynomial_source import module_source as module_source
from singimpact.codegen.radii import (
    atan_radius as atan_radius,
    bell_radius as bell_radius,
    circular_radius as circular_radius,
    exp_radius as exp_radius,
    log_of_square_radius as log_of_square_radius,
    log_radius as log_radius,
    power_of_square_radius as power_of_square_radius,
    power_radius as power_radius,
    softplus_radius as softplus_radius,
    tan_radius as tan_radius,
    tanh_radius as tanh_radius,
    whole_power_radius as whole_power_radius,
)
from singimpact.codegen.taylor_recurrence import recurrence as recurrence
