"""Run time against error beside what a user would pick instead; stress sweeps; the reference cases as package data.

Not here: what is measured (`flights`, `surface`, `dynamics`), claims of the paper (`paper`), pictures (`scenes`).
Files: `problems` (the table of reference cases, read by the tests too), `data/` (its numbers); `groups/` (what
`singimpact bench` measures, one file a group), `measuring` (methods timed in turn and judged), `fresh` (in a process of
their own), `drawn` (states for every timed call), `compiled` (waiting for object code), `exponents` (how cost grows),
`first_commands` (CPU of a user's first commands, checked in CI), `report`, `plots`, `page` (the pages of the
documentation), `timed_sources` (of which commit a page is);
`states`, `truth/` (random states), `steep_families`, `steep_states`, `steep_balls`, `steep_digits`, `steep_cost` (those
with steep layers); `peers/`;
`stress/` (what `singimpact stress` runs); `selftest/` (random states of a user's own model, `singimpact selftest`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "drawn": "Draws Fed KINDS RESTITUTIONS",
    "exponents": "fitted",
    "fresh": "cost",
    "groups": "GROUPS measured usual",
    "groups.commands": "COMMANDS PUBLIC SERIES",
    "groups.impact_map": "CALLS FED sizes_of taylor_stepper",
    "groups.regimes": "of_states",
    "groups.series": "LIMITED",
    "groups.start": "MODELS first_answer first_model script",
    "measuring": (
        "Aim Case Counted EPSILON Effort FULL Measured Method Timed condition cpu_seconds measure relative_error"
    ),
    "page": "ABOUT COMMAND READING STRESS_ABOUT STRESS_COMMAND TITLES stress_page",
    "peers.last_terms": "last_terms",
    "plots": "plotted",
    "problems": "Problem values",
    "report": "reached tables",
    "selftest.basin_pixels": "row",
    "selftest.batches": "grazes lanes",
    "selftest.draws": "flown",
    "selftest.fates": "Follower",
    "selftest.orbits": "limits orbits",
    "selftest.responses": "derivatives rebounds",
    "selftest.truths": "balls digits fixed_steps",
    "steep_families": "FAMILIES Family NAMES SMOOTH STEEP",
    "steep_states": "drawn_of family_of",
    "stress.flown": "landing",
    "stress.judging": "Function LIMITS Trial moved worst",
    "stress.launches": "Launch PLACES SteepLaunch",
    "stress.table": "FUNCTIONS chosen stressed",
    "timed_sources": "digest_of recorded timed_digest",
    "truth.first_hit": "first_hit",
    "truth.graded_steps": "HIT MISS Motion PHASE POSITION UNDECIDED VELOCITY",
    "truth.motions": "Cubic Linear",
    "truth.plain_orbits": "plain_orbits",
    "truth.plain_steps": "motion",
}
__getattr__ = names_of(__name__, _FILES)
