"""Smith's appendices 2, 3 and 4: his programmes, run line by line against numeric truth."""

from functools import cache

import numpy as np
import pytest
import seed_truth as truth
from scipy.integrate import solve_ivp
from seed_ledger import Ledger, derivative, hold, quoted, same
from seed_listings import (
    HillData,
    de_vogelaere,
    first_step,
    forbar2,
    fousim,
    hill_kinematics,
    hill_parts,
)
from seed_waves import harmonics

row = Ledger("Smith", __file__)
FIVE = truth.CRANK_ROCKERS["5,1,5,2"]
SAMPLES = range(3, 512, 7)
MENDED = ("stop", "last")


@cache
def turn(lengths, reversed_follower=False):
    """Return one turn under the programmes' names; appendix 4 measures the follower from C to D."""
    m = truth.motion(lengths)
    l1, l2, l3, l4 = lengths
    th4 = m.theta4 + (np.pi if reversed_follower else 0.0)
    a = 2 * l2 * l4 * np.cos(m.theta2) - 2 * l1 * l4
    b = l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * np.cos(m.theta2)
    c = 2 * l2 * l4 * np.sin(m.theta2)
    names = {"a": a, "b": b, "c": c, "d": (1 if reversed_follower else -1) * a * b / (a**2 + c**2)}
    names |= {"e": (b**2 - c**2) / (a**2 + c**2), "pi": np.pi, "omega2": 1.0, "theta": m.theta2}
    for k, angle in ((3, m.theta3), (4, th4)):
        names |= {f"csth{k}": np.cos(angle), f"snth{k}": np.sin(angle), f"theta{k}": angle}
    return {**truth.named(lengths), **truth.rates(m), **names, "omega2": m.omega2, "theta4": th4}


def scaled(lengths):
    """Return crank, coupler and follower for a frame of unit length, as the programme wants."""
    return [length / lengths[0] for length in lengths[1:]]


def deviations(lengths):
    """Return largest errors of omega3, alpha3, omega4, alpha4, theta3 [deg] and theta4 [deg]."""
    m = truth.motion(lengths, count=720)
    angles = np.degrees([m.theta3, m.theta4])
    true = np.array([m.omega3, m.alpha3, m.omega4, m.alpha4, *angles])
    worst = np.zeros(6)
    for th2, d3, m3, omega3, alpha3, d4, m4, omega4, alpha4 in forbar2(*scaled(lengths)):
        found = (omega3, alpha3, omega4, alpha4, d3 + m3 / 60, d4 + m4 / 60)
        worst = np.maximum(worst, np.abs(found - true[:, 2 * (th2 % 360)]))
    return worst


@row("Appendix 2 formulas", "Appendix 2 quadrants")
def formulas_and_quadrants(entry):
    for lengths in (*truth.CRANK_ROCKERS.values(), truth.LONG_CRANK):
        hold(entry.printed, turn(lengths), tol=1e-7)
        worst = deviations(lengths)
        assert worst[:4].max() < 3.1e-7
        assert worst[4:].max() < 0.5 / 60 + 1e-4
    quoted([deviations(truth.DRAG_LINK)[2]], "8.3")


@row("Appendix 2 near sin(theta2) = 0")
def near_dead_centres(entry):
    l1, l2, l3, l4 = FIVE
    theta2 = 9e-4
    A = 2 * l4 * (l2 * np.cos(theta2) - l1)
    B = l3**2 - l1**2 - l2**2 - l4**2 + 2 * l1 * l2 * np.cos(theta2)
    quoted([abs(-B / A - np.cos(truth.closure(FIVE, theta2)[1][0]))], "2.1e-4")
    for angle, small in ((theta2, True), (1.1e-3, False), (2.0, False)):
        c = entry.printed.values(l2=l2, l4=l4, theta2=angle)["c"]
        same(c, 0.0 if small else 2 * l2 * l4 * np.sin(angle))
    kept = np.array(forbar2(*scaled(FIVE), steps=36, repair={"sine"})[1:18])
    assert np.abs(kept - np.array(forbar2(*scaled(FIVE), steps=36)[1:18])).max() == 0
    # At theta2 = 0 and pi of the grid the sine is below 4e-9, and so is what is dropped.
    omega4 = truth.motion(FIVE, count=720).omega4[360]
    assert forbar2(*scaled(FIVE))[18][7] == pytest.approx(omega4, abs=1e-8)


