"""Tables of transition matrices over the speed, against the matrices themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.periodic.equation import equation_of
from elastolink.runtime.periodic.tables import table_of
from elastolink.runtime.periodic.transition import method, product, segments_of
from periodic_systems import system_of, wave

WAY = method("gauss", 6)
ENDS = (2.0, 3.0)


def system(forced=False):
    """Return two freedoms with a periodic spring and a damper."""
    load = {"p": lambda theta: np.stack([np.cos(theta), 1 + 0 * theta], -1)} if forced else {}
    springs = [np.diag([9.0, 20.0]), wave([[2.0, 1.0], [1.0, -1.0]])]
    return system_of(M=np.eye(2), C=0.1 * np.eye(2), K=springs, **load)


def equations(forced=False):
    """Return a function from inverse speeds to the equation, all members in one scale."""
    made = system(forced)
    scale = equation_of(made, 2.5, {}, forcing=forced).scale

    def at(inverse):
        equation = equation_of(made, 1.0 / np.asarray(inverse), {}, forcing=forced)
        return replace(equation, scale=np.repeat(scale, len(equation.speed), axis=0))

    return at


INVERSE = (1.0 / ENDS[1], 1.0 / ENDS[0])


@pytest.mark.smoke
@pytest.mark.parametrize("forced", [False, True])
def test_products_are_the_monodromy_matrices(forced):
    at = equations(forced)
    table = table_of(at, INVERSE, 32, WAY, 1e-13)
    values = np.random.default_rng(1).uniform(*INVERSE, 20)
    matrices, exponents = table.products(values)
    exact, powers = product(segments_of(at(values), 32, WAY).maps)
    found = np.ldexp(matrices, exponents[:, None, None])
    wanted = np.ldexp(exact, powers[:, None, None])
    assert np.max(np.abs(found - wanted)) < 1e-11 * np.max(np.abs(wanted))
    assert table.tail < 1e-11
    assert table.weights(values).shape == (20, len(table.groups))


def test_half_of_the_period_and_a_single_value():
    at = equations()
    half = table_of(at, INVERSE, 32, WAY, 1e-13, half=True)
    matrices, exponents = half.products(np.array([0.45]))
    maps = segments_of(at(np.array([0.45])), 32, WAY).maps[:, :16]
    exact, powers = product(maps)
    np.testing.assert_allclose(
        np.ldexp(matrices, exponents[:, None, None]),
        np.ldexp(exact, powers[:, None, None]),
        atol=1e-11,
    )
    single = table_of(at, (0.45, 0.45), 32, WAY, 1e-13)
    assert len(single.groups) == 1
    one, power = single.products(np.array([0.45]))
    whole, twos = product(segments_of(at(np.array([0.45])), 32, WAY).maps)
    np.testing.assert_allclose(
        np.ldexp(one, power[:, None, None]), np.ldexp(whole, twos[:, None, None]), atol=1e-12
    )


def test_a_table_that_does_not_fit_is_refused_in_one_line():
    with pytest.raises(BadInput, match="raise the lowest speed or lower samples") as caught:
        table_of(equations(), INVERSE, 200_000, WAY, 1e-13)
    assert "\n" not in str(caught.value)
