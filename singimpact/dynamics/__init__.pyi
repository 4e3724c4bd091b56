"""Names that `dynamics` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.dynamics.attractors import (
    CHAOS as CHAOS,
    CHATTER as CHATTER,
    OTHER as OTHER,
    caught as caught,
    closing_orbits as closing_orbits,
    new_attractors as new_attractors,
)
from singimpact.dynamics.basins_of_attraction import (
    Basins as Basins,
    ClassGrid as ClassGrid,
    basins as basins,
    entropy_of as entropy_of,
    uncertainty_of as uncertainty_of,
)
from singimpact.dynamics.basins_over import BasinsOver as BasinsOver
from singimpact.dynamics.behaviours import LongRun as LongRun, matched as matched
from singimpact.dynamics.bifurcation_diagram import Bifurcation as Bifurcation, bifurcation as bifurcation
from singimpact.dynamics.chatter import (
    ENDING as ENDING,
    ChatterLimit as ChatterLimit,
    chatter_left as chatter_left,
    chatter_limit as chatter_limit,
)
from singimpact.dynamics.enclosed import end_of_gamma as end_of_gamma, guided as guided, newton as newton
from singimpact.dynamics.families import OscillatorFamily as OscillatorFamily, in_parts as in_parts
from singimpact.dynamics.fit import Fit as Fit
from singimpact.dynamics.gamma_proof.folded import Models as Models
from singimpact.dynamics.gamma_proof.gravity import (
    clock_of as clock_of,
    gravity as gravity,
    place_of as place_of,
    residual as residual,
    restitution_at as restitution_at,
    speed_factor as speed_factor,
)
from singimpact.dynamics.gamma_proof.lemmas import (
    ProofSettings as ProofSettings,
    Undecided as Undecided,
    grown as grown,
    prove_box as prove_box,
    rational as rational,
)
from singimpact.dynamics.gamma_proof.proof import (
    CertifiedGamma as CertifiedGamma,
    certified_gamma as certified_gamma,
    flights_before as flights_before,
    phase_below as phase_below,
    ratio as ratio,
)
from singimpact.dynamics.growth import (
    LEFT as LEFT,
    LOST as LOST,
    NATURAL as NATURAL,
    TORN as TORN,
    Carried as Carried,
    Piece as Piece,
    held as held,
)
from singimpact.dynamics.invariant_arcs import (
    before as before,
    gammas_within as gammas_within,
    grown_gamma as grown_gamma,
    model_step as model_step,
    stable_manifold as stable_manifold,
)
from singimpact.dynamics.lift_off import release as release, turns_between as turns_between
from singimpact.dynamics.lives import Lives as Lives, Stretch as Stretch
from singimpact.dynamics.long_run import (
    Future as Future,
    chaotic as chaotic,
    rising_zeros as rising_zeros,
    settled as settled,
)
from singimpact.dynamics.lyapunov import Growth as Growth
from singimpact.dynamics.orbit import Orbit as Orbit, Section as Section
from singimpact.dynamics.regions import Regions as Regions
from singimpact.dynamics.release_map import ReleaseMap as ReleaseMap
from singimpact.dynamics.remaining import (
    chatter_completes as chatter_completes,
    rest_after as rest_after,
    sum_of_speeds as sum_of_speeds,
)
from singimpact.dynamics.settling import Study as Study, chattering as chattering
from singimpact.dynamics.threshold import SEARCH as SEARCH
from singimpact.dynamics.unfolded_swan import (
    SwanConfiguration as SwanConfiguration,
    swan_configuration as swan_configuration,
)