@row("Appendix 2 degrees and minutes")
def sixty_minutes(_):
    rows = forbar2(*scaled(FIVE))
    assert [line[0] for line in rows if 60 in (line[2], line[6])] == [120]


def wave(z):
    """A function with every harmonic, neither even nor odd, of mean value 0.7 at least."""
    return 0.7 + np.cos(z) / (1.5 - np.sin(z)) + 0.2 * np.sin(2 * z)


TRUE = harmonics(wave(truth.TURN * np.arange(256) / 256))


@row("Appendix 3 heading")
def heading(entry):
    """The programme's coefficients put into both series."""

    def short(z):
        return 0.7 + np.cos(z) - 0.4 * np.sin(2 * z)

    found = fousim(0.0, truth.TURN, short, 3, 1e-10, MENDED)
    point = {"a": found.a, "b": found.b, "M": 3, "f": short, "z": 1.234}
    hold(entry.corrected, point, tol=1e-8)
    printed = entry.printed.value(**point)
    assert short(1.234) - printed == pytest.approx(0.35, abs=1e-8)


@row("Appendix 3 quadrature")
def quadrature(entry):
    found = fousim(0.0, truth.TURN, wave, 6, 1e-10, MENDED)
    for m in range(7):
        assert [found.a[m], found.b[m]] == pytest.approx([TRUE[0][m], TRUE[1][m]], abs=3e-9)
    constant = fousim(0.0, truth.TURN, lambda z: 0.7, 2, 1e-10, MENDED)
    assert constant.a[0] == pytest.approx(0.7, abs=1e-8)
    # Exact for a cubic, which no rule of lower order is.
    x = np.linspace(0.0, 2.0, 9)
    y = 1 + 2 * x - x**2 + 3 * x**3
    sums = {"S_odd": y[1::2].sum(), "S_even": y[2:-1:2].sum(), "I_0": y[0] + y[-1], "h": x[1]}
    same(entry.printed.values(**sums)["II"], 2 + 4 - 8 / 3 + 12)


@row("Appendix 3 stopping rule")
def stopping_rule(_):
    early = fousim(0.0, truth.TURN, lambda z: np.cos(3 * z), 5, 1e-6)
    assert early.intervals == 8
    assert early.a[[1, 3, 5]] == pytest.approx([-1 / 3, 1.0, 1.0], abs=1e-6)
    full = fousim(0.0, truth.TURN, lambda z: np.cos(3 * z), 5, 1e-6, MENDED)
    assert full.intervals == 64
    assert full.a == pytest.approx([0, 0, 0, 1, 0, 0], abs=1e-8)
    assert full.b == pytest.approx(np.zeros(6), abs=1e-8)


@row("Appendix 3 interval")
def interval(_):
    half = fousim(0.0, np.pi, lambda z: 0.7 + np.cos(2 * z), 4, 1e-8, MENDED)
    assert half.a[0] == pytest.approx(0.35, abs=1e-6)
    assert half.b[1] == pytest.approx(0.2334, abs=1e-4)
    moved = fousim(-1.0, truth.TURN - 1.0, wave, 3, 1e-10, MENDED)
    assert moved.a[1] == pytest.approx(TRUE[0][1], abs=1e-8)


@row("Appendix 3 last lines")
def statement_after_the_loop(_):
    """It writes beyond the arrays; in longer ones it changes no coefficient."""
    with pytest.raises(IndexError, match="out of bounds"):
        fousim(0.0, truth.TURN, wave, 3, 1e-9, {"stop"})
    longer = fousim(0.0, truth.TURN, wave, 3, 1e-9, {"stop"}, room=1)
    mended = fousim(0.0, truth.TURN, wave, 3, 1e-9, MENDED)
    assert longer.a[4] == longer.b[4] == 0 and mended.a.size == 4
    assert np.array_equal([longer.a[:4], longer.b[:4]], [mended.a, mended.b])


