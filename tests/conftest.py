"""Let every test import the exact references of its neighbours, and emit third-party models."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
for _folder in (".", "derive", "convergence", "seed_equations", "runtime/cli"):
    _helpers = str(HERE / _folder)
    if _helpers not in sys.path:
        sys.path.insert(0, _helpers)


@pytest.fixture(scope="session")
def emit(tmp_path_factory: pytest.TempPathFactory) -> Callable:
    """Return a function from a third-party model file and a spec to the emitted module.

    By the front door: ``regenerate-equations`` on the file; then the module is found by its spec.
    """
    from elastolink.derive import regenerate
    from elastolink.runtime.core.modules import find_module

    folder = tmp_path_factory.mktemp("modules")

    def emitted(file, spec):
        model = HERE / "third_party_models" / f"{file}.py"
        arguments = ["--model", str(model), "--out", str(folder), "--jobs", "1"]
        assert regenerate.main([*arguments, spec.name()]) == 0
        return find_module(spec, [folder])

    return emitted
