"""A basis of the rod that is none of the package's: plain polynomials, integrated by quadrature."""

import numpy as np
from numpy.polynomial.legendre import leggauss


class PlainBasis:
    """Shapes ``eta^k (eta - xi)``, k = 1 ... n, smooth across the block."""

    def __init__(self, size):
        self.size = size
        self.labels = tuple(f"q{k}" for k in range(1, size + 1))

    def shapes(self, x, place, derivative=0):
        """Return shape ``(nt, nx, n)``; ``derivative`` by eta."""
        return self._power(x, place, derivative, 1) - place[:, None, None] * self._power(
            x, place, derivative, 0
        )

    def drifts(self, x, place, derivative=0):
        """Return the derivatives by xi, likewise."""
        return -self._power(x, place, derivative, 0)

    def _power(self, x, place, derivative, more):
        columns = []
        for k in range(1, self.size + 1):
            one = np.polynomial.Polynomial.basis(k + more)
            columns.append((one.deriv(derivative) if derivative else one)(x))
        return np.broadcast_to(np.stack(columns, -1), (len(place), len(x), self.size))

    def array(self, name, place):
        """Return the integrals of the protocol by quadrature, exact for these polynomials."""
        nodes, weights = leggauss(self.size + 4)
        x, w = (nodes + 1) / 2, weights / 2
        e, d = self.shapes(x, place), self.drifts(x, place)
        bent, slope = self.shapes(x, place, 2), self.shapes(x, place, 1)

        def product(left, right, weight=w):
            return np.einsum("x,txi,txj->tij", weight, left, right)

        table = {
            "overlap": lambda: product(e, e),
            "drift": lambda: product(e, d),
            "drift_drift": lambda: product(d, d),
            "bending": lambda: product(bent, bent),
            "bending_drift": lambda: product(bent, self.drifts(x, place, 2)),
            "tension": lambda: product(slope, slope, w * (1 - x**2) / 2),
            "moment": lambda: np.einsum("x,txi->ti", w * x, e),
            "mean": lambda: np.einsum("x,txi->ti", w, e),
        }
        return table[name]()
