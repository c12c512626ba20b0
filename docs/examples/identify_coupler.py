"""Identify a coupler from speeds: stiffness EI, mass per length and damping of one of Smith's rigs.

Linkage (10, 1, 10, 4), coupler 1/32 in thick.  His text quotes six crank speeds for it, at two
follower inertias: resonances at Omega/2, and the region 2 Omega/3, passed at the lower inertia and
unstable at the higher one.  The boundaries of these regions depend on two unknown numbers, the
natural frequency Omega (their place) and the mass per length m (their width and shift, through
I4/m); EI follows from both.  Damping follows from which region it keeps closed.

Six speeds are few: the last lines tell what each number becomes when one of them is left out.
Omega hardly moves; m and K hang on one observation, the onset at 450 rpm.
"""

import elastolink as el
import numpy as np
from scipy.optimize import least_squares

RPM = np.pi / 30.0
SCENE = "smith_1972_101104_thirtysecond_inch"
LBF_IN_S2 = 0.45359237 * 9.80665 * 0.0254  # kg m^2
LOW, HIGH = 0.0058 * LBF_IN_S2, 0.0079 * LBF_IN_S2

# Follower inertia, region n of 2 Omega/n, where in the region, crank speed in rpm (section 9.5.3).
OBSERVED = (
    (HIGH, 4, "middle", 350.0),
    (LOW, 4, "middle", 360.0),
    (HIGH, 4, "middle", 360.0),
    (LOW, 3, "middle", 460.0),
    (LOW, 3, "upper", 480.0),
    (HIGH, 3, "lower", 450.0),
)


class Rig:
    """The rig's boundaries as functions of the two unknowns.

    Attributes
    ----------
    frequency, mass : float
        Omega [rad/s] and mass per length [kg/m] of the scene: the first guess.
    """

    def __init__(self, formulation):
        scene = el.load_scene(SCENE, overrides={"model.formulation": formulation})
        self.form = el.hill_form(scene.system())
        self.frequency = scene["coupler"]["natural_frequency"]
        self.mass = scene["coupler"]["mass_per_length"]
        self.length = scene["links"]["coupler"]

    def function(self, inertia, mass):
        """Return the periodic coefficient: it knows the follower's inertia over m alone."""
        return self.form.function(1.0, follower_inertia=inertia * self.mass / mass)

    def speeds(self, frequency, mass, rows):
        """Return the predicted crank speeds [rpm] of observations."""
        found = []
        for inertia, n, where, _ in rows:
            edges = el.hill_boundaries(self.function(inertia, mass), 1.0, (n,))
            low, high = frequency / np.sqrt([edges.upper[0], edges.lower[0]]) / RPM
            found.append({"lower": low, "upper": high, "middle": 0.5 * (low + high)}[where])
        return np.array(found)

    def stiffness(self, frequency, mass):
        """Return EI [N m^2] of the pinned coupler."""
        return mass * frequency**2 * (self.length / np.pi) ** 4


def fit(rig, rows):
    """Return Omega, m, their relative deviations, and the scatter of the speeds."""
    seen = np.array([speed for *_, speed in rows])

    def misfit(logarithms):
        frequency, mass = np.exp(logarithms) * (rig.frequency, rig.mass)
        return rig.speeds(frequency, mass, rows) / seen - 1.0

    found = least_squares(misfit, np.zeros(2), x_scale=0.1, xtol=1e-12)
    scatter = np.sqrt(np.sum(found.fun**2) / (len(seen) - 2))
    deviation = scatter * np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))
    frequency, mass = np.exp(found.x) * (rig.frequency, rig.mass)
    return frequency, mass, deviation, scatter


def damping(rig, mass):
    """Bracket K: region 3 was stable at the lower inertia and unstable at the higher one."""
    return [
        float(el.critical_damping(rig.function(inertia, mass), 1.0, (3,)).damping[0])
        for inertia in (LOW, HIGH)
    ]


def identify(formulation):
    """Fit Omega and m, and bracket K: a record of plain numbers."""
    rig = Rig(formulation)
    frequency, mass, deviation, scatter = fit(rig, OBSERVED)
    without = [fit(rig, OBSERVED[:i] + OBSERVED[i + 1 :])[:2] for i in range(len(OBSERVED))]
    brackets = [damping(rig, other) for _, other in without]
    low, high = damping(rig, mass)
    return {
        "Omega/2 pi [Hz]": frequency / (2.0 * np.pi),
        "its deviation": deviation[0],
        "m [kg/m]": mass,
        "m's deviation": deviation[1],
        "EI [N m^2]": rig.stiffness(frequency, mass),
        "K from": low,
        "K to": high,
        "scatter of the speeds": scatter,
        "one left out: Omega from": min(w for w, _ in without) / (2.0 * np.pi),
        "one left out: Omega to": max(w for w, _ in without) / (2.0 * np.pi),
        "one left out: m from": min(m for _, m in without),
        "one left out: m to": max(m for _, m in without),
        "one left out: K from": min(k for k, _ in brackets),
        "one left out: K to": max(k for _, k in brackets),
    }


if __name__ == "__main__":
    for formulation in ("reduced", "complete"):
        print(formulation)
        for name, value in identify(formulation).items():
            print(f"  {name:24s} {value:.4g}")
