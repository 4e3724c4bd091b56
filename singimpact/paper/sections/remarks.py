"""Remarks of the errata on each misprint: its kind, its reason, and what it does not touch.

Verdicts, corrections and numbers are computed by the claims; a claim that is corrected and has no remark here, or has
one and is not corrected, fails a test.
"""

from dataclasses import dataclass
from functools import cache

GRADES = {
    "slip": "slip of the pen",
    "sign": "wrong sign",
    "constant": "wrong constant",
    "argument": "argument to repair",
    "reading": "matter of reading",
}
PLURALS = {
    "slip": "slips of the pen",
    "sign": "wrong signs",
    "constant": "wrong constants",
    "argument": "steps of arguments to repair",
    "reading": "matters of reading",
}


@dataclass(frozen=True)
class Remark:
    """One remark on the paper.

    Attributes
    ----------
    claims : ids of the claims that it is about. grade : a key of `GRADES`. reason : why the printed statement fails.
    survives : what of the paper does not depend on it, or how it is repaired.  Formulas stand between dollar signs.
    """

    claims: tuple[str, ...]
    grade: str
    reason: str
    survives: str


REMARKS = (
    Remark(
        ("s2-horizon",),
        "argument",
        r"On $V_c'$ the velocity is $\dot x_c=-t\,\frac{\partial y_c}{\partial v}\frac{\partial v_c}{\partial t}$: it "
        r"vanishes on all of $\Pi_0$, where $t=0$, while $p_c$ is singular there only at $a_c=0$.",
        r"Off $\Pi_0$ the two sets agree, and the paper uses them there.",
    ),
    Remark(
        ("p:phising-set",),
        "reading",
        r"On $\Pi_0$ the determinant of $D\phi_c$ is $\frac12 a_c$: the tangency points are singular too.",
        r"Folds and cusps are stated off $\Pi_0$.",
    ),
    Remark(
        ("p:phising-cusp",),
        "reading",
        r"Where the flight from rest also ends at rest, $\dot x_c=0$, the mixed derivative of $v_c$ vanishes and the "
        r"singularity is higher than a cusp.",
        r"It is a condition that fails at isolated points of special models alone.",
    ),
    Remark(
        ("s2-lift-off-sign",),
        "slip",
        r"The obstacle is at $x=c$: the flight from rest has to be compared with $c$, not with 0.",
        r"All that follows compares with $c$.",
    ),
    Remark(
        ("s2-first-hit-rest", "t:t2-fixed"),
        "reading",
        r"From a tangency point the flight at rest has $x_c-c=\frac16a't^3+\dots$: with $a'>0$ the mass lifts off, and "
        r"by the definition of $F$ the point is not fixed.",
        r"$w_*$ is the limit of $G$ along $\gamma$, and the theorem holds with that reading.",
    ),
    Remark(
        ("s2-corr-sets",),
        "reading",
        r"$Z_c$ contains $\Pi_0$, which $\phi_c$ leaves in $\Pi_0$ and not in $P_c$; and a launch at rest need not "
        r"come back to the wall at all, so $\phi_c(H_c)$ need not be the whole of $\Pi_0$.",
        r"Without $\Pi_0$ the sets correspond, which is what the correspondence principle needs.",
    ),
    Remark(
        ("s2-G-semiconj",),
        "reading",
        r"$F\circ p$ is the identity at visible points alone: at a later crossing the first hit is another point.",
        r"It is used at visible points.",
    ),
    Remark(
        ("s3-dvdt",),
        "sign",
        r"(5) gives $\frac{\partial v_c}{\partial t}=-\frac12a$; the flight of a mass that presses, $a<0$, has $v>0$.",
        r"$Dp$ and $D\phi$ beside it have the right signs.",
    ),
    Remark(
        ("e:phi",),
        "slip",
        r"The velocity is that at the end of the flight, at time $t$; the argument and one parenthesis are missing.",
        r"The expansions use the velocity at $t$.",
    ),
    Remark(
        ("e:vtaylor-t2", "e:vtaylor-st2", "e:vtaylor-t3"),
        "constant",
        r"The jerk at rest is $a'+ab$, not $a'$: so $\frac{\partial^2y_c}{\partial t^2}=\frac13(a'+ab)$, and with "
        r"$\frac{\partial^2y_c}{\partial v\,\partial t}=\frac12b$ the term $\frac14ab$ becomes $\frac1{12}ab$; its "
        r"derivatives and the fourth derivative of $x$ change the next two lines alike.",
        r"Each term that changes has a factor $a$ or $a'b$: (16) and (17), where these vanish, are right.",
    ),
    Remark(
        ("e:phinew",),
        "sign",
        r"The velocity at landing is $v_c(\sigma+t,-t)=kt(3\sigma+2t)$, negative before the horizon $3\sigma+2t=0$, "
        r"as at a first hit.",
        r"(21) follows from the right sign.",
    ),
    Remark(
        ("e:defq", "s4-blowup"),
        "argument",
        r"To remove the cubic terms of $\psi\circ p$ needs quadratic terms in the changes of coordinates; in the "
        r"coordinates of (20) the first component of $\psi\circ q$ is therefore $\eta-\frac12\sigma+O(2)$.",
        r"On $s=0$ the map $h'$ is as printed, and in $Dh'(0,m)$ only the entry below the diagonal changes.",
    ),
    Remark(
        ("e:hdef",),
        "sign",
        r"A first hit comes before the horizon, where $\eta<0$: of the two roots it is the negative one.",
        r"$s'$ and the root are both negative for $s<0$, so (25) has the right sign.",
    ),
    Remark(
        ("t:t2-unique", "t:t3-unique"),
        "reading",
        r"$\Pi_0$, the points at rest, is invariant too and ends at $w_*$.",
        r"$\gamma$ is the only invariant arc with $v>0$.",
    ),
    Remark(
        ("t:t2-eigenvalue-limit", "t:t3-eigenvalue-limit"),
        "argument",
        r"Along $\gamma$ the matrix $DG$ tends to one that depends on $r$ through the direction $m_3$ (or $m_*$) "
        r"alone: its eigenvalue has a limit that is 1 only for $r=1$.",
        r"The limit is above 1, so the hyperbolicity across $\gamma$ does not fade at $w_*$.",
    ),
    Remark(
        ("s4-normal-id2",),
        "reading",
        r"The changes that remove the terms of order 3 have quadratic terms: they are the identity to first order.",
        r"The fold form (20) stands; see the remark on (21).",
    ),
    Remark(
        ("s4-Er-closed",),
        "slip",
        r"$E_r$ is closed and $Q_r(1,m)$ vanishes at its ends.",
        r"The fixed points lie inside.",
    ),
    Remark(
        ("e:fixm-converse",),
        "argument",
        r"Squaring adds a solution: at $m_2$ the product $m(m-\frac12)$ is negative, and $m_2$ is mapped to $-m_2$.",
        r"$m_2$ is excluded in the list that follows.",
    ),
    Remark(
        ("s4-m32-r1",),
        "argument",
        r"$m=\frac32$ solves (28) for every $r$, since $\Pi_0$ is invariant; it solves (29) for $r=1$ only.",
        r"It is excluded because it is $\Pi_0$, for every $r$.",
    ),
    Remark(
        ("s4-m2-sign",),
        "sign",
        r"$p$ and $q$ map the ray onto one parabola, on which $v>0$; what changes sign is $\sigma$, by the factor "
        r"$m_2-\frac12<0$.",
        r"The orientation is reversed all the same, so $m_2$ is no candidate.",
    ),
    Remark(
        ("s4-Nr-3-all",),
        "argument",
        r"The elimination of $r$ uses (29), which $m=\frac32$ does not solve; there $N_r=r$.",
        r"The formula is used at $m_3$ alone.",
    ),
    Remark(
        ("s4-beta-tangent",),
        "argument",
        r"$W^s$ passes through $(0,m_3)$, so $\chi(W^s)$ has the tangent $\eta=m_3\sigma$ and not the $\sigma$-axis.",
        r"$\gamma=p(\beta)$ is quadratically tangent to $\Pi_0$, as stated.",
    ),
    Remark(
        ("s4b-T2-place",),
        "slip",
        r"$\mathcal T''$ is the image under $\phi$, before $R$: the velocities at landing are not positive.",
        r"$R\mathcal T''$ lies in $\Pi_0^+$, and that is what is used.",
    ),
    Remark(
        ("s4b-l-range",),
        "argument",
        r"$\ell$ is a slope $t/\sigma$ and cannot scale with $k$: the rays must reach $3\ell+\ell^2=\frac94r$, so they "
        r"end at $\ell=\frac32(\sqrt{1+r}-1)$, and $\ell\le\frac34r$ is enough.",
        r"The two conditions on $\delta$ are uniform on this interval too.",
    ),
    Remark(
        ("s4b-p-bound",),
        "slip",
        r"The factor $\sigma^2$ is missing, here and in (37).",
        r"It cancels in the quotient.",
    ),
    Remark(
        ("s4b-q-bound", "s4b-ratio"),
        "constant",
        r"The remainder is added to the bound from above: the factor is $1+\frac13(1-r)=\frac13(4-r)$, where "
        r"$\frac13(1+2r)$ would be below the limit itself.",
        r"The quotient of the bounds is still below 1, since $r(4-r)<2+r$ is $(1-r)(2-r)>0$.",
    ),
    Remark(
        ("s4b-back",),
        "reading",
        r"The stable manifolds of $\sigma>0$ end at $\sigma'<0$ with $\sigma'\to0$ as $\sigma\to0$: nothing is left "
        r"for $\sigma=0$.",
        r"The theorem is about $\tau>\tau_*$.",
    ),
    Remark(
        ("s5-coordinates",),
        "slip",
        r"The formulas that follow hold for $(\sigma,t)=(s,sm)$, not for $(\sigma,\eta)=(s,sm)$.",
        r"The section uses $t=sm$ throughout.",
    ),
    Remark(
        ("s5-unique",),
        "argument",
        r"$f(0)=g(0)=0$: the points at rest, $m=0$, are fixed as $m=\frac32$ was before.",
        r"Between $-1$ and 0 there is one solution, and it is $m_*$.",
    ),
    Remark(
        ("s5-F-smooth",),
        "argument",
        r"On $\sigma=0$ the launch velocity is $-\frac1{24}a''t^3+\dots$: its inverse has a cube root at $w_*$.",
        r"$F$ is a homeomorphism; $\gamma$ is smooth because $W^s$ and $p$ are.",
    ),
    Remark(
        ("s6-c-side",),
        "reading",
        r"For (6) $\frac{\partial a_c}{\partial c}=-1$ and $a''<0$, so $d_0>0$: the two zeros exist for $c<c_0$.",
        r"With $d_0<0$ the paper's choice holds for $c$ counted the other way.",
    ),
    Remark(
        ("s6-a0-typo",),
        "slip",
        r"The primes are missing: at a swan point $a_{c_0}$ itself is 0.",
        r"The sign of $a''$ is meant and used.",
    ),
    Remark(
        ("s6p-AB",),
        "slip",
        r"At a positive swan $a_c<0$ between $A$ and $B$, so $a'(A)<0<a'(B)$: the two figures are named in the wrong "
        r"order.",
        r"The picture that follows has the right order.",
    ),
)


@cache
def remark_on(claim: str) -> Remark | None:
    """The remark on a claim, by its id; None where there is none.

    Examples
    --------
    >>> remark_on("s4b-ratio").grade, remark_on("e:meq")
    ('constant', None)
    """
    return next((remark for remark in REMARKS if claim in remark.claims), None)
