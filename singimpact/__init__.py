"""An impact oscillator near a degenerate graze: theory that is executable, exact and checkable.

Everything public is reached from here; a name loads its room when it is first used.
"""

from typing import TYPE_CHECKING, Any

from singimpact.inputs import InputError as InputError
from singimpact.status import Cause as Cause, Status as Status

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
    from singimpact.certificates.certificate import certify as certify, read_certificate as read_certificate
    from singimpact.contact.points import tangency_points as tangency_points
    from singimpact.dynamics.lyapunov import lyapunov as lyapunov
    from singimpact.dynamics.threshold import threshold as threshold
    from singimpact.impact_oscillator import (
        ImpactOscillator as ImpactOscillator,
        linear as linear,
        read_model as read_model,
        shaken_wall as shaken_wall,
        universal as universal,
    )
    from singimpact.models import Models as _Models
    from singimpact.paper.claims import Claims as _Claims
    from singimpact.paper.claims.verdicts import verify as verify
    from singimpact.paper.figures import figure as figure
    from singimpact.paper.sections.errata import errata as errata
    from singimpact.scenes import Scene as Scene, plot as plot
    from singimpact.scenes.explore import explore as explore
    from singimpact.scenes.orbit_picture import animate as animate
    from singimpact.studies import (
        basins as basins,
        bifurcation as bifurcation,
        certified_gamma as certified_gamma,
        chatter_limit as chatter_limit,
        classify as classify,
        grown_gamma as grown_gamma,
        orbit as orbit,
        periodic as periodic,
        swan_points as swan_points,
    )
    from singimpact.surface.impact_surface import ImpactSurface as ImpactSurface
    from singimpact.theory import fixed_points as fixed_points

    claims: _Claims
    models: _Models

__version__ = "0.1.0"

_ROOMS = {
    "claims": "singimpact.paper.claims",
    "models": "singimpact.models",
    "theory": "singimpact.theory",
    "fixed_points": "singimpact.theory.fixed_points",
}
_FILES = {
    "bench.selftest.run": "selftest",
    "branches.border": "border_orbits",
    "branches.branch": "branch",
    "branches.event_curve": "event_curve",
    "branches.homoclinic": "homoclinic_points",
    "branches.manifold": "manifold",
    "branches.transitions": "transitions",
    "cases": "sweep",
    "certificates.certificate": "certify read_certificate",
    "contact.points": "tangency_points",
    "dynamics.lyapunov": "lyapunov",
    "dynamics.threshold": "threshold",
    "impact_oscillator": "ImpactOscillator linear read_model shaken_wall universal",
    "paper.claims.verdicts": "verify",
    "paper.figures": "figure",
    "paper.sections.errata": "errata",
    "scenes": "Scene plot",
    "scenes.explore": "explore",
    "scenes.orbit_picture": "animate",
    "studies": "basins bifurcation certified_gamma chatter_limit classify grown_gamma orbit periodic swan_points",
    "surface.impact_surface": "ImpactSurface",
}
_HOMES = {name: f"singimpact.{file}" for file, names in _FILES.items() for name in names.split()}
__all__ = sorted(["Cause", "InputError", "Status", *_ROOMS, *_HOMES])


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

    near = nearest(name, __all__)
    hint = f"the nearest known are {', '.join(near)}" if near else "dir(singimpact) lists what it has"
    return f"module 'singimpact' has no attribute {name!r}: {hint}"


def __dir__() -> list[str]:
    return __all__
