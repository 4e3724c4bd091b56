"""`Oscillator`: f, g, clearance, restitution and parameters, kept exact; and model files."""

import tomllib
from collections.abc import Collection, Mapping
from fractions import Fraction
from functools import lru_cache, partial
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

from singimpact.algebra.expressions import FUNCTIONS, Call, Expression, Name, names_in, negate, substitute, walk
from singimpact.algebra.numbers import compare, constant, tree_of
from singimpact.algebra.puiseux import Puiseux
from singimpact.algebra.rings import to_sympy
from singimpact.handed_on import sympy
from singimpact.inputs import InputError, checked_methods, refuse, require, require_known, shown, unknown
from singimpact.oscillator import rebound
from singimpact.oscillator.period import checked_period, moving_in_time, period_of
from singimpact.status import wall_of
from singimpact.store import read_bounded

STATE = ("x", "xdot")
FIELDS = ("f", "g", "clearance", "restitution", "parameters", "period", "upper", "upper_restitution")
RESERVED = {*STATE, "t", "v", "pi", *FUNCTIONS}


@partial(checked_methods, two_walls=True)
class Oscillator:
    """x'' + f(x, x', t) = g(t), x >= clearance, v -> -restitution v, or v -> rho(v); with `upper`, x <= upper too.

    Parameters
    ----------
    f : expression in x, xdot, t and the parameters: text, a Python function, sympy or a number. A force in which t
        occurs is one with moving coefficients, "(1 + cos(2*t)/5)*x".
    g : expression in t and the parameters.
    clearance : number, the obstacle's place; finite.
    restitution : number r in [0, 1], for v -> -r v; or an expression rho in the velocity v before the impact and the
        parameters, with rho(0) = 0 and rho'(0) in [-1, 0), for v -> rho(v). Powers such as (-v)**(6/5) are allowed.
    parameters : name -> number.
    period : number, optional; a common period of f and g in t. Computed where t enters through sines and cosines of
        commensurate rates; needed only where a task asks for one.
    upper : number above the clearance, the place of a second wall, x <= upper; None for one wall.
    upper_restitution : of the upper wall; without it that of the lower one. An expression rho takes the velocity
        towards the wall as v < 0 too: it is the law of the model with x -> -x, see `mirrored`.

    Raises
    ------
    InputError : one line that names the input, its value and what is accepted.

    Notes
    -----
    Two oscillators are equal when their texts are; they hash, pickle and print by that text. They are not changed:
    `replace` gives another.

    Examples
    --------
    >>> Oscillator("x", "cos(2*t)", "0.3", "1/2")
    Oscillator(f='x', g='cos(2*t)', clearance='0.3', restitution='0.5')
    """

    __slots__ = ("_period", "_texts", "clearance", "f", "g", "parameters", "restitution", "upper", "upper_restitution")

    def __init__(
        self,
        f: Any,
        g: Any,
        clearance: Any,
        restitution: Any,
        parameters: Mapping[str, Any] | None = None,
        period: Any = None,
        upper: Any = None,
        upper_restitution: Any = None,
    ) -> None:
        values = _parameters(parameters or {})
        self.parameters: Mapping[str, Expression] = MappingProxyType(values)
        self.f = tree_of(f, (*STATE, "t", *values), "f")
        self.g = tree_of(g, ("t", *values), "g")
        self.restitution = rebound.read(restitution, values)
        self.clearance = constant("clearance", clearance)
        self.upper, self.upper_restitution = self._above(upper, upper_restitution, values)
        used = names_in(self.f) | names_in(self.g) | names_in(self.restitution) | names_in(self.upper_restitution)
        for name in values:
            if name not in used:
                raise unknown("parameter", name, sorted((used | {name}) - {*STATE, "t", "v", name}))
        moving = {name: substitute(tree, values) for name, tree in moving_in_time(self.f, self.g).items()}
        self._period = period_of(*moving.values())
        if period is not None:
            self._period = checked_period(moving, period, self._period)
        self._texts = (
            str(self.f),
            str(self.g),
            str(self.clearance),
            str(self.restitution),
            tuple((name, str(value)) for name, value in sorted(values.items())),
            str(self._period) if period is not None else None,
            None if self.upper is None else str(self.upper),
            None if upper_restitution is None else str(self.upper_restitution),
        )

    def _above(
        self, upper: Any, restitution: Any, parameters: Mapping[str, Expression]
    ) -> tuple[Expression | None, Expression]:
        """The height of the upper wall, None without one, and its restitution."""
        if upper is None:
            if restitution is not None:
                raise refuse("upper_restitution", restitution, "upper= too, the height of the wall that it is of")
            return None, self.restitution
        height = constant("upper", upper)
        if compare(height, self.clearance) <= 0:
            raise refuse("upper", upper, f"a number above the clearance {self.clearance}")
        law = (
            self.restitution
            if restitution is None
            else rebound.read(restitution, dict(parameters), "upper_restitution")
        )
        for name, tree in (("restitution", self.restitution), ("upper_restitution", law)):
            require(str(tree) != "0", name, 0, "a number above 0 beside upper=: two walls need rebounds")
        return height, law

    def __setattr__(self, name: str, value: Any) -> None:
        if hasattr(self, "_texts"):  # the last field that is set
            asked = f"replace({name}={shown(value)})" if name in FIELDS else "replace(...)"
            raise InputError(f"{name} of a model is not changed: osc.{asked} gives another model")
        object.__setattr__(self, name, value)

    def __delattr__(self, name: str) -> None:
        raise InputError(f"{name} of a model is not removed: osc.replace(...) gives another model")

    @property
    def period(self) -> Expression | None:
        """The common period of f and g in t, or None when both are free of t or not known to be periodic."""
        return self._period

    @property
    def parametric(self) -> bool:
        """Whether t occurs in f."""
        return "t" in names_in(self.f)

    @property
    def autonomous(self) -> bool:
        """Whether t occurs neither in f nor in g: the model has no clock."""
        return not self.parametric and "t" not in names_in(self.g)

    @property
    def mirrored(self) -> Self:
        """The model with x -> -x, whose lower wall is the upper one of this: its local theory is that of the upper wall.

        Examples
        --------
        >>> Oscillator("x + x**2", "cos(2*t)", "-0.5", 1, upper="0.7", upper_restitution="0.8").mirrored
        Oscillator(f='-(-x + (-x)**2)', g='-cos(2*t)', clearance='-0.7', restitution='0.8', upper='0.5', upper_restitution='1')
        """  # noqa: E501
        return _mirrored(self)  # type: ignore[no-any-return]

    def one_wall(self, wall: object = "lower") -> Self:
        """The model with the lower wall alone, or with the upper one alone and x -> -x.

        Parameters
        ----------
        wall : "lower" or "upper", "l" or "u", 0 or 1.

        Examples
        --------
        >>> Oscillator("x", "cos(2*t)", "-0.5", "0.6", upper="0.7").one_wall("upper")
        Oscillator(f='x', g='-cos(2*t)', clearance='-0.7', restitution='0.6')
        """
        return self.seen_from(wall).replace(upper=None, upper_restitution=None)

    def seen_from(self, wall: object = None) -> Self:
        """The model whose lower wall is a named one: this model, or at the upper wall the `mirrored` one.

        Parameters
        ----------
        wall : as for `one_wall`, or None for the lower one.

        Examples
        --------
        >>> Oscillator("x", "cos(2*t)", "-0.5", "0.6", upper="0.7").seen_from("upper").clearance
        Number(value=Fraction(-7, 10))
        """
        code = 0 if wall is None else wall_of(wall)
        if code < 0 or (code and self.upper is None):
            raise refuse("wall", wall, "'lower' or 'upper'" if self.upper is not None else "'lower': the model has one")
        return self.mirrored if code else self

    def force(self, keep: Collection[str] = ()) -> Expression:
        """f with the parameters' values put in; those in `keep` stay letters."""
        return _with_values(self, "f", frozenset(keep))

    def forcing(self, keep: Collection[str] = ()) -> Expression:
        """g with the parameters' values put in; those in `keep` stay letters."""
        return _with_values(self, "g", frozenset(keep))

    def rho(self, keep: Collection[str] = ()) -> Expression:
        """The restitution as a tree in v with the parameters' values put in; those in `keep` stay letters."""
        return _with_values(self, "restitution", frozenset(keep))

    def slope_at_rest(self) -> Expression:
        """r = -rho'(0).

        Examples
        --------
        >>> print(Oscillator("x", "cos(t)", 0, "-0.8*v + b*v**2", {"b": 1}).slope_at_rest())
        0.8
        """
        return rebound.slope_at_rest(self.restitution, tuple(sorted(self.parameters.items())))

    def rho_at_rest(self) -> Puiseux | None:
        """The first terms of rho(-w) in rational powers of w > 0; None where there is no such expansion.

        Examples
        --------
        >>> print(Oscillator("x", "cos(t)", 0, "-v*(1 - C*(-v)**q)", {"C": "0.3", "q": "1/5"}).rho_at_rest())
        1*w**(1) + (-0.3)*w**(6/5)
        """
        return rebound.at_rest(self.restitution, tuple(sorted(self.parameters.items())))

    @property
    def smooth_at_rest(self) -> bool:
        """Whether rho has whole powers of v alone at v = 0, in the terms that are known."""
        found = None if not names_in(self.restitution) else self.rho_at_rest()
        return found is None or found.whole

    @property
    def plastic(self) -> bool:
        """Whether the restitution is the number 0: impacts leave no velocity.

        Examples
        --------
        >>> [Oscillator("x", "cos(t)", 0, r).plastic for r in (0, "0.5", "-v/2 + v**2")]
        [True, False, False]
        """
        return rebound.is_zero(self.restitution)

    def replace(self, **changes: Any) -> Self:
        """A model with some fields changed; a parameter is changed by its own name.

        Examples
        --------
        >>> Oscillator("x", "cos(w*t)", 0, 1, {"w": 2}).replace(w=0.3, clearance="0.3")
        Oscillator(f='x', g='cos(w*t)', clearance='0.3', restitution='1', parameters={'w': 0.3})
        """
        fields: dict[str, Any] = {
            "f": self.f,
            "g": self.g,
            "clearance": self.clearance,
            "restitution": self.restitution,
        }
        fields["period"] = self._period if self._texts[5] is not None else None
        fields["upper"] = self.upper
        fields["upper_restitution"] = self.upper_restitution if self._texts[7] is not None else None
        parameters: dict[str, Any] = dict(self.parameters)
        for name, value in changes.items():
            if name not in fields and name not in parameters:
                raise unknown("field or parameter", name, [*fields, *parameters])
            (fields if name in fields else parameters)[name] = value
        return type(self)(**fields, parameters=parameters)

    def to_dict(self) -> dict[str, Any]:
        """The fields as text; `type(self)(**osc.to_dict())` is an equal model."""
        f, g, clearance, restitution, parameters, *others = self._texts
        fields: dict[str, Any] = {"f": f, "g": g, "clearance": clearance, "restitution": restitution}
        if parameters:
            fields["parameters"] = dict(parameters)
        named = zip(("period", "upper", "upper_restitution"), others, strict=True)
        return fields | {name: text for name, text in named if text is not None}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Oscillator) and self._texts == other._texts

    def __hash__(self) -> int:
        return hash(self._texts)

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({', '.join(f'{key}={_written(value)}' for key, value in self.to_dict().items())})"
        )

    def _repr_latex_(self) -> str:

        return f"${equation(self)}$"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuilt, (type(self), self.to_dict()))


