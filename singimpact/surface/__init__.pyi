"""Names that `surface` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.surface.boxes_from_rest import FlightFromRest as FlightFromRest, Tangencies as Tangencies
from singimpact.surface.classification import classify as classify, default_window as default_window
from singimpact.surface.curve import (
    STATES as STATES,
    Curve as Curve,
    Mark as Mark,
    Window as Window,
    window_ends as window_ends,
)
from singimpact.surface.followed_rests import FollowedRests as FollowedRests
from singimpact.surface.impact_surface import ImpactSurface as ImpactSurface
from singimpact.surface.outline_transitions import (
    Transitions as Transitions,
    at_wall as at_wall,
    transitions as transitions,
)
from singimpact.surface.proved_touches import (
    EnclosedTouches as EnclosedTouches,
    RestFlight as RestFlight,
    doubts_left as doubts_left,
    rest_flight as rest_flight,
)
from singimpact.surface.rest_flights import RestFlights as RestFlights
from singimpact.surface.swan_families import Family as Family, Transition as Transition, swan_curves as swan_curves
from singimpact.surface.two_rests import linear_rests as linear_rests, newton as newton
