"""Emitted source as a module."""

import importlib.util
import sys
import tempfile
from pathlib import Path


def module_of(source, name):
    """A module whose functions know their lines."""
    place = Path(tempfile.mkdtemp()) / f"{name}.py"
    place.write_text(source)
    spec = importlib.util.spec_from_file_location(name, place)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module