@lru_cache(maxsize=1024)
def _with_values(osc: Oscillator, field: str, keep: frozenset[str]) -> Expression:
    """A field of a model with the values of its parameters put in, but of some."""
    tree = rebound.rho_of(osc.restitution) if field == "restitution" else getattr(osc, field)
    return substitute(tree, {name: value for name, value in osc.parameters.items() if name not in keep})


@lru_cache(maxsize=256, typed=True)
def _mirrored(osc: Oscillator) -> Any:
    if osc.upper is None:
        raise refuse("upper", None, "a model with two walls: x -> -x puts the wall of this one above")
    turned: dict[str, Expression] = {name: negate(Name(name)) for name in STATE}
    return type(osc)(
        negate(substitute(osc.f, turned)),
        negate(osc.g),
        negate(osc.upper),
        osc.upper_restitution,
        osc.parameters,
        osc.period if osc._texts[5] is not None else None,
        negate(osc.clearance),
        osc.restitution if osc._texts[7] is not None else None,
    )


def _rebuilt(kind: type[Oscillator], fields: dict[str, Any]) -> Oscillator:
    return kind(**fields)


def _parameters(given: Mapping[str, Any]) -> dict[str, Expression]:
    require(isinstance(given, Mapping), "parameters", given, "a mapping from names to numbers, such as {'omega': 1.7}")
    named: dict[Any, Any] = {getattr(name, "name", name): value for name, value in given.items()}  # sympy's Symbols
    for name in named:
        if not isinstance(name, str) or not (name.isidentifier() and name.isascii()) or name in RESERVED:
            letters = f"a name of letters a to z, digits and _ other than {', '.join(sorted(RESERVED))}"
            raise refuse("parameter name", name, letters)
    return {name: constant(name, value) for name, value in named.items()}


