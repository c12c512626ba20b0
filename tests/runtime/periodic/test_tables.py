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


def whole(parts):
    """Return matrices from their parts, a factor and a power of two."""
    matrices, exponents = parts
    return np.ldexp(matrices, exponents[:, None, None])


@pytest.mark.smoke
@pytest.mark.parametrize("forced", [False, True])
def test_products_are_the_monodromy_matrices(forced):
    at = equations(forced)
    table = table_of(at, INVERSE, 32, WAY, 1e-13)
    values = np.random.default_rng(1).uniform(*INVERSE, 20)
    found, exact = (
        whole(table.products(values)),
        whole(product(segments_of(at(values), 32, WAY).maps)),
    )
    assert np.max(np.abs(found - exact)) < 1e-11 * np.max(np.abs(exact))
    assert table.tail < 1e-11
    assert table.weights(values).shape == (20, len(table.groups))


def test_half_of_the_period_and_a_single_value():
    at, value = equations(), np.array([0.45])
    maps = segments_of(at(value), 32, WAY).maps
    half = table_of(at, INVERSE, 32, WAY, 1e-13, half=True)
    exact = whole(product(maps[:, :16]))
    np.testing.assert_allclose(whole(half.products(value)), exact, atol=1e-11)
    single = table_of(at, (0.45, 0.45), 32, WAY, 1e-13)
    assert len(single.groups) == 1
    np.testing.assert_allclose(whole(single.products(value)), whole(product(maps)), atol=1e-12)


def test_a_table_that_does_not_fit_is_refused_in_one_line():
    with pytest.raises(BadInput, match="raise the lowest speed or lower samples") as caught:
        table_of(equations(), INVERSE, 200_000, WAY, 1e-13)
    assert "\n" not in str(caught.value)