def forcing(m, lengths, mode):
    """Return g of (6.17) from true angles at unit crank speed."""
    if mode % 2:
        swing = 2 * lengths[1] / lengths[2] * np.sin(m.theta2 - m.theta3)
        return 2 / (mode * np.pi) * (swing - m.alpha3)
    return 2 / (mode * np.pi) * m.alpha3


@row("Appendix 4 form of the equation")
def form_of_the_equation(entry):
    """(6.18) of the first mode, epsilon3 = mu lambda^2."""
    point = {"lam": 3.0, "mu": 0.2, "theta": 0.0, "y": 0.6, "F": lambda _: 1.7, "g": lambda _: 0.4}
    hold(entry.printed, {**point, "D": derivative(2, 0.4 - (9.0 + 0.2 * 9.0 * 1.7) * 0.6)})


@row("Appendix 4 angles", "Appendix 4 speeds and accelerations", "Appendix 4 quadrants")
def kinematics_in_the_first_turn(entry):
    for lengths in (*truth.CRANK_ROCKERS.values(), truth.LONG_CRANK):
        true = turn(lengths, reversed_follower=True)
        fast = {f"omega{k}": 3 * true[f"omega{k}"] for k in (2, 3, 4)}
        fast |= {f"alpha{k}": 9 * true[f"alpha{k}"] for k in (3, 4)}
        hold(entry.printed, {**true, **fast}, tol=1e-6)
        names = ("csth3", "snth3", "csth4", "snth4", "omega3", "omega4", "alpha3", "alpha4")
        powers = (0, 0, 0, 0, 1, 1, 2, 2)
        for i in SAMPLES[::6] if entry.label.endswith("angles") else ():
            found = hill_kinematics(true["theta2"][i], HillData(*lengths, omega2=3.0))
            expected = [3.0**k * true[name][i] for name, k in zip(names, powers, strict=True)]
            assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)
    found = [
        hill_kinematics(a, HillData(*truth.DRAG_LINK))[5]
        for a in truth.motion(truth.DRAG_LINK).theta2[3::7]
    ]
    assert np.abs(np.array(found) - truth.motion(truth.DRAG_LINK).omega4[3::7]).max() > 1


@row("Appendix 4 coefficient", "Appendix 4 right-hand side")
def coefficient_and_right_hand_side(entry):
    for name in ("5,1,5,2", "10,1,10,4", "2,1,2,2"):
        lengths = truth.CRANK_ROCKERS[name]
        m, true = truth.motion(lengths), turn(lengths, reversed_follower=True)
        fast = {"omega2": 3.0, "alpha3": 9 * true["alpha3"], "alpha4": 9 * true["alpha4"]}
        for mode in (1, 2, 3):
            data = HillData(*lengths, omega2=3.0, m=mode, lamsq=9.3, mu=0.2)
            given = {"m": mode, "lam": 9.3**0.5, "mu": 0.2}
            value = entry.printed.value(**{**true, **fast, **given})
            right = forcing(m, lengths, mode), 9.3 + 9.3 * 0.2 * truth.coupler_functions(m)[3]
            same(value, right["coefficient" in entry.label], 1e-8)
            listed = np.array([hill_parts(a, data) for a in m.theta2[3::49]])
            assert listed == pytest.approx(np.array(right[::-1])[:, 3::49].T, abs=1e-7)


@row("Appendix 4 later turns")
def later_turns(entry):
    data = HillData(*FIVE)
    angles = np.radians(np.arange(1, 360))
    first, second, mended = (
        np.array([hill_kinematics(angle + shift, data, repair) for angle in angles])
        for shift, repair in ((0.0, ()), (truth.TURN, ()), (truth.TURN, ("turns",)))
    )
    assert np.abs(second - first)[180:].max() < 1e-9
    quoted(np.abs(second - first)[:179].max(axis=0)[[2, 7]], "0.40", "0.22")
    assert np.abs(mended - first).max() < 1e-9
    true = turn(FIVE, reversed_follower=True)
    names = {k: v[5:250] for k, v in true.items() if np.ndim(v)}
    hold(entry.printed, names, {k: v[260:-3] for k, v in true.items() if np.ndim(v)}, tol=1e-7)
    later = entry.printed.sides(**{**names, "theta": names["theta"] + truth.TURN})[0]
    quoted([np.abs(later[0] - later[1]).max()], "0.40")


