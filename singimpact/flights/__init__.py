"""One flight: first hit F, impact map G, x and x' along the way; statuses, conditions, any number of digits.

States are read once (`states`), flown in doubles by what `compiled_model` binds of `kernels/`, and come back as
`results`; a flight that ends in no plain hit goes to `undecided` and `no_return/`, one with digits to `enclosures/`.
Not here: flights after flights (`dynamics`), curves of flights (`surface`), power series (`theory`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "bind": "Emitted LAW MODULES constants floats_of over_floats over_lists",
    "compiled_model": "CompiledModel allowed recurrence_of",
    "compilers": "KernelCompiler text_of_model",
    "enclosures.analytic_flow": "AnalyticFlow Discs",
    "enclosures.certified_hit": "Launch certified_hit",
    "enclosures.equation": "Equation NoHit Refused equation_of programs_of",
    "enclosures.jet_flight": "jet_hit",
    "enclosures.motion": "CarriedMotion Start",
    "enclosures.taylor_step": "Column coefficients step",
    "enclosures.timed_flight": "timed_flight touches_first",
    "enclosures.tube": "centre",
    "family": "exponential",
    "flight_path": "path",
    "horizons": "Allowance steps_of",
    "impact_map": "first_hit",
    "in_digits": "proof",
    "interpreted": "listed",
    "interruptible": "on_threads shared_out threads_now",
    "inverse_map": "backwards",
    "kernels.entries": "FOLLOW HITS ITERATE JUDGE PREPARE PREPARE_BATCH RELEASES SEGMENT VARIATIONS",
    "kernels.gamma": "REACH SERIES TERMS_OF_GAMMA",
    "kernels.layout": "batch_model linear_model scratch_of",
    "kernels.roots": "first_root",
    "kernels.state": "Search TIME_BY_V Work",
    "machine": "Machine machine_of",
    "no_return.barrier": "SEARCH fastest_kept kept_up stays_up",
    "no_return.polynomial": "never_returns never_turns",
    "orbits": "iterate orbit_segment",
    "rebound_law": "rebound speed_before",
    "results": "counted",
    "shipped": "PLATFORMS platforms_here shipped_code sources_digest why_not",
    "states": "States",
}
__getattr__ = names_of(__name__, _FILES)
