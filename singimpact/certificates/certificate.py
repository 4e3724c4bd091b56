"""`certify` and `read_certificate`: a certified result as a file that the second program accepts."""

import json
import subprocess
import sys
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from singimpact.algebra import Certified, from_ball, sign_of
from singimpact.branches import BorderOrbit, EnclosedEvent, EnclosedOrbit, Horseshoe, HorseshoeFamily, PeriodicOrbit
from singimpact.certificates import checker
from singimpact.dynamics import CertifiedGamma, ChatterLimit
from singimpact.flights.results import CertifiedImpact, Flight
from singimpact.inputs import InputError, checked_keywords, need, refuse, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator, require_rebound
from singimpact.status import Status, Wall
from singimpact.store import write_text

CHECKER = Path(__file__).with_name("checker")  # the second program: `python checker FILE.json`
# Distance, at most, within which an orbit is certified to be alone: the second program has no frames for boxes.
UNIQUE = Fraction(1, 10**8)
DIGITS = 12  # of a state, at least
SERIES_DIGITS, LOOSER = 18, 1.01  # digits of the coefficients of gamma; factor by which bounds are written larger
FREER = 1.2  # that of the residual of nonlinear models, whose series the second program cuts on a disc of its own
IMPACT = ("flight_time", "velocity", "tau", "v")
LOST, LOOSE = 6, 1000  # digits that are left out of a multiplier, and factor of its radius


@dataclass(frozen=True)
class Certificate:
    """A certified result as text that the second program reads.

    Attributes
    ----------
    content : schema, statement, model, launch, and the numbers with their radii, all as text; and a digest of these.
    """

    content: dict[str, Any]

    @property
    def text(self) -> str:
        """The certificate as JSON."""
        return json.dumps(self.content, indent=2, ensure_ascii=False) + "\n"

    def save(self, path: Any) -> None:
        """Write the certificate to a file."""
        write_text(path, self.text)

    def check(self, seconds: int = checker.SECONDS) -> None:
        """Let the second program enclose the motion again, in a process of its own, within so many seconds of CPU.

        Raises
        ------
        InputError : it does not accept the certificate; its reason.
        """
        limited = [sys.executable, "-I", str(CHECKER), "--seconds", str(whole("seconds", seconds, 1, 10**6))]
        with TemporaryDirectory() as folder:
            self.save(f"{folder}/certificate.json")
            done = subprocess.run([*limited, f"{folder}/certificate.json"], capture_output=True, text=True, check=False)
        if done.returncode:
            reason = (done.stdout or done.stderr).strip().partition("refused: ")[2] or done.stderr.strip()
            raise InputError(f"the certificate is refused: {reason}")

    def __repr__(self) -> str:
        return f"<certificate of {checker.sentence(self.content)}>"


@checked_keywords
@takes_two_walls
def certify(result: Any) -> Certificate:
    """The certificate of a certified result.

    Parameters
    ----------
    result : of `osc.impact_map` or `osc.first_hit` for one state with `digits`; a periodic orbit with impacts, of
        `osc.periodic`; or the `.certified` of one of these. `osc.chatter_limit` of one state with v > 0 and with
        `digits`; `crossing.horseshoe()` or `.horseshoes(over, between)`; `event.certified()` over a parameter of g or
        f; an orbit of `si.border_orbits` with `digits`; or `osc.certified_gamma()`.

    Returns
    -------
    Certificate : `.save("file.json")` writes it, `.check()` lets the second program check it.

    Raises
    ------
    InputError : another kind of result; one that is not certified, with the reason.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> found = certify(linear("2.8", 0, "0.8").impact_map("0.9", "0.3", digits=5))
    >>> found
    <certificate of the first impact from (0.9, 0.3): tau = 1.533940 +- 1.55e-6, v = 0.2033385 +- 2.10e-7>
    >>> found.check()
    >>> certify(linear(4, 0, "0.5").periodic(1, 2)[0].certified(15)).content["states"][0]["tau"]
    {'value': '1.1780972450961725', 'radius': '1.19e-16'}
    """
    if isinstance(result, ChatterLimit):
        return _of_limit(result)
    if isinstance(result, Horseshoe):
        return _sealed("horseshoe", result.oscillator, _of_horseshoe(result))
    if isinstance(result, HorseshoeFamily):
        return _over(result.over, _sealed("horseshoes", result.oscillator, _of_family(result)))
    if isinstance(result, EnclosedEvent):
        return _of_event(result)
    if isinstance(result, BorderOrbit):
        return _of_border(result)
    if isinstance(result, CertifiedGamma):
        return _sealed("invariant arc", result.oscillator, _of_gamma(result))
    orbit = result.certified() if isinstance(result, PeriodicOrbit) else result
    if isinstance(orbit, EnclosedOrbit) and orbit.oscillator is not None:
        return _sealed("periodic orbit", orbit.oscillator, _of_orbit(orbit))
    impact = result.certified if isinstance(result, Flight) else result
    if isinstance(result, Flight) and impact is None:
        why = "; ".join(result.notes.values()) or "it has no digits=: ask for some"
        raise InputError(f"the result is not certified: {why}")
    if not isinstance(impact, CertifiedImpact) or impact.oscillator is None:
        raise refuse(
            "result",
            result,
            "what osc.impact_map(tau, v, digits=30) or osc.chatter_limit(tau, v, digits=30) gives "
            "for one state, a periodic orbit, or a horseshoe",
        )
    numbers = {name: getattr(impact, name).as_dict() for name in IMPACT}
    launch = {name: str(coordinate) for name, coordinate in zip(("tau", "v"), impact.launch, strict=True)}
    if impact.oscillator.upper is not None:
        launch["wall"] = Wall(impact.wall).name
    return _sealed("first impact", impact.oscillator, {"launch": launch, **numbers})


