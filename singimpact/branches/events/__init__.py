"""Kinds of events of a branch of periodic orbits: tests, other branches, equations of curves and proofs, marks.

Not here: where along a branch tests vanish (`branches.step_search`), curves of events (`branches.event_curve`), proofs
(`branches.enclosed_event`).
"""

from singimpact.branches.events.event import Event as Event
from singimpact.branches.events.graze import GRAZE as GRAZE
from singimpact.branches.events.kind import EventKind as EventKind
from singimpact.branches.events.table import KINDS as KINDS, kind_of as kind_of, own_events as own_events
from singimpact.branches.events.unit_multipliers import PERIOD_DOUBLING as PERIOD_DOUBLING
