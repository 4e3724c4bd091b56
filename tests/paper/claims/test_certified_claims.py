"""Certificates of the claims: none says X = X, each number in one matters, and a wrong derivation loses its claims."""

import json
import re
import subprocess
import sys

import pytest
from false_certificates import accepts
from tampering import bumped, changed, leaves

from singimpact.paper import CLAIMS, MODULO, run, select

SERIES = ("composed", "motion", "flight")
# proved without a derivation: the reason
UNDERIVED = {
    "s4b-M": "an inequality between two functions that are given in the statement",
    "s4b-r-ineq": "an inequality between two functions that are given in the statement",
}


@pytest.fixture(scope="module")
def verdicts():
    return {verdict.id: verdict for verdict in run(select(), cached=True)}


def all_of(verdicts):
    texts = {json.dumps(part): part for verdict in verdicts.values() for part in verdict.certificates}
    return [json.loads(text) for text in texts]


def test_no_certificate_says_that_something_is_equal_to_itself(verdicts):
    assert not [part["says"] for part in all_of(verdicts) if "left" in part and part["left"] == part["right"]]


@pytest.mark.parametrize("name", CLAIMS)
def test_what_is_proved_has_a_certificate(name, verdicts):
    verdict = verdicts[name]
    if (verdict.corrected_kind or verdict.kind) in ("proved", MODULO):
        assert verdict.certificates
        assert any(part["kind"] in SERIES for part in verdict.certificates) != (name in UNDERIVED)


def test_each_certificate_holds_as_json(verdicts):
    assert all(accepts(part) for part in all_of(verdicts))


def coefficients(certificate):
    """The paths of the coefficients of polynomials, by their place in [exponents, coefficient]."""
    for path in leaves(certificate):
        part = certificate
        for step in path[:-1]:
            part = part[step]
        if isinstance(part, list) and len(part) == 2 and isinstance(part[0], list) and path[-1] == 1:
            yield path


@pytest.mark.slow
def test_each_coefficient_of_a_derivation_matters(verdicts):
    """Without the sentence, which would refuse each change by itself: the polynomials themselves are multiplied out."""
    tried, without_effect = 0, []
    for certificate in all_of(verdicts):
        if certificate["kind"] in SERIES:
            assert not accepts(changed(certificate, next(coefficients(certificate)), bumped))
            bare = {key: part for key, part in certificate.items() if key != "says"}
            for path in [path for path in coefficients(bare) if "relation" not in path][:12]:
                tried += 1
                if accepts(changed(bare, path, bumped)):
                    without_effect.append((certificate, path))
    assert tried > 500
    # a term that the images of its own side send to 0, or beyond the order
    assert all(part["kind"] == "composed" and path[1] in ("outer", "images") for part, path in without_effect)
    # (or, 0 being 0/1, the denominator of 0)
    sides = [(part, part[path[0]]) for part, path in without_effect]
    assert all(part["order"] is not None or side["images"] or not side["outer"][0] for part, side in sides)
    assert len(without_effect) < tried / 8


def test_each_number_of_a_proof_of_signs_matters(verdicts):
    for certificate in all_of(verdicts):
        if certificate["kind"] not in SERIES:
            for path in leaves(certificate):
                if path[-1] in ("roots", "sign", "all", "first") or "expansion" in path:
                    assert not accepts(changed(certificate, path, bumped)), (certificate["says"], path)


