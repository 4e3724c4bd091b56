"""Names that `bench` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.algebra.numbers import EPSILON as EPSILON
from singimpact.bench.drawn import (
    KINDS as KINDS,
    RESTITUTIONS as RESTITUTIONS,
    Draws as Draws,
    Problem as Problem,
    values as values,
)
from singimpact.bench.groups import GROUPS as GROUPS, measured as measured, usual as usual
from singimpact.bench.groups.impact_map_rows import sizes_of as sizes_of, taylor_stepper as taylor_stepper
from singimpact.bench.groups.limit_rows import (
    BEFORE_SERIES as BEFORE_SERIES,
    SCRIPTS as SCRIPTS,
    SERIES as SERIES,
    reference as reference,
    script as script,
)
from singimpact.bench.groups.series_rows import Task as Task
from singimpact.bench.measuring import (
    FULL as FULL,
    NO_AIM as NO_AIM,
    QUICK as QUICK,
    Aim as Aim,
    Case as Case,
    Counted as Counted,
    Effort as Effort,
    Measured as Measured,
    Method as Method,
    Row as Row,
    Timed as Timed,
    condition as condition,
    cost as cost,
    cpu_seconds as cpu_seconds,
    measure as measure,
    relative_error as relative_error,
)
from singimpact.bench.page import (
    ABOUT as ABOUT,
    COMMAND as COMMAND,
    READING as READING,
    STRESS_ABOUT as STRESS_ABOUT,
    STRESS_COMMAND as STRESS_COMMAND,
    digest_of as digest_of,
    recorded as recorded,
    stress_page as stress_page,
    timed_digest as timed_digest,
)
from singimpact.bench.peers.fixed_steps import flights as flights, numbers as numbers, orbit as orbit
from singimpact.bench.random_states import release_trial as release_trial
from singimpact.bench.report import (
    as_data as as_data,
    growth as growth,
    in_words as in_words,
    plotted as plotted,
    reached as reached,
    table as table,
)
from singimpact.bench.selftest.basin_pixels import Follower as Follower, row as row
from singimpact.bench.selftest.responses import (
    balls as balls,
    derivatives as derivatives,
    digits as digits,
    fixed_steps as fixed_steps,
    limits as limits,
    orbits as orbits,
    rebounds as rebounds,
)
from singimpact.bench.selftest.rows import flown as flown
from singimpact.bench.selftest.run import grazes as grazes, lanes as lanes
from singimpact.bench.steep_states import (
    DRAW as DRAW,
    FAMILIES as FAMILIES,
    NAMES as NAMES,
    PARAMETRIC as PARAMETRIC,
    SMOOTH as SMOOTH,
    STEEP as STEEP,
    Family as Family,
    allowed as allowed,
    drawn_of as drawn_of,
    family_of as family_of,
)
from singimpact.bench.stress.flown import hit_trial as hit_trial, landing as landing
from singimpact.bench.stress.judging import (
    LIMITS as LIMITS,
    PLACES as PLACES,
    Function as Function,
    Launch as Launch,
    SteepLaunch as SteepLaunch,
    Trial as Trial,
    moved as moved,
    worst as worst,
)
from singimpact.bench.stress.table import FUNCTIONS as FUNCTIONS, chosen as chosen, stressed as stressed
from singimpact.bench.truth.first_hit import Cubic as Cubic, Linear as Linear, first_hit as first_hit
from singimpact.bench.truth.graded_steps import (
    FINENESS as FINENESS,
    HIT as HIT,
    MISS as MISS,
    PHASE as PHASE,
    POSITION as POSITION,
    UNDECIDED as UNDECIDED,
    VELOCITY as VELOCITY,
    Motion as Motion,
)
from singimpact.bench.truth.hit_in_balls import second_program as second_program
from singimpact.bench.truth.plain_orbits import motion as motion, plain_orbits as plain_orbits
