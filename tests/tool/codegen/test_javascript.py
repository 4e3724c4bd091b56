"""Python functions as JavaScript: what has no translation is refused.

`tests/tool/scenes/test_explore.py` runs the texts.
"""

import inspect

import pytest

from singimpact.codegen import translated
from singimpact.flights.kernels import roots, steps, taylor


@pytest.mark.parametrize(
    "body",
    [
        "return [a for a in x]",
        "return x // 2",
        "return 'text'",
        "return f(*x)",
        "return x @ x",
        "return x is None",
        "x //= 2",
        "with x:\n        pass",
        "for a, b in x:\n        pass",
        "while x:\n        pass\n    else:\n        x = 1",
    ],
)
def test_what_has_no_translation_is_refused(body):
    with pytest.raises(TypeError, match="no JavaScript for"):
        translated(f"def f(x):\n    {body}\n")


def test_names_that_javascript_keeps_for_itself_are_changed():
    text = translated("def f(new, k):\n    let = new if 0 < new <= k else -inf\n    return let ** 0.5\n")["f"]
    assert "function f(new_, k)" in text
    assert "let_ = ((0 < new_ && new_ <= k) ? new_ : (-Infinity));" in text
    assert "return Math.sqrt(let_);" in text


@pytest.mark.parametrize("module", [roots, steps, taylor])
def test_kernels_have_a_translation(module):
    own = [
        name for name, part in vars(module).items() if inspect.isfunction(part) and part.__module__ == module.__name__
    ]
    assert set(translated(inspect.getsource(module))) == set(own)
