"""Sums of cos and sin(h theta/2) as Fourier coefficients {h: c}, with their exact products."""

from __future__ import annotations


def wave(halves, cosine=0.0, sine=0.0):
    """Return cosine cos(h theta/2) + sine sin(h theta/2) as {h: complex coefficient}."""
    c = 0.5 * (cosine - 1j * sine)
    return total({halves: c}, {-halves: c.conjugate()})


def total(*parts):
    out = {}
    for part in parts:
        for key, value in part.items():
            out[key] = out.get(key, 0.0) + value
    return out


def scaled(part, factor):
    return {key: factor * value for key, value in part.items()}


def product(one, other):
    return total(*({j + k: u * v for k, v in other.items()} for j, u in one.items()))


def without(part, n):
    return {key: value for key, value in part.items() if abs(key) != n}


def resonant(part, n):
    """Return the factors of cos and sin(n theta/2)."""
    return 2.0 * part.get(n, 0.0).real, -2.0 * part.get(n, 0.0).imag


def distance(one, other):
    return max((abs(v) for v in total(one, scaled(other, -1.0)).values()), default=0.0)
