"""Plain functions of numbers and arrays as text of LLVM, in milliseconds, where numba takes seconds.

A small part of Python is enough for what is emitted for a model, and for the bounds that it calls: numbers, arrays of
one or two indices, named tuples of arrays, `if`, `while`, `for ... in range`, and calls of other such functions.  A
variable is a whole number if all its values are, else a double.  A division by zero has the answer of doubles.
"""

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from singimpact.codegen.over_lists import FUNCTIONS

WHOLE, REAL, TRUTH, NOTHING = ir.IntType(64), ir.DoubleType(), ir.IntType(1), ir.VoidType()
# Functions that LLVM knows; it calls the others of `FUNCTIONS` in the system's library of mathematics
INTRINSICS = {"sin", "cos", "exp", "log", "pow", "fabs"}
SIGNS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
OPERATIONS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}


# A value of the text: llvmlite gives its classes no types; or an `Array`, or `Fields`
Value = Any
Kind = Any
Kinds = tuple[Kind, ...]


@dataclass(frozen=True)
class Array:
    """An address, and the length of a row of an array of two indices."""

    address: Value
    row: Value | None = None


@dataclass(frozen=True)
class Fields:
    """The values of a named tuple; those of a plain tuple have no names."""

    values: tuple[Value, ...]
    names: tuple[str, ...] = ()


class Unsupported(ValueError):
    """A construct of Python that is not lowered."""


def lowered(functions: Mapping[str, ast.FunctionDef], space: Mapping[str, Any], entry: str, takes: Kind) -> str:
    """The text of a module of LLVM whose one function to be called is `entry`.

    Parameters
    ----------
    functions : all that may be called, by name. space : numbers and named tuples that they read.
    takes : the type of the entry; its addresses are arrays of one index.

    Raises
    ------
    Unsupported : a construct outside the part of Python that is lowered.

    Examples
    --------
    >>> tree = ast.parse("def law(v, w):\\n    return w[0] * v").body[0]
    >>> "fmul double" in lowered({"law": tree}, {}, "law", ir.FunctionType(REAL, [REAL, REAL.as_pointer()]))
    True
    """
    module = _Module(functions, space)
    module.define(entry, takes.args, _arrays, takes.return_type)
    return str(module.text)


def _arrays(arguments: Sequence[Value]) -> list[Value]:
    return [Array(value) if isinstance(value.type, ir.PointerType) else value for value in arguments]


class _Module:
    """Functions, each once for every choice of kinds of its arguments."""

    def __init__(self, functions: Mapping[str, ast.FunctionDef], space: Mapping[str, Any]) -> None:
        self.functions, self.space = functions, space
        self.text = ir.Module()
        self._versions: dict[tuple[object, ...], tuple[Value, Kinds]] = {}

    def define(
        self,
        name: str,
        kinds: Sequence[Kind],
        values_of: Callable[[Sequence[Value]], Sequence[Value]],
        returns: Kind | None = None,
    ) -> tuple[Value, Kinds]:
        """Write a function; it is returned with the kinds of its results.

        Parameters
        ----------
        kinds : of its arguments in LLVM. values_of : what they are to the body. returns : its type, if that is given.
        """
        tree = self.functions[name]
        variables: dict[str, Kind] = {}
        results: Kinds = ()
        # a variable that turns out to be a double makes others doubles: write it for nothing until no kind changes
        while True:
            trial = ir.Function(ir.Module(), ir.FunctionType(NOTHING, kinds), name)
            body = _Body(self, trial, variables, results)
            body.write(tree, values_of(trial.args))
            if (body.kinds, body.results) == (variables, results):
                break
            variables, results = body.kinds, body.results
        function = ir.Function(
            self.text, ir.FunctionType(returns or _packed(results), kinds), self.text.get_unique_name(name)
        )
        _Body(self, function, variables, results).write(tree, values_of(function.args))
        return function, results

    def version(self, name: str, values: Sequence[Value]) -> tuple[Value, Kinds]:
        """The function for values of these kinds, and the kinds of its results."""
        key = (name, *map(_shape, values))
        if key not in self._versions:
            kinds = [value.type for value in _flat(values)]
            self._versions[key] = self.define(name, kinds, lambda arguments: _like(values, iter(arguments)))
        return self._versions[key]


