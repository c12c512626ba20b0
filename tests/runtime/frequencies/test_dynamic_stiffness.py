"""Exact frequencies of frames: known roots, shapes, nodes that stand still, refusals."""

import mpmath
import numpy as np
import pytest
from beam_motions import FOUR_BAR, JOINT_MASSES, SECTIONS
from elastolink.runtime.beams import Section, beam_linkage, frame
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.families import Transcendental
from elastolink.runtime.frequencies import (
    dynamic_stiffness,
    element_matrices,
    log_determinant,
    wittrick_williams,
)
from elastolink.runtime.frequencies.frames import Members
from frame_truth import CLAMPED, portal
from refusals import refused
from scipy.linalg import eigvalsh

PINNED, FREE = ("x", "y"), ()
BAR = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)  # EI = rho A
# Equations that the roots solve, in forms without growth.
EQUATIONS = {
    "clamped-clamped": ((CLAMPED, CLAMPED), lambda z: mpmath.cos(z) - 1 / mpmath.cosh(z), 0.5),
    "clamped-free": ((CLAMPED, FREE), lambda z: mpmath.cos(z) + 1 / mpmath.cosh(z), -0.5),
    "clamped-pinned": ((CLAMPED, PINNED), lambda z: mpmath.tan(z) - mpmath.tanh(z), 0.25),
    "pinned-pinned": ((PINNED, PINNED), mpmath.sin, 0.0),
}


def bar(supports, section=BAR, **values):
    first, second = supports
    return frame(
        {"A": (0, 0), "B": (0.6, 0.8)},
        {"bar": ("A", "B")},
        section,
        supports={"A": first, "B": second},
        **values,
    )


def cross(stretch=0.0, arms=4):
    """Return equal arms from a rigid hub to clamped ends, each ``stretch`` longer than the last."""
    places, members = {"O": (0.0, 0.0)}, {}
    for k in range(arms):
        angle = 2 * np.pi * k / arms
        reach = 1 + stretch * k
        places[f"P{k}"] = (reach * np.cos(angle), reach * np.sin(angle))
        members[f"arm{k}"] = ("O", f"P{k}")
    return frame(places, members, BAR, supports={f"P{k}": CLAMPED for k in range(arms)})


@pytest.mark.parametrize("name", EQUATIONS)
def test_bars_of_known_frequencies(name):
    """Twelve roots of each, within bounds of 1e-12; axial frequencies left out."""
    supports, equation, shift = EQUATIONS[name]
    problem = dynamic_stiffness(bar(supports), inextensible=True)
    found = wittrick_williams(problem, count=12)
    assert found.passed and np.all(found.multiplicity == 1)
    with mpmath.workdps(40):
        for k, omega in enumerate(found.frequencies, 1):
            root = mpmath.findroot(equation, (k + mpmath.mpf(shift)) * mpmath.pi)
            exact = root**2
            assert abs(exact - float(omega)) <= found.error[k - 1]
            assert found.error[k - 1] <= 1e-12 * omega


def test_axial_and_bending_frequencies_interlace_in_the_count():
    """A bar held at one end: (k - 1/2) pi c / L between the bending ones."""
    found = wittrick_williams(dynamic_stiffness(bar((CLAMPED, FREE))), upto=3000.0)
    wave = np.sqrt(1e9 / 1e4)
    axial = (np.arange(1, 4) - 0.5) * np.pi * wave
    distance = np.min(np.abs(found.frequencies[:, None] / axial - 1.0), axis=0)
    assert np.all(distance < 1e-13)
    bending = [k for k in range(1, 18) if ((k - 0.5) * np.pi) ** 2 < 3000.0]
    assert len(found.frequencies) == len(bending) + 3


def test_a_free_bar_has_three_frequencies_zero():
    found = wittrick_williams(dynamic_stiffness(bar((FREE, FREE))), count=5)
    assert found.passed
    assert tuple(found.frequencies[:3]) == (0.0, 0.0, 0.0)
    assert tuple(found.multiplicity) == (3, 3, 3, 1, 1)
    np.testing.assert_allclose(
        np.sqrt(found.frequencies[3:]), [4.730040744862704, 7.853204624095838]
    )
    assert len(wittrick_williams(dynamic_stiffness(bar((FREE, FREE))), upto=1.0).frequencies) == 3


