"""Smith chapter 4: accelerations, pin forces, torque, and what the linkage does to its frame."""

import numpy as np
import pytest
import sympy as sp
from seed_derivations import ACCELERATIONS, ANGLES, LENGTHS, SPEEDS
from seed_ledger import establishes
from seed_rigid import (
    GRAVITY,
    SMITH_LENGTHS,
    Link,
    centres,
    forces,
    motion,
    rate,
    smith_links,
)
from seed_rigid_derivations import (
    INERTIAS,
    MASSES,
    RADII,
    X12,
    X23,
    X34,
    X41,
    Y12,
    Y23,
    Y34,
    Y41,
    T,
    centre_accelerations,
    newton_euler,
    solution,
    substituted,
)
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK

SPEED, UNSTEADY, COUNT = 10.0, 0.2, 1024
LINKS = (Link(0.7, 1.3, 4.0), Link(1.1, 2.7, 9.0), Link(0.9, -1.6, 6.5))
KINDS = [
    (SMITH_LENGTHS, "open"),
    (SMITH_LENGTHS, "crossed"),
    (CRANK_ROCKERS["5,1,5,2"], "open"),
    (LONG_CRANK, "crossed"),
    (DRAG_LINK, "open"),
]
# Second spectral derivatives of 1024 samples leave this much of the greatest value.
TIGHT = 2e-8
every_kind = pytest.mark.parametrize(("lengths", "assembly"), KINDS)


def truth(lengths, assembly, links=LINKS):
    """Return the forces by Newton and Euler at uneven crank speed."""
    return forces(lengths, links, SPEED, assembly, UNSTEADY, COUNT)


def moving(lengths, assembly):
    """Return angles, speeds and accelerations at the true crank speed."""
    m = motion(lengths, assembly, COUNT, UNSTEADY)
    angles = (m.theta2, m.theta3, m.theta4)
    speeds = tuple(SPEED * value for value in (m.omega2, m.omega3, m.omega4))
    return angles, speeds, tuple(SPEED**2 * value for value in (m.alpha2, m.alpha3, m.alpha4))


def printed_accelerations(lengths, links, assembly):
    """Return (4.1)-(4.3) as complex numbers a_x + i a_y."""
    angles, speeds, spins = moving(lengths, assembly)
    radii = [link.along / link.mass for link in links]

    def turning(radius, i):
        across = -radius * (speeds[i] ** 2 * np.sin(angles[i]) - spins[i] * np.cos(angles[i]))
        along = -radius * (speeds[i] ** 2 * np.cos(angles[i]) + spins[i] * np.sin(angles[i]))
        return along + 1j * across

    crank = turning(radii[0], 0)
    coupler = lengths[1] / radii[0] * crank + turning(radii[1], 1)
    return crank, coupler, turning(radii[2], 2)


def close(ours, theirs):
    """Compare complex arrays by the greatest of the second."""
    return np.abs(ours - theirs).max() < TIGHT * np.abs(theirs).max()


def latex_of(*unknowns):
    """Return the solved forms of some unknowns."""
    return ",\\; ".join(f"{sp.latex(name)} = {sp.latex(solution()[name])}" for name in unknowns)


def rows_latex(i):
    """Return the three equations of a link, moments about its centre of mass."""
    return ",\\; ".join(f"{sp.latex(row)} = 0" for row in newton_euler()[3 * i : 3 * i + 3])


def acceleration_latex(i):
    """Return the derived acceleration of a centre of mass."""
    return ",\\; ".join(
        f"a_{{{i + 2}{axis}}} = {sp.latex(part)}"
        for axis, part in zip("xy", centre_accelerations()[i], strict=True)
    )


