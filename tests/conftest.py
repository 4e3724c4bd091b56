"""The suite starts with an empty kernel cache of its own."""

from __future__ import annotations

import os
import tempfile

os.environ["SINGIMPACT_CACHE"] = tempfile.mkdtemp(prefix="singimpact-tests-")
