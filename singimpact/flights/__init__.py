"""One flight: first hit F, impact map G, x and x' along the way; statuses, conditions, any number of digits.

`impact_map` (F and G), `off_wall` (starts above the wall), `derivative` (D G), `inverse_map`, `path`, `orbits` (impacts
in a row; many orbits) are asked by users; `states` are read once, `results` come back. `compiled_model` holds all that
a model needs and is the one caller of the kernels: `kernels/` are plain modules, `bind` puts them over numbers,
`machine` keeps them compiled, `compiler_process` compiles them, `interpreted` runs them until then; `model_numbers`,
`phase`, `limits` are what it is made from. `undecided` decides flights that end in no plain hit: `no_return/` proves
that none returns, `closing` that one touches, `causes` says why one is open. `in_digits` flies states with many digits:
`certified_flights` proves them in `enclosures/`, `enclosed_impact` boxes of them; `multiprecision` flies the rest, and
`refined_hit` places a hit that double-double arithmetic leaves open.
`horizons` says when a flight is given up. `response` and `rebound_law` are derivatives at a hit and what the impact
makes of them, `determinant` that of D G; `counted` counts flights,
`together` makes many flights at rest at once on arrays, `family` flies models with derivatives by their numbers,
`blocks` cuts large arrays, `interruptible` makes long calls hear Ctrl-C.
Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "bind": "Compiler Emitted LAW MODULES constants floats_of over_floats over_lists",
    "certified_flights": "proof",
    "compiled_model": "CompiledModel allowed recurrence_of",
    "compiler_process": "first_wanted",
    "enclosures.analytic_flow": "AnalyticFlow",
    "enclosures.certified_hit": "Launch certified_hit",
    "enclosures.equation": "Equation NoHit Refused equation_of programs_of",
    "enclosures.motion": "CarriedMotion Start",
    "enclosures.jet_flight": "jet_hit",
    "enclosures.taylor_step": "Column coefficients step",
    "enclosures.timed_flight": "timed_flight touches_first",
    "enclosures.tube": "centre",
    "family": "exponential",
    "horizons": "Allowance steps_of",
    "impact_map": "first_hit",
    "interpreted": "listed",
    "inverse_map": "backwards",
    "kernels.entries": "FOLLOW HITS ITERATE JUDGE PREPARE PREPARE_BATCH RELEASES SEGMENT VARIATIONS",
    "kernels.gamma": "REACH SERIES TERMS_OF_GAMMA",
    "kernels.layout": "batch_model linear_model scratch_of",
    "kernels.roots": "first_root",
    "kernels.state": "Search TIME_BY_V Work",
    "machine": "Machine machine_of",
    "model_numbers": "forcing_phases linear_numbers numbers_of",
    "no_return.averaged": "stays_up",
    "no_return.barrier": "SEARCH fastest_kept kept_up",
    "no_return.linear": "never_returns",
    "no_return.polynomial": "never_turns",
    "orbits": "iterate orbit_segment",
    "path": "places",
    "rebound_law": "rebound speed_before",
    "states": "States",
    "together": "NotTogether in_step rest_flights runs_on_arrays",
}
__getattr__ = names_of(__name__, _FILES)