def require_smooth_text(tree: Expression, what: str) -> None:
    """Refuse abs where a task needs derivatives."""
    for part in walk(tree):
        if isinstance(part, Call) and part.function == "abs":
            raise InputError(
                f"{what} = {shown(str(tree))} is not smooth where abs changes sign: a smooth expression is needed here"
            )


def require_smooth_rho(osc: Oscillator, what: str) -> None:
    """Refuse a restitution that is 0, or not smooth at rest, where a task needs its Taylor series there.

    Parameters
    ----------
    what : the task, as the subject of a sentence.
    """
    require_rebound(osc, what)
    if not osc.smooth_at_rest:
        raise not_smooth(osc, what)


def require_rebound(osc: Oscillator, what: str) -> None:
    """Refuse the restitution 0 where a task needs velocities after impacts; `what` is as in `require_smooth_rho`."""
    if osc.plastic:
        raise InputError(f"restitution = 0 is not accepted here: {what} needs impacts that rebound, give a number > 0")


def require_model(name: str, value: object) -> None:
    """Refuse what is not a model."""
    require(isinstance(value, Oscillator), name, value, "an ImpactOscillator")


def not_smooth(osc: Oscillator, what: str) -> InputError:
    """The refusal of a restitution that is not smooth at rest."""
    return InputError(
        f"restitution = {shown(str(osc.restitution))} is not accepted here: at v = 0 it has powers of v that are not "
        f"whole, and {what} needs a number r, or a rho that is smooth there, such as -0.8*v + v**2"
    )