@pytest.mark.parametrize("stretch", [0.0, 1e-9])
def test_close_and_equal_frequencies(stretch):
    """A symmetric cross has pairs; arms that differ by 1e-9 part them, and none is lost."""
    found = wittrick_williams(dynamic_stiffness(cross(stretch)), count=13)
    assert found.passed
    pairs = [1, 2, 2, 1, 1, 2, 2, 1, 1, 2, 2, 1, 1] if stretch == 0.0 else [1] * 13
    assert list(found.multiplicity) == pairs
    gap = found.frequencies[2] / found.frequencies[1] - 1.0
    assert gap < 1e-13 if stretch == 0.0 else 1e-10 < gap < 1e-8
    # One of a pair counts as such where the other was not asked for.
    few = wittrick_williams(dynamic_stiffness(cross(stretch)), count=2)
    assert list(few.multiplicity) == pairs[:2]


def test_shapes_are_orthogonal_and_of_unit_mass():
    """By quadrature of the shapes between the nodes, modes with q = 0 and pairs among them."""
    found = wittrick_williams(dynamic_stiffness(cross()), count=5)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    products = np.zeros((5, 5))
    for arm in found.problem.structure.beams:
        u = np.array([found.shape(i, arm.name, (nodes + 1) / 2).displacement for i in range(5)])
        mass = 0.5 * arm.length * BAR.mass_per_length
        products += mass * np.einsum("p,ipx,jpx->ij", weights, u, u)
    np.testing.assert_allclose(products, np.eye(5), atol=1e-7)
    # Four arms that bend about a hub that barely moves.
    assert np.min(np.max(np.abs(found.vectors()), axis=1)) < 2e-3


def test_nodes_that_stand_still():
    """A bar with both ends held, and a portal's fourth mode: in no node, but with a shape."""
    for problem, number in (
        (dynamic_stiffness(bar((CLAMPED, CLAMPED))), 0),
        (dynamic_stiffness(portal(), inextensible=True), 3),
    ):
        found = wittrick_williams(problem, count=number + 1)
        assert found.passed
        np.testing.assert_allclose(found.frequencies[-1], 4.730040744862704**2, rtol=1e-12)
        if number:
            assert np.max(np.abs(found.vectors()[-1])) < 1e-12
        name = problem.structure.beams[0].name
        shape = found.shape(number, name, np.linspace(0.0, 1.0, 9))
        assert abs(shape.across[0]) < 1e-10 and abs(shape.slope[-1]) < 1e-9
        assert np.max(np.abs(shape.across)) > 0.5


def test_shapes_join_at_the_nodes_and_solve_the_field_equation():
    found = wittrick_williams(dynamic_stiffness(portal()), count=6)
    for mode, omega in enumerate(found.frequencies):
        left, beam = (found.shape(mode, name, [0.0, 1.0]) for name in ("left", "beam"))
        size = np.max(np.abs(found.shape(mode, "beam", np.linspace(0, 1, 11)).across)) + 0.1
        np.testing.assert_allclose(left.displacement[1], beam.displacement[0], atol=1e-11 * size)
        assert abs(left.slope[1] - beam.slope[0]) < 1e-10 * size
        assert abs(left.curvature[1] - beam.curvature[0]) < 1e-9 * (1 + omega) * size
        places = np.array([0.3 - 1e-3, 0.3, 0.3 + 1e-3])
        third = found.shape(mode, "beam", places)
        fourth = (third.third[2] - third.third[0]) / 2e-3
        assert abs(fourth - omega**2 * third.across[1]) < 1e-4 * (1 + omega**2) * size


def test_linkage_against_its_finite_elements():
    """Four-bar at two angles: quintic elements, a pin at each joint, masses on the joints."""
    exact, fine = (
        beam_linkage(FOUR_BAR, SECTIONS, joint_masses=JOINT_MASSES, **mesh)
        for mesh in ({}, {"elements": 5, "kind": "internal_node"})
    )
    for theta in (0.4, 3.3):
        found = wittrick_williams(dynamic_stiffness(exact, theta), count=6)
        mass, stiffness, _ = element_matrices(fine, theta)
        reference = np.sqrt(eigvalsh(stiffness, mass))[:6]
        assert found.passed
        np.testing.assert_allclose(found.frequencies, reference, rtol=5e-6)