def _sealed(statement: str, model: Oscillator, numbers: dict[str, Any]) -> Certificate:
    require_rebound(model, "a certificate")
    if model.parametric and statement not in checker.IN_TIME:
        raise InputError(
            f"the {statement} is not certified in a file: f = {model.f} depends on t, and of such a model the second "
            f"program checks {', '.join(checker.IN_TIME)}"
        )
    if model.upper is not None and (statement not in checker.BETWEEN or numbers.get("kind") in checker.TOUCHING):
        raise InputError(
            f"the {statement} is not certified in a file: of a model with two walls the second program checks "
            f"{', '.join(checker.BETWEEN)} without a graze"
        )
    content = {"schema": checker.SCHEMA, "statement": statement, "model": model.to_dict(), **numbers}
    return Certificate({**content, "digest": checker.digest_of(content)})


def _of_orbit(orbit: EnclosedOrbit) -> dict[str, Any]:
    """The statement of a certificate of a periodic orbit, as text."""
    assert orbit.oscillator is not None
    states = [
        {"tau": _narrow(tau).as_dict(), "v": _narrow(v).as_dict()} for tau, v in zip(orbit.tau, orbit.v, strict=True)
    ]
    widest = max(Fraction(number["radius"]) for state in states for number in state.values())
    _at_walls(states, orbit.word)
    precise = [pair for pair in orbit.multipliers or () if pair[0].digits > 2 * LOST]  # others say next to nothing
    multipliers = [{"real": _wider(real), "imaginary": _wider(imaginary)} for real, imaginary in precise]
    return {
        "period": str(orbit.oscillator.period),
        "periods": str(orbit.k),
        "states": states,
        "unique_within": str(min(orbit.unique_within, max(UNIQUE, 4 * widest))),
        "multipliers": multipliers,
    }


def _at_walls(states: list[dict[str, Any]], word: tuple[int, ...]) -> None:
    """Write the walls of states between two walls."""
    for state, wall in zip(states, word, strict=False):
        state["wall"] = Wall(wall).name


def _narrow(number: Certified) -> Certified:
    """A number with enough digits for its radius to be within the box in which the orbit is alone."""
    return replace(number, digits=max(number.digits, DIGITS))


def _of_limit(limit: ChatterLimit) -> Certificate:
    if limit.certified is None or limit.oscillator is None:
        raise InputError(
            "the chatter limit is not certified: it needs digits=, one state, and a number for restitution"
        )
    need(sign_of(limit.launch[1]), InputError("a chatter that starts at rest has no certificate: launch with v > 0"))
    launch = {name: str(coordinate) for name, coordinate in zip(("tau", "v"), limit.launch, strict=True)}
    ends = "lift-off" if limit.status == Status.lifts_off else "accumulation"
    statement = {"launch": launch, "ends": ends, "tau": limit.certified.as_dict()}
    return _sealed("chatter limit", limit.oscillator, statement)


def _of_event(event: EnclosedEvent) -> Certificate:
    if event.kind not in checker.KINDS or event.oscillator is None:
        raise InputError(f"a {event.kind} has no certificate as a file: only a {' or a '.join(checker.KINDS)} has one")
    if event.over not in event.oscillator.parameters:
        raise InputError(
            f"an event over the {event.over} has no certificate as a file: only those over a parameter have"
        )
    states = [{"tau": tau.as_dict(), "v": v.as_dict()} for tau, v in zip(event.tau, event.v, strict=True)]
    _at_walls(states, event.word)
    statement = {
        "kind": event.kind,
        "over": event.over,
        "period": str(event.oscillator.period),
        "periods": str(event.k),
        "parameter": event.parameter.as_dict(),
        "states": states,
    }
    if event.kind in checker.TOUCHING:
        states[0]["v"] = {"value": "0", "radius": event.tau[0].as_dict()["radius"]}
        statement["unique_within"] = str(min(event.unique_within, UNIQUE))
    return _sealed("event", event.oscillator, statement)


def _of_border(orbit: BorderOrbit) -> Certificate:
    if orbit.certified is None or orbit.oscillator.period is None:
        why = "is not certified" if orbit.certified is None else "of a model without a period has no file"
        raise InputError(f"the border orbit {why}: {'; '.join(orbit.notes) or 'ask for digits= and a period'}")
    statement = {
        "over": orbit.over,
        "parameter": orbit.certified.as_dict(),
        "release": repr(float(orbit.release)),
        "end": repr(float(orbit.end)),
        "impacts": str(orbit.returned.entry),
        "completes": orbit.side,
    }
    return _over(orbit.over, _sealed("border orbit", orbit.oscillator, statement))


