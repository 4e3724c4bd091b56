"""Stand-ins for rooms, so that the shell is tested by itself: what it asks for and what it makes of the answer."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from importlib import import_module
from types import ModuleType, SimpleNamespace

import singimpact
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
    certificates: tuple = ()
    trials: tuple = ()
    effective_modulo: tuple = ()
    title: str = "a statement"

    @property
    def worth(self):
        return self.effective

    @property
    def in_words(self):
        return self.kind if self.effective == self.kind else f"{self.kind} ({self.effective})"

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


def _folder_of(room):
    """The folder of `claims` inside a room, where the import system looks for its files."""
    return [f"{place}/claims" for place in import_module(room).__path__]


def claims_room(verdicts=VERDICTS):
    """A module with the interface of `singimpact.paper.claims` and three claims."""
    room = ModuleType("singimpact.paper.claims")
    room.__path__ = _folder_of("singimpact.paper")  # its files stay importable

    def select(ids=None):
        known = [claim.id for claim in CLAIMS]
        for name in ids or ():
            if name not in known:
                raise unknown("claim", name, known)
        return [claim for claim in CLAIMS if ids is None or claim.id in ids]

    def run(claims, on_start=None, on_end=None, cached=False):  # noqa: ARG001
        for at, claim in enumerate(claims, 1):
            if on_start:
                on_start(claim, at, len(claims))
        return [verdicts[claim.id] for claim in claims]

    room.select, room.run, room.CLAIMS = select, run, CLAIMS
    return room


def oscillator_room():
    """A module with the interface of `singimpact.impact_oscillator`, flights made up."""
    import numpy as np

    from singimpact.algebra import float_array
    from singimpact.dynamics import Orbit
    from singimpact.oscillator import Oscillator, read_fields

    class ImpactOscillator(Oscillator):
        def impact_map(self, tau, v, *, digits=None, tolerance=None, horizon=None, wall=None):  # noqa: ARG002
            tau, v = np.broadcast_arrays(float_array("tau", tau), float_array("v", v))
            gone = tau >= 2
            time = np.where(gone, np.inf, 0.25)
            if digits:
                import mpmath

                with mpmath.workdps(digits + 5):
                    time = np.array([mpmath.mpf(1) / 3 for _ in tau])
            status = np.where(gone, 3, 0).astype(np.int8)
            proofs = {"certified": np.full(tau.shape, None), "notes": {0: "not certified: a fake"}}
            return SimpleNamespace(tau=tau + 0.25, v=v, flight_time=time, status=status, wall=None, **proofs)

        def orbit(self, tau, v, impacts=200, horizon=None, wall=None):  # noqa: ARG002
            tau, v = float_array("tau", tau), float_array("v", v)
            kinds = np.array(["impact", "rest"])
            return Orbit(self, np.array([tau, tau + 0.5]), np.array([v, 0]), kinds, [("sticking", 1.5, 2)], 2.0)

    room = ModuleType("singimpact.impact_oscillator")
    room.ImpactOscillator = ImpactOscillator
    room.linear = lambda omega, clearance, restitution: ImpactOscillator("x", f"cos({omega}*t)", clearance, restitution)
    room.read_model = lambda path: ImpactOscillator(**read_fields(path))
    return room


def scenes_room():
    """A module whose `plot` and `orbit_sheet` draw a point."""
    room = ModuleType("singimpact.scenes")
    room.__path__ = [f"{folder}/scenes" for folder in singimpact.__path__]  # its other files are the true ones

    def plot(orbit):
        from matplotlib.figure import Figure

        axes = Figure().subplots()
        axes.plot(orbit.tau, orbit.v)
        return axes

    room.plot = plot
    room.orbit_sheet = lambda orbit: plot(orbit).figure
    return room