def _written(value: Any) -> str:
    """A field as it can be typed: a number that came as a float is shown as that float, not by its many decimals."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name!r}: {_written(each)}" for name, each in value.items()) + "}"
    try:
        number = float(value)
    except ValueError:
        return repr(value)
    short = repr(number)
    return short if len(short) < len(value) and Fraction(number) == Fraction(value) else repr(value)


# Model files: TOML with the fields of an `Oscillator`.

REQUIRED = ("f", "g", "clearance", "restitution")


def fields_of(text: str, source: str = "model file") -> dict[str, Any]:
    """The fields in a TOML text; numbers keep the decimals that are written.

    Raises
    ------
    InputError : not TOML, an unknown key (the nearest known one is named), a field missing.

    Examples
    --------
    >>> fields_of('f = "x"\\ng = "cos(2*t)"\\nclearance = 0.3\\nrestitution = 0.5')
    {'f': 'x', 'g': 'cos(2*t)', 'clearance': '0.3', 'restitution': '0.5'}
    """
    try:
        fields = tomllib.loads(text, parse_float=str)
    except (ValueError, RecursionError) as error:  # an integer of 5000 digits is a plain ValueError
        raise InputError(f"{source} is not TOML: {' '.join(str(error).split())}") from None
    require_known(f"key in {source}:", fields, FIELDS)
    for key in REQUIRED:
        if key not in fields:
            raise InputError(f"{source} has no {key}: a model needs {', '.join(REQUIRED)}")
    return fields


def read_fields(path: str | Path) -> dict[str, Any]:
    """The fields of a model file."""
    raw = read_bounded(path, "model file")
    try:
        return fields_of(raw.decode("utf-8"), f"model file {shown(str(path))}")
    except UnicodeDecodeError:
        raise InputError(f"model file {shown(str(path))} is not UTF-8 text") from None


def to_toml(fields: dict[str, Any]) -> str:
    """The TOML text of a model's fields (`Oscillator.to_dict`)."""
    lines = [f'{key} = "{value}"' for key, value in fields.items() if key != "parameters"]
    if "parameters" in fields:
        lines += ["", "[parameters]", *(f'{name} = "{value}"' for name, value in fields["parameters"].items())]
    return "\n".join(lines) + "\n"