# file below singimpact: what stands there, what stands there instead, claims that must fail
MUTANTS = {
    "the launch of a flight turned round": (
        "theory/impact_sheet.py",
        "self._minus = ring.rational(Fraction(-1))",
        "self._minus = ring.rational(Fraction(1))",
        "e:degen e:phinew e:vtaylor-t2 s4b-rays s5-F-smooth s5-positive s5-vt-positive"),
    "one integral of two": (
        "theory/impact_sheet.py",
        "self.engine.integral(self.engine.integral(self._right_side(degree), 0), 0)",
        "self.engine.integral(self._right_side(degree), 0)",
        "e:swan"),
    "a jet of the acceleration without its factorial": (
        "contact/contact.py",
        "* ring.rational(Fraction(1, factorial(k))) for k in free",
        "for k in free",
        "e:pdeg3 e:phi e:swan e:vtaylor-st e:vtaylor-st2 e:vtaylor-t3 s5-coordinates s5-phi"),
    "the involution with another sign": (
        "theory/impact_sheet.py",
        "return sigma + t, -t",
        "return sigma - t, -t",
        "e:phinew"),
    "an outline that is halved": (
        "theory/plane_forms.py",
        "outline = _shown(source, sheet_), sheet_.to_sympy(form.offset)",
        "outline = _shown(source, sheet_), sheet_.to_sympy(form.offset) / 2",
        "e:defq e:hdef e:pdef s4-blowup s4-normal-id2"),
    "a step of the normal form of another size": (
        "germs/__init__.py",
        "step = value * ring.rational(Fraction(1, power))",
        "step = value",
        "e:pdef"),
    "a motion without a factor": (
        "paper/routes/implicit.py",
        "/ ((n + 1) * (n + 2)))",
        "/ ((n + 1) * (n + 1)))",
        "e3 e:acc s2-first-hit-rest s2-ivp s2-lift-off-sign s2-two-sheets t:t2-fixed"),
    "the sheet one degree short": (
        "paper/routes/implicit.py",
        "for degree in range(1, order + 1):",
        "for degree in range(1, order):",
        "e:acc e:pnew e:yeq s6-a0-typo s3-Dp s3-Dphi s3-dvdt s4-Z-line s4-saddle s4b-Np s4b-T2-bounds s4b-T2-place "
        "s4b-continuous s4b-eps s4b-l-range s4b-p-bound s4b-q-bound s4b-ratio s4b-sector s4-P-star s4b-back "
        "s4b-conditions s4b-contraction t:foliate t:foliate-smooth t:t2-exists t:t2-sides t:t2-smooth "
        "t:t2-unique t:t3 t:t3-attracting t:t3-others t:t3-smooth t:t3-unique"),
    "the acceleration at rest taken at x = 0": (
        "contact/contact.py",
        '{"x": clearance, "xdot": number(0)}',
        '{"x": number(0), "xdot": number(0)}',
        "e:lin s4-zeros"),
    "DG without the reset": (
        "paper/routes/implicit.py",
        "matrix = (restitution * Dphi()",
        "matrix = (Dphi()",
        "s3-DG s3-eigenvectors"),
    "an eigenvector turned round": (
        "paper/routes/implicit.py",
        "x, y = -(matrix",
        "x, y = (matrix",
        "s3-slope s3-slope-r t:t1 t:t1-foliation"),
    "a horizon that is another line": (
        "paper/routes/fold.py",
        "line = sympy.cancel(-slope.nth(0) / slope.nth(1))",
        "line = sympy.cancel(-slope.nth(0) / slope.nth(1) / 2)",
        "s4-fold-form s4-horizon-line"),
    "a square that is doubled": (
        "paper/routes/fold.py",
        "found = sympy.expand(sympy.cancel(psi_q()[1] / square))",
        "found = sympy.expand(2 * sympy.cancel(psi_q()[1] / square))",
        "e:fixm e:fixm-converse e:meq e:qdef s4-Er-closed s4-Qr-zeros s4-beta-tangent s4-domain "
        "s4-m1 s4-m1-gradient s4-m2 s4-m2-sign s4-m32-r1 s4-root-places"),
    "a slope of m' with a factor": (
        "paper/routes/fold.py",
        "found = sympy.diff(h_blown_up()[1], m)",
        "found = 2 * sympy.diff(h_blown_up()[1], m)",
        "s4-Nr-1 s4-Nr-2 s4-saddle-m3"),
    "an entry above the diagonal": (
        "paper/routes/fold.py",
        "first = [sympy.diff(new, letter).subs(s, 0) for letter in (s, m)]",
        "first = [sympy.diff(new, letter).subs(s, 1) for letter in (s, m)]",
        "s4-Dh-form s4-mu-direction"),
    "r of m upside down": (
        "paper/routes/fold.py",
        "found = sympy.factor(-cubic.nth(0) / cubic.nth(1))",
        "found = sympy.factor(-cubic.nth(1) / cubic.nth(0))",
        "s4-Nr-3 s4-Nr-3-all s4-m3 s4-saddle-m3 t:t2-attracting"),
    "the entry of D h-bar doubled": (
        "paper/routes/swan.py",
        "slope = sympy.factor(sympy.cancel(sympy.diff(f_map(), m)",
        "slope = sympy.factor(sympy.cancel(2 * sympy.diff(f_map(), m)",
        "s5-jacobian s5-saddle"),
    "a power of the new s": (
        "paper/routes/swan.py",
        "found = -r * impact - growth**3 * launch",
        "found = -r * impact - growth**2 * launch",
        "s5-hbar s5-mstar-place s5-slopes s5-unique"),
    "P_j without a factor": (
        "theory/multipliers.py",
        "(j + 1) * (j + 2) * launch_velocity(j, sympy.Integer(1), lambda_)",
        "(j + 1) * launch_velocity(j, sympy.Integer(1), lambda_)",
        "t:t2-repelling"),
    "mu without 1/lambda": (
        "theory/multipliers.py",
        "ratio = sympy.factor((P(j) / Q(j)) ** 2 / lambda_)",
        "ratio = sympy.factor((P(j) / Q(j)) ** 2)",
        "s6n-accumulate"),
    "a leading coefficient with a factor": (
        "theory/multipliers.py",
        "found = sympy.factor((1 - lambda_) * P(j)",
        "found = sympy.factor(3 * (1 - lambda_) * P(j)",
        "t:t2-eigenvalue-limit t:t2-repelling t:t3-eigenvalue-limit t:t3-repelling"),
    "a launch of the model without a term": (
        "paper/routes/unfolding.py",
        "displaced = sum(value * s ** (n + 2) / ((n + 1) * (n + 2))",
        "displaced = sum(value * s ** (n + 2) / (n + 2)",
        "s6-lips s6-sections s6n-C s6n-corr s6n-corr-A s6n-cusp s6n-maps s6n-AB s6p-regions"),
    "another order of flights": (
        "paper/claims/sections/section6_loops.py",
        "3 * place * (later - t)",
        "3 * place * (later + t)",
        "s6p-separates s6n-tangent s6n-transverse s6n-loops s6n-accumulate s7-loops s6n-Y"),
    "grazing flights beside their conic": (
        "paper/claims/sections/section6_loops.py",
        "(6 - 3 * m**2)",
        "(6 - 2 * m**2)",
        "s6n-transverse s6n-loops s6n-Y"),
    "a flight from rest that lands elsewhere": (
        "paper/claims/sections/section6.py",
        "model.zero_set().subs(t, 1 - sigma)",
        "model.zero_set().subs(t, 3 - sigma)",
        "s6p-gamma"),
    "flights from rest without their factor": (
        "paper/claims/sections/section6_regions.py",
        "value * s ** (n + 1) / (n + 1) for",
        "value * s ** (n + 2) / (n + 2) for",
        "s6-swallowtail"),
    "flights that pass the wall elsewhere": (
        "paper/claims/sections/section2.py",
        "height = k + (level",
        "height = 2 * k + (level",
        "s2-dense"),
    "a limit of launches without a term": (
        "paper/routes/unfolding.py",
        "displaced = sum(value * s ** (n + 2) / ((n + 1) * (n + 2))",
        "displaced = sum(value * s ** (n + 2) / (n + 2)",
        "s6-scaling s6p-none"),
    "a force that is scaled otherwise": (
        "paper/routes/unfolding.py",
        "sigma**3 * alpha - x * phi_1 - y * phi_2",
        "sigma**2 * alpha - x * phi_1 - y * phi_2",
        "s6-scaling"),
    "a flight's other factor": (
        "paper/routes/unfolding.py",
        "height(u) / (kappa * u * (u - t))",
        "height(u) / (kappa * (u - t))",
        "s6n-visible s6n-X"),
    "an arc of AE that is another": (
        "paper/claims/sections/section6_exact.py",
        "{sigma: -third * w * (1 + z),",
        "{sigma: -third * w * (1 - z),",
        "s6p-eps"),
    "a shadow that is another": (
        "paper/routes/unfolding.py",
        "found = sympy.expand(total - 2 * t)",
        "found = sympy.expand(total - t)",
        "s6n-shadow-neg"),
    "E mirrored": (
        "paper/routes/unfolding.py",
        "E = (-sympy.sqrt(3), 2 * sympy.sqrt(3))",
        "E = (sympy.sqrt(3), -2 * sympy.sqrt(3))",
        "s6p-AE s6p-BE"),
    "a birth of zeros by another power": (
        "paper/claims/sections/section6.py",
        "bend = sympy.cancel(-along / by_clearance) / 2",
        "bend = sympy.cancel(-along / by_clearance**3) / 2",
        "s6-d"),
    "a zero followed the wrong way": (
        "paper/claims/sections/section4.py",
        "rate = sympy.cancel(-sympy.diff(acceleration, delta)",
        "rate = sympy.cancel(sympy.diff(acceleration, delta)",
        "s4-depends-on-c"),
    "a slope of the acceleration turned round": (
        "paper/routes/unfolding.py",
        "found = sympy.diff(acceleration(), sigma).subs(sigma, time)",
        "found = -sympy.diff(acceleration(), sigma).subs(sigma, time)",
        "s6p-AB"),
    "a group law with another sign": (
        "paper/routes/variations.py",
        "difference = P - (u - v * q - A * b)",
        "difference = P - (u + v * q - A * b)",
        "p:phising-cusp s2-smooth"),
    "an involution that exchanges nothing": (
        "paper/routes/variations.py",
        "INVOLUTION = {v: u, u: v}",
        "INVOLUTION = {v: v, u: u}",
        "p:phising-cusp p:phising-set s2-corr-sets"),
    "a second derivative with another sign": (
        "paper/routes/variations.py",
        "(by * k + E) * e**2 / 2, order=2",
        "(by * k - E) * e**2 / 2, order=2",
        "p:phising-fold"),
    "a velocity with a factor": (
        "paper/routes/variations.py",
        "velocity = y + t * y_t",
        "velocity = y + 2 * t * y_t",
        "p:phising-set s2-discontinuity s2-horizon"),
    "an exact motion without a factor": (
        "paper/trials/surfaces.py",
        "* t) / ((n + 1) * (n + 2))\n",
        "* t) / (n + 1)\n",
        "p:corresp s2-G-semiconj s2-corr-sets"),
    "a new time that runs at another rate": (
        "paper/routes/first_order.py",
        "tempo = 1 + h * sympy.diff(change.time, s)",
        "tempo = 1 + h * change.time",
        "b:first-order b:first-order-foot"),
    "a closed form for every order with another factor": (
        "paper/claims/beyond/every_order.py",
        "CLOSED_Q = 1 - (j + 2) * ell * L",
        "CLOSED_Q = 1 - (j + 1) * ell * L",
        "b:order-ray b:order-saddle b:order-expansion b:order-exponents b:holder-bounds b:hertz-adiabatic b:hertz"),
    "a landing with another factor of the length of the flight": (
        "paper/claims/beyond/hertz.py",
        "LANDING = sympy.Rational(1, 2) - j * e / 3",
        "LANDING = sympy.Rational(1, 2) - j * e / 4",
        "b:hertz-adiabatic b:hertz b:hertz-sides b:hertz-next"),
    "an image of a height by another power": (
        "paper/claims/beyond/loops.py",
        "(r * landing - w * ell**2)",
        "(r * landing - w * ell)",
        "b:loops-map"),
    "a flight of the swan with another factor": (
        "paper/routes/unfolding.py",
        "velocity = sympy.expand(sympy.cancel(-displaced.subs(s, t) / t))",
        "velocity = sympy.expand(sympy.cancel(-2 * displaced.subs(s, t) / t))",
        "b:foot-monotone b:foot-limit b:onset-hop"),
}  # fmt: skip