@establishes(
    "Smith",
    "4.1",
    printed=r"a_{2x} = -r_2(\omega_2^2\cos\theta_2 + \alpha_2\sin\theta_2),\; "
    r"a_{2y} = -r_2(\omega_2^2\sin\theta_2 - \alpha_2\cos\theta_2)",
    verdict="agrees",
    derived=lambda: acceleration_latex(0),
)
@establishes(
    "Smith",
    "4.2",
    printed=r"a_{3x} = \frac{\ell_2}{r_2}a_{2x} - r_3(\omega_3^2\cos\theta_3 + "
    r"\alpha_3\sin\theta_3),\; a_{3y} = \frac{\ell_2}{r_2}a_{2y} - r_3(\omega_3^2\sin\theta_3 - "
    r"\alpha_3\cos\theta_3)",
    verdict="agrees",
    derived=lambda: acceleration_latex(1),
    remark="The form with l2/r2 fails for the balanced crank of chapter 5, r2 = 0; the other "
    "holds.",
)
@establishes(
    "Smith",
    "4.3",
    printed=r"a_{4x} = -r_4(\omega_4^2\cos\theta_4 + \alpha_4\sin\theta_4),\; "
    r"a_{4y} = -r_4(\omega_4^2\sin\theta_4 - \alpha_4\cos\theta_4)",
    verdict="agrees",
    derived=lambda: acceleration_latex(2),
)
@every_kind
def test_accelerations_of_the_centres(lengths, assembly):
    places = centres(lengths, LINKS, motion(lengths, assembly, COUNT, UNSTEADY))
    radii = [link.along / link.mass for link in LINKS]
    values = (*lengths, *radii, *(v for group in moving(lengths, assembly) for v in group))
    symbols = (*LENGTHS, *RADII, *ANGLES, *SPEEDS, *ACCELERATIONS)
    printed = printed_accelerations(lengths, LINKS, assembly)
    for place, ours, derived in zip(places, printed, centre_accelerations(), strict=True):
        true = rate(place, 2) * SPEED**2
        assert close(ours, true)
        along, across = sp.lambdify(symbols, derived)(*values)
        assert close(along + 1j * across, true)


@establishes(
    "Smith",
    "4.4",
    printed=r"X_{12} - X_{23} = M_2 a_{2x},\; Y_{12} - Y_{23} = M_2 a_{2y},\; "
    r"T + X_{23}\ell_2\sin\theta_2 - Y_{23}\ell_2\cos\theta_2 = I_{2A}\alpha_2",
    verdict="agrees",
    derived=lambda: rows_latex(0),
)
@establishes(
    "Smith",
    "4.5",
    printed=r"X_{23} - X_{34} = M_3 a_{3x},\; Y_{23} - Y_{34} = M_3 a_{3y},\; "
    r"X_{23}r_3\sin\theta_3 - Y_{23}r_3\cos\theta_3 + X_{34}(\ell_3 - r_3)\sin\theta_3 - "
    r"Y_{34}(\ell_3 - r_3)\cos\theta_3 = (I_{3B} - M_3 r_3^2)\alpha_3",
    verdict="agrees",
    derived=lambda: rows_latex(1),
)
@establishes(
    "Smith",
    "4.6",
    printed=r"X_{34} - X_{41} = M_4\alpha_{4x},\; Y_{34} - Y_{41} = M_4\alpha_{4y},\; "
    r"-X_{34}\ell_4\sin\theta_4 + Y_{34}\ell_4\cos\theta_4 = I_{4D}\alpha_4",
    verdict="agrees",
    derived=lambda: rows_latex(2),
    remark="The scan has the letter of an angular acceleration; a_4x and a_4y are meant.",
)
@every_kind
def test_equations_of_each_link(lengths, assembly):
    _, l2, l3, l4 = lengths
    f = truth(lengths, assembly)
    angles, _, spins = moving(lengths, assembly)
    crank, coupler, follower = LINKS
    accelerations = printed_accelerations(lengths, LINKS, assembly)
    assert close(f.f12 - f.f23, crank.mass * accelerations[0])
    assert close(f.f23 - f.f34, coupler.mass * accelerations[1])
    assert close(f.f34 - f.f41, follower.mass * accelerations[2])
    sine, cosine = np.sin(angles), np.cos(angles)
    r3 = coupler.along / coupler.mass
    x23, y23, x34, y34 = f.f23.real, f.f23.imag, f.f34.real, f.f34.imag
    crank_moment = f.torque + x23 * l2 * sine[0] - y23 * l2 * cosine[0]
    size = np.abs(f.torque).max()
    assert np.abs(crank_moment - crank.inertia * spins[0]).max() < TIGHT * size
    moment = x23 * r3 * sine[1] - y23 * r3 * cosine[1]
    moment += (x34 * sine[1] - y34 * cosine[1]) * (l3 - r3)
    about_centre = coupler.inertia - coupler.mass * r3**2
    assert np.abs(moment - about_centre * spins[1]).max() < TIGHT * size
    moment = -x34 * l4 * sine[2] + y34 * l4 * cosine[2]
    assert np.abs(moment - follower.inertia * spins[2]).max() < TIGHT * size


