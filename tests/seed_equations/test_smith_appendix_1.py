"""Smith appendix 1: the loop closure solved for the follower angle."""

import numpy as np
import pytest
import sympy as sp
from seed_derivations import (
    closure_rows,
    follower_cosine,
    follower_quadratic,
    l1,
    l2,
    l3,
    l4,
    theta2,
    theta4,
)
from seed_ledger import establishes
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, TURN, closure

EVERY_KIND = [*CRANK_ROCKERS.values(), LONG_CRANK, DRAG_LINK]
CRANK_ANGLES = np.linspace(1e-3, TURN, 80)


def angles(lengths, assembly):
    return (CRANK_ANGLES, *closure(lengths, CRANK_ANGLES, assembly))


def eliminated():
    """Return l3^2 from the closure: the squared distance from B to C without the coupler."""
    coupler = [sp.expand(row.subs(l3, 0)) for row in closure_rows(0)]
    return sp.trigsimp(sp.expand(sum(part**2 for part in coupler)))


@establishes(
    "Smith",
    "A.1",
    printed=r"\ell_2\cos\theta_2 + \ell_3\cos\theta_3 = \ell_1 + \ell_4\cos\theta_4",
    verdict="agrees",
    derived=lambda: f"{sp.latex(closure_rows(0)[0])} = 0",
)
@establishes(
    "Smith",
    "A.2",
    printed=r"\ell_2\sin\theta_2 + \ell_3\sin\theta_3 = \ell_4\sin\theta_4",
    verdict="agrees",
    derived=lambda: f"{sp.latex(closure_rows(0)[1])} = 0",
)
@establishes(
    "Smith",
    "A.3",
    printed=r"\ell_3\cos\theta_3 = \ell_1 - \ell_2\cos\theta_2 + \ell_4\cos\theta_4",
    verdict="agrees",
)
@establishes(
    "Smith",
    "A.4",
    printed=r"\ell_3\sin\theta_3 = -\ell_2\sin\theta_2 + \ell_4\sin\theta_4",
    verdict="agrees",
)
@establishes(
    "Smith",
    "Appendix 1 coupler angle",
    printed=r"\theta_3 \text{ from (A.3), (A.4) with } \sin\theta_4 \text{ calculated from } "
    r"\cos\theta_4",
    verdict="agrees",
    derived=r"\theta_3 = \operatorname{atan2}(\ell_4\sin\theta_4 - \ell_2\sin\theta_2,\; "
    r"\ell_1 - \ell_2\cos\theta_2 + \ell_4\cos\theta_4)",
    remark="Agrees once the sign of sin(theta4) is known; the cosine alone leaves it open.",
)
@pytest.mark.parametrize("assembly", ["open", "crossed"])
@pytest.mark.parametrize("lengths", EVERY_KIND)
def test_projections(lengths, assembly):
    a, b, c, d = lengths
    th2, th3, th4 = angles(lengths, assembly)
    tolerance = 1e-12 * sum(lengths)
    first = b * np.cos(th2) + c * np.cos(th3) - (a + d * np.cos(th4))
    second = b * np.sin(th2) + c * np.sin(th3) - d * np.sin(th4)
    along = a - b * np.cos(th2) + d * np.cos(th4)
    across = -b * np.sin(th2) + d * np.sin(th4)
    for residual in (first, second, c * np.cos(th3) - along, c * np.sin(th3) - across):
        assert np.abs(residual).max() < tolerance
    assert np.abs(np.sin(np.arctan2(across, along) - th3)).max() < 1e-12


@establishes(
    "Smith",
    "A.5",
    printed=r"\ell_3^2 = \ell_1^2 + \ell_2^2 + \ell_4^2 - 2\ell_1\ell_2\cos\theta_2 + "
    r"2\ell_1\ell_4\cos\theta_4 - 2\ell_2\ell_4\cos(\theta_2 - \theta_4)",
    verdict="agrees",
    derived=lambda: rf"\ell_3^2 = {sp.latex(eliminated())}",
)
@establishes(
    "Smith",
    "Appendix 1 regrouped (A.5)",
    printed=r"\ell_1^2 + \ell_2^2 - \ell_3^2 + \ell_4^2 - 2\ell_1\ell_2\cos\theta_2 = "
    r"(2\ell_2\ell_4\cos\theta_2 - 2\ell_1\ell_4)\cos\theta_4 + 2\ell_2\ell_4\sin\theta_2"
    r"\sin\theta_4",
    verdict="agrees",
)
def test_coupler_angle_eliminated():
    printed = (
        l1**2
        + l2**2
        + l4**2
        - 2 * l1 * l2 * sp.cos(theta2)
        + 2 * l1 * l4 * sp.cos(theta4)
        - 2 * l2 * l4 * sp.cos(theta2 - theta4)
    )
    regrouped = (2 * l2 * l4 * sp.cos(theta2) - 2 * l1 * l4) * sp.cos(theta4)
    regrouped += 2 * l2 * l4 * sp.sin(theta2) * sp.sin(theta4)
    left = l1**2 + l2**2 + l4**2 - 2 * l1 * l2 * sp.cos(theta2)
    expanded = sp.expand(sp.expand_trig(eliminated() - printed))
    assert sp.trigsimp(expanded) == 0
    assert sp.trigsimp(sp.expand(sp.expand_trig(eliminated() - (left - regrouped)))) == 0


