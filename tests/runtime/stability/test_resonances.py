"""Where exponents of the mean system meet: speeds, labels, signatures, refusals."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.stability import resonances, tongue
from periodic_systems import system_of, wave


def _beam(**changes):
    """Return two modes of 3 and 7 rad/s, softened by w^2 pull, with a small periodic load."""
    return system_of(
        {"pull": 0.0, "load": 0.0, **changes},
        M=np.eye(2),
        B=("pull", np.eye(2)),
        K=np.diag([9.0, 49.0]),
        Kg=("load", wave(np.ones((2, 2)))),
    )


def test_speeds_of_a_constant_system():
    found = resonances(_beam(), (2.4, 20.0), highest=4)
    sums = {"2 w1": 6.0, "2 w2": 14.0, "w1 + w2": 10.0, "w2 - w1": 4.0}
    expected = {
        f"{left} = {'' if n == 1 else f'{n} '}w": total / n
        for left, total in sums.items()
        for n in (1, 2, 3, 4)
        if total / n > 2.4
    }
    assert {item.label: pytest.approx(item.speed, rel=1e-13) for item in found} == expected
    assert [item.speed for item in found] == sorted((i.speed for i in found), reverse=True)
    for item in found:
        assert item.opens == (item.kind != "difference")
        assert sum(item.signatures) == (2 if item.kind == "difference" else 0)
        np.testing.assert_allclose(item.frequencies, np.array([3.0, 7.0])[np.array(item.modes) - 1])


def test_the_mean_inertia_shifts_them_and_divergence_ends_them():
    # Omega^2 = k - pull w^2: 2 sqrt(9 - w^2/4) = w at w = 3 sqrt 2.
    found = resonances(_beam(pull=0.25), (1.0, 30.0), highest=1, kinds=("principal",))
    assert [item.label for item in found] == ["2 w2 = w", "2 w1 = w"]
    np.testing.assert_allclose([item.speed for item in found], [7 * 2**0.5, 3 * 2**0.5])
    multipliers = floquet_multipliers(_beam(pull=0.25), [item.speed for item in found]).multipliers
    assert np.all(np.min(np.abs(multipliers + 1), axis=-1) < 1e-6)
    # Beyond w = 6 the first mode does not oscillate; the second keeps its number, and what ends
    # at w = 6 is no meeting.
    near = resonances(_beam(pull=0.25), (5.9, 6.2), highest=9)
    assert [item.label for item in near] == ["w2 - w1 = w"]
    assert near[0].frequencies[0] - near[0].frequencies[1] == pytest.approx(near[0].speed)


def test_no_values_no_ends():
    system = _beam()
    resonance = resonances(system, (9.0, 11.0))[0]
    found = tongue(system, resonance, parameter=("load", np.zeros((0, 3))))
    assert found.lower.shape == (0, 3)
    assert found.passed


def test_a_mean_system_at_divergence_is_refused():
    # A mode without stiffness has an exponent of zero twice, with one eigenvector.
    pull = ("load", wave(np.ones((2, 2))))
    system = system_of({"load": 0.0}, M=np.eye(2), K=np.diag([0.0, 49.0]), Kg=pull)
    resonance = resonances(system, (10.0, 20.0), highest=1)[0]
    assert resonance.label == "2 w2 = w"
    with pytest.raises(BadInput, match="multiple exponent"):
        tongue(system, resonance, parameter=("load", 0.1))
