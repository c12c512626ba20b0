"""Derivation of the rod's equations: moving support, tension, floating frame, projection."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from elastolink.derive.arrays import BasisProduct, CrankMotion, DiscreteSystem
from elastolink.derive.lagrange import NotRepresentable
from elastolink.derive.models import flexible_rod as rod
from elastolink.derive.projection.moving_basis import Moments, MovingShapes, project_moving
from elastolink.derive.records import EndForce, Essential, PointTerm, Support
from elastolink.derive.spec import ModelSpec
from elastolink.derive.variational import hamilton
from numpy.polynomial.legendre import leggauss
from plain_basis import PlainBasis

SPEC = ModelSpec("quick_return", "moving_basis", flexible=("rod",))
PRINTED = SPEC.with_(drop=("frame", "tension"))
x, t, v, phi, block = rod.x, rod.t, rod.v, rod.phi, rod.block
mass, stiffness, length = rod.density, rod.stiffness, rod.length
turn, bend, sliding = sp.symbols("turn bend sliding", real=True)
MOTION = CrankMotion(
    rod.theta2, rod.rate, rod.acceleration, {rod.theta4: turn, turn: bend, rod.place: sliding}
)
SHAPES = MovingShapes(length, rod.place, rod.eta)
FOLLOWERS = {phi: rod.theta4, block: length * rod.place}


def projected(action, **options):
    return project_moving(action, v, SHAPES, MOTION, followers=FOLLOWERS, **options)


def terms(system: DiscreteSystem, array: str) -> dict[str, sp.Expr]:
    """Return the coefficients of an array by the names of the integrals."""
    if array not in system.arrays:
        return {}
    return {what.name: sp.expand(value) for value, what in system.arrays[array].terms}


def undamped(spec):
    return rod.action(spec).with_(dissipation=sp.S.Zero)


def test_damping_is_in_the_equation_and_in_the_moment():
    equations = hamilton(rod.action(PRINTED))
    drag = -rod.damping * v.diff(t) - rod.internal * v.diff(x, 4, t)
    difference = equations.equations[v] - hamilton(undamped(PRINTED)).equations[v]
    assert sp.expand(difference - drag).doit() == 0
    moment = equations.condition(length, v, 1)
    bent = stiffness * v.diff(x, 2) + rod.internal * v.diff(x, 2, t)
    assert sp.expand(moment + bent).doit() == 0
    (jump,) = [j for j in equations.jumps if j.order == 1]
    assert sp.expand(jump.value + bent).doit() == 0 and jump.applied == 0


def test_frame_is_the_line_of_least_squares():
    """Rotation and offset of a polynomial deflection, by minimising the squares."""
    found = rod.buckens_frame()
    deflection = 3 * x - 7 * x**2 / length + x**4 / length**3
    slope, start = sp.symbols("slope start")
    off = sp.integrate((deflection - slope * x - start) ** 2, (x, 0, length))
    best = sp.solve([sp.diff(off, slope), sp.diff(off, start)], [slope, start], dict=True)[0]
    moments = {s: sp.integrate(w * deflection, (x, 0, length)) for s, w in found.weights.items()}
    assert sp.simplify(found.rotation.subs(moments) - best[slope]) == 0
    # The pin (v = 0) lies at minus the line's start from the frame.
    assert sp.simplify(found.offset.subs(moments) + best[start]) == 0


def test_frame_part_is_the_difference_of_two_works():
    """Against direct integration, for any tension that ends at the tip."""
    force = (length - x) * x
    part = rod.frame_part(force)
    deflection = x * (x - length / 3) * (2 * length - x)
    moments = {s: sp.integrate(w * deflection, (x, 0, length)) for s, w in part.weights.items()}
    frame = rod.buckens_frame()
    rotation = frame.rotation.subs(
        {s: sp.integrate(w * deflection, (x, 0, length)) for s, w in frame.weights.items()}
    )
    slope = sp.diff(deflection, x)
    work = sp.integrate(force * (slope**2 - (slope - rotation) ** 2) / 2, (x, 0, length))
    assert sp.simplify(part.expression.subs(moments) + work) == 0


def test_points_stand_at_fixed_places():
    """A tip mass and a spring at half the length: values of the shapes there, by their names."""
    tip, spring = sp.symbols("tip spring", positive=True)
    base = undamped(PRINTED)
    found = projected(
        base.with_(
            point_terms=(
                PointTerm(length, tip / 2 * v.diff(t) ** 2),
                PointTerm(length / 2, -spring / 2 * v**2),
            )
        )
    )
    before = projected(base)
    assert terms(found, "M") == {**terms(before, "M"), "overlap_at_1": tip * length**2}
    assert terms(found, "A") == {**terms(before, "A"), "drift_at_1": tip * length**2 * sliding}
    drifted = tip * length**2 * sliding**2
    assert terms(found, "B") == {**terms(before, "B"), "drift_drift_at_1": drifted}
    expected = {**terms(before, "K"), "overlap_at_1_over_2": spring * length**2}
    assert terms(found, "K") == expected
    moving = base.with_(point_terms=(PointTerm(block, -spring / 2 * v**2),))
    with pytest.raises(NotRepresentable, match="no fixed fraction"):
        projected(moving)


def test_an_even_load_and_a_force_at_the_tip_are_forces():
    load, push = sp.symbols("load push", real=True)
    given = undamped(PRINTED)
    given = given.with_(
        force_density={v: load * phi.diff(t) ** 2}, end_forces=(EndForce(length, v, 0, push),)
    )
    found = projected(given)
    assert terms(found, "f")["mean"] == load * turn**2 * length**2
    assert terms(found, "p") == {"shape_at_1": push * length}


def test_moments_give_products():
    a, b = sp.symbols("a b")
    part = Moments(5 * a**2 * phi.diff(t) ** 2 + 2 * a * b, {a: sp.Integer(1), b: x}, "both")
    found = projected(undamped(PRINTED), moments=(part,))
    (spun,) = [(f, w) for f, w in found.arrays["B"].terms if isinstance(w, BasisProduct)]
    mean = [sp.Symbol(f"mean_{end}") for end in ("row", "column")]
    assert spun[0] == turn**2 * length**4
    assert spun[1].form == 10 * mean[0] * mean[1]
    (still,) = [(f, w) for f, w in found.arrays["K"].terms if isinstance(w, BasisProduct)]
    moment = [sp.Symbol(f"moment_{end}") for end in ("row", "column")]
    assert sp.expand(still[0] * still[1].form) == sp.expand(
        -2 * length**5 * (mean[0] * moment[1] + moment[0] * mean[1])
    )
    with pytest.raises(ValueError, match="not quadratic"):
        projected(undamped(PRINTED), moments=(replace(part, expression=a**3),))


@pytest.mark.parametrize(
    "change",
    [
        {"essential": (Essential(length, v, 0),)},
        {"essential": (Essential(sp.Integer(0), v, 1),)},
        {"supports": (Support(2 * block, v, rod.reaction),)},
    ],
)
def test_shapes_hold_where_the_action_says(change):
    with pytest.raises(ValueError, match="not held at"):
        projected(undamped(PRINTED).with_(**change))


@pytest.mark.parametrize(
    "density, words",
    [
        (v.diff(t, 2) ** 2, "second time derivatives"),
        (v * v.diff(t), "no array"),
        (v**2 * phi.diff(t), "no array"),
        (v.diff(t) * v.diff(x) * phi.diff(t) ** 2, "rates"),
        (v.diff(t) * phi.diff(t) ** 2, "momentum"),
        (v.diff(x, 2, t) * phi.diff(t), "derivative"),
    ],
)
def test_terms_without_a_place_are_refused(density, words):
    with pytest.raises(NotRepresentable, match=words):
        projected(undamped(PRINTED).with_(density=density))


@pytest.mark.parametrize("drop", [("spin",), ("tension", "axial")])
def test_unknown_terms_are_refused(drop):
    with pytest.raises(ValueError, match="unknown terms"):
        rod.action(SPEC.with_(drop=drop))


class Defined(PlainBasis):
    """The plain shapes, integrated as a module's own table says."""

    def __init__(self, size, module):
        super().__init__(size)
        self.rows = {name: row for name, *row in module.BASIS}

    def array(self, name, place):
        weight, row, column, at = self.rows[name]
        nodes, weights = leggauss(self.size + 4)
        eta, w = ((nodes + 1) / 2, weights / 2) if at is None else (np.array([at]), np.ones(1))
        w = w * np.polynomial.Polynomial(weight)(eta)
        left, right = (
            None
            if orders is None
            else (self.drifts if orders[1] else self.shapes)(eta, place, orders[0])
            for orders in (row, column)
        )
        if right is None:
            return np.einsum("x,txi->ti", w, left)
        return np.einsum("x,txi,txj->tij", w, left, right)


def test_the_table_defines_the_names_of_the_protocol():
    module = importlib.import_module("elastolink.generated.quick_return_rod_moving_basis")
    place = np.array([0.2, 0.7, 1.0])
    defined, named = Defined(3, module), PlainBasis(3)
    for row in module.BASIS:
        found = defined.array(row[0], place)
        np.testing.assert_allclose(found, named.array(row[0], place), rtol=1e-12, atol=1e-15)
    instead = [row for _, more in module.DROPS.values() for row in more]
    terms = {row[-1] for row in (*module.TERMS, *instead)}
    used = terms - set(module.RETURNS.get("basis_products", ()))
    vectors = set() if "basis_products" not in module.RETURNS else {"mean", "moment"}
    assert used | vectors == {row[0] for row in module.BASIS}
