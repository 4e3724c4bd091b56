"""Names that `oscillator` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.oscillator.linear import TAU as TAU, T as T, linear_flight as linear_flight, linear_form as linear_form
from singimpact.oscillator.model import (
    FIELDS as FIELDS,
    Oscillator as Oscillator,
    fields_of as fields_of,
    read_fields as read_fields,
    require_model as require_model,
    require_rebound as require_rebound,
)
from singimpact.oscillator.moving_number import (
    CLEARANCE as CLEARANCE,
    RESTITUTION as RESTITUTION,
    UPPER as UPPER,
    period_over as period_over,
    value_of as value_of,
    with_number as with_number,
)
from singimpact.oscillator.rebound import rho_of as rho_of
from singimpact.oscillator.wall_acceleration import (
    acceleration as acceleration,
    acceleration_at as acceleration_at,
    largest_push as largest_push,
)
