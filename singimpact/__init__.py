"""An impact oscillator near a degenerate graze: theory that is executable, exact and checkable.

Everything public is reached from here; a name loads its room when it is first used.
"""

from typing import TYPE_CHECKING, Any

from singimpact.inputs import InputError as InputError
from singimpact.status import Cause as Cause
from singimpact.status import Status as Status

if TYPE_CHECKING:
    from singimpact import theory as theory
    from singimpact.bench.selftest.run import selftest as selftest
    from singimpact.branches.border import border_orbits as border_orbits
    from singimpact.branches.branch import branch as branch
    from singimpact.branches.event_curve import event_curve as event_curve
    from singimpact.branches.homoclinic import homoclinic_points as homoclinic_points
    from singimpact.branches.manifold import manifold as manifold
    from singimpact.branches.transitions import transitions as transitions
    from singimpact.cases import sweep as sweep
    from singimpact.certificates.certificate import certify as certify
    from singimpact.certificates.certificate import read_certificate as read_certificate
    from singimpact.contact.points import tangency_points as tangency_points
    from singimpact.dynamics.lyapunov import lyapunov as lyapunov
    from singimpact.dynamics.threshold import threshold as threshold
    from singimpact.impact_oscillator import ImpactOscillator as ImpactOscillator
    from singimpact.impact_oscillator import linear as linear
    from singimpact.impact_oscillator import read_model as read_model
    from singimpact.impact_oscillator import shaken_wall as shaken_wall
    from singimpact.impact_oscillator import universal as universal
    from singimpact.paper.claims import Claims as _Claims
    from singimpact.paper.claims.verdicts import verify as verify
    from singimpact.paper.figures import figure as figure
    from singimpact.paper.sections.errata import errata as errata
    from singimpact.scenes import Scene as Scene
    from singimpact.scenes import plot as plot
    from singimpact.scenes.explore import explore as explore
    from singimpact.studies import basins as basins
    from singimpact.studies import bifurcation as bifurcation
    from singimpact.studies import classify as classify
    from singimpact.studies import grown_gamma as grown_gamma
    from singimpact.studies import swan_points as swan_points
    from singimpact.surface.impact_surface import ImpactSurface as ImpactSurface
    from singimpact.theory import fixed_points as fixed_points

    claims: _Claims

__version__ = "0.1.0"

_ROOMS = {
    "claims": "singimpact.paper.claims",
    "theory": "singimpact.theory",
    "fixed_points": "singimpact.theory.fixed_points",
}
_HOMES = {
    "ImpactOscillator": "singimpact.impact_oscillator",
    "border_orbits": "singimpact.branches.border",
    "branch": "singimpact.branches.branch",
    "event_curve": "singimpact.branches.event_curve",
    "homoclinic_points": "singimpact.branches.homoclinic",
    "manifold": "singimpact.branches.manifold",
    "linear": "singimpact.impact_oscillator",
    "universal": "singimpact.impact_oscillator",
    "lyapunov": "singimpact.dynamics.lyapunov",
    "read_model": "singimpact.impact_oscillator",
    "tangency_points": "singimpact.contact.points",
    "shaken_wall": "singimpact.impact_oscillator",
    "swan_points": "singimpact.studies",
    "sweep": "singimpact.cases",
    "certify": "singimpact.certificates.certificate",
    "read_certificate": "singimpact.certificates.certificate",
    "basins": "singimpact.studies",
    "bifurcation": "singimpact.studies",
    "classify": "singimpact.studies",
    "grown_gamma": "singimpact.studies",
    "transitions": "singimpact.branches.transitions",
    "threshold": "singimpact.dynamics.threshold",
    "ImpactSurface": "singimpact.surface.impact_surface",
    "plot": "singimpact.scenes",
    "explore": "singimpact.scenes.explore",
    "Scene": "singimpact.scenes",
    "figure": "singimpact.paper.figures",
    "verify": "singimpact.paper.claims.verdicts",
    "errata": "singimpact.paper.sections.errata",
    "selftest": "singimpact.bench.selftest.run",
}
_PUBLIC = sorted(["Cause", "InputError", "Status", *_ROOMS, *_HOMES])


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _ROOMS:
        return import_module(_ROOMS[name])
    if name in _HOMES:
        found = globals()[name] = getattr(import_module(_HOMES[name]), name)
        return found
    raise AttributeError(_no_such(name))


def _no_such(name: str) -> str:
    if name.startswith("__"):
        return f"module 'singimpact' has no attribute {name!r}"
    from singimpact.inputs import nearest

    near = nearest(name, _PUBLIC)
    hint = f"the nearest known are {', '.join(near)}" if near else "dir(singimpact) lists what it has"
    return f"module 'singimpact' has no attribute {name!r}: {hint}"


def __dir__() -> list[str]:
    return _PUBLIC
