"""Certified results as files, and the second programs that check them and the proofs of claims.

Not here: how a result is certified (`flights`), how certificates of polynomials are made (`algebra`).
"""

from singimpact.handed_on import names_of

_FILES = {
    "certificate": "CHECKER Certificate",
    "checker": "KINDS check",
    "checker.chatter_limit": "rest",
    "checker.files": "STATEMENTS TERMS",
    "checker.formulas": "Formula require_period",
    "checker.gravity": "Gravity",
    "checker.horseshoe": "Set derivative",
    "checker.motion": "Flight Model defect read taylor",
    "checker.nonlinear": "Flights Growing",
    "checker.periodic_orbit": "Orbits impact",
    "claims_proofs": "check_certificate number",
    "claims_checker": "Refused STATED STRONGEST_FIRST check_words statement_of",
}
__getattr__ = names_of(__name__, _FILES)
