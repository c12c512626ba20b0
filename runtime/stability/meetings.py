"""Parametric resonances of a linear periodic system: speeds where its mean exponents meet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..core.errors import bad
from ..core.families import LinearPeriodic
from ..core.inputs import is_whole, numbers
from ..core.trigonometric import even_angles
from ..periodic.equation import SPEED_POWER, equation_of
from ..periodic.signatures import form_matrix

Array = NDArray[np.float64]
Kind = Literal["principal", "sum", "difference"]
# Kind, modes from 1, and harmonic.
Condition = tuple[Kind, tuple[int, int], int]

_GRID = 400
_ARRAYS = ("M", "A", "B", "K", "Kg")
# Real part, over the modulus, up to which an exponent of the mean system counts as imaginary.
IMAGINARY = 1e-7


@dataclass(frozen=True)
class Resonance:
    """A speed (or parameter value) at which exponents of the mean system meet.

    Attributes
    ----------
    kind : {"principal", "sum", "difference"}
        ``2 w_i = n w``, ``w_i + w_j = n w`` or ``w_i - w_j = n w``.
    modes : tuple of int
        Numbers (i, j) of the modes, from 1, by rising frequency; i = j where principal.
    harmonic : int
        n.
    speed : float
        The speed w [rad/s], or the value of the detuned parameter.
    frequencies : tuple of float
        Frequencies of the two modes of the mean system there [rad/s].
    signatures : tuple of int
        Krein signatures of the exponents that meet; (0, 0) where the system is not conservative.
    detuning : str
        What ``speed`` is a value of: "speed" or a parameter's name.
    """

    kind: Kind
    modes: tuple[int, int]
    harmonic: int
    speed: float
    frequencies: tuple[float, float]
    signatures: tuple[int, int]
    detuning: str = "speed"

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

    def at(self, value: float) -> dict[str, float]:
        """Return a value of the detuned parameter by name; nothing where that is the speed."""
        return {} if self.detuning == "speed" else {self.detuning: value}


class MeanSystem:
    """The undamped system with its coefficients replaced by their means over the period.

    ``parameters`` replace the system's own values; ``detuning`` is "speed" or the parameter that is
    varied, at the crank speed ``speed`` [rad/s].
    """

    def __init__(
        self,
        system: LinearPeriodic,
        parameters: Mapping[str, float],
        detuning: str = "speed",
        speed: float = 1.0,
    ) -> None:
        self.system, self.parameters = system, dict(parameters)
        self.detuning, self.speed = detuning, speed
        count = 1024 if any(not term.constant for term in system.terms) else 1
        theta = even_angles(system.period, count)
        self._means = [
            (term, np.asarray(term(theta[:1] if term.constant else theta), dtype=float).mean(0))
            for term in system.terms
            if term.array in _ARRAYS
        ]

    def _generator(self, at: Array) -> Array:
        """Return L at values of the detuned quantity ``(nb,)``, shape ``(nb, 2n, 2n)``."""
        n = self.system.size
        speed = at if self.detuning == "speed" else np.full(len(at), self.speed)
        varied = {} if self.detuning == "speed" else {self.detuning: at}
        scales = self.system.scale_values(**self.parameters, **varied)
        total = {name: np.zeros((len(at), n, n)) for name in ("M", "A", "B", "K")}
        for term, mean in self._means:
            factor = 1.0 if term.scale is None else scales[term.scale]
            factor = factor * speed ** float(SPEED_POWER[term.array] + term.power)
            total["K" if term.array == "Kg" else term.array] += factor[:, None, None] * mean
        return generator(total["M"], total["A"], total["B"] - total["K"])

    def frequencies(self, at: Array) -> Array:
        """Return frequencies in radians per radian of crank angle, rising; ``(nb, n)``.

        Not a number for modes that do not oscillate, the first ones.
        """
        values = np.linalg.eigvals(self._generator(at)).astype(complex)
        upper = np.where(_turning(values), values.imag, np.nan)
        # Modes that do not oscillate are the lowest: the others keep their numbers.
        rising: Array = -np.sort(-upper, axis=-1)[:, : self.system.size][:, ::-1]
        return rising

    def modes(self, at: float) -> tuple[Array, NDArray[np.int64]]:
        """Return frequencies and Krein signatures of exp(i nu theta) at one value, ``(n,)``."""
        n = self.system.size
        values, vectors = np.linalg.eig(self._generator(np.array([at]))[0])
        kept = np.flatnonzero(_turning(values))
        kept = kept[np.argsort(values.imag[kept], kind="stable")]
        form = np.diagonal(form_matrix(vectors[:, kept].astype(complex))).real
        nu, signs = np.full(n, np.nan), np.zeros(n, dtype=np.int64)
        nu[n - len(kept) :], signs[n - len(kept) :] = values.imag[kept], np.sign(form)
        return nu, signs

    def meetings(self, span: tuple[float, float], conditions: Sequence[Condition]) -> list[Array]:
        """Return all values in a span at which the two exponents of each condition meet, rising."""
        first, second, minus, turns = (
            np.array(column)
            for column in zip(
                *(
                    (i - 1, j - 1, kind == "difference", harmonic * 2 * np.pi / self.system.period)
                    for kind, (i, j), harmonic in conditions
                ),
                strict=True,
            )
        )

        def distance(at: Array, which: NDArray[np.intp]) -> Array:
            nu, rows = self.frequencies(at), np.arange(len(at))
            other = nu[rows, second[which]]
            both = nu[rows, first[which]] + np.where(minus[which], -other, other)
            return np.asarray(both - turns[which])

        grid = np.geomspace(*span, _GRID) if span[0] > 0 else np.linspace(*span, _GRID)
        nu = self.frequencies(grid)
        value = nu[:, first] + np.where(minus, -1.0, 1.0) * nu[:, second] - turns
        with np.errstate(invalid="ignore"):
            passing = (value[:-1] * value[1:] <= 0) & (value[1:] != 0)
        which, change = np.nonzero(passing.T)
        low, high = grid[change], grid[change + 1]
        sign = np.sign(value[change + 1, which])
        for _ in range(60):
            middle = (low + high) / 2
            above = np.sign(distance(middle, which)) == sign
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        places: Array = (low + high) / 2
        # Where a mode ends, at a divergence, the numbers of the others jump.
        met = np.abs(distance(places, which)) < 1e-7
        return [places[met & (which == k)] for k in range(len(conditions))]

    def described(
        self, kind: Kind, modes: tuple[int, int], harmonic: int, at: float, conservative: bool
    ) -> Resonance:
        """Return the record of one meeting, with frequencies and signatures."""
        nu, signs = self.modes(at)
        speed = at if self.detuning == "speed" else self.speed
        i, j = modes[0] - 1, modes[1] - 1
        second = int(signs[j]) if kind == "difference" else -int(signs[j])
        return Resonance(
            kind=kind,
            modes=modes,
            harmonic=harmonic,
            speed=at,
            frequencies=(float(nu[i] * speed), float(nu[j] * speed)),
            signatures=(int(signs[i]), second) if conservative else (0, 0),
            detuning=self.detuning,
        )


def generator(mass: Array, gyro: Array, push: Array) -> Array:
    """Return L of y' = L y, y = (q, p), of mean M, A and B - K; shape ``(nb, 2n, 2n)``."""
    flexibility = np.linalg.inv(mass)
    back = np.swapaxes(gyro, -1, -2) @ flexibility
    return np.block([[-flexibility @ gyro, flexibility], [push - back @ gyro, back]])


