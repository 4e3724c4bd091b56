"""Functions of plain arithmetic as JavaScript: kernels and emitted recurrences run unchanged in a browser.

Doubles of both languages follow one standard, so that sums and products agree bit for bit; `exp`, `sin` and their like
may differ in the last bit.  A construct that is not in the tables below is refused when the text is made.
"""

import ast
import math
from collections.abc import Collection, Iterator

from singimpact.algebra.expressions import Call, Expression, Name, Number, Pi, Power, Product, Sum
from singimpact.algebra.numbers import as_float
from singimpact.codegen.over_lists import FUNCTIONS, nested

# % of numbers that are not negative: the languages differ elsewhere
BINARY = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Mod: "%"}
COMPARED = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "===", ast.NotEq: "!=="}
CALLED = {
    **{name: f"Math.{name}" for name in FUNCTIONS},
    "abs": "Math.abs",
    "min": "Math.min",
    "max": "Math.max",
    "int": "Math.trunc",
    "float": "",
}
NAMES = {"inf": "Infinity", "nan": "NaN", "True": "true", "False": "false", "None": "null"}
_RESERVED = (
    "case const default delete do enum export extends function let new null super switch "
    "this throw typeof var void arguments eval static"
)
RESERVED = set(_RESERVED.split())


def translated(source: str, wanted: Collection[str] | None = None) -> dict[str, str]:
    """The functions of a Python text as JavaScript, by name.

    Parameters
    ----------
    source : functions over numbers, lists and named tuples. wanted : names of functions; all of them without it.

    Raises
    ------
    TypeError : a wanted function holds something that has no translation here.

    Examples
    --------
    >>> text = "def f(a, n):\\n    s, t = 0.0, a[0, 1]\\n    for k in range(n):\\n        s += t**k\\n    return s, k"
    >>> print(translated(text)["f"])
    function f(a, n) {
      let k, s, t;
      [s, t] = [0.0, a[0][1]];
      for (k = 0; k < n; k += 1) {
        s += Math.pow(t, k);
      }
      return [s, k];
    }
    """
    tree = nested(ast.parse(source))
    functions = {function.name: function for function in tree.body if isinstance(function, ast.FunctionDef)}
    return {name: _function(function) for name, function in functions.items() if wanted is None or name in wanted}


def formula(tree: Expression, table: str) -> str:
    """A constant of a model as JavaScript; its parameters are entries of an object.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> formula(parse("-a**2/3 + sqrt(b)", ["a", "b"]), "given")
    '(((-1 / 3) * Math.pow(given["a"], 2)) + Math.sqrt(given["b"]))'
    """
    match tree:
        case Number(value):
            small = max(abs(value.numerator), value.denominator) < 2**53
            exact = f"{value.numerator}" if value.denominator == 1 else f"({value.numerator} / {value.denominator})"
            return exact if small else repr(float(value))
        case Pi():
            return "Math.PI"
        case Name(name):
            return f'{table}["{name}"]'
        case Sum(terms):
            return f"({' + '.join(formula(term, table) for term in terms)})"
        case Product(factors):
            return f"({' * '.join(formula(factor, table) for factor in factors)})"
        case Power(base, exponent):
            return f"Math.pow({formula(base, table)}, {formula(exponent, table)})"
        case Call(function, argument):
            return f"Math.{function}({formula(argument, table)})"
    return repr(as_float(tree))  # an algebraic number


