"""Orbits of many impacts: rest, chatter, gamma and W^s, basins, bifurcation diagrams.

Not here: one flight (`flights`), periodic orbits (`branches`), power series of the chatter limit (`theory`), pictures
(`scenes`).
Files: `orbit` (impacts, rest and chatter in order), `sampling` (x and x' of an orbit at times), `lyapunov` (its
exponents), `gamma_proof` (gamma proved, a folder), `release` (when a mass lifts off), `chatter`
(when impacts end), `completion` (its map), `remaining` (its terms in doubles),
`fractional_chatter` (for rho that is not smooth at rest), `gathered` (results of many states),
`threshold` (the velocity between complete and incomplete chatter), `enclosed` (both in balls),
`guide` (a velocity on gamma in many digits, not proved),
`growth` (an invariant curve of a map, cut at discontinuities),
`invariant_arcs` (gamma and the stable manifolds, grown), `swan_configuration` (the named points of an unfolded swan),
`attractors`, `nearby_orbit` (beside a state that almost returns), `settling` (which one is reached), `basins`,
`long_run` (what follows a rest), `bifurcation`.
"""

from singimpact.handed_on import names_of

_FILES = {
    "orbit": "Orbit",
    "attractors": "CHAOS CHATTER OTHER caught closing_orbits new_attractors",
    "chatter": "ENDING chatter_left chatter_limit",
    "enclosed": "end_of_gamma",
    "fractional_chatter": "chatter_completes rest_after sum_of_speeds",
    "gamma_proof.folded": "Models",
    "gamma_proof.gauge": "clock_of place_of speed_factor",
    "gamma_proof.gravity": "gravity",
    "gamma_proof.lemmas": "ProofSettings Undecided grown prove_box",
    "gamma_proof.proof": "certified_gamma flights_before phase_below ratio rational restitution_at",
    "gamma_proof.relation": "residual",
    "growth": "held",
    "guide": "guided newton",
    "invariant_arcs": "before grown_gamma model_step stable_manifold",
    "long_run": "Future chaotic settled",
    "settling": "Study chattering",
    "threshold": "SEARCH",
}
__getattr__ = names_of(__name__, _FILES)
