"""Parametric resonances of a linear periodic system: speeds where its mean exponents meet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import DAMPING, Array, LinearPeriodic
from ..core.inputs import is_whole, speed_span
from ..core.maxima import bracketed_roots
from ..periodic.equation import Equation, at_geometry, equation_of, sampled
from ..periodic.signatures import form_matrix

Complex = NDArray[np.complex128]
Kind = Literal["principal", "sum", "difference"]
# Kind, modes from 1, and harmonic.
Condition = tuple[Kind, tuple[int, int], int]

# Real part, over the modulus, up to which an exponent of the mean system counts as imaginary.
IMAGINARY = 1e-7


@dataclass(frozen=True)
class Resonance:
    """A crank speed at which exponents of the mean system meet.

    Attributes
    ----------
    kind : {"principal", "sum", "difference"}
        ``2 w_i = n w``, ``w_i + w_j = n w`` or ``w_i - w_j = n w``.
    modes : tuple of int
        Numbers (i, j) of the modes, from 1, by rising frequency; i = j where principal.
    harmonic : int
        n.
    speed : float
        The speed w [rad/s].
    frequencies : tuple of float
        Frequencies of the two modes of the mean system there [rad/s].
    signatures : tuple of int
        Krein signatures of the exponents that meet; (0, 0) where the system is not conservative.
    """

    kind: Kind
    modes: tuple[int, int]
    harmonic: int
    speed: float
    frequencies: tuple[float, float]
    signatures: tuple[int, int]

    @property
    def opens(self) -> bool:
        """False where Krein's theorem forbids instability: equal signatures meet."""
        return self.signatures == (0, 0) or self.signatures[0] != self.signatures[1]

    @property
    def label(self) -> str:
        """The condition in words, such as ``w1 + w2 = 3 w``."""
        i, j = self.modes
        right = "w" if self.harmonic == 1 else f"{self.harmonic} w"
        if self.kind == "principal":
            return f"2 w{i} = {right}"
        return f"w{i} {'+' if self.kind == 'sum' else '-'} w{j} = {right}"


class MeanSystem:
    """The undamped system with its coefficients replaced by their means over the period.

    ``parameters`` replace the system's own values.
    """

    def __init__(self, system: LinearPeriodic, parameters: Mapping[str, ArrayLike]) -> None:
        self.system, self._parameters = system, parameters
        self._known = sampled(system.without(*DAMPING))

    def modes(self, speed: Array) -> tuple[Array, NDArray[np.int64]]:
        """Return frequencies and Krein signatures of exp(i nu theta), ``(nb, n)``, nu rising.

        Of modes that do not oscillate, the first ones, nu is not a number and the signature 0.
        """
        equation = equation_of(self._known, speed, self._parameters)
        values, _, form = mean_exponents(equation)
        size = IMAGINARY * np.max(np.abs(values), axis=-1, keepdims=True)
        turning = (np.abs(values.real) <= size) & (values.imag > size)
        # Modes that do not oscillate are the lowest: the others keep their numbers.
        falling = np.where(turning, -values.imag, np.nan)
        rising = np.argsort(falling, axis=-1, kind="stable")[:, : self.system.size][:, ::-1]
        signs = np.take_along_axis(np.where(turning, form, 0.0), rising, axis=-1)
        return -np.take_along_axis(falling, rising, axis=-1), signs.astype(np.int64)

    def meetings(self, span: tuple[float, float], conditions: Sequence[Condition]) -> list[Array]:
        """Return all speeds in a span at which the two exponents of each condition meet, rising."""
        rows = [
            (i - 1, j - 1, kind == "difference", harmonic * 2 * np.pi / self.system.period)
            for kind, (i, j), harmonic in conditions
        ]
        first, second, minus, turns = (np.array(column) for column in zip(*rows, strict=True))
        grid = np.geomspace(*span, 400)
        nu, _ = self.modes(grid)
        value = nu[:, first] + np.where(minus, -1.0, 1.0) * nu[:, second] - turns
        with np.errstate(invalid="ignore"):
            passing = (value[:-1] * value[1:] <= 0) & (value[1:] != 0)
        which, change = np.nonzero(passing.T)
        if not len(which):
            return [np.zeros(0)] * len(conditions)

        def distance(index: NDArray[np.intp], at: Array) -> tuple[Array, float]:
            (nu, _), rows, condition = self.modes(at), np.arange(len(at)), which[index]
            other = nu[rows, second[condition]]
            both = nu[rows, first[condition]] + np.where(minus[condition], -other, other)
            return np.asarray(both - turns[condition]), 0.0

        values = value[change, which], value[change + 1, which]
        places = bracketed_roots(distance, grid[change], grid[change + 1], values)[0]
        # Where a mode ends, at a divergence, the numbers of the others jump.
        met = np.abs(distance(np.arange(len(places)), places)[0]) < 1e-7
        return [places[met & (which == k)] for k in range(len(conditions))]

    def described(
        self, kind: Kind, modes: tuple[int, int], harmonic: int, speed: float, conservative: bool
    ) -> Resonance:
        """Return the record of one meeting, with frequencies and signatures."""
        (nu,), (signs,) = self.modes(np.array([speed]))
        i, j = modes[0] - 1, modes[1] - 1
        second = int(signs[j]) if kind == "difference" else -int(signs[j])
        return Resonance(
            kind=kind,
            modes=modes,
            harmonic=harmonic,
            speed=speed,
            frequencies=(float(nu[i] * speed), float(nu[j] * speed)),
            signatures=(int(signs[i]), second) if conservative else (0, 0),
        )


