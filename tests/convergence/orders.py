"""Observed orders: the exponents k of ``errors ~ sizes^k``; of counts, minus the order."""

import numpy as np


def slope(sizes, errors) -> float:
    """Return the exponent that fits best."""
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])


def slopes(sizes, errors) -> np.ndarray:
    """Return the exponent from each pair of neighbours."""
    return np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
