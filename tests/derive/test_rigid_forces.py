"""Forces of rigid linkages: four derivations of the same numbers, and what each costs."""

from __future__ import annotations

import importlib
import itertools
from dataclasses import replace
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
import sympy as sp
from derivations import namespace_of
from elastolink.derive.lagrange import euler_lagrange
from elastolink.derive.models import four_bar, four_bar_forces
from elastolink.derive.models.four_bar_vectors import link_vectors
from elastolink.derive.rigid.multibody import lagrangian
from elastolink.derive.rigid.newton_euler import (
    TORQUE,
    balances,
    frame_load,
    shaking,
    solve,
    unknowns_of,
    wrench_symbols,
)
from elastolink.derive.rigid.planar import ETA, XI, MassMoments, Pin, inertia_wrench, momenta
from elastolink.derive.spec import ModelSpec
from force_machines import SIDES, call, cartesian, change_points, emitted, random_machine, state_of
from forces_truth import LOADS, MECHANISMS, forces, links, loads
from judging import reference_of
from multibody_truth import solve as eliminate

STRAIGHT = ModelSpec("four_bar", "forces", drop=("across",))
FULL = ModelSpec("four_bar", "forces")


# ---------------------------------------------------------------- Smith's own equations


def _circle_form(expression, angles):
    """Return an expression in sines and cosines with each pair on its circle: 0 if it vanishes."""
    names, circles = {}, []
    for i, angle in enumerate(angles):
        s, c = sp.symbols(f"s{i} c{i}")
        names |= {sp.sin(angle): s, sp.cos(angle): c}
        circles.append(s**2 + c**2 - 1)
    numerator = sp.numer(sp.together(sp.expand_trig(expression).subs(names)))
    symbols = [name for name in names.values()]
    return sp.reduced(sp.expand(numerator), circles, *symbols)[1]


def test_newton_and_euler_give_smiths_pin_forces_and_torque():
    """Smith (4.7)-(4.11) for links whose centres of gravity lie on them, a2 included."""
    linkage = four_bar_forces.linkage(STRAIGHT)
    t = linkage.t
    th2, th3, th4 = (body.angle for body in linkage.bodies)
    w2, w3, w4, a2, a3, a4 = sp.symbols("w2 w3 w4 a2 a3 a4")
    rates = {
        **{th.diff(t, 2): a for th, a in ((th2, a2), (th3, a3), (th4, a4))},
        **{th.diff(t): w for th, w in ((th2, w2), (th3, w3), (th4, w4))},
    }
    pushes = {}
    for body, push in zip(linkage.bodies, wrench_symbols(linkage), strict=True):
        for symbol, part in zip(push, inertia_wrench(body, t), strict=True):
            pushes[symbol] = part.subs(rates)
    found = {}
    for symbol, value in solve(balances(linkage), unknowns_of(linkage)):
        found[symbol.name] = value.subs(pushes).subs(
            {sp.Symbol(n, real=True): v for n, v in found.items()}
        )
    l2, l3, l4 = four_bar.crank, four_bar.coupler, four_bar.follower
    (_, s2, _, i2), (m3, s3, _, i3), (_, s4, _, i4) = (
        vars(body.moments).values() for body in linkage.bodies
    )
    below = l3 * l4 * sp.sin(th3 - th4)
    pulled = w2**2 * sp.sin(th2 - th3) - a2 * sp.cos(th2 - th3)
    smith = {}
    for axis, trig in (("x", sp.cos), ("y", sp.sin)):
        smith[f"{axis}34"] = (
            i3 * a3 * l4 * trig(th4) + i4 * a4 * l3 * trig(th3) - s3 * l2 * l4 * trig(th4) * pulled
        ) / below

    def falling(theta, w, a):
        return (
            w**2 * sp.cos(theta) + a * sp.sin(theta),
            w**2 * sp.sin(theta) - a * sp.cos(theta),
        )

    crank, coupler, follower = falling(th2, w2, a2), falling(th3, w3, a3), falling(th4, w4, a4)
    for i, axis in enumerate("xy"):
        smith[f"{axis}23"] = smith[f"{axis}34"] - m3 * l2 * crank[i] - s3 * coupler[i]
        smith[f"{axis}12"] = smith[f"{axis}23"] - s2 * crank[i]
        smith[f"{axis}41"] = smith[f"{axis}34"] + s4 * follower[i]
    smith["torque"] = i2 * a2 + l2 * (smith["y23"] * sp.cos(th2) - smith["x23"] * sp.sin(th2))
    assert set(smith) == set(found)
    for name, value in smith.items():
        assert _circle_form(value - found[name], (th2, th3, th4)) == 0, name


