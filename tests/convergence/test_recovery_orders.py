"""Order of the recovered moments in the length of the elements, by slope."""

import numpy as np
import pytest
from beam_motions import periodic_motion, rocking, turning_bar
from elastolink.runtime.recovery import recover
from orders import slopes

# A third of the first frequency, where the elastic inertia matters: some harmonics resonate.
SPEED, COUNT = 17.0, 32
PLACES = np.linspace(0.0, 1.0, 97)
# A cubic's curvature is right to h^2, its nodes to h^4; a quintic's curvature to h^4.
ORDERS = {("cubic", "equilibrium"): 4.0, ("cubic", "shape"): 2.0, ("internal_node", "shape"): 4.0}


def moment(elements, kind, method):
    system = turning_bar(rocking, modulus=210e9, elements=elements, kind=kind)
    motion = periodic_motion(system, SPEED, COUNT)
    return recover(system, motion, stations={"bar": PLACES}, method=method).moment


@pytest.fixture(scope="module")
def reference():
    fine = moment(6, "internal_node", "equilibrium")
    coarse = moment(4, "internal_node", "equilibrium")
    assert np.max(np.abs(fine - coarse)) <= 2e-7 * np.max(np.abs(fine))
    return fine


@pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")
@pytest.mark.parametrize(("kind", "method"), ORDERS)
def test_order_by_slope(kind, method, reference):
    meshes = np.array([2, 4, 8] if kind == "cubic" else [1, 2, 3])
    size = np.max(np.abs(reference))
    errors = [np.max(np.abs(moment(int(n), kind, method) - reference)) / size for n in meshes]
    last = -slopes(meshes, errors)[-1]
    expected = ORDERS[kind, method]
    assert expected - 0.4 <= last <= expected + 0.5
