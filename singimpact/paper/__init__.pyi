"""Names that `paper` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.paper.claims import BEYOND as BEYOND, CLAIMS as CLAIMS, INDEX as INDEX, run as run, select as select
from singimpact.paper.claims.claim import (
    IN_MODEL as IN_MODEL,
    KINDS as KINDS,
    MODULO as MODULO,
    PROVED as PROVED,
    STRENGTH as STRENGTH,
    STRONGEST_FIRST as STRONGEST_FIRST,
    Check as Check,
    Claim as Claim,
    Statement as Statement,
    Trial as Trial,
    Verdict as Verdict,
    compared as compared,
    told as told,
)
from singimpact.paper.claims.deciding import decide as decide, effective as effective
from singimpact.paper.claims.engine import imported_by as imported_by, keep as keep, key_of as key_of, recall as recall
from singimpact.paper.claims.index import (
    COLOURS as COLOURS,
    as_svg as as_svg,
    as_text as as_text,
    claims_in as claims_in,
    colour_of as colour_of,
    dependants as dependants,
)
from singimpact.paper.claims.sections.section4_trials import next_sigma as next_sigma
from singimpact.paper.claims.sections.section6_exact import (
    crossing as crossing,
    near_the_swan as near_the_swan,
    nonzero as nonzero,
    scaling_check as scaling_check,
)
from singimpact.paper.claims.verdicts import VerdictTable as VerdictTable, verify as verify
from singimpact.paper.claims.verifiers import every as every, sample as sample
from singimpact.paper.figures import FIGURES as FIGURES, picture as picture
from singimpact.paper.figures.beyond_figures import (
    B7 as B7,
    B8 as B8,
    generations as generations,
    inner_start as inner_start,
    two_waves as two_waves,
)
from singimpact.paper.figures.figure_rendering import drawn as drawn, legend_words as legend_words
from singimpact.paper.figures.outlines import CHANGES as CHANGES, damped as damped
from singimpact.paper.routes.equations import derived_from as derived_from, equation as equation, watched as watched
from singimpact.paper.routes.fold import eta as eta, psi_q as psi_q, s as s
from singimpact.paper.routes.implicit import a_symbol as a_symbol, phi_c as phi_c, r as r, v_c as v_c
from singimpact.paper.routes.swan import (
    Dh_bar as Dh_bar,
    f_map as f_map,
    g_map as g_map,
    h_bar as h_bar,
    m as m,
    mbar as mbar,
    mu_of_m as mu_of_m,
    r_of_m as r_of_m,
)
from singimpact.paper.routes.unfolding import (
    WEIGHTS as WEIGHTS,
    A as A,
    D as D,
    E as E,
    Weights as Weights,
    cofactor as cofactor,
    e as e,
    impact_velocity as impact_velocity,
    kappa as kappa,
    launch_velocity as launch_velocity,
    limit_launch as limit_launch,
    t as t,
    u as u,
)
from singimpact.paper.sections import NOTATION as NOTATION
from singimpact.paper.sections.errata import (
    GRADES as GRADES,
    REMARKS as REMARKS,
    Erratum as Erratum,
    place_of as place_of,
)
from singimpact.paper.sections.section_formulas import with_Q as with_Q
from singimpact.paper.sections.stored_sections import (
    kept_sections as kept_sections,
    marks_of as marks_of,
)
from singimpact.paper.trials.true_orbits import (
    System as System,
    gamma_cases as gamma_cases,
    resting_times as resting_times,
    scipy_flow as scipy_flow,
)
from singimpact.paper.trials.universal_foot import elastic as elastic
