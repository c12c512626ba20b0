"""Why a peer is left out of a benchmark: told without compiling anything."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from elastolink.runtime.benchmarking.work_precision import peers, problems

SMALL = SimpleNamespace(a=np.ones((1, 2, 2)), b=np.zeros((1, 2, 2)), rate=1.0)
LARGE = SimpleNamespace(a=np.ones((1, 200, 200)), b=np.zeros((1, 200, 200)), rate=1.0)


@pytest.fixture
def nothing_compiles(monkeypatch):
    """Fail where a peer is made."""

    def refuse(equation, setting):
        raise AssertionError("a peer was made")

    monkeypatch.setattr(problems, "PEERS", dict.fromkeys(peers.PEERS, refuse))


def test_each_reason_is_named(monkeypatch, nothing_compiles):
    angles = np.array([0.0, 1.0])
    monkeypatch.setattr(peers, "find_spec", lambda name: None if name == "numba" else True)
    made, absent = problems._peers(peers.PEERS, LARGE, np.eye(200), angles, "heyoka batch")
    assert absent == ("heyoka: too many terms", "numba loop: not installed")
    left = set(peers.PEERS) - {"heyoka", "heyoka batch", "numba loop"}
    assert {method.name for method in made} == left


def test_what_is_missing_is_not_installed_however_many_terms_there_are(monkeypatch):
    monkeypatch.setattr(peers, "find_spec", lambda name: None)
    for equation in (SMALL, LARGE):
        reasons = {name: peers.absence(name, equation) for name in peers.PEERS}
        there = {name for name, reason in reasons.items() if reason is None}
        assert there == {"solve_ivp DOP853", "solve_ivp Radau"}
        assert set(reasons.values()) == {None, "not installed"}
        assert peers.heyoka_scalar(equation, 1e-6) is None