PROGRAM = """
import importlib.machinery, json, sys
file, old, new, *names = sys.argv[1:]
loader = importlib.machinery.SourceFileLoader
read, stats = loader.get_data, loader.path_stats

def get_data(self, path):
    data = read(self, path)
    if path.endswith("singimpact/" + file):
        text = data.decode()
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {file}"
        data = text.replace(old, new).encode()
    return data

def path_stats(self, path):
    if path.endswith("singimpact/" + file):
        raise OSError("compiled anew")
    return stats(self, path)

loader.get_data, loader.path_stats, sys.dont_write_bytecode = get_data, path_stats, True
from singimpact.algebra.gathering import collected
from singimpact.certificates import check_certificate
from singimpact.paper.claims import CLAIMS

def holds(name):
    claim = CLAIMS[name]
    with collected() as certificates:
        found = claim.verify((claim.corrected() if claim.corrected else claim.printed).value).holds
    for certificate in certificates:
        check_certificate(json.loads(json.dumps(certificate)))
    return found

for name in names:
    try:
        print(name, holds(name))
    except Exception as error:  # a certificate that is refused, or a step that cannot be made
        print(name, False)
"""


def held(file, old, new, names):
    command = [sys.executable, "-c", PROGRAM, file, old, new, *names.split()]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [line.split()[0] for line in done.stdout.splitlines() if line.endswith(" True")]


