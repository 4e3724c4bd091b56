"""Long-term behaviours of orbits and their names, the same in basins and in bifurcation diagrams."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.dynamics import attractors
from singimpact.dynamics.settling import Study
from singimpact.flights.horizons import horizon_of
from singimpact.flights.orbits import signed_iterate

# Distance of the states of an attractor at neighbouring values of a number, in periods and highest velocities, from
# which on they are two attractors; the (1, 1) orbit of x'' + x = cos 2t moves by 0.15 from c = 0.25 to 0.3
JUMP = 0.25
KINDS = {
    attractors.OTHER: "not decided",
    attractors.CHAOS: "chaotic",
    attractors.GONE: "never returns",
    attractors.AWAY: "no impact",
    attractors.STUCK: "unresolved",
    attractors.SENSITIVE: "sensitive",
    attractors.LEVEL: "continuum",
}


@dataclass(frozen=True)
class LongRun:
    """An attractor, or another long-term behaviour.

    Attributes
    ----------
    kind : "orbit"; "chatter" (it completes again and again); "rest" (on the wall); "equilibrium" (a rest off the wall);
        "quasi-periodic" (the forcing never repeats, and neighbours come together); "chaotic" (no period within
        `impacts`, and neighbours separate); "not decided" (no period, and they do not); "sensitive" (there are several
        attractors, or chatter comes again after more than 60 impacts, and a neighbour 1e-15 away parts from the orbit:
        more than doubles would decide); "continuum" (without a clock: the orbit closes, and its neighbours do); "no
        impact" (none within `horizon`); "never returns" (proved); "unresolved" (a flight is: `osc.orbit` says which).
    n, k : impacts (inf for chatter) in k periods, of an orbit or of chatter; 0 otherwise. A limit cycle has k = 0, and
        n = 0 where it does not touch the wall.
    tau, v : the states of an orbit; of chatter the phase at which the mass lifts off, and 0; where
        the forcing never repeats, one late impact.
    period : of a limit cycle. x : of an equilibrium; of a limit cycle without impact the least one.
    word : of a model with two walls their letters l and u, in the order of the impacts of an orbit; of a rest its wall,
        and of chatter one from which the mass lifts off. v is < 0 at the upper wall there.
    """

    kind: str
    n: float
    k: int
    tau: Array
    v: Array
    impacts: int = 0
    horizon: float = 0.0
    period: float = 0.0
    x: float = np.nan
    word: str = ""

    @property
    def name(self) -> str:
        """The name in the legend of the picture, and what would decide a class that is not decided."""
        if self.kind == "orbit" and self.k:
            return f"({self.word or f'{self.n:.0f}'}, {self.k}) orbit"
        count = f"{self.impacts:,}".replace(",", " ")
        wall = {"l": "lower", "u": "upper"}.get(self.word, "")
        lifts_off, at_wall = (f", lifts off the {wall} wall", f" at the {wall} wall") if wall else ("", "")
        touches = f"of {self.n:.0f} impact" + "s" * (self.n > 1) if self.n else "without impact"
        names = {
            "orbit": f"limit cycle {touches}, period {self.period:.6g}",
            "equilibrium": f"rest off the wall at x = {self.x:.6g}",
            "chatter": f"{f'(inf, {self.k}) ' if self.k else ''}chatter for ever{lifts_off}",
            "rest": f"rest for ever{at_wall}",
            "chaotic": f"no period in {count} impacts, neighbours separate",
            "not decided": f"not settled in {count} impacts: larger impacts= may decide",
            "sensitive": "rounding decides: neighbours 1e-15 away part",
            "no impact": f"no impact within {self.horizon:.4g}",
            "continuum": "closes beside others that close: nothing attracts",
            "unresolved": "a flight is unresolved: osc.orbit says which",
        }
        return names.get(self.kind, self.kind)


def behaviour(study: Study, row: Array) -> LongRun:
    """The long-term behaviour that a row of `classify` stands for.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> behaviour(Study(Oscillator("x", "-1", 0, 1), (), 1.0, 100), np.array([attractors.CHATTER, -1.0, 0.0])).name
    'rest for ever'
    """
    model, (code, tau, v) = study.model, row.tolist()
    none, wall = np.zeros(0), as_float(model.clearance)
    if code >= attractors.PLACES:
        n, k = divmod(int(code), attractors.PLACES)
        times, speeds = attractors.states_of(model, int(code), tau, v)
        # of a cycle the sum of its flights, each from time 0
        period = k * study.phases.unit or float(signed_iterate(model, 0 * speeds, speeds, 1).tau.sum())
        letters = "".join("lu"[speed < 0] for speed in speeds.tolist())
        word = "" if model.upper is None else min(letters[i:] + letters[:i] for i in range(n))
        return LongRun("orbit", n, k, times, speeds, period=period, word=word)
    if code == attractors.CYCLE:
        return LongRun("orbit", 0, 0, none, none, period=tau, x=wall + v)
    if code == attractors.STILL:
        return LongRun("equilibrium", 0, 0, none, none, x=wall + tau)
    if code == attractors.CHATTER:
        lifted = study.lift_offs[int(tau) :][:1] if tau >= 0 else ()
        walls = [side for _, side in lifted] if tau >= 0 else [int(-1 - tau)]
        word = "lu"[walls[0]] if walls and model.upper is not None else ""
        at = np.array([phase for phase, _ in lifted])
        return LongRun("chatter" if tau >= 0 else "rest", np.inf, int(v), at, 0 * at, word=word)
    if code == attractors.RESPONSE:
        return LongRun("quasi-periodic", 0, 0, np.array([tau]), np.array([v]))
    if code == attractors.RESTING:
        return LongRun("chatter", np.inf, 0, none, none)
    return LongRun(KINDS[int(code)], 0, 0, none, none, study.impacts, horizon_of(model, None))


def matched(
    groups: Sequence[Sequence[LongRun]], units: Sequence[float], fast: float, jump: float = JUMP
) -> tuple[list[LongRun], list[list[int]]]:
    """Attractors of a sequence of models, each at the last model that has it, and the numbers of those of each model.

    Parameters
    ----------
    groups : those of each model. units : the period of each, inf where states have no phase. fast : a velocity.
    jump : the distance of states, in periods and in `fast`, from which on attractors of one class are two.

    Examples
    --------
    >>> runs = [LongRun("orbit", 1, 1, np.array([0.1]), np.array([v])) for v in (1.0, 1.05, 2.0)]
    >>> matched([[run] for run in runs], [1.0] * 3, 2.0)[1]
    [[0], [0], [1]]
    """
    last, labels, alike = list[tuple[LongRun, float]](), list[list[int]](), dict[tuple[Any, ...], list[int]]()
    for runs, unit in zip(groups, units, strict=True):
        own, kin = dict[int, int](), [alike.setdefault((run.kind, run.n, run.k, run.word), []) for run in runs]
        gaps = [(_gap((run, unit), last[k], fast), i, k) for i, run in enumerate(runs) for k in kin[i]]
        for gap, i, label in sorted(gaps):
            if gap < jump and i not in own and label not in own.values():
                own[i] = label
        for i, run in enumerate(runs):
            label = own.setdefault(i, len(last))
            kin[i] += [label] if label == len(last) else []
            last[label : label + 1] = [(run, unit)]
        labels.append([own[i] for i in range(len(runs))])
    return [run for run, _ in last], labels


def _gap(one: tuple[LongRun, float], other: tuple[LongRun, float], fast: float) -> float:
    """The largest distance of a state of an attractor from the nearest one of another of its class."""
    (run, unit), (old, before) = one, other
    turns, speeds = np.subtract.outer(run.tau / unit, old.tau / before), np.subtract.outer(run.v, old.v) / fast
    away = np.maximum(np.abs(turns - np.rint(turns)), np.abs(speeds))
    places = np.nan_to_num(abs(run.x - old.x) / max(abs(run.x), abs(old.x), 1e-300))
    return float(max(away.min(axis=0, initial=1.0).max(initial=places), away.min(axis=1, initial=1.0).max(initial=0.0)))
