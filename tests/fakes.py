"""Stand-ins for rooms, so that the shell is tested by itself: what it asks for and what it makes of the answer."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from types import ModuleType

from singimpact.inputs import unknown


@dataclass
class FakeClaim:
    id: str
    title: str
    label: str = ""
    section: str = "2"
    printed: str = "x = x"


@dataclass
class FakeVerdict:
    id: str
    kind: str = "proved"
    effective: str = "proved"
    printed: str = "x = x"
    corrected: str | None = None
    corrected_kind: str | None = None
    witness: dict | None = None
    evidence: str = "difference is the zero polynomial"
    rests_on: tuple = ()
    seconds: float = 0.125

    def as_dict(self):
        data = asdict(self)
        data["verdict"] = data.pop("kind")
        return data


CLAIMS = [
    FakeClaim("e:meq", "the fixed points of the blown-up map at a tangency solve an equation that is linear in r"),
    FakeClaim("e:qdef", "Q_r is the leading part of the return map in fold coordinates"),
    FakeClaim("p:odd", "a formula with a sign that is wrong as it stands in the print"),
]
VERDICTS = {
    "e:meq": FakeVerdict("e:meq"),
    "e:qdef": FakeVerdict("e:qdef", effective="supported", rests_on=("p:odd",)),
    "p:odd": FakeVerdict(
        "p:odd", "corrected", "proved", r"a = -\frac{b}{2}", r"a = \frac{b}{2}", "proved", {"a": "1", "b": 2}
    ),
}


def claims_room(verdicts=VERDICTS):
    """A module with the interface of `singimpact.claims` and three claims."""
    room = ModuleType("singimpact.claims")

    def select(ids=None):
        known = [claim.id for claim in CLAIMS]
        for name in ids or ():
            if name not in known:
                raise unknown("claim", name, known)
        return [claim for claim in CLAIMS if ids is None or claim.id in ids]

    def run(claims, on_start=None, on_end=None):  # noqa: ARG001
        for at, claim in enumerate(claims, 1):
            if on_start:
                on_start(claim, at, len(claims))
        return [verdicts[claim.id] for claim in claims]

    room.select, room.run, room.CLAIMS = select, run, CLAIMS
    return room
