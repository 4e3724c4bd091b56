"""All kinds of events of the package, in the order in which a branch looks for them."""

from singimpact.branches.events.graze import GRAZE, INTERIOR_GRAZE
from singimpact.branches.events.kind import FOLD, NEIMARK_SACKER, EventKind
from singimpact.branches.events.meeting_branches import BRANCH_POINT, PITCHFORK, TRANSCRITICAL
from singimpact.branches.events.onset_of_rest import ONSET_OF_REST
from singimpact.branches.events.own_event import OwnEvent
from singimpact.branches.events.period_doubling import PERIOD_DOUBLING

KINDS: tuple[EventKind, ...] = (
    FOLD,
    PERIOD_DOUBLING,
    NEIMARK_SACKER,
    BRANCH_POINT,
    GRAZE,
    INTERIOR_GRAZE,
    ONSET_OF_REST,
    PITCHFORK,
    TRANSCRITICAL,
)
_BY_NAME = {kind.name: kind for kind in KINDS}


def kind_of(name: str) -> EventKind:
    """The kind with a name; a name that is not in the table is that of a user's event.

    Examples
    --------
    >>> kind_of("torus").word
    'Neimark-Sacker bifurcation (torus)'
    """
    return _BY_NAME.get(name) or OwnEvent(name)
