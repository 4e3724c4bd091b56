"""numba's disk cache with sealed entries.

numba reads what it wrote without a check: a flipped byte in its data is other machine code, a cut index a traceback.
Two processes that compile different signatures at once give both the same number, and one then runs the other's code.
Here an entry is one file, named by what was compiled and sealed by a digest of its content.
"""

from __future__ import annotations

import hashlib
import pickle
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.serialize import dumps

from singimpact import cache


class _Entries(IndexDataCacheFile):
    """One sealed file for each function, signature and processor."""

    def _place(self, key: Any) -> Path:
        name = hashlib.sha256(repr((numba.__version__, key)).encode()).hexdigest()[:24]
        return Path(self._cache_path) / f"{self._index_name.removesuffix('.nbi')}.{name}.nbc"

    def save(self, key: Any, data: Any) -> None:
        cache.keep(self._place(key), dumps(data))

    def load(self, key: Any) -> Any:
        content = cache.recall(self._place(key))
        return None if content is None else pickle.loads(content)


class _SealedCache(FunctionCache):
    """The cache of one function."""

    def __init__(self, function: Any) -> None:
        super().__init__(function)  # type: ignore[no-untyped-call]
        plain = self._cache_file
        base = plain._index_name.removesuffix(".nbi")
        self._cache_file = _Entries(plain._cache_path, base, plain._source_stamp)  # type: ignore[no-untyped-call]

    def _save_overload(self, signature: Any, data: Any) -> None:
        try:
            super()._save_overload(signature, data)  # type: ignore[no-untyped-call]
        except OSError as error:
            cache.not_kept(error)


def keep_machine_code(dispatcher: Any) -> None:
    """Give a compiled function its entries in the cache; without a place that can be written it has none."""
    try:
        dispatcher._cache = _SealedCache(dispatcher.py_func)
    except (RuntimeError, OSError) as error:  # numba finds no folder
        cache.not_kept(error)