def _function(part: ast.FunctionDef) -> str:
    given = [argument.arg for argument in part.args.args]
    stored = {node.id for node in ast.walk(part) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    own = sorted(_name(name) for name in stored - set(given))
    lines = [f"  let {', '.join(own)};"] if own else []
    lines += _block(part.body)
    return "\n".join([f"function {_name(part.name)}({', '.join(map(_name, given))}) {{", *lines, "}"])


def _name(name: str) -> str:
    return NAMES.get(name, f"{name}_" if name in RESERVED else name)


def _block(body: list[ast.stmt]) -> list[str]:
    return [f"  {line}" for part in body for line in _statement(part)]


def _statement(statement: ast.stmt) -> Iterator[str]:
    match statement:
        case ast.Expr(ast.Constant(str())) | ast.Pass():
            return
        case ast.Expr(value):
            yield f"{_text(value)};"
        case ast.Assign(targets, value):
            # Python evaluates the value once and assigns from left to right
            yield f"{' = '.join(_text(target) for target in targets)} = {_text(value)};"
        case ast.AugAssign(target, op, value) if type(op) in BINARY:
            yield f"{_text(target)} {BINARY[type(op)]}= {_text(value)};"
        case ast.Return(value):
            yield "return;" if value is None else f"return {_text(value)};"
        case ast.Break():
            yield "break;"
        case ast.Continue():
            yield "continue;"
        case ast.If(test, body, orelse):
            yield f"if ({_text(test)}) {{"
            yield from _block(body)
            if orelse:
                yield "} else {"
                yield from _block(orelse)
            yield "}"
        case ast.While(test, body, []):
            yield f"while ({_text(test)}) {{"
            yield from _block(body)
            yield "}"
        case ast.For(ast.Name(variable), ast.Call(ast.Name("range"), given), body, []):
            yield _loop(_name(variable), [_text(argument) for argument in given], given)
            yield from _block(body)
            yield "}"
        case _:
            raise TypeError(f"no JavaScript for {ast.unparse(statement)!r}")


def _loop(variable: str, ends: list[str], given: list[ast.expr]) -> str:
    """The head of a loop over a range; its step must be a number that is written, for its sign is the direction."""
    start, stop = ends[:2] if len(ends) > 1 else ("0", ends[0])
    step = ast.literal_eval(given[2]) if len(given) == 3 else 1
    return f"for ({variable} = {start}; {variable} {'<' if step > 0 else '>'} {stop}; {variable} += {step}) {{"


def _text(node: ast.expr) -> str:
    match node:
        case ast.Constant(bool(value)):
            return "true" if value else "false"
        case ast.Constant(int() | float() as value):
            return repr(value) if math.isfinite(value) else "Infinity"
        case ast.Name(name):
            return _name(name)
        case ast.Tuple(parts) | ast.List(parts):
            return f"[{', '.join(map(_text, parts))}]"
        case ast.Attribute(value, name):
            return f"{_text(value)}.{name}"
        case ast.Subscript(value, at):
            return f"{_text(value)}[{_text(at)}]"
        case ast.Call(ast.Name("len"), [part]):
            return f"{_text(part)}.length"
        case ast.Call(ast.Name(name), given, []):
            return f"{CALLED.get(name, _name(name))}({', '.join(map(_text, given))})"
    return _operation(node)


def _operation(node: ast.expr) -> str:
    match node:
        case ast.UnaryOp(ast.USub(), part):
            return f"(-{_text(part)})"
        case ast.UnaryOp(ast.Not(), part):
            return f"!({_text(part)})"
        case ast.BinOp(base, ast.Pow(), ast.Constant(0.5)):
            return f"Math.sqrt({_text(base)})"
        case ast.BinOp(base, ast.Pow(), exponent):
            return f"Math.pow({_text(base)}, {_text(exponent)})"
        case ast.BinOp(left, op, right) if type(op) in BINARY:
            return f"({_text(left)} {BINARY[type(op)]} {_text(right)})"
        case ast.BoolOp(op, parts):
            return f"({(' && ' if isinstance(op, ast.And) else ' || ').join(map(_text, parts))})"
        case ast.Compare(left, ops, rights) if all(type(op) in COMPARED for op in ops):
            parts = [left, *rights]
            links = [
                f"{_text(a)} {COMPARED[type(op)]} {_text(b)}" for a, op, b in zip(parts, ops, rights, strict=False)
            ]
            return f"({' && '.join(links)})"
        case ast.IfExp(test, body, orelse):
            return f"({_text(test)} ? {_text(body)} : {_text(orelse)})"
    raise TypeError(f"no JavaScript for {ast.unparse(node)!r}")
