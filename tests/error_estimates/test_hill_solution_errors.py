"""Error estimates of periodic solutions on boundaries, against Hill's matrix in 500 bits.

The reference eliminates all unknowns but those of ``k = n/2`` at the boundary itself, as
``boundary_truth`` does for its place, and puts them back.
"""

import mpmath
import numpy as np
from boundary_truth import ONE, combined, fixed, hill_rows, near, solutions
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.periodic_function import PeriodicFunction
from elastolink.runtime.hill import boundary_solution, hill_boundaries
from honesty import extended, over_scenes

pytestmark = extended
THETA = np.linspace(0.0, 4.0 * np.pi, 61)


def scene(rng, strongest):
    """Return functions, parameters, region, end and damping."""
    count = 1 + int(rng.random() < 0.2)
    functions = []
    for _ in range(count):
        highest = int(rng.choice([1, 2, 4, 8]))
        a, b = rng.normal(size=(2, highest + 1)) * rng.uniform(0.3, 0.8) ** np.arange(highest + 1)
        b[0] = 0.0
        b *= rng.random() > 0.25  # even ones
        if rng.random() < 0.2:  # of period pi: every other region is closed
            a[1::2] = b[1::2] = 0.0
        functions.append(PeriodicFunction(a, b))
    mu = [float(10.0 ** rng.uniform(-6.0, strongest) * rng.choice([-1, 1])) for _ in functions]
    n = int(rng.integers(0, 7))
    end = "upper" if n == 0 else str(rng.choice(["lower", "upper"]))
    damping = 0.0 if rng.random() < 0.6 else float(10.0 ** rng.uniform(-8.0, -0.5))
    return functions, mu, n, end, damping


def as_long(values):
    high = np.array([float(v) for v in values])
    rest = np.array([float(v - h) for v, h in zip(values, high, strict=True)])
    return high.astype(np.longdouble) + rest


def orthonormal(columns):
    found = []
    for column in columns:
        for _ in range(2):
            for other in found:
                column = column - other * np.sum(other * column)
        found.append(column / np.sum(column * column) ** 0.5)
    return np.stack([as_long(column) for column in found], axis=-1)


def exact_solutions(given, found):
    """Return 2 k and kinds, and the solution, or where degenerate those of both ends.

    As columns of unit length, of coefficients that weigh alike in the mean square.
    """
    functions, mu, n, end, damping = given
    seen = np.flatnonzero(np.hypot(found.a, found.b) > 1e-14)[-1]
    # A way beyond these and back is 1e-28 of the coupling of the pair.
    reach = int(seen) + 1 + max(f.harmonics for f in functions)
    rows = hill_rows(*combined(functions, mu), fixed(damping), n % 2, reach)
    whole = sum((f * m for f, m in zip(functions[1:], mu[1:], strict=True)), functions[0] * mu[0])
    place = fixed(getattr(hill_boundaries(whole, 1.0, (n,), damping), end).item())
    ends = near(rows, n, place)
    if not ends:
        return None
    if not found.degenerate:
        # Nearer than this to each other they come in their order.
        close = ends[-1] - ends[0] < max(ONE, abs(place)) // 10**11
        own = ends[0 if end == "lower" else -1]
        ends = [own if close else min(ends, key=lambda x: abs(x - place))]
    scale = [mpmath.mpf(1 if k2 == 0 else 0.5) ** 0.5 for k2, _ in rows]
    every = solutions(rows, n, ends[0])
    if len(every) < len(ends):
        every += solutions(rows, n, ends[1])
    columns = [np.array(list(v.values())) * scale for v in every]
    return np.array(list(rows)), orthonormal(columns)


def compared(given, order):
    """Return the estimate and the largest deviation of a solution; None where there is none."""
    functions, mu, n, end, damping = given
    try:
        found = boundary_solution(functions, mu, n, end, order, damping)
    except BadInput as refusal:
        assert "closed by damping" in str(refusal) or "converge visibly" in str(refusal)
        return None
    with mpmath.workdps(100):
        exact = exact_solutions(given, found)
    if exact is None:
        return None
    (k2, sine), basis = exact[0].T, exact[1]
    scale = np.where(k2 == 0, 1.0, np.sqrt(np.longdouble(0.5)))
    kept = k2 // 2 < len(found.a)
    ours = np.zeros_like(scale)
    ours[kept] = np.stack([found.a, found.b])[sine[kept], k2[kept] // 2] * scale[kept]
    shares = basis.T @ ours
    nearest = basis @ (shares if found.degenerate else np.sign(shares))
    phase = np.multiply.outer(THETA.astype(np.longdouble), 0.5 * k2.astype(np.longdouble))
    values = np.where(sine, np.sin(phase), np.cos(phase)) @ (nearest / scale)
    return found.error, float(np.max(np.abs(found(THETA) - values)))


@over_scenes(61, floor=1e-17)
def test_exact_solutions(rng):
    return compared(scene(rng, 2.0), None)


@over_scenes(62, floor=1e-17)
def test_solutions_to_an_order(rng):
    return compared(scene(rng, 0.0), int(rng.integers(1, 9)))
