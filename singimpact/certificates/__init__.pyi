"""Names that `certificates` hands on, with their homes: `__init__.py` loads each from here when it is used."""

from singimpact.certificates.certificate import CHECKER as CHECKER, Certificate as Certificate
from singimpact.certificates.checker import KINDS as KINDS, check as check
from singimpact.certificates.checker.chatter_limit import rest as rest
from singimpact.certificates.checker.files import STATEMENTS as STATEMENTS, TERMS as TERMS, answered as answered
from singimpact.certificates.checker.formulas import Formula as Formula, require_period as require_period
from singimpact.certificates.checker.gravity import Gravity as Gravity
from singimpact.certificates.checker.horseshoe import Set as Set, derivative as derivative
from singimpact.certificates.checker.motion import (
    Flight as Flight,
    Model as Model,
    defect as defect,
    read as read,
    taylor as taylor,
)
from singimpact.certificates.checker.nonlinear import Flights as Flights, Growing as Growing
from singimpact.certificates.checker.periodic_orbit import Orbits as Orbits, impact as impact
from singimpact.certificates.claims_checker import (
    STATED as STATED,
    STRONGEST_FIRST as STRONGEST_FIRST,
    check_words as check_words,
    statement_of as statement_of,
)
from singimpact.certificates.claims_proofs import (
    Refused as Refused,
    check_certificate as check_certificate,
    number as number,
)