def test_the_shaking_moment_needs_the_drives_reaction():
    """Smith (4.12) as printed; (4.13) is l1 Y41, complete it is l1 Y41 - T."""
    (x, y), moment = frame_load(four_bar_forces.linkage(STRAIGHT))
    x12, y12, x41, y41 = sp.symbols("x12 y12 x41 y41", real=True)
    assert (sp.expand(x - x41 + x12), sp.expand(y - y41 + y12)) == (0, 0)
    assert sp.expand(moment - four_bar.frame * y41 + TORQUE) == 0


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_reactions_and_momenta_load_the_frame_alike(mechanism):
    """The sum of what acts on the links is what they take, whatever that is: symbolically."""
    model = importlib.import_module(f"elastolink.derive.models.{mechanism}_forces")
    linkage = model.linkage(ModelSpec(mechanism, "forces"))
    (x, y), moment = frame_load(linkage)
    whole = shaking(linkage)
    rows = balances(linkage)
    origins = [body.origin for body in linkage.bodies]
    total = [sum(rows[i::3]) for i in (0, 1)]
    turned = sum(
        rows[3 * n + 2] + ox * rows[3 * n + 1] - oy * rows[3 * n]
        for n, (ox, oy) in enumerate(origins)
    )
    closing = model.motion().named
    pairs = ((x, whole.x, total[0]), (y, whole.y, total[1]), (moment, whole.moment, turned))
    numbers = _pose_numbers(model, mechanism)
    for by_joints, by_momenta, balance in pairs:
        gap = closing(by_joints - by_momenta + balance)
        value = model.motion().steps.inline(gap).subs(numbers)
        # The reactions are left; each of their factors vanishes at a closed pose.
        factors = (
            sp.Poly(value, *sorted(value.free_symbols, key=str)).coeffs() if value != 0 else []
        )
        assert all(abs(sp.N(factor, 30)) < 1e-25 for factor in factors)


def _pose_numbers(model, mechanism):
    lengths = {
        "frame": sp.Integer(5),
        "crank": sp.Rational(3, 2),
        "coupler": sp.Integer(4),
        "follower": sp.Integer(3),
        "offset": sp.Rational(1, 2),
        "assembly": sp.Integer(-1),
        "theta2": sp.Rational(7, 5),
    }
    symbols = {s for _, value in model.motion().steps.steps for s in value.free_symbols}
    return {s: lengths[s.name] for s in symbols if s.name in lengths}


# ---------------------------------------------------------------- four ways to the same numbers


def _classes(machines):
    """Return Barker's classes of four-bar linkages, each with its assembly.

    By Grashof's sum and the shortest link, or the longest of a triple-rocker; None for the sum of
    a change point.
    """
    found = set()
    for n in machines:
        by_length = sorted(SIDES, key=n.get)
        shortest, second, third, longest = (n[name] for name in by_length)
        excess = second + third - shortest - longest
        named = by_length[0] if excess > 0 else by_length[3]
        found.add(((excess > 0, named) if excess else None, n["assembly"]))
    return found