def printed_solution(lengths, links, assembly):
    """Return (4.7)-(4.11): the pin forces as complex numbers and the torque."""
    _, l2, l3, l4 = lengths
    (th2, th3, th4), (w2, w3, w4), (a2, a3, a4) = moving(lengths, assembly)
    m2, m3, m4 = (link.mass for link in links)
    r2, r3, r4 = (link.along / link.mass for link in links)
    i2a, i3b, i4d = (link.inertia for link in links)
    bracket = w2**2 * np.sin(th2 - th3) - a2 * np.cos(th2 - th3)
    x34, y34 = (
        (
            i3b * a3 * l4 * trig(th4)
            + i4d * a4 * l3 * trig(th3)
            - m3 * r3 * l2 * l4 * trig(th4) * bracket
        )
        / (l3 * l4 * np.sin(th3 - th4))
        for trig in (np.cos, np.sin)
    )
    x23 = x34 - m3 * (
        l2 * w2**2 * np.cos(th2)
        + l2 * a2 * np.sin(th2)
        + r3 * w3**2 * np.cos(th3)
        + r3 * a3 * np.sin(th3)
    )
    y23 = y34 - m3 * (
        l2 * w2**2 * np.sin(th2)
        - l2 * a2 * np.cos(th2)
        + r3 * w3**2 * np.sin(th3)
        - r3 * a3 * np.cos(th3)
    )
    x12 = -m2 * (r2 * w2**2 * np.cos(th2) + r2 * a2 * np.sin(th2)) + x23
    y12 = -m2 * (r2 * w2**2 * np.sin(th2) - r2 * a2 * np.cos(th2)) + y23
    x41 = m4 * (r4 * w4**2 * np.cos(th4) + r4 * a4 * np.sin(th4)) + x34
    y41 = m4 * (r4 * w4**2 * np.sin(th4) - r4 * a4 * np.cos(th4)) + y34
    torque = i2a * a2 + y23 * l2 * np.cos(th2) - x23 * l2 * np.sin(th2)
    return {
        "f34": x34 + 1j * y34,
        "f23": x23 + 1j * y23,
        "f12": x12 + 1j * y12,
        "f41": x41 + 1j * y41,
        "torque": torque,
    }


