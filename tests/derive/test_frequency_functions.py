"""The derivation of the dynamic stiffness: it follows the Lagrangian, and proves what it emits."""

import pytest
import sympy as sp
from elastolink.derive.models import beam_frequency_functions as ff
from elastolink.derive.models import beam_frequency_problem as problem
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.variational import hamilton

v, x, t = problem.DEFLECTION, problem.X, problem.TIME


def test_another_lagrangian_gives_other_waves_and_forces():
    """A foundation shifts the squared frequency; tension adds a force and splits the waves."""
    k, n = sp.symbols("k n", positive=True)
    action = problem.bending()
    sprung = hamilton(action.with_(density=action.density - k * v**2 / 2))
    found = problem.wave_numbers(sprung, sp.sqrt(problem.Z**4 + k))
    assert set(found) == set(problem.wave_numbers(hamilton(action), problem.Z**2))
    pulled = hamilton(action.with_(density=action.density - n * v.diff(x) ** 2 / 2))
    shape = problem.MIDDLE**3
    bare = problem.end_forces(hamilton(action), sp.S.Zero, shape)
    taut = problem.end_forces(pulled, sp.S.Zero, shape)
    assert bare == [-6, 3]
    assert sp.expand(taut[0] - bare[0]) == n * sp.Rational(3, 4) and taut[1] == bare[1]
    waves = [sp.simplify(w**2) for w in problem.wave_numbers(pulled, sp.S.Zero)]
    assert n in waves


def test_a_wrong_form_is_refused():
    functions = ff.functions()
    above, divisor = ff.numerators()
    with pytest.raises(UnsafeRewriting, match="is not"):
        ff._prove(2 * functions["F2"], above["F2"] / divisor)
    with pytest.raises(UnsafeRewriting, match="no combination"):
        ff._shortest({(1, 0, 0, 0): sp.S.One}, {ff.FUNCTIONS["F1"]: {(0, 1, 0, 0): sp.S.One}})