def _packed(kinds: Kinds) -> Kind:
    if len(kinds) < 2:
        return kinds[0] if kinds else NOTHING
    return ir.LiteralStructType(kinds)


def _flat(values: Sequence[Value]) -> Iterator[Value]:
    """The values of LLVM in values of all kinds."""
    for value in values:
        if isinstance(value, Fields):
            yield from _flat(value.values)
        elif isinstance(value, Array):
            yield value.address
            if value.row is not None:
                yield value.row
        else:
            yield value


def _like(values: Sequence[Value], flat: Iterator[Value]) -> list[Value]:
    """Values of the same kinds, made of others of LLVM."""
    copies: list[Value] = []
    for value in values:
        if isinstance(value, Fields):
            copies.append(Fields(tuple(_like(value.values, flat)), value.names))
        elif isinstance(value, Array):
            copies.append(Array(next(flat), None if value.row is None else next(flat)))
        else:
            copies.append(next(flat))
    return copies


def _shape(value: Value) -> object:
    if isinstance(value, Fields):
        return (value.names, *map(_shape, value.values))
    if isinstance(value, Array):
        return str(value.address.type), value.row is not None
    return str(value.type)


class _Body:
    """The text of one function as it grows.

    Parameters
    ----------
    kinds : of variables, as known from a trial. results : kinds of what is returned.
    """

    def __init__(self, module: _Module, function: Value, kinds: Mapping[str, Kind], results: Kinds) -> None:
        self.module, self.kinds, self.results = module, dict(kinds), results
        self.builder = ir.IRBuilder(function.append_basic_block())
        self.memory: dict[str, Value] = {}  # of numbers by variable
        self.objects: dict[str, Array | Fields] = {}  # arrays and named tuples by variable: each is assigned once

    def write(self, tree: ast.FunctionDef, arguments: Sequence[Value]) -> None:
        """Write the whole function."""
        for name, value in zip(tree.args.args, arguments, strict=True):
            self._set(name.arg, value)
        self._run(tree.body)
        if not self.builder.block.is_terminated:
            if self.results:
                self.builder.unreachable()
            else:
                self.builder.ret_void()

    # ---- statements

    def _run(self, statements: Sequence[ast.stmt]) -> None:
        for statement in statements:
            if self.builder.block.is_terminated:
                return
            self._statement(statement)

    def _statement(self, statement: ast.stmt) -> None:
        match statement:
            case ast.Assign(targets=[target], value=tree):
                self._assign(target, self._value(tree))
            case ast.AugAssign(target=target, op=operation, value=tree):
                before = self._value(target)
                self._assign(target, self._operation(operation, before, self._value(tree)))
            case ast.Return(value=tree):
                self._return(self._value(tree) if tree is not None else Fields(()))
            case ast.If(test=test, body=body, orelse=otherwise):
                self._branch(test, body, otherwise)
            case ast.While(test=test, body=body):
                self._loop(lambda: self._truth(test), body)
            case ast.For(target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range"), args=bounds), body=body):
                self._count(name, [self._value(bound) for bound in bounds], body)
            case ast.Expr(value=ast.Constant()):
                pass
            case ast.Expr(value=tree):
                self._value(tree)
            case _:
                raise Unsupported(ast.unparse(statement))

    def _assign(self, target: ast.expr, value: Value) -> None:
        match target:
            case ast.Name(id=name):
                self._set(name, value)
            case ast.Tuple(elts=targets):
                for one, item in zip(targets, value.values, strict=True):
                    self._assign(one, item)
            case ast.Subscript(value=array, slice=index):
                self.builder.store(self._as(value, REAL), self._address(self._value(array), index))
            case _:
                raise Unsupported(ast.unparse(target))

    def _set(self, name: str, value: Value) -> None:
        if isinstance(value, Array | Fields):
            self.objects[name] = value
            return
        if name not in self.memory:
            kind = self.kinds.setdefault(name, value.type)
            with self.builder.goto_entry_block():
                self.memory[name] = self.builder.alloca(kind)
        self.kinds[name] = _joined(self.kinds[name], value.type)
        self.builder.store(self._as(value, self.memory[name].type.pointee), self.memory[name])

    def _return(self, value: Value) -> None:
        values = value.values if isinstance(value, Fields) else (value,)
        if len(self.results) != len(values):  # a trial, before the kinds are known
            self.results = tuple(item.type for item in values)
        kinds = self.results
        self.results = tuple(_joined(kind, item.type) for kind, item in zip(kinds, values, strict=True))
        if self.builder.function.function_type.return_type == NOTHING:
            self.builder.ret_void()
            return
        values = tuple(self._as(item, kind) for item, kind in zip(values, kinds, strict=True))
        if len(values) == 1:
            self.builder.ret(values[0])
            return
        packed = ir.Constant(_packed(kinds), ir.Undefined)
        for at, item in enumerate(values):
            packed = self.builder.insert_value(packed, item, at)
        self.builder.ret(packed)

    def _branch(self, test: ast.expr, body: Sequence[ast.stmt], otherwise: Sequence[ast.stmt]) -> None:
        yes, no, after = (self.builder.append_basic_block() for _ in range(3))
        self.builder.cbranch(self._truth(test), yes, no)
        for block, statements in ((yes, body), (no, otherwise)):
            self.builder.position_at_end(block)
            self._run(statements)
            if not self.builder.block.is_terminated:
                self.builder.branch(after)
        self.builder.position_at_end(after)

    def _loop(
        self, test: Callable[[], Value], body: Sequence[ast.stmt], step: Callable[[], None] = lambda: None
    ) -> None:
        head, inside, after = (self.builder.append_basic_block() for _ in range(3))
        self.builder.branch(head)
        self.builder.position_at_end(head)
        self.builder.cbranch(test(), inside, after)
        self.builder.position_at_end(inside)
        self._run(body)
        if not self.builder.block.is_terminated:
            step()
            self.builder.branch(head)
        self.builder.position_at_end(after)

    def _count(self, name: str, bounds: Sequence[Value], body: Sequence[ast.stmt]) -> None:
        begin, end = bounds if len(bounds) == 2 else (ir.Constant(WHOLE, 0), *bounds)
        with self.builder.goto_entry_block():
            counter = self.builder.alloca(WHOLE)
        self.builder.store(begin, counter)

        def test() -> Value:
            value = self.builder.load(counter)
            self._set(name, value)
            return self.builder.icmp_signed("<", value, end)

        def step() -> None:
            self.builder.store(self.builder.add(self.builder.load(counter), ir.Constant(WHOLE, 1)), counter)

        self._loop(test, body, step)

    # ---- values

    def _value(self, tree: ast.expr) -> Value:
        match tree:
            case ast.Constant(value=int() | float() as number):
                return _constant(number)
            case ast.Name(id=name):
                return self._named(name)
            case ast.Attribute(value=inner, attr=name):
                fields = self._value(inner)
                return fields.values[fields.names.index(name)]
            case ast.Tuple(elts=items):
                return Fields(tuple(self._value(item) for item in items))
            case ast.Subscript(value=inner, slice=index):
                value = self._value(inner)
                if isinstance(value, Fields) and isinstance(index, ast.Constant) and isinstance(index.value, int):
                    return value.values[index.value]
                return self.builder.load(self._address(value, index))
            case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int() as power)):
                return self._whole_power(self._as(self._value(base), REAL), power)
            case ast.BinOp(left=left, op=operation, right=right):
                return self._operation(operation, self._value(left), self._value(right))
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                value = self._value(inner)
                return self.builder.fneg(value) if value.type == REAL else self.builder.neg(value)
            case ast.IfExp(test=test, body=body, orelse=otherwise):
                return self._choice(self._truth(test), lambda: self._value(body), lambda: self._value(otherwise))
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._call(name, arguments)
        raise Unsupported(ast.unparse(tree))

    def _named(self, name: str) -> Value:
        if name in self.objects:
            return self.objects[name]
        if name in self.memory:
            return self.builder.load(self.memory[name])
        if isinstance(self.module.space.get(name), int | float):
            return _constant(self.module.space[name])
        raise Unsupported(name)

    def _address(self, array: Value, index: ast.expr) -> Value:
        if not isinstance(array, Array):
            raise Unsupported(f"an index {ast.unparse(index)} of what is no array")
        if isinstance(index, ast.Tuple):
            row, column = (self._value(item) for item in index.elts)
            offset = self.builder.add(self.builder.mul(row, array.row), column)
        else:
            offset = self._value(index)
        return self.builder.gep(array.address, [offset])

    def _operation(self, operation: ast.operator, left: Value, right: Value) -> Value:
        if isinstance(operation, ast.Pow):
            return self._function("pow", self._as(left, REAL), self._as(right, REAL))
        if isinstance(operation, ast.Div):
            return self.builder.fdiv(self._as(left, REAL), self._as(right, REAL))
        if type(operation) not in OPERATIONS:
            raise Unsupported(ast.unparse(operation))
        kind = _joined(left.type, right.type)
        name = OPERATIONS[type(operation)]
        write = getattr(self.builder, name if kind == WHOLE else f"f{name}")
        return write(self._as(left, kind), self._as(right, kind))

    def _whole_power(self, value: Value, power: int) -> Value:
        """A power by repeated squares, as numba has it, so that both have the same bits."""
        result, left = _constant(1.0), abs(power)
        while left:
            if left & 1:
                result = self.builder.fmul(result, value)
            left >>= 1
            value = self.builder.fmul(value, value)
        return self.builder.fdiv(_constant(1.0), result) if power < 0 else result

    def _truth(self, tree: ast.expr) -> Value:
        match tree:
            case ast.Compare(left=first, ops=signs, comparators=others):
                values = [self._value(item) for item in (first, *others)]
                truths = [self._compared(*pair) for pair in zip(signs, values, values[1:], strict=False)]
                truth = truths[0]
                for other in truths[1:]:
                    truth = self.builder.and_(truth, other)
                return truth
            case ast.BoolOp(op=ast.And(), values=[first, *rest]):
                return self._both(first, rest, False)
            case ast.BoolOp(op=ast.Or(), values=[first, *rest]):
                return self._both(first, rest, True)
            case ast.UnaryOp(op=ast.Not(), operand=inner):
                return self.builder.not_(self._truth(inner))
        raise Unsupported(ast.unparse(tree))

    def _both(self, first: ast.expr, rest: Sequence[ast.expr], decided: bool) -> Value:
        """`and`, or `or` where a first True decides: what is decided by the first is not looked at further."""
        truth = self._truth(first)
        if not rest:
            return truth
        known = ir.Constant(TRUTH, decided)
        longer = [lambda: self._both(rest[0], rest[1:], decided), lambda: known]
        return self._choice(truth, *(longer[::-1] if decided else longer))

    def _compared(self, sign: ast.cmpop, left: Value, right: Value) -> Value:
        kind, name = _joined(left.type, right.type), SIGNS[type(sign)]
        values = self._as(left, kind), self._as(right, kind)
        if kind == WHOLE:
            return self.builder.icmp_signed(name, *values)
        # nan differs from everything, and is neither less nor more
        compare: Any = self.builder.fcmp_unordered if name == "!=" else self.builder.fcmp_ordered
        return compare(name, *values)

    def _choice(self, truth: Value, body: Callable[[], Value], otherwise: Callable[[], Value]) -> Value:
        """A value that is computed on one of two ways."""
        blocks = [self.builder.append_basic_block() for _ in range(2)]
        after = self.builder.append_basic_block()
        self.builder.cbranch(truth, *blocks)
        ends = []
        for block, write in zip(blocks, (body, otherwise), strict=True):
            self.builder.position_at_end(block)
            value = write()
            ends.append((value, self.builder.block))
        kind = ends[0][0].type if ends[0][0].type == TRUTH else _joined(ends[0][0].type, ends[1][0].type)
        values = []
        for value, block in ends:
            self.builder.position_at_end(block)
            values.append((self._as(value, kind), block))
            self.builder.branch(after)
        self.builder.position_at_end(after)
        chosen = self.builder.phi(kind)
        for value, block in values:
            chosen.add_incoming(value, block)
        return chosen

    def _as(self, value: Value, kind: Kind) -> Value:
        if value.type == kind:
            return value
        if kind == REAL:
            return self.builder.sitofp(value, REAL)
        return self.builder.fptosi(value, kind)  # in a trial alone, which is not kept

    # ---- calls

    def _call(self, name: str, arguments: Sequence[ast.expr]) -> Value:
        values = [self._value(argument) for argument in arguments]
        if name in ("max", "min"):
            return self._extreme(">" if name == "max" else "<", values)
        if name == "abs":
            return self._function("fabs", self._as(values[0], REAL))
        if name == "int":
            return self._whole(values[0])
        if name == "block":  # `flights.kernels.layout.block` over an address
            array, at, shape = values
            length = shape.values[1] if len(shape.values) == 2 else None
            return Array(self.builder.gep(array.address, [at]), length)
        if name in FUNCTIONS:
            return self._function(name, self._as(values[0], REAL))
        if name in self.module.functions:
            return self._called(name, values)
        if isinstance(self.module.space.get(name), type):
            return Fields(tuple(values), self.module.space[name]._fields)
        raise Unsupported(name)

    def _called(self, name: str, values: Sequence[Value]) -> Value:
        function, kinds = self.module.version(name, values)
        result = self.builder.call(function, list(_flat(values)))
        if len(kinds) < 2:
            return result
        return Fields(tuple(self.builder.extract_value(result, at) for at in range(len(kinds))))

    def _extreme(self, sign: str, values: Sequence[Value]) -> Value:
        """The largest or least of numbers; as in Python, nan is passed over unless it comes first."""
        kind = REAL if any(value.type == REAL for value in values) else WHOLE
        extreme, *others = [self._as(value, kind) for value in values]
        compare: Any = self.builder.icmp_signed if kind == WHOLE else self.builder.fcmp_ordered
        for other in others:
            extreme = self.builder.select(compare(sign, other, extreme), other, extreme)
        return extreme

    def _whole(self, value: Value) -> Value:
        if value.type == WHOLE:
            return value
        return self.builder.call(self._declared("llvm.fptosi.sat.i64.f64", WHOLE, 1), [value])

    def _function(self, name: str, *values: Value) -> Value:
        full = f"llvm.{name}.f64" if name in INTRINSICS else name
        return self.builder.call(self._declared(full, REAL, len(values)), values)

    def _declared(self, name: str, returns: Kind, count: int) -> Value:
        text = self.module.text
        return text.globals.get(name) or ir.Function(text, ir.FunctionType(returns, [REAL] * count), name)


def _constant(number: float) -> Value:
    return ir.Constant(WHOLE if isinstance(number, int) else REAL, number)


def _joined(one: Kind, other: Kind) -> Kind:
    return WHOLE if one == other == WHOLE else REAL
