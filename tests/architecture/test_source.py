"""Habits of the source that are checked by reading it: sizes, banned calls, nothing unfinished."""

import ast
import re

import pytest

BANNED = {"series", "limit", "simplify", "solve", "integrate"}
OTHERS = {"np", "numpy", "scipy", "flint"}
LONGEST, MOST_PARAMETERS, MOST_BRANCHES = 600, 8, 24
IMPORTLIB_HOMES = ("__init__.py", "handed_on.py", "cli/")
NAMELESS = {"utils.py", "helpers.py", "core.py", "common.py", "misc.py"}


def sources(clone):
    """Path inside the package -> text, of what people wrote."""
    package = clone / "singimpact"
    found = {path.relative_to(package).as_posix(): path.read_text() for path in package.rglob("*.py")}
    assert len(found) > 20
    return {
        path: text for path, text in found.items() if not path.startswith("generated/") or path.endswith("__init__.py")
    }


def banned_uses(text):
    """Lines where a banned function of sympy is imported, named or called, as a function or as a method."""
    nodes = list(ast.walk(ast.parse(text)))
    aliases = {
        alias for node in nodes if isinstance(node, ast.Import | ast.ImportFrom) for alias in sympy_aliases(node)
    }
    sympy_here = bool(aliases) or any(from_sympy(node) for node in nodes)
    return sorted({node.lineno for node in nodes if banned(node, aliases, sympy_here)})


def sympy_aliases(node):
    return {(alias.asname or "sympy") for alias in node.names if alias.name.partition(".")[0] == "sympy"}


def from_sympy(node):
    return isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "sympy"


def banned(node, aliases, sympy_here):
    if from_sympy(node):
        return any(alias.name in BANNED for alias in node.names)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in BANNED:
        # no other library in use has a method `simplify`; the other names are sympy's only where sympy is imported
        return (sympy_here and owner(node.func) not in OTHERS) or node.func.attr == "simplify"
    return isinstance(node, ast.Attribute) and node.attr in BANNED and owner(node) in aliases


def owner(node):
    """The first name of a dotted one."""
    while isinstance(node, ast.Attribute):
        node = node.value
    return node.id if isinstance(node, ast.Name) else None


def of_bench_peers(path):
    return path.startswith("bench/peers")


def test_banned_functions_of_sympy_are_not_called(clone):
    found = {path: banned_uses(text) for path, text in sources(clone).items() if not of_bench_peers(path)}
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "text",
    [
        "import sympy\nsympy.simplify(x)",
        "import sympy as sp\nsp.series(x)",
        "from singimpact.handed_on import sympy\nsympy.series(x)",
        "import sympy\nshorten = sympy.simplify",
        "def late(x):\n    import sympy as sp\n    return sp.limit(x)",
        "from sympy import solve as root",
        "from sympy.integrals import integrate",
        "from sympy import Symbol\nSymbol('x').series()",
        "def shown(x):\n    return x.simplify()",
    ],
)
def test_planted_banned_call_is_seen(text):
    assert banned_uses(text)


def words_of(key):
    """The words of a check that a mapping names; what a run puts into them is left open."""
    parts = key.values if isinstance(key, ast.JoinedStr) else [key]
    return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in parts)


def hidden_checks(text):
    """Lines of mappings given to `every` in which two checks may have one name: the later one would be the only one."""
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call) and node.args]
    calls = [node for node in nodes if getattr(node.func, "id", "") in ("every", "persisting")]
    tables = [call.args[0].keys for call in calls if isinstance(call.args[0], ast.Dict)]
    return [keys[0].lineno for keys in tables if len({words_of(key) for key in keys}) < len(keys)]


def test_no_check_of_a_claim_hides_another(clone):
    found = {path: hidden_checks(text) for path, text in sources(clone).items() if path.startswith("paper/")}
    assert sum(text.count("every(\n        {") for text in sources(clone).values()) > 5
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize("keys", ['"it is 0": a, "it is 0": b', 'f"{x} is 0": a, f"{y} is 0": b'])
def test_a_planted_check_of_the_same_name_is_seen(keys):
    assert hidden_checks(f"every({{{keys}}})")
    assert not hidden_checks(f"every({{{keys.replace('is', 'was', 1)}}})")


@pytest.mark.parametrize(
    "text", ["import numpy\nimport sympy\nnumpy.linalg.solve(a, b)", "import sympy\nsympy.Poly(x).resultant(y)"]
)
def test_other_calls_are_not(text):
    assert not banned_uses(text)


