"""Each third-party model enters by the front door: regenerate-equations on its model file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from elastolink.derive import regenerate
from elastolink.derive.spec import ModelSpec
from elastolink.runtime.core.modules import EmittedModule, find_module

Emit = Callable[[str, ModelSpec], EmittedModule]


@pytest.fixture(scope="session")
def emit(tmp_path_factory: pytest.TempPathFactory) -> Emit:
    """Return a function from model file and spec to the emitted module, found by its spec."""
    folder = tmp_path_factory.mktemp("modules")
    here = Path(__file__).parent

    def emitted(file: str, spec: ModelSpec) -> EmittedModule:
        arguments = ["--model", str(here / f"{file}.py"), "--out", str(folder), "--jobs", "1"]
        assert regenerate.main([*arguments, spec.name()]) == 0
        return find_module(spec, [folder])

    return emitted