def _over(over: str, sealed: Certificate) -> Certificate:
    """The certificate whose model has the number by its name, where it is no parameter anyway."""
    if over in sealed.content["model"].get("parameters", {}):
        return sealed
    model = {**sealed.content["model"], over: over}
    content = {name: entry for name, entry in sealed.content.items() if name != "digest"} | {"model": model}
    return Certificate({**content, "digest": checker.digest_of(content)})


def _of_horseshoe(horseshoe: Horseshoe) -> dict[str, Any]:
    """The statement of a certificate of a horseshoe, as text."""
    return {
        "period": str(horseshoe.oscillator.period),
        **_of_sets(horseshoe, ("centre", "radii")),
        "entropy": horseshoe.entropy.as_dict(),
    }


def _of_sets(horseshoe: Horseshoe, pairs: tuple[str, ...]) -> dict[str, Any]:
    sets = [
        {name: [str(x) for x in getattr(crossed, name)] for name in pairs}
        | {"frame": [[str(x) for x in row] for row in crossed.frame]}
        for crossed in horseshoe.sets
    ]
    return {"loops": [str(n) for n in horseshoe.loops], "sets": sets}


def _of_family(family: HorseshoeFamily) -> dict[str, Any]:
    """The statement of a certificate of horseshoes for all values of a number, as text."""
    (low, high), number, pieces = family.between, family.between[0], []
    for piece in family.pieces:
        number += piece.reach
        sets = _of_sets(piece, ("centre", "radii", "drift"))
        pieces.append({"number": str(number), "reach": str(piece.reach), **sets})
        number += piece.reach
    return {
        "over": family.over,
        "between": [str(low), str(high)],
        "period": str(family.oscillator.period),
        "entropy": family.entropy.as_dict(),
        "pieces": pieces,
    }


def _of_gamma(gamma: CertifiedGamma) -> dict[str, Any]:
    """The statement of a certificate of gamma, as text; bounds leave room for another evaluation of the same lemmas."""
    loose = FREER if gamma.fastest else LOOSER
    boxes = [
        {
            "lambda": [str(box.low), str(box.high)],
            "N": str(box.settings.N),
            "D": str(box.settings.D),
            "pieces": str(box.settings.pieces),
            "eta": f"{float(box.eta):.6g}",
            "M": f"{float(box.M):.6g}",
            "series": [_with_room(from_ball(number, SERIES_DIGITS)) for number in box.series],
            "R": _bound(box.R, loose),
            "Kl": _bound(box.Kl, LOOSER**2 * loose),
            "grow": _bound(box.grow, 2 - LOOSER),
            "tree": box.tree,
        }
        for box in gamma.boxes
    ]
    after = gamma.lost or gamma.settled
    statement = {
        "order": str(gamma.order),
        "tau": gamma.tau.as_dict(),
        "reach": str(gamma.reach),
        "restitution": "model" if gamma.of_model else [str(end) for end in gamma.restitution or ()],
        "after": {name: str(number) for name, number in after._asdict().items()} if after else {},
        "boxes": boxes,
    }
    if gamma.fastest:
        statement["fastest"] = f"{0.99 * float(gamma.fastest.value):.4g}"
    return {**statement, "threshold": _with_room(gamma.at_reach())} if gamma.of_model else statement


def _with_room(number: Certified) -> dict[str, str]:
    """A number with a radius that leaves room for another enclosure."""
    texts = number.as_dict()
    return {"value": texts["value"], "radius": f"{1.5 * float(texts['radius']):.3g}"}


def _bound(ball: Any, factor: float) -> str:
    return str(float(f"{factor * float(ball.mid()):.6g}"))


def _wider(number: Certified) -> dict[str, str]:
    """A multiplier with a radius that leaves room for another enclosure of the derivative."""
    texts = number.as_dict()
    least = Fraction(max(abs(Fraction(texts["value"])), Fraction(1))) / 10 ** (number.digits - LOST)
    radius = max(LOOSE * Fraction(texts["radius"]), least)
    return {"value": texts["value"], "radius": f"{float(radius):.3g}"}


@checked_keywords
def read_certificate(path: Any, seconds: int = checker.SECONDS) -> Certificate:
    """A certificate from a file, once the second program has accepted it within so many seconds of CPU.

    Raises
    ------
    InputError : no such file, no certificate; or one that is refused, with the reason.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> with TemporaryDirectory() as folder:
    ...     certify(linear("2.8", 0, "0.8").impact_map("0.9", "0.3", digits=20)).save(f"{folder}/impact.json")
    ...     print(read_certificate(f"{folder}/impact.json").content["v"]["radius"])
    2.05e-22
    """
    try:
        content = checker.read(path)
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    except checker.Refused as reason:
        raise InputError(f"{path} is no certificate: {reason}") from None
    certificate = Certificate(content if isinstance(content, dict) else {})
    certificate.check(seconds)
    return certificate