def test_no_file_is_too_long(clone):
    folders = (clone / "tests", clone / "articles")
    beside = {str(path.relative_to(clone)): path.read_text() for folder in folders for path in folder.rglob("*.py")}
    every = sources(clone) | beside
    assert len(every) > len(beside) > 100
    assert {path: count for path, text in every.items() if (count := text.count("\n")) > LONGEST} == {}


def test_no_function_asks_a_reader_to_hold_too_much(clone):
    """At most 8 parameters, and a bounded number of branches; click hands options to callbacks, one a parameter."""
    burdens = {(path, name): found for path, text in sources(clone).items() for name, found in burden(text).items()}
    assert {where for where, (many, _) in burdens.items() if many > MOST_PARAMETERS} == set()
    assert {where for where, (_, branches) in burdens.items() if branches > MOST_BRANCHES} == set()
    assert burden("def f(a, b, c, d, e, f, g, *, h, i):\n    pass\n")["f"][0] == 9
    assert burden("def f(x):\n" + "    if x: x += 1\n" * 30)["f"][1] > MOST_BRANCHES


def burden(text):
    """Parameters and branches of every function that is no click callback."""
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    return {node.name: (parameters(node), branches(node)) for node in nodes if not called_back(node)}


def parameters(node):
    given = node.args.posonlyargs + node.args.args + node.args.kwonlyargs
    return len(given) - (bool(given) and given[0].arg in ("self", "cls"))


def branches(node):
    kinds = (ast.If, ast.For, ast.While, ast.IfExp, ast.ExceptHandler, ast.With, ast.comprehension, ast.BoolOp,
             ast.match_case)  # fmt: skip
    return 1 + sum(isinstance(part, kinds) for part in ast.walk(node))


def called_back(node):
    return any("click" in ast.unparse(each) or "command" in ast.unparse(each) for each in node.decorator_list)


def test_every_room_says_what_lives_there(clone):
    """Its first lines name what is there, and send what is not to a neighbour."""
    rooms = {path: text for path, text in sources(clone).items() if path.endswith("/__init__.py")}
    told = {path: ast.get_docstring(ast.parse(text)) or "" for path, text in rooms.items()}
    outer = {path: text for path, text in told.items() if path.count("/") == 1}
    assert [path for path, text in told.items() if not text] == []
    assert [path for path, text in outer.items() if "Not here" not in text and "Nothing" not in text] == []


def test_every_file_is_named_for_its_content(clone):
    assert [path for path in sources(clone) if path.rpartition("/")[2] in NAMELESS] == []


def test_nothing_is_unfinished(clone):
    sign = re.compile(r"\b(TODO|FIXME|XXX|NotImplementedError)\b")
    assert [path for path, text in sources(clone).items() if sign.search(text)] == []


def test_importlib_stays_at_the_doors(clone):
    """An import by name is not seen by the contract on the direction of imports."""
    found = [path for path, text in sources(clone).items() if imports_by_name(text)]
    assert [path for path in found if not path.startswith(IMPORTLIB_HOMES)] == []


def imports_by_name(text):
    """importlib.resources and importlib.metadata read data; everything else imports by name."""
    data = {"importlib.resources", "importlib.metadata"}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import) and any(
            a.name.startswith("importlib") and a.name not in data for a in node.names
        ):
            return True
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("importlib"):
            inside = {f"{node.module}.{alias.name}" for alias in node.names}
            if node.module not in data and not inside <= data:
                return True
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "__import__":
            return True
    return False


def test_rooms_say_what_they_hold(clone):
    """The docstring of a room: what lives here, what does not and which neighbour takes it."""
    rooms = [path for path in sources(clone) if path.count("/") == 1 and path.endswith("/__init__.py")]
    told = {path: ast.get_docstring(ast.parse(sources(clone)[path])) or "" for path in rooms}
    assert [path for path, text in told.items() if "Not here:" not in text] == []


SHOWN = ("scenes/", "paper/figures/", "cli/", "bench/")


def test_pixels_are_known_to_pictures_alone(clone):
    """Below them a resolution is a length in units of the window."""
    found = [path for path, text in sources(clone).items() if re.search("pixel", text, re.IGNORECASE)]
    assert found
    assert [path for path in found if not path.startswith(SHOWN)] == []
