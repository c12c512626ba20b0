"""A linear periodic system as a power series in one of its lengths or ratios, about zero."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term

PLACES, ANGLES, REACH = 24, 256, 0.03


def taylor_in_geometry(system: LinearPeriodic, name: str, order: int) -> LinearPeriodic:
    """Return the system with each term a power series in a geometry value, now a parameter.

    Every term's function of the angle is sampled at Chebyshev's places between -0.03 and 0.03; a
    negative value stands for the positive one half a period later, as of a crank.  The Taylor
    coefficients at 0 are those of the polynomial through the samples, kept as the finite Fourier
    series that they are.
    """
    angle = (np.arange(PLACES) + 0.5) * np.pi / PLACES
    made = [system.with_geometry(**{name: p}) for p in REACH * np.cos(angle[: PLACES // 2])]
    theta = system.period * np.arange(ANGLES) / ANGLES
    # From values at the places to Chebyshev coefficients to powers of the value.
    chebyshev = 2.0 / PLACES * np.cos(np.multiply.outer(np.arange(PLACES), angle))
    chebyshev[0] /= 2.0
    powers = np.zeros((PLACES, PLACES))
    for k in range(PLACES):
        powers[: k + 1, k] = np.polynomial.chebyshev.cheb2poly(np.eye(PLACES)[k])[: k + 1]
    weights = (powers @ chebyshev)[: order + 1] / REACH ** np.arange(order + 1)[:, None]
    terms = []
    for column, term in enumerate(system.terms):
        right = np.array([one.terms[column](theta) for one in made])
        samples = np.concatenate([right, np.roll(right[::-1], ANGLES // 2, axis=1)])
        rest = np.max(np.abs(np.tensordot(chebyshev[-1], samples, axes=1)))
        for power, row in enumerate(weights):
            waves = np.fft.rfft(np.tensordot(row, samples, axes=1), axis=0) / ANGLES
            waves[1:] *= 2.0
            size = 4e-15 * np.max(np.abs(samples)) + 4 * rest
            waves[np.abs(waves) <= size * np.sum(np.abs(row))] = 0.0
            kept = np.flatnonzero(np.abs(waves).reshape(len(waves), -1).max(axis=1))
            if len(kept):
                function = partial(_series, waves[: kept[-1] + 1], 2 * np.pi / system.period)
                values = waves[0].real if kept[-1] == 0 else function
                terms.append(Term(term.array, _label(term.scale, name, power), values, term.power))
    return replace(
        system,
        terms=tuple(terms),
        parameters={**system.parameters, name: float(system.geometry[name])},
        scales=partial(_scales, system.scales, tuple(system.parameters), name, order),
        geometry={},
        rebuild=None,
        moving_shape=None,
    )


def _series(waves, turning, theta):
    turns = np.exp(1j * turning * np.multiply.outer(theta, np.arange(len(waves))))
    return np.tensordot(turns, waves, axes=1).real


def _label(scale, name, power):
    alone = f"{name}**{power}"
    return scale if power == 0 else alone if scale is None else f"{scale} {alone}"


def _scales(old, names, name, order, values):
    scales = dict(old({key: values[key] for key in names}))
    out = dict(scales)
    for power in range(1, order + 1):
        factor = np.asarray(values[name], dtype=float) ** power
        out[f"{name}**{power}"] = factor
        out |= {f"{key} {name}**{power}": value * factor for key, value in scales.items()}
    return out
