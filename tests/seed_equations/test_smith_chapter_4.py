"""Smith chapter 4: accelerations, pin forces, torque, and what the linkage does to its frame."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from seed_ledger import Ledger, hold, holds
from seed_rigid import GRAVITY, SMITH_LENGTHS, Link, forces, smith_links
from seed_truth import CRANK_ROCKERS, DRAG_LINK, LONG_CRANK, motion, turning

row = Ledger("Smith", __file__)
SPEED, UNSTEADY = 10.0, 0.2
LINKS = tuple(
    Link(m, s, inertia=i) for m, s, i in ((0.7, 1.3, 4.0), (1.1, 2.7, 9.0), (0.9, -1.6, 6.5))
)
KINDS = (
    (SMITH_LENGTHS, "open"),
    (SMITH_LENGTHS, "crossed"),
    (CRANK_ROCKERS["5,1,5,2"], "open"),
    (LONG_CRANK, "crossed"),
    (DRAG_LINK, "open"),
)


@cache
def moving():
    """Return motion, accelerations and forces of each linkage at uneven speed."""
    points = []
    for lengths, assembly in KINDS:
        point = turning(lengths, motion(lengths, assembly, unsteady=UNSTEADY), SPEED)
        f = forces(lengths, LINKS, SPEED, assembly, UNSTEADY)
        for i, link in enumerate(LINKS, 2):
            at, r = getattr(f, f"a{i}"), link.centre[0]
            point |= {f"M{i}": link.mass, f"m{i}": link.mass, f"r{i}": r, f"r{i}_dot": r}
            point |= {f"a_{i}x": at.real, f"a_{i}y": at.imag}
        point |= {"alpha_4x": point["a_4x"], "alpha_4y": point["a_4y"]}
        for pin in ("12", "23", "34", "41"):
            force = getattr(f, f"f{pin}")
            point |= {f"X{pin}": force.real, f"Y{pin}": force.imag}
        point |= dict(zip(("I_2A", "I_3B", "I_4D"), (k.inertia for k in LINKS), strict=True))
        frame = {"X_Frame": f.shaking_force.real, "Y_Frame": f.shaking_force.imag}
        points.append({**point, **frame, "T": f.torque, "M_Frame": f.moment})
    return points


def close(ours, theirs):
    """Compare complex arrays by the greatest of the second."""
    return np.abs(ours - theirs).max() < 1e-9 * np.abs(theirs).max()


true = holds(moving)
row(*(f"4.{k}" for k in range(1, 13)), check=true)


@row("4.2 X_ij = -X_ji")
def action_and_reaction(_):
    """A link's neighbours push it with opposite forces: momentum of the three moving links."""
    for p in moving():
        total = sum(p[f"M{i}"] * (p[f"a_{i}x"] + 1j * p[f"a_{i}y"]) for i in (2, 3, 4))
        assert close(p["X12"] - p["X41"] + 1j * (p["Y12"] - p["Y41"]), total)


@row("4.13")
def moment_on_the_frame(entry):
    true(replace(entry, printed=None))
    f = forces(SMITH_LENGTHS, smith_links(), SPEED)
    printed = entry.printed.values(l1=SMITH_LENGTHS[0], Y41=f.f41.imag)["M_Frame"]
    sizes = [np.abs(v).max() for v in (f.moment, printed, f.torque)]
    assert sizes == pytest.approx([44.1, 61.0, 33.1], abs=0.06)


def smith_forces(links=None):
    """Return forces for the linkage of Figs. 12-16 at 10 rad/s, and the crank angles [deg]."""
    found = forces(SMITH_LENGTHS, links or smith_links(), SPEED)
    return found, np.degrees(motion(SMITH_LENGTHS).theta2)


