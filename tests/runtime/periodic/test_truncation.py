"""Modal truncation: motions and multipliers of the lowest modes against those of the whole."""

import numpy as np
import pytest
from elastolink.runtime.periodic import floquet_multipliers, steady_state
from elastolink.runtime.periodic.swept_motions import Truncations
from elastolink.runtime.scenes import load_scene

pytestmark = pytest.mark.filterwarnings("ignore::elastolink.runtime.core.errors.LinearRangeWarning")


def apart(few, whole):
    """Return the distance of each multiplier to the nearest of the whole system."""
    return np.min(np.abs(few[:, None] - whole), axis=-1)


def modal_truncation(system, modes):
    """Return a system on its lowest modes, at 128 angles or more."""
    return Truncations(system).at(modes, 128)[0]


@pytest.fixture(scope="module")
def four_bar():
    system = load_scene("aannaque_1996_table_4_1").linear_system()
    return system, modal_truncation(system, 6)


@pytest.mark.smoke
def test_the_lifted_motion_is_that_of_the_whole_system(four_bar):
    """Six of the modes at 62 rad/s: 1.3e-5 of the small coordinates, measured against the whole."""
    system, truncated = four_bar
    few = steady_state(truncated, 62.0, rtol=1e-9, samples=len(truncated.theta))
    q, rest = truncated.lift(few.q[None], np.array([62.0]))
    whole = steady_state(system, 62.0, rtol=1e-9, samples=len(truncated.theta)).q
    gap = np.max(np.abs(q[0] - whole), axis=0) / np.max(np.abs(whole), axis=0)
    assert np.max(gap) < 1e-4
    # What is left tells the gap.
    left = np.max(np.abs(rest[0]), axis=0) / np.max(np.abs(whole), axis=0)
    assert 0.3 * np.max(gap) < np.max(left) < 3.0 * np.max(gap)


def test_the_multipliers_of_six_modes_are_those_of_the_whole_system(four_bar):
    """Measured: 5e-6 at the most at 62 rad/s."""
    system, truncated = four_bar
    few = floquet_multipliers(truncated, 62.0).multipliers
    whole = floquet_multipliers(system, 62.0).multipliers
    assert few.shape == (12,)
    assert np.max(apart(few, whole)) < 2e-5


@pytest.mark.parametrize("ratio", [0.0, 0.02])
def test_all_modes_are_the_whole_system_and_few_of_them_stay_conservative(ratio):
    overrides = {"damping.ratio": ratio, "mesh.elements": 1}
    system = load_scene("aannaque_1996_table_4_1", overrides=overrides).linear_system()
    whole = floquet_multipliers(system, 62.0, rtol=1e-10).multipliers
    all_modes = floquet_multipliers(modal_truncation(system, system.size), 62.0, rtol=1e-10)
    assert np.max(apart(all_modes.multipliers, whole)) < 1e-7
    if not ratio:
        few = floquet_multipliers(modal_truncation(system, 3), 62.0).multipliers
        assert np.max(apart(1 / few, few)) < 1e-9
