"""The words of the derivations and of the errata: the paper's derivation retold, equations from the derived objects.

Not here: how a section becomes LaTeX or Markdown (`documents`), what is true (`paper.claims`).

`NOTATION` has the meanings of the letters, which follow the sections.
"""

from singimpact.documents.document_steps import Section, Step

NOTATION = Section(
    "notation",
    "Notation",
    (
        Step(
            "A point mass at $x$ moves freely by $x'' + f(x, x') = g(t)$ as long as $x > c$, where $g$ has period "
            "$T$. When it meets the wall $x = c$ with velocity $v$ it leaves with $-r v$, where $0 < r \\le 1$. A "
            "flight is named by its launch: it leaves the wall at the time $\\tau$ with velocity $v \\ge 0$, and $t$ "
            "counts time from then on. The set of launches at rest, $v = 0$ or $t = 0$, is written $\\Pi_0$."
        ),
        Step(
            "The acceleration at rest on the wall is $a_c(\\tau) = g(\\tau) - f(c, 0)$. Everything is expanded at "
            "one phase $\\tau_*$: $\\sigma = \\tau - \\tau_*$ is the distance from it, and $a, a', a'', \\ldots$ are "
            "$a_c$ and its derivatives by $\\tau$ at $\\tau_*$. The derivatives of $f$ at $(c, 0)$ are $f_{ij}$, $i$ "
            "times by $x$ and $j$ times by $x'$; the damping comes in so often that $b = -f_{01}$ has a letter of "
            "its own. At a regular point $a \\ne 0$, at a tangency point $a = 0 \\ne a'$, at a swan point $a = a' = "
            "0 \\ne a''$."
        ),
        Step(
            "Two scales are used: $k = \\tfrac16 a'$ at a tangency point and $\\ell = -\\tfrac1{24} a''$ at a swan "
            "point. $\\lambda$ is the factor by which an impact shortens $\\sigma$ along the invariant curve "
            "$\\gamma$, $\\mu$ the multiplier across it. $O(n)$ stands for a smooth function whose Taylor series in "
            "the small variables of the moment, $(\\sigma, v, t)$, $(\\sigma, t)$ or $(\\sigma, \\eta)$, begins at "
            "total degree $n$; after a blow-up $O(s^n)$ is $s^n$ times a smooth function of $(s, m)$."
        ),
        Step(
            "At the right of a formula stands its label and what its claims were found to be: proved in exact "
            "arithmetic, proved modulo a theorem that is named, proved in the model $x'' = 12\\kappa(s^2 - 1)$ alone, "
            "certified with bounds, argued (some links are sentences), formal (an expansion without its remainder), "
            "supported by numbers, or corrected, when the paper prints something else; what it "
            "prints is then quoted below. The word is the weakest along all that the claim rests on. A formula without "
            "a verdict is a step on the way."
        ),
    ),
)
