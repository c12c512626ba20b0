"""The emitted rod in Buckens' frame: short code for any number of modes, proved at two."""

from dataclasses import replace

import pytest
import sympy as sp
from derivations import model_of
from elastolink.derive.lagrange import euler_lagrange, variational_equations
from elastolink.derive.modal import closed_in_modes
from elastolink.derive.models import free_free_rod as rod
from elastolink.derive.pipeline import equations_of_motion
from elastolink.derive.safe import UnsafeRewriting
from elastolink.derive.spec import ModelSpec

SPEC = ModelSpec("quick_return", "free_free", flexible=("rod",))


@pytest.fixture(scope="module")
def derived():
    """Return the equations and variations of one mode and of two."""
    one = equations_of_motion(model_of(SPEC).energies(SPEC))
    two = euler_lagrange(rod.lagrangian(2))
    return (one, variational_equations(one)), (two, variational_equations(two))


def spoiled(equations, entry):
    """Return equations with something added to the last entry of the jacobian."""
    jacobian = sp.MutableDenseMatrix(equations.jacobian)
    jacobian[-1, -1] += entry
    return replace(equations, jacobian=sp.ImmutableDenseMatrix(jacobian))


@pytest.mark.parametrize(
    ("entry", "words"),
    [("left_1**2", "is no sum"), ("f1**2*left_1", "is no sum"), ("left_1", "of two modes is")],
)
def test_what_is_no_sum_over_the_modes_is_refused(derived, entry, words):
    (one, variations), two = derived
    wrong = (spoiled(one, sp.sympify(entry)), variations)
    with pytest.raises(UnsafeRewriting, match=words):
        closed_in_modes(rod.MODES, wrong, two)