@establishes(
    "Smith",
    "4.7",
    printed=r"X_{34} = \frac{I_{3B}\alpha_3\ell_4\cos\theta_4 + I_{4D}\alpha_4\ell_3\cos\theta_3 - "
    r"m_3 r_3\ell_2\ell_4\cos\theta_4[\omega_2^2\sin(\theta_2 - \theta_3) - \alpha_2\cos(\theta_2 "
    r"- \theta_3)]}{\ell_3\ell_4\sin(\theta_3 - \theta_4)},\; Y_{34} \text{ with sines}",
    verdict="agrees",
    derived=lambda: latex_of(X34, Y34),
    remark="Every term and sign, at uneven crank speed, both assemblies, a drag link included.",
)
@establishes(
    "Smith",
    "4.8",
    printed=r"X_{23} = -m_3(\ell_2\omega_2^2\cos\theta_2 + \ell_2\alpha_2\sin\theta_2 + "
    r"r_3\omega_3^2\cos\theta_3 + r_3\alpha_3\sin\theta_3) + X_{34},\; "
    r"Y_{23} = -m_3(\ell_2\omega_2^2\sin\theta_2 - \ell_2\alpha_2\cos\theta_2 + "
    r"r_3\omega_3^2\sin\theta_3 - r_3\alpha_3\cos\theta_3) + Y_{34}",
    verdict="agrees",
    derived=lambda: latex_of(X23, Y23),
)
@establishes(
    "Smith",
    "4.9",
    printed=r"X_{12} = -m_2(\dot r_2\omega_2^2\cos\theta_2 + \dot r_2\alpha_2\sin\theta_2) + "
    r"X_{23},\; Y_{12} = -m_2(\dot r_2\omega_2^2\sin\theta_2 - \dot r_2\alpha_2\cos\theta_2) + "
    r"Y_{23}",
    verdict="agrees",
    derived=lambda: (
        f"X_{{12}} - X_{{23}} = {sp.latex(sp.expand(solution()[X12] - solution()[X23]))},\\; "
        f"Y_{{12}} - Y_{{23}} = {sp.latex(sp.expand(solution()[Y12] - solution()[Y23]))}"
    ),
    remark="r_2 without the dot of the scan.",
)
@establishes(
    "Smith",
    "4.10",
    printed=r"X_{41} = m_4(\dot r_4\omega_4^2\cos\theta_4 + \dot r_4\alpha_4\sin\theta_4) + "
    r"X_{34},\; Y_{41} = m_4(\dot r_4\omega_4^2\sin\theta_4 - \dot r_4\alpha_4\cos\theta_4) + "
    r"Y_{34}",
    verdict="agrees",
    derived=lambda: latex_of(X41, Y41),
    remark="r_4 without the dot of the scan.",
)
@establishes(
    "Smith",
    "4.11",
    printed=r"T = I_{2A}\alpha_2 + Y_{23}\ell_2\cos\theta_2 - X_{23}\ell_2\sin\theta_2",
    verdict="agrees",
    derived=lambda: latex_of(T),
    remark="T omega2 is the rate of the kinetic energy, to round-off.",
)
@every_kind
def test_closed_solution(lengths, assembly):
    f = truth(lengths, assembly)
    for name, ours in printed_solution(lengths, LINKS, assembly).items():
        assert close(ours, getattr(f, name)), name
    _, speeds, _ = moving(lengths, assembly)
    assert np.abs(f.torque * speeds[0] - f.energy_rate).max() < TIGHT * np.abs(f.energy_rate).max()


@every_kind
def test_machine_solution(lengths, assembly):
    f = truth(lengths, assembly)
    radii = [link.along / link.mass for link in LINKS]
    symbols = (*LENGTHS, *MASSES, *RADII, *INERTIAS, *ANGLES, *SPEEDS, *ACCELERATIONS)
    masses, inertias = [k.mass for k in LINKS], [k.inertia for k in LINKS]
    motions = [v for group in moving(lengths, assembly) for v in group]
    unknowns = [substituted(name) for name in (X12, Y12, X23, Y23, X34, Y34, X41, Y41, T)]
    found = sp.lambdify(symbols, unknowns)(*lengths, *masses, *radii, *inertias, *motions)
    for i, true in enumerate((f.f12, f.f23, f.f34, f.f41)):
        assert close(found[2 * i] + 1j * found[2 * i + 1], true)
    assert close(found[8], f.torque)


