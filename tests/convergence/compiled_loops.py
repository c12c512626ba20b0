"""What the tests of compiled loops share: emitted modules, and whether there is numba."""

from __future__ import annotations

import importlib
import importlib.util
import types

import pytest

NEEDS_NUMBA = pytest.mark.skipif(
    importlib.util.find_spec("numba") is None,
    reason="numba, of the extra fast, is not installed",
)


def emitted(name: str) -> types.ModuleType:
    """Return an emitted module."""
    return importlib.import_module(f"elastolink.generated.{name}")