def _exact(reference, numbers):
    with mpmath.workdps(30):
        return {
            k: float(v)
            for k, v in reference({name: mpmath.mpf(v) for name, v in numbers.items()}).items()
        }


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_four_derivations_agree(mechanism):
    """Emitted closed forms, free bodies in many digits, multipliers, virtual power and momenta."""
    random = np.random.default_rng(7)
    machines = [random_machine(mechanism, random) for _ in range(60)]
    if mechanism == "four_bar":
        every = itertools.product(itertools.product((True, False), SIDES), (-1.0, 1.0))
        assert _classes(machines) == set(every)
        machines += (folding := change_points(random))
        assert _classes(folding) == {(None, -1.0), (None, 1.0)}
    module, redundant = emitted(f"{mechanism}_forces"), emitted(f"{mechanism}_multibody")
    for numbers in machines:
        closed = call(module, "forces", numbers)
        size = max(abs(value) for value in closed.values())
        exact = _exact(forces(mechanism), numbers)
        for function in ("pin_forces", "driving_torque", "shaking_force", "shaking_moment"):
            for name, value in call(module, function, numbers).items():
                assert abs(value - closed[name]) < 1e-12 * size
        unloaded = {**numbers, **dict.fromkeys(LOADS, 0.0), **state_of(mechanism, numbers)}
        unloaded |= {"drive_d1": numbers["speed"], "drive_d2": numbers["acceleration"]}
        multipliers = cartesian(mechanism, eliminate(redundant, unloaded)[1], numbers)
        for name, value in closed.items():
            assert abs(value - exact[name]) < 1e-12 * size, name
            if name in multipliers:
                assert abs(value - multipliers[name]) < 1e-12 * size, name
        assert len(multipliers) == 9 if mechanism == "four_bar" else 10


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_loads_alone_and_their_multipliers(mechanism):
    random = np.random.default_rng(8)
    module, redundant = emitted(f"{mechanism}_forces"), emitted(f"{mechanism}_multibody")
    for _ in range(30):
        numbers = random_machine(mechanism, random)
        closed = call(module, "load_forces", numbers)
        size = max(abs(value) for value in closed.values())
        exact = _exact(loads(mechanism), numbers)
        # At rest only the loads act, whatever the masses are.
        still = {**numbers, "speed": 0.0, "mass2": 1.0, "mass3": 1.0, "mass4": 1.0}
        still |= {f"inertia{n}": 9.0 for n in (2, 3, 4)}
        still |= state_of(mechanism, still)
        multipliers = cartesian(mechanism, eliminate(redundant, still)[1], numbers)
        for name, value in closed.items():
            assert abs(value - exact[name]) < 1e-12 * size, name
            assert abs(value - multipliers.get(name, value)) < 1e-12 * size, name


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_the_free_linkage_follows_its_torque(mechanism):
    """Forward dynamics under the closed form's torque gives back the acceleration put into it."""
    random = np.random.default_rng(9)
    module = emitted(f"{mechanism}_forces")
    free = namespace_of(ModelSpec(mechanism, "multibody", drop=("drive",)))
    free = SimpleNamespace(**free)
    for _ in range(20):
        numbers = random_machine(mechanism, random)
        for n in (2, 3, 4):  # a mass that exists: the equations are to be solved for motion
            numbers |= {f"mass{n}": 3.0, f"inertia{n}": 40.0}
        numbers |= dict.fromkeys(LOADS, 0.0)
        numbers["torque"] = call(module, "driving_torque", numbers)["torque"]
        found, _ = eliminate(free, numbers | state_of(mechanism, numbers))
        assert abs(found[2] - numbers["acceleration"]) < 1e-9 * (200 + numbers["speed"] ** 2)


# ---------------------------------------------------------------- momenta and power, differentiated


def _momenta(mechanism, numbers, time):
    """Return momentum, moment of momentum about A and energy after a time, in many digits."""
    moved = dict(numbers)
    speed, acceleration = numbers["speed"], numbers["acceleration"]
    moved["theta2"] += speed * time + acceleration * time**2 / 2
    moved["speed"] = mpmath.mpf(1)
    moved["acceleration"] = mpmath.mpf(0)
    rate = speed + acceleration * time
    bodies, _ = links(mechanism, moved)
    step = mpmath.mpf(10) ** -18
    ahead, behind = (
        links(mechanism, {**moved, "theta2": moved["theta2"] + s * step})[0] for s in (1, -1)
    )
    momentum, turning, energy = mpmath.mpc(0), mpmath.mpf(0), mpmath.mpf(0)
    for n, (body, after, before) in enumerate(zip(bodies, ahead, behind, strict=True), start=2):
        mass, along, across, inertia = (
            numbers[f"{name}{n}"] for name in ("mass", "along", "across", "inertia")
        )
        velocity = (after[0] - before[0]) / (2 * step) * rate
        omega = mpmath.im((after[2] - before[2]) / (2 * step) / body[2]) * rate
        arm = mpmath.mpc(along, across) * body[2]
        own = mass * velocity + mpmath.mpc(0, omega) * arm
        momentum += own
        turning += mpmath.im(mpmath.conj(body[0]) * own + mpmath.conj(arm) * velocity)
        turning += inertia * omega
        energy += mass * abs(velocity) ** 2 / 2 + inertia * omega**2 / 2
        energy += mpmath.re(mpmath.conj(velocity) * mpmath.mpc(0, omega) * arm)
    return momentum, turning, energy