@row("4.1 inertia of the coupler and follower only")
def what_the_crank_adds(_):
    _, coupler, follower = smith_links()
    with_crank, _ = smith_forces()
    without, _ = smith_forces((Link(), coupler, follower))
    for name in ("f23", "f34", "f41", "torque"):
        assert close(getattr(without, name), getattr(with_crank, name))
    own = 0.5 / GRAVITY * 3.0 * SPEED**2
    for name, peak in (("f12", 8.51), ("shaking_force", 6.50)):
        difference = np.abs(getattr(with_crank, name) - getattr(without, name))
        assert difference == pytest.approx(np.full(difference.size, own), rel=1e-6)
        assert np.abs(getattr(with_crank, name)).max() == pytest.approx(peak, abs=0.006)
    assert own == pytest.approx(0.389, abs=6e-4)


@row("4.2 completely general")
def centre_beside_the_line(_):
    crank, coupler, follower = smith_links()
    inertia = coupler.inertia + coupler.mass
    beside, flat = (Link(coupler.mass, coupler.along, s, inertia) for s in (coupler.mass, 0.0))
    true, _ = smith_forces((crank, beside, follower))
    printed, _ = smith_forces((crank, flat, follower))
    for name, size in (("torque", 0.083), ("f23", 0.061)):
        a, b = getattr(true, name), getattr(printed, name)
        assert np.abs(a - b).max() / np.abs(a).max() == pytest.approx(size, abs=6e-4)
    m = motion(SMITH_LENGTHS)
    more = beside.across * SMITH_LENGTHS[1] * SPEED**2 * np.cos(m.theta2 - m.theta3)
    divisor = SMITH_LENGTHS[2] * np.sin(m.theta3 - m.theta4)
    assert close(printed.f34 + more * np.exp(1j * m.theta4) / divisor, true.f34)


@row("4.2 inertia in the data of Figs. 12-16")
def inertia_of_the_uniform_bars(entry):
    data = entry.printed.values()
    uniform = Link.uniform_bar(1.0 / GRAVITY, 12.0)
    hold(entry.corrected, {"W3": 1, "l3": 12, "g": GRAVITY, "I_3B": uniform.inertia}, tol=2e-4)
    assert data["I_3B"] / uniform.inertia - 1 == pytest.approx(0.0054, abs=6e-5)
    links = [smith_links()[0]]
    for weight, inertia in (("W3", "I_3B"), ("W4", "I_4D")):
        mass = data[weight] / GRAVITY
        assert Link.uniform_bar(data[weight] / 384, 12.0).inertia == pytest.approx(
            data[inertia], rel=1e-12
        )
        links.append(Link(mass, 6 * mass, inertia=data[inertia]))
    data, _ = smith_forces(links)
    exact, _ = smith_forces((smith_links()[0], uniform, uniform))
    rise = [
        np.abs(getattr(data, name)).max() / np.abs(getattr(exact, name)).max() - 1
        for name in ("f12", "f23", "f34", "f41")
    ]
    assert [min(rise), max(rise)] == pytest.approx([0.0030, 0.0046], abs=6e-5)


@row("4.2 maxima near theta2 = 0")
def places_of_the_greatest_forces(_):
    f, degrees = smith_forces()
    m = motion(SMITH_LENGTHS)
    values = [np.abs(v) for v in (f.f12, f.f23, f.f34, f.f41, m.alpha4)]
    step = 360.0 / degrees.size
    places = [degrees[v.argmax()] for v in values]
    assert places == pytest.approx([17.6, 17.6, 17.6, 20.4, 20.4], abs=step)
    assert [v[0] / v.max() for v in values[1:]] == pytest.approx([0.42, 0.26, 0.06, 0.31], abs=0.01)
    assert int(np.abs(np.sin(m.theta4 - m.theta3)).argmin()) == 0


@row("4.2 growth with the crank length")
def growth_with_the_crank(_):
    peaks = [
        np.abs(forces((12.0, crank, 12.0, 12.0), smith_links(), SPEED).f41).max()
        for crank in (2.0, 4.0, 6.0, 8.0)
    ]
    assert peaks == pytest.approx([0.448, 1.612, 5.134, 23.50], rel=2e-3)
    assert np.all(np.diff(np.log(peaks)) > np.log(2.0))


test_row, test_falsified_row = row.tests()
