"""Named systems of the literature: `singimpact.models.shaw_holmes()` is a model, `list(singimpact.models)` the names.

Their functions, numbers, sources and one known fact of each are data, `named_models.toml`.
"""

import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import require_known, unknown
from singimpact.notebook import table
from singimpact.oscillator.moving_number import UPPER

COLUMNS = ("name", "title", "source")


@dataclass(frozen=True)
class NamedModel:
    """A system of the literature, which makes the model when it is called.

    Parameters
    ----------
    name, title : what it is called here, and in words. source : where it comes from. known : a published fact, which
        its page of the documentation computes. fields : of the model.

    Examples
    --------
    >>> shaw_holmes = Models.named("shaw_holmes")
    >>> shaw_holmes(omega="2.5").parameters["omega"].value
    Fraction(5, 2)
    """

    name: str
    title: str
    source: str
    known: str
    fields: dict[str, Any]

    def __call__(self, **numbers: Any) -> ImpactOscillator:
        """The model, with the numbers that are given in place of its own: of its walls, or a parameter."""
        own = self.fields.get("parameters", {})
        walls = ["clearance", "restitution", *(UPPER if "upper" in self.fields else ())]
        require_known(f"number of {self.name}", numbers, [*walls, *own])
        parameters = {name: numbers.get(name, value) for name, value in own.items()}
        outer = {name: value for name, value in numbers.items() if name not in own}
        return ImpactOscillator(**self.fields | outer | {"parameters": parameters})

    def __repr__(self) -> str:
        return f"{self.name}: {self.title} ({self.source}); {self.known}"


class Models(ModuleType):
    """The named systems: names on iteration, by name or as attributes the systems."""

    @staticmethod
    @cache
    def _all() -> dict[str, NamedModel]:
        systems = tomllib.loads(Path(__file__).with_name("named_models.toml").read_text(encoding="utf-8"))
        return {
            name: NamedModel(name, system.pop("title"), system.pop("source"), system.pop("known"), system)
            for name, system in systems.items()
        }

    @classmethod
    def named(cls, name: str) -> NamedModel:
        """The system of a name; others are refused with the nearest."""
        if name not in cls._all():
            raise unknown("named model", name, cls._all())
        return cls._all()[name]

    __getitem__ = named

    def __getattr__(self, name: str) -> NamedModel:
        if name.startswith("_") or name not in self._all():
            raise AttributeError(str(unknown("named model", name, self._all())))
        return self._all()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __dir__(self) -> list[str]:
        return list(self._all())

    def __repr__(self) -> str:
        return "\n".join(f"{system.name:17} {system.title}" for system in self._all().values())

    def _repr_html_(self) -> str:
        return table(COLUMNS, [[getattr(system, name) for name in COLUMNS] for system in self._all().values()])


sys.modules[__name__].__class__ = Models