@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_shaking_is_the_change_of_momentum_and_torque_that_of_energy(mechanism):
    random = np.random.default_rng(10)
    module = emitted(f"{mechanism}_forces")
    for _ in range(12):
        numbers = random_machine(mechanism, random)
        closed = call(module, "forces", numbers)
        size = max(abs(value) for value in closed.values())
        with mpmath.workdps(50):
            exact = {name: mpmath.mpf(value) for name, value in numbers.items()}
            step = mpmath.mpf(10) ** -9
            after, before = (_momenta(mechanism, exact, s * step) for s in (1, -1))
            force, moment, power = (
                (a - b) / (2 * step) for a, b in zip(after, before, strict=True)
            )
            assert abs(closed["shaking_x"] + force.real) < 1e-10 * size
            assert abs(closed["shaking_y"] + force.imag) < 1e-10 * size
            assert abs(closed["shaking_moment"] + moment) < 1e-10 * size
            assert abs(closed["torque"] * numbers["speed"] - power) < 1e-10 * size * 20


# ---------------------------------------------------------------- derived means derived


def test_a_point_mass_in_the_energies_moves_the_forces_as_its_moments_do():
    """Only the kinetic energy is changed; the multipliers follow as by hand."""
    m, a, b = 0.7, 1.3, -0.4
    plain = lagrangian(FULL, four_bar_forces.linkage(FULL))
    coupler = [sp.Function(name)(plain.t) for name in ("x3", "y3", "angle3")]
    place = (
        coupler[0] + a * sp.cos(coupler[2]) - b * sp.sin(coupler[2]),
        coupler[1] + a * sp.sin(coupler[2]) + b * sp.cos(coupler[2]),
    )
    speed2 = sum(part.diff(plain.t) ** 2 for part in place)
    heavier = replace(plain, expression=plain.expression + sp.Float(m) / 2 * speed2)
    found = _multipliers(euler_lagrange(heavier))
    numbers = _hand_machine()
    numbers |= {
        "mass3": numbers["mass3"] + m,
        "along3": numbers["along3"] + m * a,
        "across3": numbers["across3"] + m * b,
        "inertia3": numbers["inertia3"] + m * (a**2 + b**2),
    }
    expected = call(emitted("four_bar_forces"), "forces", numbers)
    for name, value in found.items():
        assert value == pytest.approx(expected[name], rel=1e-11), name


def test_a_spring_in_the_energies_acts_as_the_load_that_it_is():
    """A spring of stiffness k from the crank pin B to the origin: force -k AB on the coupler."""
    stiffness = 3.0
    plain = lagrangian(FULL, four_bar_forces.linkage(FULL))
    x3, y3 = (sp.Function(name)(plain.t) for name in ("x3", "y3"))
    sprung = replace(plain, expression=plain.expression - stiffness * (x3**2 + y3**2) / 2)
    found = _multipliers(euler_lagrange(sprung))
    numbers = _hand_machine()
    pin = numbers["crank"] * np.exp(1j * numbers["theta2"])
    numbers |= dict.fromkeys(LOADS, 0.0)
    numbers |= {"fx3": -stiffness * pin.real, "fy3": -stiffness * pin.imag}
    module = emitted("four_bar_forces")
    inertia, load = (call(module, name, numbers) for name in ("forces", "load_forces"))
    for name, value in found.items():
        assert value == pytest.approx(inertia[name] + load[name], rel=1e-11), name
    # By hand: the spring pulls along the crank, so that nothing but pin 23 and 12 feels it.
    assert load["x34"] == pytest.approx(0, abs=1e-13)
    assert load["x12"] == pytest.approx(stiffness * pin.real, rel=1e-12)
    assert load["torque"] == pytest.approx(0, abs=1e-12)


