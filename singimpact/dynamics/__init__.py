"""Orbits of many impacts: rest, chatter, gamma and W^s, ensembles, basins, diagrams, regions over two numbers, fits.

Not here: one flight (`flights`), periodic orbits (`branches`), power series of the chatter limit (`theory`), pictures
(`scenes`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "attractors": "CHAOS CHATTER OTHER caught closing_orbits new_attractors",
    "basins_of_attraction": "basins entropy_of uncertainty_of",
    "behaviours": "LongRun matched",
    "bifurcation_diagram": "bifurcation",
    "chatter": "ENDING chatter_left chatter_limit",
    "enclosed": "end_of_gamma guided newton",
    "gamma_proof.folded": "Models",
    "gamma_proof.gravity": "clock_of gravity place_of residual restitution_at speed_factor",
    "gamma_proof.lemmas": "ProofSettings Undecided grown prove_box",
    "gamma_proof.proof": "certified_gamma flights_before phase_below ratio rational",
    "growth": "held",
    "invariant_arcs": "before grown_gamma model_step stable_manifold",
    "lift_off": "release",
    "long_run": "Future chaotic settled",
    "orbit": "Orbit",
    "remaining": "chatter_completes rest_after sum_of_speeds",
    "settling": "Study chattering",
    "threshold": "SEARCH",
    "unfolded_swan": "swan_configuration",
}
__getattr__ = names_of(__name__, _FILES)
