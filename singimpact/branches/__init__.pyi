"""Names that `branches` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.branches.ball_closing import (
    BallClosing as BallClosing,
    Spans as Spans,
    TouchingClosing as TouchingClosing,
    return_slope as return_slope,
)
from singimpact.branches.border import BorderOrbit as BorderOrbit
from singimpact.branches.branch import Branch as Branch
from singimpact.branches.cascade import (
    Cascade as Cascade,
    CascadeWindow as CascadeWindow,
    settled_orbit as settled_orbit,
)
from singimpact.branches.clearance_curves import ClearanceCurve as ClearanceCurve
from singimpact.branches.closing import Closing as Closing
from singimpact.branches.continuation import Curve as Curve, root_between as root_between
from singimpact.branches.cylinder import distances as distances
from singimpact.branches.enclosed_closing import (
    SEARCH as SEARCH,
    ClosingBoxes as ClosingBoxes,
    closed_boxes as closed_boxes,
)
from singimpact.branches.enclosed_crossing import EnclosedCrossing as EnclosedCrossing
from singimpact.branches.enclosed_event import EnclosedEvent as EnclosedEvent, rate_over as rate_over
from singimpact.branches.event_curve import EventCurve as EventCurve
from singimpact.branches.events import KINDS as KINDS, Event as Event, EventKind as EventKind, kind_of as kind_of
from singimpact.branches.homoclinic import Crossing as Crossing, Crossings as Crossings, crossings as crossings
from singimpact.branches.horseshoe import (
    CrossedSet as CrossedSet,
    Horseshoe as Horseshoe,
    HorseshoeFamily as HorseshoeFamily,
)
from singimpact.branches.krawczyk import EnclosedOrbit as EnclosedOrbit, Krawczyk as Krawczyk
from singimpact.branches.manifold import Manifold as Manifold
from singimpact.branches.orbits import PeriodicOrbit as PeriodicOrbit
from singimpact.branches.resting import Releases as Releases
from singimpact.branches.saddle_arcs import expansion as expansion, local_arc as local_arc, returned as returned
from singimpact.branches.saddle_cones import Cones as Cones
from singimpact.branches.solutions import orbit_period as orbit_period
from singimpact.branches.starts import conditions as conditions
from singimpact.branches.transitions import BothSides as BothSides, OrbitTransitions as OrbitTransitions
