"""Run time against error beside what a user would pick instead; stress sweeps; reference values as package data.

Not here: what is measured (`flights`, `surface`, `dynamics`), claims of the paper (`paper`), pictures (`scenes`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "drawn": "Draws KINDS Problem RESTITUTIONS values",
    "groups": "GROUPS measured usual",
    "groups.impact_map_rows": "sizes_of taylor_stepper",
    "groups.limit_rows": "BEFORE_SERIES SCRIPTS SERIES reference script",
    "groups.series_rows": "Task",
    "measuring": (
        "Aim Case Counted EPSILON Effort FULL Measured Method NO_AIM QUICK Row Timed condition cost cpu_seconds "
        "measure relative_error"
    ),
    "page": "ABOUT COMMAND READING STRESS_ABOUT STRESS_COMMAND digest_of recorded stress_page timed_digest",
    "peers.fixed_steps": "flights numbers orbit",
    "random_states": "release_trial",
    "report": "as_data growth in_words plotted reached table",
    "selftest.basin_pixels": "Follower row",
    "selftest.responses": "balls derivatives digits fixed_steps limits orbits rebounds",
    "selftest.rows": "flown",
    "selftest.run": "grazes lanes",
    "steep_states": "DRAW FAMILIES Family NAMES PARAMETRIC SMOOTH STEEP allowed drawn_of family_of",
    "stress.flown": "hit_trial landing",
    "stress.judging": "Function LIMITS Launch PLACES SteepLaunch Trial moved worst",
    "stress.table": "FUNCTIONS chosen stressed",
    "truth.first_hit": "Cubic Linear first_hit",
    "truth.graded_steps": "FINENESS HIT MISS Motion PHASE POSITION UNDECIDED VELOCITY",
    "truth.hit_in_balls": "second_program",
    "truth.plain_orbits": "motion plain_orbits",
}
__getattr__ = names_of(__name__, _FILES)