@establishes(
    "Smith",
    "4.2 X_ij = -X_ji",
    printed=r"X_{ij} = -X_{ji} \text{ for } i, j = 1, 2, 3, 4",
    verdict="agrees",
)
@establishes(
    "Smith",
    "4.12",
    printed=r"X_{Frame} = X_{41} - X_{12} = -(M_2 a_{2x} + M_3 a_{3x} + M_4 a_{4x}),\; "
    r"Y_{Frame} \text{ likewise}",
    verdict="agrees",
    derived=lambda: "X_{Frame} = " + sp.latex(sp.expand(substituted(X41) - substituted(X12))),
)
@establishes(
    "Smith",
    "4.13",
    printed=r"M_{Frame} = Y_{41}\ell_1",
    verdict="slip",
    derived=r"M_{Frame} = Y_{41}\ell_1 - T = -\frac{dH_A}{dt}",
    remark="The frame carries the reaction of the drive as well. Linkage of Figs. 12-16 at 10 "
    "rad/s: greatest true moment 44.1 lbf in, printed 61.0 lbf in; the torque left out "
    "reaches 33.1.",
)
@every_kind
def test_force_and_moment_on_the_frame(lengths, assembly):
    f = truth(lengths, assembly)
    accelerations = printed_accelerations(lengths, LINKS, assembly)
    inertia_force = -sum(k.mass * a for k, a in zip(LINKS, accelerations, strict=True))
    assert close(f.f41 - f.f12, inertia_force)
    whole = f.f41.imag * lengths[0] - f.torque
    assert close(whole, -f.momentum_rate)
    assert not np.allclose(f.f41.imag * lengths[0], -f.momentum_rate, rtol=0.1)
    smith = forces(SMITH_LENGTHS, smith_links(), SPEED)
    sizes = (smith.momentum_rate, smith.f41.imag * SMITH_LENGTHS[0], smith.torque)
    assert [np.abs(v).max() for v in sizes] == pytest.approx([44.1, 61.0, 33.1], abs=0.06)


def smith_forces(links=None):
    """Return forces for the linkage of Figs. 12-16 at 10 rad/s, and the crank angles [deg]."""
    found = forces(SMITH_LENGTHS, links or smith_links(), SPEED)
    return found, np.degrees(motion(SMITH_LENGTHS).theta2)


@establishes(
    "Smith",
    "4.1 inertia of the coupler and follower only",
    printed=r"\text{constant input: forces due to the inertia of coupler and follower only}",
    verdict="slip",
    derived=r"F_{23}, F_{34}, F_{41}, T;\; \text{but } F_{12} \text{ and the force on the frame "
    r"hold } -M_2 r_2\omega_2^2",
    remark="The crank's own weight gives 0.389 lbf of F12 and of the force on the frame in Figs. "
    "12-16, whose peaks are 8.5 and 6.5 lbf. His (4.9) has the term.",
)
def test_what_the_crank_adds():
    _, coupler, follower = smith_links()
    with_crank, _ = smith_forces()
    without, _ = smith_forces((Link(1e-12, 0.0, 0.0), coupler, follower))
    for name in ("f23", "f34", "f41", "torque"):
        assert close(getattr(without, name), getattr(with_crank, name))
    own = 0.5 / GRAVITY * 3.0 * SPEED**2
    for name, peak in (("f12", 8.51), ("shaking_force", 6.50)):
        difference = np.abs(getattr(with_crank, name) - getattr(without, name))
        assert difference == pytest.approx(np.full(difference.size, own), rel=1e-6)
        assert np.abs(getattr(with_crank, name)).max() == pytest.approx(peak, abs=0.006)
    assert own == pytest.approx(0.389, abs=6e-4)


@establishes(
    "Smith",
    "4.2 completely general",
    printed=r"\text{(4.7)-(4.13) are a completely general inertia force analysis}",
    verdict="slip",
    derived=r"\text{centre } s_3 \text{ beside BC: } -m_3\ell_2\left[r_3(\omega_2^2\sin("
    r"\theta_2 - \theta_3) - \alpha_2\cos(\theta_2 - \theta_3)) - s_3(\omega_2^2"
    r"\cos(\theta_2 - \theta_3) + \alpha_2\sin(\theta_2 - \theta_3))\right]",
    remark="General for links whose centre lies on the line of their pins. A coupler of Figs. "
    "12-16 with its centre 1 in. beside BC: torque wrong by 8 percent of its peak, F23 by 6 "
    "percent.",
)
def test_centre_beside_the_line():
    crank, coupler, follower = smith_links()
    beside = Link(coupler.mass, coupler.along, coupler.inertia + coupler.mass, coupler.mass)
    flat = Link(coupler.mass, coupler.along, coupler.inertia + coupler.mass)
    true, _ = smith_forces((crank, beside, follower))
    printed, _ = smith_forces((crank, flat, follower))
    for name, size in (("torque", 0.083), ("f23", 0.061)):
        a, b = getattr(true, name), getattr(printed, name)
        assert np.abs(a - b).max() / np.abs(a).max() == pytest.approx(size, abs=6e-4)
    m = motion(SMITH_LENGTHS)
    more = beside.across * SMITH_LENGTHS[1] * SPEED**2 * np.cos(m.theta2 - m.theta3)
    divisor = SMITH_LENGTHS[2] * np.sin(m.theta3 - m.theta4)
    assert close(printed.f34 + more * np.exp(1j * m.theta4) / divisor, true.f34)


