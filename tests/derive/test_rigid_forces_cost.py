"""What the emitted forces cost, and that they are linear in the moments."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from force_machines import call, emitted, random_machine
from forces_truth import MECHANISMS, MOMENTS


class _Counted:
    """An array that counts the operations on it."""

    count = 0

    def __array_namespace__(self):
        return SimpleNamespace(**dict.fromkeys(("sin", "cos", "tan", "sqrt"), self._made))

    def _made(self, *_):
        _Counted.count += 1
        return _Counted()

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _made
    __truediv__ = __rtruediv__ = __pow__ = __neg__ = _made


def array_operations(module, function):
    """Return the operations on arrays of an emitted function whose crank angle alone is one."""
    kernel = getattr(module, function)
    wanted = kernel.__code__.co_varnames[1 : kernel.__code__.co_argcount]
    _Counted.count = 0
    kernel(_Counted(), *(1.0 + 0.1 * i for i, _ in enumerate(wanted)))
    return _Counted.count


def test_operations_on_arrays_of_the_four_bar():
    """What decides the run time at many angles, signs counted too: as when this was written.

    Without moments across the links and at constant speed it would be 127: 29 % less.
    """
    module = emitted("four_bar_forces")
    counts = {name: array_operations(module, name) for name in module.RETURNS}
    assert counts["forces"] <= 180
    assert max(counts["driving_torque"], counts["shaking_moment"]) <= 102
    assert max(counts["shaking_force"], counts["load_forces"]) <= 115


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_forces_are_linear_in_the_moments(mechanism):
    """At unit values of one moment the function returns the derivatives by it."""
    module = emitted(f"{mechanism}_forces")
    numbers = random_machine(mechanism, np.random.default_rng(13))
    whole = call(module, "forces", numbers)
    total = dict.fromkeys(whole, 0.0)
    for moment in MOMENTS:
        unit = numbers | dict.fromkeys(MOMENTS, 0.0) | {moment: 1.0}
        for name, value in call(module, "forces", unit).items():
            total[name] += numbers[moment] * value
    size = max(abs(value) for value in whole.values())
    assert all(abs(total[name] - value) < 1e-11 * size for name, value in whole.items())
