"""Small linear periodic systems, and how far two of their motions differ."""

from dataclasses import replace

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term
from elastolink.runtime.core.trigonometric import even_angles, interpolated, resampled
from elastolink.runtime.periodic import floquet_multipliers
from elastolink.runtime.periodic.equation import equation_of


def named(names):
    """Return scale factors that are the parameters themselves."""
    return lambda values: {name: np.asarray(values[name], dtype=float) for name in names}


def wave(matrix, harmonic=1, phase=0.0):
    """Return a matrix, or a vector, times a cosine of the crank angle."""
    flat = (1,) * np.ndim(matrix)
    return lambda theta: np.cos(harmonic * theta + phase).reshape(-1, *flat) * np.array(matrix)


def system_of(numbers=None, /, period=2 * np.pi, **arrays) -> LinearPeriodic:
    """Return the system of arrays by name: matrices, or functions of the crank angle.

    ``("k", array)`` is scaled by the parameter k of ``numbers``, ``("k", array, 1)`` by a power of
    the speed too; a list is a sum.
    """
    numbers = dict(numbers or {})
    sums = {name: parts if isinstance(parts, list) else [parts] for name, parts in arrays.items()}
    terms = [
        Term(name, *(part if isinstance(part, tuple) else (None, part)))
        for name, parts in sums.items()
        for part in parts
    ]
    size = next(term(np.zeros(1)).shape[-1] for term in terms if term.array == "M")
    return LinearPeriodic(size, tuple(terms), numbers, named(numbers), period=period)


def mathieu(period=2 * np.pi, **values) -> LinearPeriodic:
    """y'' + 2 K y' + (lam2 + mu cos(2 pi theta / period)) y = 0 at every speed."""
    return system_of(
        {"lam2": 1.3, "mu": 0.4, "K2": 0.0, **values},
        period,
        M=np.eye(1),
        K=("lam2", np.eye(1), 2),
        Kg=("mu", wave(np.eye(1), 2 * np.pi / period), 2),
        C=("K2", np.eye(1), 1),
    )


def forced_mathieu(**changes) -> LinearPeriodic:
    """q'' + c q' + (k + mu cos theta) q = 1/(1.5 - cos theta), theta = speed t."""
    made = system_of(
        {"k": 9.3, "mu": 1.4, "c": 0.2, **changes},
        M=np.eye(1),
        K=("k", np.eye(1)),
        Kg=("mu", wave(np.eye(1))),
        C=("c", np.eye(1)),
        p=lambda theta: (1 / (1.5 - np.cos(theta)))[:, None],
    )
    return replace(made, reference_length=2.0, shape=lambda x: 1e-4 * x[:, None])


def every_term(**changes):
    """Two modes with periodic mass, Coriolis, centrifugal and axial terms, all times eps."""
    return system_of(
        {"eps": 0.0, "c": 0.0, **changes},
        M=[np.array([[2.0, 0.3], [0.3, 1.0]]), ("eps", wave([[0.3, 0.1], [0.1, 0.2]], 1, 0.3))],
        A=[np.array([[0.1, -0.2], [0.3, 0.0]]), ("eps", wave([[0.1, 0.2], [-0.1, 0.1]], 2, 1.0))],
        B=[np.array([[0.1, 0.05], [0.05, -0.2]]), ("eps", wave([[0.2, 0.1], [0.1, -0.3]]))],
        K=np.array([[20.0, 3.0], [3.0, 9.0]]),
        Kg=("eps", wave([[2.0, 1.0], [1.0, 3.0]], 1, -0.4)),
        C=("c", np.array([[0.4, 0.1], [0.1, 0.3]])),
    )


def coupled_pair(coupling, sign=1.0, damping=0.0) -> LinearPeriodic:
    """1 and 2.3 rad/s, coupled by cos theta; ``sign`` is the Hamiltonian sign of the second."""
    return system_of(
        {"c": damping},
        M=np.eye(2),
        K=np.diag([1.0, 2.3**2]),
        Kg=wave(coupling * np.array([[0.0, 1.0], [sign, 0.0]])),
        C=("c", np.eye(2)),
    )


def is_growing(system, speed, limit, **parameters):
    """Return where a multiplier is larger than 1 by more than a limit."""
    values = floquet_multipliers(system, speed, rtol=1e-13, **parameters).multipliers
    return np.max(np.abs(values), axis=-1) > 1 + limit


def peak_gap(found, other):
    """Return the largest difference of each coordinate over its peak, at common angles."""
    count = max(len(found.theta), len(other.theta))
    one, two = resampled(found.q, count), resampled(other.q, count)
    return np.max(np.abs(one - two), axis=0) / np.max(np.abs(two), axis=0)


def hamiltonian_gap(system, speed, angles):
    """Return how far J L is from symmetric, entries over their natural sizes."""
    flow = equation_of(system, speed).generator(angles)[0]
    n = system.size
    unit = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    hamiltonian = unit @ flow
    odd = np.abs(hamiltonian - np.swapaxes(hamiltonian, -1, -2))
    return float(np.max(odd) / np.max(np.abs(hamiltonian)))


def second_order(system, theta, speed, acceleration=0.0):
    """Return at angles, ``(nt, ...)``, the matrices of q, qd and qdd and the force of a system.

    ``M qdd + (C + w G) qd + (K + Kg + w D + w^2 H + a E) q = w^2 f + w h + a g + p`` with
    G = M' + A - A^T, H = A' - B, E = A - S.  Speed w and acceleration a are numbers, or one for
    each angle; derivatives by the crank angle are those of Fourier series.
    """
    theta = np.atleast_1d(theta)
    w, a = (np.broadcast_to(v, theta.shape)[:, None] for v in (speed, acceleration))
    f, h, g, p = (system.array(name, theta, w) for name in "fhgp")
    force = w**2 * f + w * h + a * g + p
    w, a = w[..., None], a[..., None]

    def at(name):
        return system.array(name, theta, w)

    def slope(name):
        angles = even_angles(system.period, 1024)
        return interpolated(system.array(name, angles), system.period).derivative(theta)

    drift = at("A")
    stiffness = at("K") + at("Kg") + w * at("D")
    stiffness += w**2 * (slope("A") - at("B")) + a * (drift - at("S"))
    damping = at("C") + w * (slope("M") + drift - np.swapaxes(drift, 1, 2))
    return stiffness, damping, at("M"), force
