"""Names that `flights` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.flights.bind import (
    LAW as LAW,
    MODULES as MODULES,
    Emitted as Emitted,
    constants as constants,
    floats_of as floats_of,
    over_floats as over_floats,
    over_lists as over_lists,
)
from singimpact.flights.compiled_model import (
    CompiledModel as CompiledModel,
    allowed as allowed,
)
from singimpact.flights.compilers import KernelCompiler as KernelCompiler, text_of_model as text_of_model
from singimpact.flights.derivative import log_determinant as log_determinant
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow as AnalyticFlow, Discs as Discs
from singimpact.flights.enclosures.certified_hit import (
    Launch as Launch,
    ProvedImpact as ProvedImpact,
    certified_hit as certified_hit,
)
from singimpact.flights.enclosures.equation import (
    Equation as Equation,
    NoHit as NoHit,
    Refused as Refused,
    equation_of as equation_of,
    programs_of as programs_of,
)
from singimpact.flights.enclosures.jet_flight import JetHit as JetHit, jet_hit as jet_hit
from singimpact.flights.enclosures.motion import CarriedMotion as CarriedMotion, Met as Met, Start as Start
from singimpact.flights.enclosures.taylor_step import Column as Column, coefficients as coefficients, step as step
from singimpact.flights.enclosures.timed_flight import (
    Arrival as Arrival,
    Walls as Walls,
    timed_flight as timed_flight,
    touches_first as touches_first,
)
from singimpact.flights.enclosures.tube import Tube as Tube, centre as centre, divided as divided, narrowed as narrowed
from singimpact.flights.family import Family as Family, Number as Number, Values as Values, exponential as exponential
from singimpact.flights.flat_numbers import gap_of as gap_of
from singimpact.flights.flight_path import ends as ends, path as path
from singimpact.flights.horizons import (
    Allowance as Allowance,
    horizon_of as horizon_of,
    reach_of as reach_of,
    steps_of as steps_of,
)
from singimpact.flights.impact_map import checked_digits as checked_digits, first_hit as first_hit
from singimpact.flights.in_digits import proof as proof
from singimpact.flights.interpreted import listed as listed
from singimpact.flights.interruptible import (
    on_threads as on_threads,
    shared_out as shared_out,
    threads_now as threads_now,
)
from singimpact.flights.inverse_map import backwards as backwards
from singimpact.flights.kernels.entries import (
    FOLLOW as FOLLOW,
    HITS as HITS,
    ITERATE as ITERATE,
    JUDGE as JUDGE,
    PREPARE as PREPARE,
    PREPARE_BATCH as PREPARE_BATCH,
    RELEASES as RELEASES,
    SEGMENT as SEGMENT,
    VARIATIONS as VARIATIONS,
)
from singimpact.flights.kernels.gamma import REACH as REACH, SERIES as SERIES, TERMS_OF_GAMMA as TERMS_OF_GAMMA
from singimpact.flights.kernels.layout import (
    batch_model as batch_model,
    linear_model as linear_model,
    scratch_of as scratch_of,
)
from singimpact.flights.kernels.roots import first_root as first_root
from singimpact.flights.kernels.state import ACROSS as ACROSS, TIME_BY_V as TIME_BY_V, Search as Search, Work as Work
from singimpact.flights.limits import LIMITS as LIMITS, degree_for as degree_for
from singimpact.flights.machine import Machine as Machine, machine_of as machine_of
from singimpact.flights.model_numbers import (
    fastest_rate as fastest_rate,
    numbers_of_flow as numbers_of_flow,
    recurrence_of as recurrence_of,
)
from singimpact.flights.no_return.barrier import (
    SEARCH as SEARCH,
    fastest_kept as fastest_kept,
    kept_up as kept_up,
    stays_up as stays_up,
)
from singimpact.flights.no_return.polynomial import never_returns as never_returns, never_turns as never_turns
from singimpact.flights.orbits import iterate as iterate, iterates as iterates, orbit_segment as orbit_segment
from singimpact.flights.rebound_law import (
    rebound as rebound,
    rebound_slope as rebound_slope,
    speed_before as speed_before,
)
from singimpact.flights.response import variations as variations
from singimpact.flights.results import counted as counted
from singimpact.flights.shipped import (
    PLATFORMS as PLATFORMS,
    platforms_here as platforms_here,
    shipped_code as shipped_code,
    sources_digest as sources_digest,
    why_not as why_not,
)
from singimpact.flights.states import States as States
from singimpact.flights.walls import at_walls as at_walls