def mean_exponents(equation: Equation) -> tuple[Complex, Complex, Array]:
    """Return exponents and vectors of the mean equation y' = L y, and signs of their Krein form.

    y = (q, p) in the units of the equation; with its means M, A and B - K.
    """
    mass, gyro, push = (equation.mean(name) for name in ("mass", "gyroscopic", "stiffness"))
    flexibility = np.linalg.inv(mass)
    back = np.swapaxes(gyro, -1, -2) @ flexibility
    generator = np.block([[-flexibility @ gyro, flexibility], [push - back @ gyro, back]])
    values, vectors = (part.astype(complex) for part in np.linalg.eig(generator))
    form = np.diagonal(form_matrix(vectors), axis1=-2, axis2=-1).real
    return values, vectors, np.sign(form)


def resonances(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    kinds: Sequence[Kind] = ("principal", "sum", "difference"),
    highest: int = 12,
    **parameters: float,
) -> list[Resonance]:
    """Return where exponents of the mean system meet, by falling speed.

    Parameters
    ----------
    system : LinearPeriodic
        The system.  Its coefficients are averaged over the period, damping is left out.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s].
    kinds : sequence of str
        Any of "principal", "sum", "difference".
    highest : int
        Highest harmonic n.
    **parameters : float
        Parameter values that replace the system's own; geometry too.

    Returns
    -------
    list of Resonance
        With Krein signatures where the system is conservative.

    Raises
    ------
    BadInput
        If an argument is unusable.

    Notes
    -----
    Smith, chapter 9, suggestion 1.

    Examples
    --------
    >>> import elastolink as el
    >>> system = el.load_scene("smith_1972_5152_sixteenth_inch").system()
    >>> for resonance in el.stability.resonances(system, (75.0, 85.0)):
    ...     print(resonance.label, round(resonance.speed, 2))
    2 w1 = 4 w 83.05
    """
    span = speed_span(speed_range)
    if not is_whole(highest, 1):
        raise bad("highest", highest, "a whole number of at least 1", "choose 12")
    if not isinstance(kinds, tuple | list):
        raise bad("kinds", repr(kinds), "a tuple of principal, sum or difference", "correct it")
    wrong = sorted(str(kind) for kind in kinds if kind not in get_args(Kind))
    if wrong:
        raise bad("kinds", wrong, "principal, sum or difference", "correct the name")
    system, values = at_geometry(system, parameters)
    mean = MeanSystem(system, values)
    undamped = conservative(system, span[0], values)
    conditions: list[Condition] = [
        (kind, (i, j) if kind == "difference" else (j, i), n)
        for i in range(1, system.size + 1)
        for j in range(1, i + 1)
        for kind in kinds
        if (kind == "principal") == (i == j)
        for n in range(1, highest + 1)
    ]
    places = mean.meetings(span, conditions) if conditions else []
    out = [
        mean.described(*condition, float(at), undamped)
        for condition, met in zip(conditions, places, strict=True)
        for at in met
    ]
    return sorted(out, key=lambda item: (-item.speed, item.modes, item.kind))


def conservative(system: LinearPeriodic, speed: float, parameters: Mapping[str, ArrayLike]) -> bool:
    """Return True where the system without its damping terms has a symplectic flow."""
    return not equation_of(system.without(*DAMPING), speed, parameters).damped