def _hand_machine():
    return random_machine("four_bar", np.random.default_rng(12))


def _multipliers(equations):
    """Solve symbolic equations of motion numerically at the pose of :func:`_hand_machine`."""
    numbers = _hand_machine() | dict.fromkeys(LOADS, 0.0)
    state = numbers | state_of("four_bar", numbers)
    drive = sp.Function("drive")(equations.t)
    values = {
        drive.diff(equations.t, 2): numbers["acceleration"],
        drive.diff(equations.t): numbers["speed"],
        drive: numbers["theta2"],
    }

    def number(matrix):
        matrix = matrix.subs(values)
        named = {s: state[s.name] for s in matrix.free_symbols if s.name in state}
        return np.array(matrix.subs(named).evalf(), dtype=float)

    mass, jacobian = number(equations.mass), number(equations.jacobian)
    right = [number(equations.forces) - number(equations.rest), number(equations.gamma)]
    zero = np.zeros((len(jacobian), len(jacobian)))
    whole = np.block([[mass, -jacobian.T], [jacobian, zero]])
    solution = np.linalg.solve(whole, np.concatenate(right)[:, 0])[9:]
    return {m.name: value for m, value in zip(equations.multipliers, solution, strict=True)}


def test_momentum_differentiates_to_the_inertia_force():
    linkage = four_bar_forces.linkage(FULL)
    for body in linkage.bodies:
        taken, held = inertia_wrench(body, linkage.t), momenta(body, linkage.t)
        assert sp.simplify(held.x.diff(linkage.t) - taken.x) == 0
        about_a = taken.moment + body.origin[0] * taken.y - body.origin[1] * taken.x
        assert sp.simplify(held.moment.diff(linkage.t) - about_a) == 0


def test_vectors_are_those_of_the_kinematics():
    """Every step against the kinematics module's own, in 40 digits, for both assemblies."""
    v, k = link_vectors(), four_bar.kinematics()
    pairs = [
        (v.coupler_x, four_bar.coupler * k.cos3),
        (v.coupler_y, four_bar.coupler * k.sin3),
        (v.follower_x, four_bar.follower * k.cos4),
        (v.follower_y, four_bar.follower * k.sin4),
        *((getattr(v, name), getattr(k, name)) for name in ("w3", "w4", "a3", "a4", "spread")),
        (v.slip3, k.slip3),
        (v.slip4, k.slip4),
    ]
    inputs = (four_bar.theta2, *(sp.Symbol(a.name) for a in four_bar.ARGUMENTS[1:]))
    names = [str(i) for i, _ in enumerate(pairs)]
    vectors = reference_of(inputs, [(n, p[0]) for n, p in zip(names, pairs, strict=True)], v.steps)
    angles = reference_of(inputs, [(n, p[1]) for n, p in zip(names, pairs, strict=True)], k.steps)
    with mpmath.workdps(40):
        lengths = map(mpmath.mpf, (1.3, 5, 2, 4.5, 3))
        given = dict(zip((a.name for a in four_bar.ARGUMENTS), lengths, strict=False))
        for assembly in (1, -1):
            given["assembly"] = mpmath.mpf(assembly)
            one, two = vectors(given), angles(given)
            assert all(abs(one[name] - two[name]) < mpmath.mpf(10) ** -37 for name in names)


# ---------------------------------------------------------------- refusals


def test_four_numbers_describe_no_other_integral():
    moments = MassMoments(*sp.symbols("m a b j"))
    assert moments.integral(XI**2 + ETA**2 + 3) == sp.Symbol("j") + 3 * sp.Symbol("m")
    for density in (XI**2, XI * ETA, XI**3):
        with pytest.raises(ValueError, match="do not determine"):
            moments.integral(density)


def test_an_indeterminate_linkage_is_refused():
    linkage = four_bar_forces.linkage(STRAIGHT)
    zero = (sp.S.Zero, sp.S.Zero)
    doubled = replace(linkage, joints=(*linkage.joints, Pin(1, 3, zero, zero)))
    with pytest.raises(ValueError, match="not determined by statics"):
        solve(balances(doubled), unknowns_of(doubled))