@row("Appendix 4 near sin(theta2) = 0")
def near_dead_centres_of_the_solver(entry):
    data = HillData(*FIVE)
    gap = [
        abs(hill_kinematics(a, data)[2] - hill_kinematics(a, data, ("sine",))[2])
        for a in (9e-4, np.pi - 9e-4)
    ]
    quoted([max(gap)], "2.1e-4")
    steps = [np.sin(np.radians(first_step(lam**2))) for lam in (229.0, 232.0)]
    assert steps[0] > 1e-3 > steps[1]
    for angle in (9e-4, 1.1e-3, 2.0):
        c = entry.printed.values(l2=1.0, l4=2.0, theta=angle)["c"]
        same(c, 0.0 if angle < 1e-3 else 4 * np.sin(angle))


def reference(f, x0, y0, z0, places):
    """Return y at the places by DOP853."""
    span, tight = (x0, places[-1]), {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    return solve_ivp(lambda x, s: [s[1], f(x, s[0])], span, [y0, z0], t_eval=places, **tight).y[0]


def mathieu(x, y):
    return -(5 + 3 * np.cos(x)) * y


def errors_and_order(run, x0=1.5, z0=0.4, counts=(50, 100, 200, 400)):
    """Return the errors of a run at halved steps, and their slopes."""
    errors = []
    for count in counts:
        places, values = run(mathieu, x0, 1.0, z0, 1.0 / count, count)
        errors.append(np.abs(values - reference(mathieu, x0, 1.0, z0, places)).max())
    return np.array(errors), np.log2(np.array(errors[:-1]) / errors[1:])


def listing(*repair):
    """Return the programme with some repairs."""
    return lambda *args: de_vogelaere(*args, repair)


@row("Appendix 4 de Vogelaere's algorithm")
def order_of_the_method(entry):
    errors, order = errors_and_order(listing("slope", "start"))
    assert order == pytest.approx(4.0, abs=0.1)
    assert errors[-1] < 1e-10
    # The printed form, step by step: the programme's numbers.
    h, x, y, z = 0.02, 1.5, 1.0, 0.4
    before = mathieu(x - h, y - h * z + h**2 / 2 * mathieu(x, y))
    _, listed = de_vogelaere(mathieu, x, y, z, h, 20, ("slope", "start"))
    for value in listed:
        point = {"h": h, "f_0": mathieu(x, y), "f_mh": before, "y_0": y, "z_0": z, "f": mathieu}
        step = entry.printed.values(**point, x=x)
        before, y, z = mathieu(x + h, step["y_h"]), step["y_1"], step["z_1"]
        x += 2 * h
        assert y == pytest.approx(value, rel=1e-10)


@row("Appendix 4 initial slope")
def initial_slope(entry):
    start = {"h": 0.01, "x_0": 0.0, "z_0": 1.0}
    assert entry.printed.values(**start)["q"] == 0
    same(entry.printed.values(**{**start, "x_0": 3.0})["q"], 0.03)
    same(entry.corrected.values(**start)["q"], 0.01)
    _, values = de_vogelaere(lambda x, y: -4.0 * y, 0.0, 0.0, 1.0, 0.01, 200)
    assert np.all(values == 0)
    places, values = listing("slope")(lambda x, y: -4.0 * y, 0.0, 0.0, 1.0, 0.01, 200)
    assert np.abs(values - np.sin(2 * places) / 2).max() < 1e-6


@row("Appendix 4 initial angle")
def initial_angle(entry):
    right, _ = errors_and_order(listing("slope", "start"))
    printed, order = errors_and_order(listing("slope"))
    assert order == pytest.approx(3.0, abs=0.1)
    quoted([right[-1], printed[-1]], "7e-11", "2.5e-8")
    at_zero, order = errors_and_order(listing("slope"), x0=0.0)
    assert order == pytest.approx(4.0, abs=0.1) and at_zero[-1] < 1e-9
    point = {"h": 0.3, "x_0": 1.5, "t": 0.8, "f": lambda x, y: x + y**2}
    same(entry.corrected.values(**point)["s"], 0.03 * (1.2 + 0.64))
    same(entry.printed.values(**point)["s"], 0.03 * (-0.3 + 0.64))


@row("Appendix 4 end test")
def end_test(entry):
    stop = entry.printed.sides(p=0.0)[0][1]
    arguments = (lambda x, y: y, 0.0, -0.5, 0.0, 0.05, 90)
    _, printed = de_vogelaere(*arguments, stop=stop)
    assert printed.size == 90 and printed[-1] < -1000
    assert not np.greater(*entry.printed.sides(p=printed[-1])[0])
    _, mended = de_vogelaere(*arguments, ("end",), stop=stop)
    assert mended.size < 20 and -1.2 < mended[-1] < -1
    assert np.greater(*entry.corrected.sides(p=mended[-1])[0])
    assert not np.greater(*entry.corrected.sides(p=mended[-2])[0])


def damping_per_turn(half_step_degrees, lam):
    """Return how much of an oscillation y'' = -lam^2 y one crank turn leaves."""
    h = np.radians(half_step_degrees)
    steps = round(truth.TURN / (2 * h))
    _, values = de_vogelaere(lambda x, y: -(lam**2) * y, 0.0, 1.0, 0.0, h, 12 * steps)
    peaks = [np.abs(values[i * steps : (i + 1) * steps]).max() for i in (2, 10)]
    return (peaks[1] / peaks[0]) ** (1 / 8)


@row("Appendix 4 step")
def step(entry):
    """Halved from the first until the condition holds."""
    for lam, expected in ((1.8, 10.0), (1.9, 5.0), (7.0, 2.5), (18.0, 0.625)):
        h = entry.printed.values(lam=lam)["h_1"]
        while not np.less_equal(*entry.printed[1].sides(h=h, lam=lam)[0]):
            h /= 2
        assert h == expected == first_step(lam**2)
    assert damping_per_turn(1.0, 18.0) == pytest.approx(0.98, abs=0.002)
    assert damping_per_turn(2.0, 18.0) == pytest.approx(0.53, abs=0.01)
    assert damping_per_turn(4.0, 18.0) < 1e-2


@row("Appendix 4 higher modes")
def higher_modes(entry):
    m = truth.motion(FIVE)
    f3 = truth.coupler_functions(m)[3]
    lam2, epsilon3 = 9.3, 0.8
    data = entry.corrected.values(m=2, lam=lam2**0.5, eps3=epsilon3)
    printed = HillData(*FIVE, m=2, lamsq=lam2, mu=epsilon3 / lam2)
    meant = HillData(*FIVE, m=2, lamsq=data["lamsq"], mu=data["mu"])
    for i in SAMPLES:
        assert hill_parts(m.theta2[i], printed)[0] == pytest.approx(lam2 + epsilon3 * f3[i])
        true = 16 * lam2 + 4 * epsilon3 * f3[i]
        assert hill_parts(m.theta2[i], meant)[0] == pytest.approx(true)


def series(samples, count=60):
    """Return a function that evaluates the Fourier series of even samples over one turn."""
    coefficients = 2 * truth.fourier(samples)[:count]
    coefficients[0] /= 2
    return lambda angle: float(np.real(coefficients @ np.exp(1j * np.arange(count) * angle)))


@row("Appendix 4 repaired listing")
def whole_programme(_):
    m = truth.motion(FIVE)
    f3, g = series(truth.coupler_functions(m)[3]), series(forcing(m, FIVE, 1))
    data = HillData(*FIVE, lamsq=9.3, mu=0.2)
    worst = []
    for repair in (("slope", "start", "turns", "end", "sine"), ()):

        def listed(x, y, repair=repair):
            factor, right = hill_parts(x, data, repair)
            return right - factor * y

        places, values = de_vogelaere(listed, 0.7, 0.1, 0.4, np.radians(1.0), 540, repair)
        true = reference(lambda x, y: g(x) - 9.3 * (1 + 0.2 * f3(x)) * y, 0.7, 0.1, 0.4, places)
        worst.append(np.abs(values - true).max())
    quoted(worst, "3.1e-6", "0.11")


test_row, test_falsified_row = row.tests()
