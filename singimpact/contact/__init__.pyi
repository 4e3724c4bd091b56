"""Names that `contact` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.contact.contact import (
    NAMED_ORDERS as NAMED_ORDERS,
    Contact as Contact,
    acceleration as acceleration,
    acceleration_jet as acceleration_jet,
    contact_order as contact_order,
    force_jet as force_jet,
    series_of_rho as series_of_rho,
)
from singimpact.contact.contacts_over import contact_points as contact_points
from singimpact.contact.points import (
    MOST_DIGITS as MOST_DIGITS,
    TangencyPoints as TangencyPoints,
    enclosed as enclosed,
    is_polynomial as is_polynomial,
    tangency_points as tangency_points,
)
from singimpact.contact.swans import (
    SwanPoint as SwanPoint,
    swan_points_over_clearance as swan_points_over_clearance,
    swans_are_listed as swans_are_listed,
)
from singimpact.contact.zero_ahead import next_zero as next_zero