# The model as the reader of a paper would write it, in LaTeX.


def equation(osc: Oscillator) -> str:
    """x'' + f = g, the walls, the rebound, and the numbers that the letters stand for.

    Examples
    --------
    >>> print(equation(Oscillator("x + x**3", "t*omega", 1, "1/2", {"omega": 2})))
    \\ddot x + x^{3} + x = \\omega t,\\quad x \\ge 1,\\quad v \\mapsto - \\frac{v}{2},\\quad \\omega = 2
    """
    force = "" if to_sympy(osc.f) == 0 else f" + {latex(osc.f)}".replace("+ -", "-")
    parts = [rf"\ddot x{force} = {latex(osc.g)}", rf"x \ge {latex(osc.clearance)}"]
    parts.append(rf"v \mapsto {latex(rebound.rho_of(osc.restitution))}")
    if osc.upper is not None:
        parts[1] = rf"{latex(osc.clearance)} \le x \le {latex(osc.upper)}"
        if osc.upper_restitution != osc.restitution:
            above = substitute(negate(rebound.rho_of(osc.upper_restitution)), {"v": negate(Name("v"))})
            parts[2] += rf"\text{{ below}},\ {latex(above)}\text{{ above}}"
    parts += [f"{latex_name(name)} = {latex(value)}" for name, value in osc.parameters.items()]
    return r",\quad ".join(parts)


def latex(tree: Expression) -> str:
    """LaTeX of an expression of a model; x' has its dot."""
    found = sympy.sympify(to_sympy(tree))
    return str(sympy.latex(found, symbol_names={each: latex_name(each.name) for each in found.free_symbols}))


def latex_name(name: str) -> str:
    """LaTeX of the name of a parameter, a word upright; x' has its dot.

    Examples
    --------
    >>> [latex_name(name) for name in ("omega", "mu_1", "damping", "A", "xdot")]
    ['\\\\omega', '\\\\mu_{1}', '\\\\mathrm{damping}', 'A', '\\\\dot x']
    """
    letters = str(sympy.latex(sympy.Symbol(name)))
    word = letters.isalpha() and len(letters) > 1
    return r"\dot x" if name == "xdot" else rf"\mathrm{{{letters}}}" if word else letters
