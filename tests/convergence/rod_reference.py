"""The flexible rod on a fixed mesh, from Newton's law: tip deflections to compare every basis with.

Run as a script it prints the table of tip deflections.

Newton's law, per length and across the line from the pin to the block, for a particle at the
distance x from the pin, v across, in axes that turn with phi(t):

    m (v_tt + x phi_tt - phi_t^2 v) = -EI v'''' + (N v')' + R delta(x - x1(t)).

Along the line ``N' = -m phi_t^2 x`` with ``N(L) = 0``, so ``N = m phi_t^2 (L^2 - x^2)/2``.  The
block's force R holds ``v(x1(t), t) = 0``.  Lengths over L, crank angle theta as the variable.

Nothing here moves with the block: quintic Hermite elements (value, slope, curvature at each node)
on a mesh that stays, finer where the block passes.  R is a Lagrange multiplier; its row holds the
shape functions at x1(theta) and moves across the elements.  Held at the level of places and of
speeds (a second multiplier, zero in the exact solution), of index 2; integrated by the Radau IIA
rule of order 5.  Rest, v = v_t = 0, meets both levels of the constraint as it stands, so nothing
has to be made consistent; phi_tt = 0 at theta = 0 makes the start smooth.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from beam_energies import monomials
from scipy.sparse.linalg import splu

INCH, POUND, POUND_FORCE = 0.0254, 0.45359237, 4.4482216152605


@dataclass(frozen=True)
class Rod:
    """Geometry, rod and crank speed, in SI units."""

    crank: float
    frame: float
    length: float
    bending_stiffness: float
    mass_per_length: float
    speed: float
    tension: bool = True

    @property
    def stiffness(self) -> float:
        """EI / (m L^4 speed^2)."""
        return self.bending_stiffness / (self.mass_per_length * self.length**4 * self.speed**2)


def flexible(ratio: float, speed: float, tension: bool = True) -> Rod:
    """The very flexible rod of Beale & Scott, section 2.1."""
    return Rod(ratio * 0.59997, 0.59997, 1.0, 0.7e11 * 0.5208e-6, 7.15, speed, tension)


def stiff() -> Rod:
    """The rod of Bahgat & Willmert, 0.1268 lbm/in read as a mass, 90 rad/s."""
    return Rod(
        1.5 * INCH,
        4.0 * INCH,
        9.3746 * INCH,
        2.91992e6 * POUND_FORCE * INCH**2,
        0.1268 * POUND / INCH,
        90.0,
    )


def kinematics(rod: Rod, theta: float) -> tuple[float, float, float, float]:
    """Return x1/L, its derivative, and two of phi, by theta: z = a + G exp(i theta)."""
    arm = rod.crank * np.exp(1j * theta) / rod.length
    z = rod.frame / rod.length + arm
    first = 1j * arm / z
    second = -arm / z - first**2
    place = abs(z)
    return place, place * first.real, first.imag, second.imag


class Mesh:
    """Quintic Hermite elements over 0 <= x <= 1, pinned at 0."""

    def __init__(self, nodes: np.ndarray) -> None:
        self.nodes = nodes
        ends = [monomials([s], 6, k)[0] for s in (0.0, 1.0) for k in range(3)]
        self.powers = np.linalg.inv(np.array(ends))
        self.size = 3 * len(nodes) - 1
        point, weight = np.polynomial.legendre.leggauss(7)
        point, weight = 0.5 * (point + 1), 0.5 * weight
        found = {name: sp.lil_matrix((self.size + 1,) * 2) for name in ("mass", "bend", "pull")}
        self.moment = np.zeros(self.size + 1)
        for e, (left, right) in enumerate(pairwise(nodes)):
            x, w = left + (right - left) * point, (right - left) * weight
            at = slice(3 * e, 3 * (e + 2))
            value, slope, bend = (self._local(e, point, k) for k in (0, 1, 2))
            found["mass"][at, at] += (value * w) @ value.T
            found["bend"][at, at] += (bend * w) @ bend.T
            found["pull"][at, at] += (slope * (w * (1 - x**2) / 2)) @ slope.T
            self.moment[at] += value @ (w * x)
        self.mass, self.bend, self.pull = (sp.csc_matrix(m)[1:, 1:] for m in found.values())
        self.moment = self.moment[1:]

    def _local(self, element: int, s: np.ndarray, times: int) -> np.ndarray:
        long = self.nodes[element + 1] - self.nodes[element]
        scale = np.tile(long ** np.arange(3), 2) / long**times
        return scale[:, None] * (monomials(s, 6, times) @ self.powers).T

    def row(self, x: float, times: int) -> sp.csr_matrix:
        """Return the shape functions, or a derivative, at a place as a sparse row."""
        element = int(np.clip(np.searchsorted(self.nodes, x, "right") - 1, 0, len(self.nodes) - 2))
        s = (x - self.nodes[element]) / (self.nodes[element + 1] - self.nodes[element])
        values = self._local(element, np.array([s]), times)[:, 0]
        columns = 3 * element - 1 + np.arange(2 * 3)
        kept = columns >= 0
        place = (np.zeros(kept.sum(), dtype=int), columns[kept])
        return sp.csr_matrix((values[kept], place), shape=(1, self.size))


def mesh_for(rod: Rod, fine: int, coarse: int = 12) -> Mesh:
    """Return ``fine`` elements where the block passes and about ``coarse`` on the rest."""
    low, high = (rod.frame - rod.crank) / rod.length, (rod.frame + rod.crank) / rod.length
    # A margin keeps the block away from the places where the element length jumps.
    margin = 0.02 * (high - low)
    low, high = low - margin, high + margin
    before = max(2, round(coarse * low / (1 - high + low)))
    after = max(2, coarse - before)
    parts = (
        np.linspace(0.0, low, before + 1)[:-1],
        np.linspace(low, high, fine + 1)[:-1],
        np.linspace(high, 1.0, after + 1),
    )
    return Mesh(np.concatenate(parts))


_S6 = np.sqrt(6.0)
_C = np.array([(4 - _S6) / 10, (4 + _S6) / 10, 1.0])
_A = np.array(
    [
        [(88 - 7 * _S6) / 360, (296 - 169 * _S6) / 1800, (-2 + 3 * _S6) / 225],
        [(296 + 169 * _S6) / 1800, (88 + 7 * _S6) / 360, (-2 - 3 * _S6) / 225],
        [(16 - _S6) / 36, (16 + _S6) / 36, 1 / 9],
    ]
)


def tip_motion(
    rod: Rod, mesh: Mesh, revolutions: int, steps: int, samples: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the deflections over L of the tip and, which should be zero, at the block, from rest.

    At ``samples`` even crank angles a revolution; ``steps`` of the Radau rule a revolution, a
    multiple of these.
    """
    n = mesh.size
    inertia = sp.block_diag([mesh.mass, mesh.mass, sp.csc_matrix((2, 2))], format="csc")
    step = 2 * np.pi / steps
    weights = np.linalg.inv(_A) / step
    storage = sp.kron(sp.csc_matrix(weights), inertia, format="csc")
    tip = mesh.row(1.0, 0)
    state = np.zeros(2 * n + 2)
    tips, held = [0.0], [0.0]
    for k in range(revolutions * steps):
        parts, loads = [], []
        for c in _C:
            part, load = _equations(rod, mesh, (k + c) * step)
            parts.append(part)
            loads.append(part @ state + load)
        matrix = storage - sp.block_diag(parts, format="csc")
        change = splu(matrix.tocsc()).solve(np.concatenate(loads))
        state = state + change[-(2 * n + 2) :]
        if (k + 1) % (steps // samples) == 0:
            place = kinematics(rod, (k + 1) * step)[0]
            tips.append(float((tip @ state[:n])[0]))
            held.append(float((mesh.row(place, 0) @ state[:n])[0]))
    return np.array(tips), np.array(held)


def _equations(rod: Rod, mesh: Mesh, theta: float) -> tuple[sp.csc_matrix, np.ndarray]:
    """Return matrix and load of ``inertia y' = matrix y + load``, y = (a, a', two multipliers)."""
    place, place_1, turn, turn_1 = kinematics(rod, theta)
    here, ahead = mesh.row(place, 0), mesh.row(place, 1)
    spring = rod.stiffness * mesh.bend - turn**2 * mesh.mass
    if rod.tension:
        spring = spring + turn**2 * mesh.pull
    matrix = sp.bmat(
        [
            [None, mesh.mass, here.T, None],
            [-spring, None, None, here.T],
            [here, None, None, None],
            [place_1 * ahead, here, None, None],
        ],
        format="csc",
    )
    load = np.zeros(2 * mesh.size + 2)
    load[mesh.size : 2 * mesh.size] = -turn_1 * mesh.moment
    return matrix, load


CASES = {
    "flexible, ratio 0.01, 100 rad/s": flexible(0.01, 100.0),
    "flexible, ratio 0.2, 300 rad/s": flexible(0.2, 300.0),
    "stiff, 90 rad/s": stiff(),
}
# Elements where the block passes, elements on the rest, steps a revolution.
EFFORT = {"flexible": (96, 16, 1600), "stiff": (48, 12, 6400)}
# Tip deflections v(L)/L from rest at crank angles pi/4, pi/2 ... 2 pi, with tension or not.
# Known to 5e-10 at ratio 0.2 and to 5e-11 else: an eighth of the change from half the elements and
# half the steps (the elements near the block converge in third order, the steps in fifth).
_TIPS = {
    ("flexible, ratio 0.01, 100 rad/s", True): (
        "8.727844473e-05 1.314370068e-04 9.474358088e-05 -1.430485840e-05 "
        "-1.210567202e-04 -1.513582184e-04 -9.582529733e-05 6.973050921e-06"
    ),
    ("flexible, ratio 0.01, 100 rad/s", False): (
        "8.727882385e-05 1.314370253e-04 9.474380409e-05 -1.430510876e-05 "
        "-1.210575585e-04 -1.513589371e-04 -9.582639130e-05 6.972173574e-06"
    ),
    ("flexible, ratio 0.2, 300 rad/s", True): (
        "2.368682027e-03 1.507538039e-02 5.222700332e-02 7.418780656e-02 "
        "-6.423087472e-02 -1.275204513e-01 1.045885837e-01 -8.629103295e-02"
    ),
    ("flexible, ratio 0.2, 300 rad/s", False): (
        "2.373776867e-03 1.511018969e-02 5.226948572e-02 7.608785717e-02 "
        "-6.033447582e-02 -1.309026097e-01 1.061002789e-01 -8.589334211e-02"
    ),
    ("stiff, 90 rad/s", True): (
        "6.107421323e-06 3.290465312e-05 1.417532977e-04 -3.426060007e-08 "
        "-1.417104760e-04 -3.293025608e-05 -6.081298181e-06 3.537151703e-08"
    ),
    ("stiff, 90 rad/s", False): (
        "6.107483373e-06 3.290474094e-05 1.417554085e-04 -3.435249003e-08 "
        "-1.417125824e-04 -3.293028452e-05 -6.081153584e-06 3.530829531e-08"
    ),
}
TIPS = {case: np.array(values.split(), dtype=float) for case, values in _TIPS.items()}


def main() -> None:
    """Print tip deflection over length at eight crank angles of the first revolution."""
    for name, case in CASES.items():
        for tension in (True, False):
            rod = replace(case, tension=tension)
            fine, coarse, steps = EFFORT[name.split(",")[0]]
            values, _ = tip_motion(rod, mesh_for(rod, fine, coarse), 1, steps, 8)
            rough, _ = tip_motion(rod, mesh_for(rod, fine // 2, coarse), 1, steps // 2, 8)
            print(name, "with tension" if tension else "as printed")
            print("   ", ", ".join(f"{v:.9e}" for v in values[1:]))
            print("    change from half the elements and steps:", np.max(np.abs(values - rough)))


if __name__ == "__main__":
    main()