@pytest.mark.parametrize(
    "mutant", [name if at % 12 == 0 else pytest.param(name, marks=pytest.mark.slow) for at, name in enumerate(MUTANTS)]
)
def test_a_wrong_derivation_loses_its_claims(mutant):
    assert held(*MUTANTS[mutant]) == []


def test_each_proved_claim_has_a_derivation_that_a_mutant_breaks(verdicts):
    kinds = {name: verdict.corrected_kind or verdict.kind for name, verdict in verdicts.items()}
    proved = {name for name, kind in kinds.items() if kind in ("proved", MODULO)}
    lost = {name for *_, names in MUTANTS.values() for name in names.split()}
    assert proved - lost == set(UNDERIVED)


def test_the_unchanged_derivation_keeps_them():
    line = "sigma, t, v, r = sympy.symbols"
    assert held("paper/routes/implicit.py", line, line, "s3-DG s4b-M") == ["s3-DG", "s4b-M"]


def unknown_names(old, new, source):
    """Names of a mutated line that its source does not have, or another variable on its left side."""
    names = {name for name in re.findall(r"(?<![\w.])[A-Za-z_]\w*", new) if not re.search(rf"\b{name}\b", source)}
    left, right = (re.match(r"(\w+) =", text) for text in (old, new))
    return names | ({right[1]} if left and right and left[1] != right[1] else set())


@pytest.mark.parametrize("mutant", MUTANTS)
def test_a_mutant_names_what_its_file_knows(mutant, clone):
    """A name that does not exist would lose the claims for a reason of its own."""
    file, old, new, _ = MUTANTS[mutant]
    assert unknown_names(old, new, (clone / "singimpact" / file).read_text(encoding="utf-8")) == set()


def test_a_stale_name_is_seen():
    assert unknown_names("ratio = a / b", "found = a", "ratio = a / b") == {"found"}
    assert unknown_names("ratio = a / b", "ratio = 2 * a", "ratio = a / b") == set()
