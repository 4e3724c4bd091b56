"""Results of many states as one result whose fields are arrays."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from singimpact.status import status_array


def gathered(kind: Any, results: list[Any], shape: tuple[int, ...]) -> Any:
    """One result whose fields are arrays of a shape; statuses and causes are int8.

    Fields that are not printed say where one result comes from, and are left out.
    """
    columns = {}
    for field in (entry for entry in fields(kind) if entry.repr):
        values = [getattr(one, field.name) for one in results]
        if field.name in ("status", "cause"):
            columns[field.name] = np.array(values, dtype=np.int8).reshape(shape)
        else:
            plain = all(isinstance(value, int | float) for value in values)
            columns[field.name] = np.array(values, dtype=None if plain else object).reshape(shape)
    columns["status"] = status_array(columns["status"])
    return kind(**columns)
