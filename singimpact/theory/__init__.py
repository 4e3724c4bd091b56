"""The local theory as exact power series at one point of the tau-axis, one body of code for every contact order.

Not here: the points and their jets (`contact`), finite flights (`flights`), the paper's own steps in sympy
(`paper.routes`), verdicts on the paper (`paper.claims`).
"""

from typing import Any

from singimpact.handed_on import names_of as _names_of

_value_of = _names_of(__name__)


def __getattr__(name: str) -> Any:
    """A name of a file that loads sympy, or of those that tests use."""
    try:
        return _value_of(name)
    except AttributeError:
        offer = ", ".join(_PUBLIC)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}: it has {offer}") from None


_PUBLIC = [
    "Sheet",
    "chatter_limit",
    "dynamics_on_gamma",
    "fibre",
    "gamma",
    "grazing_map",
    "normal_form",
    "r_of_lambda",
    "v_c",
    "v_c_on_arrays",
]


def __dir__() -> list[str]:
    return _PUBLIC
