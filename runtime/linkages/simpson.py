"""Smith's procedure for Fourier coefficients (appendix 3): Simpson's rule with halved intervals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np

from ..core.errors import bad
from ..core.results import Check, provenance
from ..core.sampling import values_at
from .harmonic_analysis import (
    Harmonics,
    Source,
    check_order,
    function_of,
    harmonics,
    source_told,
    without_growth,
)
from .inputs import Array

StoppingRule = Literal["printed", "every"]

_MOST = 2**17


def simpson_harmonics(
    source: Source,
    *,
    order: int = 8,
    accuracy: float = 1e-6,
    stop: StoppingRule = "printed",
) -> Harmonics:
    """Return harmonics by the procedure of Smith's appendix 3, as a piece of history.

    The trapezoidal sums of a periodic function converge faster than any power of the interval;
    Simpson's combination of two of them is as good as the coarser one, so that the procedure costs
    about twice the angles for the same digits.  Two faults of its stopping rule weigh more:

    - As printed, the loop over the harmonics is left at the first one that has converged: it stops
      as soon as the mean has, whatever the others do.  ``cos 3 theta`` stops at 8 intervals with
      a[1] = -1/3 and a[5] = 1.  ``stop="every"`` tests all of them, as the text has it.
    - It starts from zero and two intervals, and compares once.  A function that vanishes at 0, pi
      and 2 pi - any sine series - stops there with all coefficients zero, even if every one is
      tested; and so does one whose first two sums agree.

    Parameters
    ----------
    source : callable, (Linkage, str) or (Machine, str, float)
        As for :func:`~elastolink.runtime.linkages.harmonic_analysis.harmonics`.
    order : int
        Highest harmonic, 1 to 4096.
    accuracy : float
        The procedure's own: largest change of an integral (pi times a coefficient), absolute.
    stop : {"printed", "every"}
        The stopping rule.

    Returns
    -------
    Harmonics
        With pi to all digits (the listing has nine).  ``error`` is measured: the largest
        difference from the FFT, and that one's error; the check "error over the accuracy asked
        for" fails where the procedure has stopped too early, "intervals" where 131072 did not
        do.  ``evaluations`` counts the procedure's own angles.

    Raises
    ------
    BadInput
        As for ``harmonics``; or an unknown stopping rule.
    """
    if stop not in ("printed", "every"):
        raise bad("stop", repr(stop), "'printed' or 'every'", "choose a stopping rule")
    name, f = function_of(source)
    check_order(order, accuracy)
    periodic, secular, _ = without_growth(f, name)
    sums = _halved(periodic, name, int(order), accuracy, stop)
    a, b = sums.cosine / pi, sums.sine / pi
    # The last statement of the listing: a[0] is the mean, whatever the heading says.
    a[0] /= 2.0
    reference = harmonics(source, order=order)
    gap = float(np.max(np.maximum(np.abs(a - reference.a), np.abs(b - reference.b))))
    error = gap + float(reference.error)
    return Harmonics(
        name=name,
        a=a,
        b=b,
        secular=secular,
        largest=reference.largest,
        remainder=reference.remainder + (2 * order + 1) * error,
        evaluations=sums.intervals + 1,
        method=f"Simpson's rule, stopping rule {'as printed' if stop == 'printed' else 'of all'}",
        error=error,
        error_norm="largest difference of a coefficient from the FFT, absolute",
        checks={
            "error over the accuracy asked for": Check(error * pi / accuracy, 1.0),
            "intervals": Check(float(sums.intervals), float(_MOST if sums.settled else 0)),
        },
        provenance=provenance(source_told(source)),
    )


@dataclass(frozen=True, eq=False)
class _Sums:
    """Integrals of f cos m theta and f sin m theta, and how they were come by."""

    cosine: Array
    sine: Array
    intervals: int
    settled: bool


def _halved(
    f: Callable[[Array], Array], name: str, order: int, accuracy: float, stop: StoppingRule
) -> _Sums:
    """Halve the interval until the rule is content; letters as in the listing."""
    m = np.arange(order + 1)

    def added(theta: Array) -> tuple[Array, Array]:
        values = values_at(f, theta, name)
        cosine, sine = np.zeros(order + 1), np.zeros(order + 1)
        # In pieces, so that a long row of angles does not fill the memory.
        for start in range(0, len(theta), 4096):
            part = slice(start, start + 4096)
            angles = m[:, None] * theta[part]
            cosine += np.cos(angles) @ values[part]
            sine += np.sin(angles) @ values[part]
        return cosine, sine

    n, h = 1, pi
    ends = added(np.array([0.0, 2.0 * pi]))
    even = (np.zeros(order + 1), np.zeros(order + 1))
    before = (np.zeros(order + 1), np.zeros(order + 1))
    while True:
        odd = added(np.asarray((2 * np.arange(n) + 1) * h, dtype=np.float64))
        now = tuple(h * (e + 4 * o + 2 * w) / 3 for e, o, w in zip(ends, odd, even, strict=True))
        change = np.maximum(np.abs(now[0] - before[0]), np.abs(now[1] - before[1]))
        settled = bool(change[0] < accuracy if stop == "printed" else np.all(change < accuracy))
        if settled or 2 * n >= _MOST:
            return _Sums(now[0], now[1], 2 * n, settled)
        before = (now[0], now[1])
        even = (even[0] + odd[0], even[1] + odd[1])
        n, h = 2 * n, h / 2