def _turning(values: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """Return True for exponents i nu with nu > 0, of eigenvalues along the last axis."""
    size = IMAGINARY * np.max(np.abs(values), axis=-1, keepdims=True)
    return np.asarray((np.abs(values.real) <= size) & (values.imag > size))


def resonances(
    system: LinearPeriodic,
    speed_range: tuple[float, float],
    *,
    kinds: Sequence[Kind] = ("principal", "sum", "difference"),
    highest: int = 12,
    detuning: str = "speed",
    speed: float = 1.0,
    **parameters: float,
) -> list[Resonance]:
    """Return where exponents of the mean system meet, by falling speed.

    Parameters
    ----------
    system : LinearPeriodic
        The system.  Its coefficients are averaged over the period, damping is left out.
    speed_range : pair of float
        Lowest and highest crank speed [rad/s], or value of the parameter ``detuning``.
    kinds : sequence of str
        Any of "principal", "sum", "difference".
    highest : int
        Highest harmonic n.
    detuning : str
        "speed", or a parameter to be varied at constant ``speed``.
    speed : float
        Crank speed [rad/s] where a parameter is varied.
    **parameters : float
        Parameter values that replace the system's own.

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
    """
    span = _checked_span(speed_range, detuning)
    if not is_whole(highest, 1):
        raise bad("highest", highest, "a whole number of at least 1", "choose 12")
    if not isinstance(kinds, tuple | list):
        raise bad("kinds", repr(kinds), "a tuple of principal, sum or difference", "correct it")
    wrong = sorted(str(kind) for kind in kinds if kind not in get_args(Kind))
    if wrong:
        raise bad("kinds", wrong, "principal, sum or difference", "correct the name")
    varied = {} if detuning == "speed" else {detuning: span[0]}
    where = span[0] if detuning == "speed" else speed
    equation_of(system, where, {**parameters, **varied})
    mean = MeanSystem(system, parameters, detuning, speed)
    undamped = conservative(system, where, {**parameters, **varied})
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
    out.sort(key=lambda item: (-item.speed, item.modes, item.kind))
    return out


def conservative(system: LinearPeriodic, speed: float, parameters: Mapping[str, float]) -> bool:
    """Return True where the system without its damping terms has a symplectic flow."""
    theta = even_angles(system.period, 8)
    b, k, g = (system.array(name, theta, speed, **parameters) for name in ("B", "K", "Kg"))
    return all(
        float(np.max(np.abs(value - np.swapaxes(value, -1, -2))))
        <= 1e-13 * float(np.max(np.abs(value)))
        for value in (b, k + g)
    )


def _checked_span(span: tuple[float, float], detuning: str) -> tuple[float, float]:
    values = numbers("speed_range", span)
    good = values.shape == (2,) and bool(np.all(np.isfinite(values))) and values[0] < values[1]
    if not good or (detuning == "speed" and not values[0] > 0):
        raise bad("speed_range", span, "(low, high) with low < high, speeds positive", "correct it")
    return float(values[0]), float(values[1])