@establishes(
    "Smith",
    "4.2 inertia in the data of Figs. 12-16",
    printed=r"W_3 = W_4 = 1\text{ lbf},\; I_{3B} = I_{4D} = 0.125\text{ lbf in s}^2",
    verdict="approximation",
    derived=r"\frac{W\ell^2}{3g} = \frac{48}{g} = 0.1243\text{ at } g = 386.09\text{ in/s}^2",
    remark="A uniform bar's only with g = 384 in/s^2: 0.54 percent too much, which raises the "
    "greatest pin forces by 0.30 to 0.46 percent.",
)
def test_inertia_of_the_uniform_bars():
    uniform = Link.bar(1.0 / GRAVITY, 12.0)
    assert 0.125 / uniform.inertia - 1 == pytest.approx(0.0054, abs=6e-5)
    assert Link.bar(1.0 / 384.0, 12.0).inertia == pytest.approx(0.125, rel=1e-12)
    data, _ = smith_forces()
    exact, _ = smith_forces((smith_links()[0], uniform, uniform))
    rise = [
        np.abs(getattr(data, name)).max() / np.abs(getattr(exact, name)).max() - 1
        for name in ("f12", "f23", "f34", "f41")
    ]
    assert [min(rise), max(rise)] == pytest.approx([0.0030, 0.0046], abs=6e-5)


@establishes(
    "Smith",
    "4.2 maxima near theta2 = 0",
    printed=r"\text{the maxima of the forces occur in the region of } \theta_2 = 0",
    verdict="approximation",
    derived=r"\theta_2 = 17.6^\circ\ldots 20.4^\circ \text{ for (12,6,12,12)}",
    remark="The follower's acceleration peaks at 20.4 deg and is a third of that at 0; there F41 "
    "has 6 percent of its peak and F23 42 percent. Only the transmission angle is least at 0.",
)
def test_places_of_the_greatest_forces():
    f, degrees = smith_forces()
    m = motion(SMITH_LENGTHS)
    values = [np.abs(v) for v in (f.f12, f.f23, f.f34, f.f41, m.alpha4)]
    step = 360.0 / degrees.size
    places = [degrees[v.argmax()] for v in values]
    assert places == pytest.approx([17.6, 17.6, 17.6, 20.4, 20.4], abs=step)
    assert [v[0] / v.max() for v in values[1:]] == pytest.approx([0.42, 0.26, 0.06, 0.31], abs=0.01)
    assert int(np.abs(np.sin(m.theta4 - m.theta3)).argmin()) == 0


@establishes(
    "Smith",
    "4.2 growth with the crank length",
    printed=r"\text{pin forces grow rapidly with the crank (Figs. 17-19)}",
    verdict="agrees",
    derived=r"\max F_{41} = 0.45,\; 1.61,\; 5.13,\; 23.5\text{ lbf for } "
    r"\ell_2 = 2, 4, 6, 8\text{ in}",
    remark="For the other data of Figs. 12-16; the lengths of Figs. 17-19 are lost with the "
    "pictures.",
)
def test_growth_with_the_crank():
    peaks = [
        np.abs(forces((12.0, crank, 12.0, 12.0), smith_links(), SPEED).f41).max()
        for crank in (2.0, 4.0, 6.0, 8.0)
    ]
    assert peaks == pytest.approx([0.448, 1.612, 5.134, 23.50], rel=2e-3)
    assert np.all(np.diff(np.log(peaks)) > np.log(2.0))
