"""The public names with their homes: `__init__.py` loads each from here when it is first used."""

from singimpact import theory as theory
from singimpact.bench.selftest.run import selftest as selftest
from singimpact.branches.border import border_orbits as border_orbits
from singimpact.branches.branch import branch as branch
from singimpact.branches.certified_diagram import certified_diagram as certified_diagram
from singimpact.branches.doublings import cascade as cascade
from singimpact.branches.event_curve import event_curve as event_curve
from singimpact.branches.homoclinic import homoclinic_points as homoclinic_points
from singimpact.branches.homoclinic_end import homoclinic_end as homoclinic_end
from singimpact.branches.manifold import manifold as manifold
from singimpact.branches.resting_windows import resting_windows as resting_windows
from singimpact.branches.transitions import transitions as transitions
from singimpact.cases import sweep as sweep
from singimpact.certificates.certificate import certify as certify, read_certificate as read_certificate
from singimpact.contact.contacts_over import contact_points as contact_points
from singimpact.contact.points import tangency_points as tangency_points
from singimpact.dynamics.bifurcation_diagram import bifurcation as bifurcation
from singimpact.dynamics.ensemble import ensemble as ensemble
from singimpact.dynamics.fit import fit as fit
from singimpact.dynamics.lyapunov import lyapunov as lyapunov
from singimpact.dynamics.regions import regions as regions
from singimpact.dynamics.release_map import release_map as release_map
from singimpact.dynamics.threshold import threshold as threshold
from singimpact.flights.derivative import sensitivity as sensitivity
from singimpact.impact_oscillator import (
    ImpactOscillator as ImpactOscillator,
    linear as linear,
    read_model as read_model,
    shaken_wall as shaken_wall,
    universal as universal,
)
from singimpact.inputs import InputError as InputError
from singimpact.models import Models as _Models
from singimpact.paper.claims import Claims as _Claims
from singimpact.paper.claims.verdicts import verify as verify
from singimpact.paper.figures import figure as figure
from singimpact.paper.sections.errata import errata as errata
from singimpact.scenes import Scene as Scene, plot as plot
from singimpact.scenes.explore import explore as explore
from singimpact.scenes.orbit_picture import animate as animate
from singimpact.status import Cause as Cause, Status as Status
from singimpact.studies import (
    basins as basins,
    certified_gamma as certified_gamma,
    chatter_limit as chatter_limit,
    classify as classify,
    constants as constants,
    grown_gamma as grown_gamma,
    orbit as orbit,
    periodic as periodic,
    swan_points as swan_points,
)
from singimpact.surface.impact_surface import ImpactSurface as ImpactSurface
from singimpact.theory import fixed_points as fixed_points

claims: _Claims
models: _Models
__version__: str
__all__: list[str]
