"""A linear periodic system as a power series in one of its lengths or ratios, about zero."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import bad
from ..core.families import Array, LinearPeriodic, Term
from ..core.inputs import require_whole

ComplexArray = NDArray[np.complex128]

# Places on either side of zero at which the system is made, and angles at which it is sampled.
_PLACES, _ANGLES = 12, 256
_HIGHEST = 10
_ROUNDING = 16 * float(np.finfo(float).eps)
# Largest last Chebyshev coefficient, relatively, of terms that their series follows.
_TAIL = 1e-9


def taylor_in_geometry(
    system: LinearPeriodic, name: str, order: int, *, reach: float = 0.03
) -> LinearPeriodic:
    """Return the system with each term a power series in a geometry value, now a parameter.

    Every term's function of the angle is sampled at Chebyshev's places between ``-reach`` and
    ``reach``; the Taylor coefficients at 0 are those of the polynomial through the samples, with
    exact weights.  Each is kept as the finite Fourier series that it is.  A negative value stands
    for the positive one half a period later, as of a crank; that the samples of both sides follow
    one polynomial proves that this is so.  What comes out is for
    :func:`~.tongues.series.tongue` with ``parameter=(name, values)``: a small-parameter expansion
    of any mechanism, without a formula for it.

    Parameters
    ----------
    system : LinearPeriodic
        With that geometry; it need not exist at 0 itself, only close to it.
    name : str
        Name of the geometry value, such as ``crank_ratio``.
    order : int
        Highest power kept, 1 to 10; a tongue of order p looks at p + 2.
    reach : float
        Up to which value the system is sampled; well within the radius of convergence.

    Returns
    -------
    LinearPeriodic
        Parameters: the system's own and ``name``; no geometry.

    Raises
    ------
    BadInput
        If the name or a number is not usable, or a term does not follow a polynomial up to
        ``reach``: too large a reach, or a geometry value whose sign is not half a turn.

    Notes
    -----
    Beale & Scott 1992, section 3.1, whose reference [1] expands by hand.
    """
    if name not in system.geometry:
        raise bad("name", repr(name), f"one of {sorted(system.geometry)}", "correct it")
    if name in system.parameters:
        raise bad("name", repr(name), "no parameter of the same name", "rename it")
    require_whole("order", order, 1, _HIGHEST, "choose 4")
    if not (np.isfinite(reach) and reach > 0.0):
        raise bad("reach", reach, "a finite number above 0", "choose 0.2")
    count = 2 * _PLACES
    places = reach * np.cos((np.arange(count) + 0.5) * np.pi / count)
    made = [system.with_geometry(**{name: float(place)}) for place in places[:_PLACES]]
    weights = _weights(places, order)
    theta = system.period * np.arange(_ANGLES) / _ANGLES
    terms: list[Term] = []
    for column, term in enumerate(system.terms):
        like = [one.terms[column] for one in made]
        if any((t.array, t.scale, t.power) != (term.array, term.scale, term.power) for t in like):
            raise bad(name, "terms that come and go with it", "the same terms", "choose another")
        right = np.array([np.array(t(theta), dtype=float) for t in like])
        samples = np.concatenate([right, np.roll(right[::-1], _ANGLES // 2, axis=1)])
        rest = _followed(samples, name, reach, term)
        terms += _expanded(term, samples, rest, weights, name, system.period)
    return replace(
        system,
        terms=tuple(terms),
        parameters={**system.parameters, name: float(system.geometry[name])},
        scales=partial(_scales, system.scales, tuple(system.parameters), name, order),
        geometry={},
        rebuild=None,
        moving_shape=None,
        provenance={**system.provenance, "expanded": f"{name} to order {order}"},
    )


def _weights(places: Array, order: int) -> Array:
    """Return what takes values at the places to Taylor coefficients at 0, ``(order + 1, m)``.

    The coefficients of Lagrange's polynomials, in exact arithmetic.
    """
    nodes = [Fraction(float(place)) for place in places]
    out = np.zeros((order + 1, len(nodes)))
    for j, own in enumerate(nodes):
        powers = [Fraction(1)]
        for i, other in enumerate(nodes):
            if i == j:
                continue
            scaled = [value / (own - other) for value in powers]
            moved = [Fraction(0), *scaled]
            powers = [a - other * b for a, b in zip(moved, [*scaled, Fraction(0)], strict=True)]
        out[:, j] = [float(value) for value in powers[: order + 1]]
    return out


def _followed(samples: Array, name: str, reach: float, term: Term) -> float:
    """Return the last Chebyshev coefficient of a term; raise where it is not small."""
    count = len(samples)
    angle = (np.arange(count) + 0.5) * np.pi / count
    last = 2.0 / count * np.tensordot(np.cos((count - 1) * angle), samples, axes=1)
    size = float(np.max(np.abs(samples), initial=0.0))
    tail = float(np.max(np.abs(last), initial=0.0))
    if not tail <= _TAIL * size:
        raise bad(
            "reach",
            f"{reach:g}, up to which term {term.array} ({term.scale}) follows no polynomial of "
            f"degree {count - 1} in {name} through zero (rest {tail / max(size, 1e-300):.1g})",
            "a reach well within the radius of convergence, and a sign that is half a turn",
            "choose a smaller one",
        )
    return tail


def _expanded(
    term: Term, samples: Array, rest: float, weights: Array, name: str, period: float
) -> list[Term]:
    """Return the terms of the powers of one term, finite Fourier series of the angle each."""
    size = float(np.max(np.abs(samples), initial=0.0))
    found = []
    for power, row in enumerate(weights):
        values = np.tensordot(row, samples, axes=1)
        noise = (_ROUNDING * size + 4 * rest) * float(np.sum(np.abs(row)))
        waves = np.fft.rfft(values, axis=0) / len(values)
        waves[1:] *= 2.0
        amplitude = np.max(np.abs(waves.reshape(len(waves), -1)), axis=1)
        kept = np.flatnonzero(amplitude > noise)
        if not len(kept):
            continue
        waves = waves[: int(kept[-1]) + 1]
        waves[np.abs(waves) <= noise] = 0.0
        function: Callable[[Array], Array] | Array = waves[0].real
        if len(waves) > 1:
            function = partial(_series, waves, 2 * np.pi / period)
        found.append(Term(term.array, _label(term.scale, name, power), function, term.power))
    return found


def _series(waves: ComplexArray, turning: float, theta: Array) -> Array:
    """Return the real part of ``sum_k waves[k] exp(i k turning theta)``."""
    turns = np.exp(1j * turning * np.multiply.outer(theta, np.arange(len(waves))))
    value: Array = np.tensordot(turns, waves, axes=1).real
    return value


def _label(scale: str | None, name: str, power: int) -> str | None:
    """Return the name of a monomial times a power."""
    if power == 0:
        return scale
    own = f"{name}**{power}"
    return own if scale is None else f"{scale} {own}"


def _scales(
    old: Callable[[Mapping[str, ArrayLike]], Mapping[str, Array]],
    names: tuple[str, ...],
    name: str,
    order: int,
    values: Mapping[str, ArrayLike],
) -> Mapping[str, Array]:
    """Return the monomials of the system, alone and times each power."""
    own = dict(old({key: values[key] for key in names}))
    out: dict[str, Array] = dict(own)
    base = np.asarray(values[name], dtype=float)
    for power in range(1, order + 1):
        factor = base**power
        out[f"{name}**{power}"] = factor
        for key, value in own.items():
            out[f"{key} {name}**{power}"] = value * factor
    return out
