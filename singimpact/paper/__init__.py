"""The paper, checked. A study of your own oscillator does not need this sub-package.

Not here: the theory for any oscillator (`theory`), flights and orbits (`flights`, `dynamics`), formulas as text
(`documents`), pictures of a user's model (`scenes`).
Rooms: `claims/` (statements, verifiers, verdicts), `trials/` (true orbits and surfaces on which claims are tried),
`routes/` (the paper's own steps in sympy), `figures/` (1 to 17), `sections/` (the words of the derivations and errata).
"""

from singimpact.handed_on import names_of

_FILES = {
    "claims": "CLAIMS INDEX run select",
    "claims.claim": (
        "Check Claim IN_MODEL KINDS MODULO PROVED STRENGTH STRONGEST_FIRST Statement Trial Verdict compared told"
    ),
    "claims.deciding": "decide effective",
    "claims.engine": "imported_by keep key_of recall",
    "claims.index": "COLOURS as_svg claims_in colour_of",
    "claims.sections.section4_trials": "next_sigma",
    "claims.sections.section6_exact": "crossing near_the_swan nonzero scaling_check",
    "claims.verdicts": "VerdictTable verify",
    "claims.verifiers": "every sample",
    "figures": "FIGURES picture",
    "figures.beyond_figures": "B7 B8 generations inner_start two_waves",
    "figures.figure_rendering": "drawn legend_words",
    "figures.outlines": "CHANGES damped",
    "routes.equations": "derived_from equation watched",
    "routes.fold": "eta psi_q s",
    "routes.implicit": "a_symbol phi_c r v_c",
    "routes.swan": "Dh_bar f_map g_map h_bar m mbar mu_of_m r_of_m",
    "routes.unfolding": "A D E WEIGHTS Weights cofactor e impact_velocity kappa launch_velocity limit_launch t u",
    "sections.errata": "GRADES REMARKS Erratum place_of",
    "sections": "NOTATION",
    "sections.stored_sections": "cache kept_sections marks_of",
    "sections.section_formulas": "with_Q",
    "trials.true_orbits": "System gamma_cases resting_times scipy_flow",
    "trials.universal_foot": "elastic",
}
__getattr__ = names_of(__name__, _FILES)
