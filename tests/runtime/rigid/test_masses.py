"""Mass distributions: constructors against integrals, sums, and refusals."""

import math

import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.rigid import MassDistribution
from refusals import refused


def test_disc_about_its_centre_and_about_the_joint() -> None:
    disc = MassDistribution.disc(2.0, 0.1, 0.3, -0.4)
    assert disc.centre == pytest.approx((0.3, -0.4))
    assert disc.inertia_about_centre == pytest.approx(0.01)
    assert disc.inertia == pytest.approx(0.01 + 2.0 * 0.25)


def test_sum_has_the_common_centre() -> None:
    one = MassDistribution.point(1.0, 0.2, 0.1)
    other = MassDistribution.about_centre(3.0, -0.2, 0.5, 0.04)
    both = one + other
    assert both.centre == pytest.approx((-0.1, 0.4))
    # Steiner about the common centre: 1*(0.3^2 + 0.3^2) + 3*(0.1^2 + 0.1^2) + 0.04.
    assert both.inertia_about_centre == pytest.approx(0.18 + 0.06 + 0.04)
    nothing = MassDistribution(inertia=0.2)
    assert (nothing.centre, nothing.inertia_about_centre) == ((0.0, 0.0), 0.2)


@pytest.mark.parametrize("place", [1e-150, 0.1, 1 / 3, 1e150])
def test_a_point_mass_is_at_the_limit_and_accepted(place: float) -> None:
    point = MassDistribution.point(0.3, place)
    assert point.centre[0] == pytest.approx(place)
    assert point.inertia_about_centre <= 1e-15 * point.inertia


test_impossible_ones_are_refused = refused(
    lambda make: make(),
    [
        (lambda: MassDistribution(-1.0), "MassDistribution.mass"),
        (lambda: MassDistribution(1.0, inertia=-0.1), "MassDistribution.inertia"),
        (lambda: MassDistribution(1.0, along=0.5, inertia=0.2), "first moment"),
        (lambda: MassDistribution(along=0.5), "first moment"),
        (lambda: MassDistribution(inertia=math.inf), "finite"),
        (lambda: MassDistribution("1 kg"), "finite"),
        (lambda: MassDistribution(True), "finite"),
        (lambda: MassDistribution.uniform_bar(1.0, -0.5), "length"),
        (lambda: MassDistribution.disc(1.0, -0.5, 0.1), "radius"),
        (lambda: MassDistribution.about_centre(1.0, 0.1, 0.0, -1.0), "inertia"),
        (lambda: MassDistribution.point(1.0, math.nan), "finite"),
    ],
)


def test_only_distributions_add() -> None:
    with pytest.raises(TypeError):
        MassDistribution() + 1.0  # type: ignore[operator]


def test_a_first_moment_whose_inertia_underflows_is_no_mistake():
    # An optimiser may pass by: the least inertia, moment^2 / mass = 2e-512, is zero in doubles.
    tiny = MassDistribution(mass=0.684, across=1.1e-256)
    assert (tiny.inertia, tiny.across) == (0.0, 1.1e-256)
    with pytest.raises(BadInput, match="first moment"):
        MassDistribution(mass=0.684, across=1.1e-100)