@establishes(
    "Smith",
    "Appendix 1 ratios R1, R2, R3",
    printed=r"R_1 = \frac{\ell_1}{\ell_4},\; R_2 = \frac{\ell_1}{\ell_2},\; "
    r"R_3 = \frac{\ell_1^2 + \ell_2^2 + \ell_4^2 - \ell_3^2}{2\ell_2\ell_4}",
    verdict="agrees",
    derived=r"\cos(\theta_2 - \theta_4) = R_3 - R_1\cos\theta_2 + R_2\cos\theta_4",
    remark="The ratios are those of (A.5) divided by 2 l2 l4; only their signs in (A.6) are not.",
)
@establishes(
    "Smith",
    "A.6",
    printed=r"R_1\cos\theta_2 - R_2\cos\theta_4 - R_3 = \cos(\theta_2 - \theta_4)",
    verdict="slip",
    derived=r"-R_1\cos\theta_2 + R_2\cos\theta_4 + R_3 = \cos(\theta_2 - \theta_4)",
    remark="The left-hand side has the wrong sign throughout. (5,1,5,2), open, theta2 = 1: the "
    "printed left-hand side is -0.9352, the cosine +0.9352.",
)
def test_freudenstein_form():
    for lengths in EVERY_KIND:
        a, b, c, d = lengths
        r1, r2, r3 = a / d, a / b, (a**2 + b**2 + d**2 - c**2) / (2 * b * d)
        for assembly in ("open", "crossed"):
            th2, _, th4 = angles(lengths, assembly)
            printed = r1 * np.cos(th2) - r2 * np.cos(th4) - r3
            assert np.abs(printed + np.cos(th2 - th4)).max() < 1e-10
    lengths = CRANK_ROCKERS["5,1,5,2"]
    _, th4 = closure(lengths, 1.0)
    printed = 2.5 * np.cos(1.0) - 5.0 * np.cos(th4[0]) - 1.25
    assert printed == pytest.approx(-0.9352, abs=6e-5)
    assert np.cos(1.0 - th4[0]) == pytest.approx(+0.9352, abs=6e-5)


@establishes(
    "Smith",
    "A.7",
    printed=r"A\cos\theta_4 + B + C\sin\theta_4 = 0",
    verdict="agrees",
    derived=lambda: ",\\; ".join(f"{k} = {sp.latex(v)}" for k, v in follower_quadratic().items()),
    remark="A, B and C are those printed below (2.2).",
)
def test_linear_form():
    derived = follower_quadratic()
    assert sp.expand(derived["A"] - 2 * l4 * (l2 * sp.cos(theta2) - l1)) == 0
    B = l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * sp.cos(theta2)
    assert sp.expand(derived["B"] - B) == 0
    assert sp.expand(derived["C"] - 2 * l2 * l4 * sp.sin(theta2)) == 0


@establishes(
    "Smith",
    "A.8",
    printed=r"\cos\theta_4 = -\frac{AB}{D^2} \pm \sqrt{\left(\frac{AB}{D^2}\right)^2 "
    r"- \frac{B^2 - C^2}{D^2}},\; D^2 = A^2 + C^2",
    verdict="agrees",
    derived=lambda: r"\cos\theta_4 \in " + sp.latex(set(follower_cosine()[0])),
    remark="Here D^2 is right, unlike below (2.2). For the sign see (2.2).",
)
def test_roots_of_the_quadratic():
    roots, (A, B, C) = follower_cosine()
    D2 = A**2 + C**2
    middle, square = -A * B / D2, (A * B / D2) ** 2 - (B**2 - C**2) / D2
    assert sp.simplify(sum(roots) - 2 * middle) == 0
    assert sp.simplify(roots[0] * roots[1] - (middle**2 - square)) == 0