def test_plain_problems_are_bisected():
    """What only counts: one mass between springs that stiffen, sqrt(k / m) = 3."""
    problem = Transcendental(
        1,
        lambda omega: 9.0 - np.asarray(omega)[..., None, None] ** 2,
        lambda omega: np.zeros(np.shape(omega)),
    )
    found = wittrick_williams(problem, upto=10.0)
    assert found.frequencies.shape == (1,) and found.modes == ()
    assert abs(found.frequencies[0] - 3.0) <= found.error[0] <= 1e-11
    with pytest.raises(BadInput, match="members"):
        found.vectors()
    with pytest.raises(BadInput, match="fewer frequencies"):
        wittrick_williams(problem, count=2)


def test_determinant_of_one_and_two_pieces():
    """Fig. 5.1: a pole with whole bars where nodes stand still, a zero with divided ones."""
    whole = dynamic_stiffness(portal(), inextensible=True)
    halves = whole.divided(dict.fromkeys(("left", "beam", "right"), (0.5, 0.5)))
    at = 4.730040744862704**2
    near = at * (1 + np.array([1e-3, 1e-5]))
    one, two = log_determinant(whole, near)[0], log_determinant(halves, near)[0]
    assert one[1] > one[0] + 1.0 and two[1] < two[0] - 1.0
    signs = log_determinant(halves, at * np.array([0.9999, 1.0001]))[1]
    assert signs[0] == -signs[1]
    with pytest.raises(BadInput, match="positive"):
        log_determinant(whole, [0.0, 1.0])


def test_matrices_of_a_section_that_loses_energy():
    """Complex stiffness: analytic in it, so that a small loss turns D by its derivative."""
    base, step = 30.0, 30.0e-6

    def stiffness(bending):
        return Members(*np.array([[0.4], [bending], [2e6], [0.6]])).matrices(700.0)[0]

    plain, lossy = stiffness(base), stiffness(base + 1j * step)
    above, below = stiffness(base + step), stiffness(base - step)
    np.testing.assert_allclose(lossy.real, plain, rtol=1e-9, atol=1e-6)
    slope = (above - below) / 2
    np.testing.assert_allclose(lossy.imag, slope, rtol=1e-5, atol=1e-9 * np.abs(plain).max())


def test_static_limits_are_the_cubic_element():
    stiffness, mass = Members(*np.array([[2.0], [8.0], [6.0], [3.0]])).matrices(0.0)
    assert stiffness[0, 1, 1] == pytest.approx(12.0, rel=1e-15)
    assert stiffness[0, 2, 5] == pytest.approx(8.0, rel=1e-15)
    assert stiffness[0, 0, 3] == pytest.approx(-3.0, rel=1e-15)
    assert mass[0, 1, 1] == pytest.approx(156 / 420 * 6.0, rel=1e-15)
    assert mass[0, 0, 3] == pytest.approx(1.0, rel=1e-15)


test_refusals = refused(
    lambda call: call(),
    [
        (lambda: wittrick_williams(dynamic_stiffness(portal())), "one of the two"),
        (lambda: wittrick_williams(dynamic_stiffness(portal()), upto=1.0, count=2), "both"),
        (lambda: dynamic_stiffness(portal(), inextensible=("roof",)), "roof"),
        (
            lambda: dynamic_stiffness(bar((CLAMPED, ("y", "rotation"))), inextensible=True),
            "no node",
        ),
        *(
            (
                lambda at=at: wittrick_williams(dynamic_stiffness(portal()), count=2).shape(*at),
                words,
            )
            for at, words in (
                ((2, "beam", 0.5), "0 to 1"),
                ((0, "roof", 0.5), "roof"),
                ((0, "beam", 1.5), "places"),
            )
        ),
        (lambda: dynamic_stiffness(portal()).stiffness([]), "finite frequencies"),
    ],
)
