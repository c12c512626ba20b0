"""Boundaries of a region as power series in mu, and as formulas in LaTeX: sums over harmonics.

The formulas are the words of the emitted recursion, taken between resonant harmonics.  With the
Fourier coefficients ``c_m = (a_m - i b_m)/2`` of all that multiplies y (the parameters included),
V takes harmonic l to harmonic m with the factor ``-c_(m-l)``, P keeps the harmonics 0 and n, and a
power of R brings ``(-1)^k / (m (m - n))^k``.  Sums over P are written out.  The mean ``c_0`` moves
the boundaries as a whole and is taken out of V; so each step changes the harmonic, unless there is
damping, which brings ``-2 i K (m - n/2)``.  The formulas say so: in their sums
``c_(m-l)`` is 0 for m = l.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from ...generated import hill_recursion
from ..core.errors import bad, shown
from ..core.inputs import is_finite, is_whole, require_whole
from ..core.periodic_function import PeriodicFunction
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from .bloch import HIGHEST_ORDER, effective_operator, level_distance
from .boundaries import hill_boundaries
from .checks import EPS, Array, Complex, check_function, check_regions, finite

# A leading coefficient of the root is taken for zero where it is within the round-off of the terms
# that make it, so many units of their size; above this share of its majorant it cannot be.
_ROUNDED, _CLEAR = 64.0, 1e-6
HIGHEST_FORMULA = max(hill_recursion.WORDS)


@dataclass(frozen=True, kw_only=True)
class BoundarySeries(Result):
    """``lam2 = n^2/4 + alpha_1 mu + alpha_2 mu^2 + ...`` for both boundaries of a region.

    Attributes
    ----------
    lower, upper : ndarray, shape (order,)
        alpha_1, alpha_2, ... of the boundary that is the lower and the upper one at small
        positive mu; for negative mu they change places where the first difference is of odd order.
        Both are the same for region 0, and where they do not part up to this order.
    error : ndarray, shape (2, order)
        Estimate of their absolute error.
    region, order : int
        Number n and highest power of mu.
    damping_ratio : float
        beta of ``K = beta mu``.
    splitting : int
        Power of mu at which the two part; 0 where they do not up to this order.
    function : PeriodicFunction
        As given.
    """

    lower: Array
    upper: Array
    region: int
    order: int
    damping_ratio: float
    splitting: int
    function: PeriodicFunction

    arrays_along: ClassVar = {"power": "lower upper", "end power": "error"}

    def __call__(self, mu: ArrayLike, order: int | None = None) -> tuple[Array, Array]:
        """Return ``n^2/4 + alpha_1 mu + ...`` of both boundaries.

        Parameters
        ----------
        mu : array_like
            Any shape.
        order : int, optional
            Highest power of mu, by default all that are known.

        Returns
        -------
        lower, upper : ndarray
            In the shape of mu, in the order that they have at small positive mu.

        Raises
        ------
        BadInput
            If mu is not finite.
        """
        x = finite("mu", mu)
        lower, upper = (
            0.25 * self.region**2 + x * polyval(x, alpha[:order])
            for alpha in (self.lower, self.upper)
        )
        return lower, upper

    def latex(self) -> str:
        """Return both boundaries as a formula, to the order; see :func:`boundary_latex`.

        Raises ``BadInput`` if the order is above 6.
        """
        return boundary_latex(self.order, self.region, self.damping_ratio > 0.0)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw partial sums of every order and the exact boundaries, mu upwards."""
        ax = axes_or_new(ax)
        mu = np.linspace(0.0, 1.0, 101)
        exact = hill_boundaries(self.function, mu, (self.region,), damping=self.damping_ratio * mu)
        for side, exact_end in enumerate((exact.lower[0], exact.upper[0])):
            if side == 0 and not self.region:
                continue
            ax.plot(exact_end, mu, color="black", lw=1.6, label="exact" if side else None)
            for k in range(1, self.order + 1):
                label = f"order {k}" if side else None
                ax.plot(self(mu, k)[side], mu, "--", color=f"C{k - 1}", lw=1.0, label=label)
        known = np.concatenate([exact.lower[0], exact.upper[0]])
        known = known[np.isfinite(known)]
        room = 0.3 * np.ptp(known) + 0.1
        ax.set_xlim(known.min() - room, known.max() + room)
        ax.set(xlabel=r"$\lambda^2$", ylabel=r"$\mu$")
        ax.legend()
        return ax


def boundary_series(
    f: PeriodicFunction, region: int, order: int = 4, damping_ratio: float = 0.0
) -> BoundarySeries:
    """Return the power series in mu of the boundaries of one region.

    Parameters
    ----------
    f : PeriodicFunction
        Coefficient of period 2 pi in ``y'' + 2 K y' + (lam2 + mu f) y = 0``.
    region : int
        Number n >= 0.
    order : int
        1 to 10: highest power of mu.
    damping_ratio : float
        beta >= 0 of ``K = beta mu``, Smith 7.1.4.2.

    Returns
    -------
    BoundarySeries
        The error estimate compares series for several origins of theta, on which the boundaries
        do not depend; it covers round-off, not the error of f.  A difference of the two that is
        within the round-off of its terms, or within the error of f, is taken for zero, and the
        error holds what it may be; one that no harmonics of f make is zero indeed.

    Raises
    ------
    BadInput
        If an argument is out of range, or the damping closes the region at every small mu.

    Notes
    -----
    Smith (7.12), (7.23), (7.35), (7.46), to any order by Bloch's recursion.

    Examples
    --------
    >>> import elastolink as el
    >>> series = el.boundary_series(el.PeriodicFunction(a=[0.0, 1.0]), region=1, order=3)
    >>> print(series.lower.round(6), series.upper.round(6))
    [-0.5     -0.125    0.03125] [ 0.5     -0.125   -0.03125]
    """
    check_function(f)
    (n,) = check_regions((region,))
    require_whole("order", order, 1, HIGHEST_ORDER, "choose one")
    if not (is_finite(damping_ratio) and damping_ratio >= 0.0):
        raise bad("damping_ratio", shown(damping_ratio), "a finite number >= 0", "correct it")
    # The boundaries do not depend on the origin of theta: other ones show the round-off.
    runs = [_alphas(_turned(f, float(k)), n, order, damping_ratio) for k in range(5)]
    (middle, half), splitting, doubt = runs[0]
    spread = np.max([np.abs(other - runs[0][0]) for other, *_ in runs[1:]], axis=0).sum(axis=0)
    # Of 8000 coefficients in 90 digits the least error told was 1.7 times the true one.
    error = 2.0 * spread + EPS * (np.abs(middle) + np.abs(half)) + doubt
    disagreeing = float(sum(other != splitting for _, other, _ in runs))
    return BoundarySeries(
        method=f"Bloch's recursion, order {order}",
        error=np.stack([error, error]),
        error_norm="absolute, entrywise",
        checks={"origins that disagree on the order of splitting": Check(disagreeing, 0.0)},
        provenance=provenance(),
        lower=middle - half,
        upper=middle + half,
        region=n,
        order=order,
        damping_ratio=float(damping_ratio),
        splitting=splitting,
        function=f,
    )


def _turned(f: PeriodicFunction, origin: float, power: int = 1) -> PeriodicFunction:
    """Return ``f(theta + origin)``, or with other phases that grow with a power of the harmonic."""
    turn = (f.a - 1j * f.b) * np.exp(1j * origin * np.arange(len(f.a)) ** power)
    return PeriodicFunction(a=turn.real, b=-turn.imag, error=f.error)


def _uncertain(f: PeriodicFunction, n: int, k: int, size: float) -> float:
    """Return below which size the coupling ``B_k`` of region n may be zero; ``size`` is its own."""
    # Whether its terms cancel is seen with other phases of the harmonics.
    reach = float(f.amplitudes[1:].sum())
    given = k * f.error * (reach / level_distance(n)) ** (k - 1)
    if size > _CLEAR * reach**k:
        return given
    point = np.array([[1.0], [0.0]])
    # Other phases, harmonic by harmonic: what cancels at one does not at another.
    others = [
        effective_operator((_turned(f, phase, 2),), n, k, True).components(point)[1][-1, 0]
        for phase in (0.7, 1.3, 2.1)
    ]
    return _ROUNDED * EPS * max(size, *(float(abs(other)) for other in others)) + given


def _alphas(f: PeriodicFunction, n: int, order: int, ratio: float) -> tuple[Array, int, Array]:
    """Return the coefficients of middle and half, shape (2, order), and the order of splitting."""
    # Also what the coefficients may be off by for a leading one that is zero or uncertain,
    # (order,).
    point = np.array([[1.0], [ratio]])
    a, b = effective_operator((f,), n, order, True).components(point)
    middle, drag = a[:, 0].real, a.imag
    half, doubt = np.zeros(order), np.zeros(order)
    # Damping is of the first order, and exact.
    s = 1 if ratio > 0.0 and n else 0
    for k in range(1, order + 1 if n and not s else 0):
        size = float(np.abs(b[k - 1, 0]))
        # Where no path leads from one harmonic to the other there is a zero without round-off.
        least = _uncertain(f, n, k, size) if size > 0.0 else 0.0
        if size > least:
            s = k
            break
        doubt[k - 1] = least
    if not s:
        return np.stack([middle, half]), 0, doubt
    drag, coupling = drag[s - 1 :, 0], b[s - 1 :, 0]
    if np.abs(coupling[0]) <= np.abs(drag[0]):
        closing = np.abs(coupling[0]) / n
        expected = f"less than {closing:.6g}, where the damping closes region {n}"
        raise bad("damping_ratio", f"{ratio:g}", expected, "take less damping")
    root = _root(drag, coupling)
    half[s - 1 :] = root
    # Roundings of the leading component of the root, which all others hang on.
    nudged = _root(drag, np.concatenate([coupling[:1] * (1.0 + 4.0 * EPS), coupling[1:]]))
    doubt[s - 1 :] += np.abs(nudged - root)
    return np.stack([middle, half]), s, doubt


def _root(drag: Array, coupling: Complex) -> Array:
    """Return the power series of the root of ``|B|^2 - (Im A)^2``, which begins positive."""
    # A power of two, so that squares stay within the range of doubles and no digit changes.
    unit = np.ldexp(1.0, np.frexp(np.abs(coupling[0]) + np.abs(drag[0]))[1])
    b, a = coupling / unit, drag / unit
    squares = (np.convolve(b, b.conj()).real - np.convolve(a, a))[: len(a)]
    root = np.sqrt(squares[:1])
    for square in squares[1:]:
        inner = np.dot(root[1:], root[:0:-1])
        root = np.append(root, (square - inner) / (2.0 * root[0]))
    return np.asarray(unit * root)


# ---------------------------------------------------------------- formulas


class _Chain(NamedTuple):
    """Steps between two harmonics over others that are summed, with the powers of R there."""

    end: str
    start: str
    powers: tuple[int, ...]


def boundary_latex(order: int, n: int | None = None, damped: bool = False) -> str:
    """Return both boundaries of a region as a formula, to an order from 1 to 6.

    An ``aligned`` environment (amsmath), without dollar signs: lam2, then the homogeneous parts of
    A and B.  Sums run over all whole numbers but 0 and n; between equal harmonics stands what
    damping does, or nothing.  Without a number the letter n stands for any region from 1.  Smith
    (7.25), (7.35), (7.49) are orders 1 and 2, expanded in the parameter.
    """
    fix = "the terms of higher orders are many: use perturbation_boundaries for their values"
    require_whole("order", order, 1, HIGHEST_FORMULA, fix)
    if not (n is None or is_whole(n, 0)):
        raise bad("region", repr(n), "a whole number >= 0", "correct it")
    region = "n" if n is None else str(int(n))
    a, b = (" + ".join(f"{x}_{{{k}}}" for k in range(1, order + 1)) for x in "AB")
    if region == "0":
        lines = [rf"\lambda^2 &= {a}", *_parts("A", "0", "0", order, region, damped)]
    else:
        if n is None:
            centre = r"\frac{n^2}{4}"
        else:
            centre = rf"\frac{{{n * n}}}{{4}}" if n % 2 else str((n // 2) ** 2)
        lines = [
            rf"\lambda^2 &= {centre} + \operatorname{{Re}} A \pm "
            r"\sqrt{\left|B\right|^2 - \left(\operatorname{Im} A\right)^2}",
            rf"A &= {a}, \quad B = {b}",
            *_parts("A", "n", "n", order, region, damped),
            *_parts("B", "n", "0", order, region, damped),
        ]
    body = " \\\\\n".join([*lines, *_where(order, region, damped)])
    return f"\\begin{{aligned}}\n{body}\n\\end{{aligned}}"


def _where(order: int, region: str, damped: bool) -> Iterator[str]:
    """Yield the lines that say what the letters are."""
    if order > 1:
        others = "0" if region == "0" else f"0, {region}"
        yield rf"m, m_1, m_2, \dots &\neq {others}"
        if order > 2 and not damped:
            yield r"\text{in the sums: } c_{m-l} &= 0 \quad (m = l)"
        if damped:
            drag = "2 i m" if region == "0" else f"i (2 m - {region})"
            yield rf"v_{{m,l}} &= c_{{m-l}} \quad (m \neq l), \qquad v_{{m,m}} = {drag} K"


def _parts(
    letter: str, end: str, start: str, order: int, region: str, damped: bool
) -> Iterator[str]:
    """Yield ``A_1, A_2, ...`` or ``B_1, ...``, sums as lines of a few terms each."""
    for k in range(1, order + 1):
        texts = ["-c_{0}"] if k == 1 and end == start else []
        for chains, coefficient in _terms(k, end, start, damped, region).items():
            size = "" if abs(coefficient) == 1 else f"{abs(coefficient)} "
            sign = "-" if coefficient < 0 else "+"
            texts.append(f"{sign} {size}{_product(chains, region, damped)}")
        texts = texts or ["0"]
        texts[0] = texts[0].removeprefix("+ ").replace("- ", "-", 1)
        lead = f"{letter}_{{{k}}} &= "
        while texts:
            line = texts.pop(0)
            # Characters of source in a line of a sum.
            while texts and len(line) + len(texts[0]) < 200:
                line += " " + texts.pop(0)
            yield lead + line
            lead = r"&\quad "


def _terms(
    order: int, end: str, start: str, damped: bool, region: str
) -> dict[tuple[_Chain, ...], int]:
    """Return the words of an order between two harmonics, sums over P written out."""
    found: Counter[tuple[_Chain, ...]] = Counter()
    resonant = ("0",) if region == "0" else ("0", "n")
    for coefficient, word in hill_recursion.WORDS[order]:
        stops = word.split(" V ")[1:-1]
        # P, R, R^2 ...
        powers = [0 if stop == "P" else int(stop[2:] or 1) for stop in stops]
        sign = coefficient * (-1) ** (order + sum(powers))
        for chains in _paths(end, start, powers, resonant):
            still = [chain for chain in chains if not chain.powers and chain.end == chain.start]
            if still and (not damped or region == "0"):
                continue
            kept = chains if damped else tuple(map(_canonical, chains))
            # What damping does to the harmonic 0 is the opposite of what it does to n.
            turned = still.count(_Chain("0", "0", ()))
            kept = tuple(_Chain("n", "n", ()) if c == _Chain("0", "0", ()) else c for c in kept)
            found[tuple(sorted(kept))] += sign * (-1) ** turned
    return {key: value for key, value in sorted(found.items()) if value}


def _paths(
    end: str, start: str, powers: list[int], resonant: tuple[str, ...]
) -> Iterator[tuple[_Chain, ...]]:
    """Yield the chains of a word for every choice of the harmonics at which P stands."""
    if 0 not in powers:
        yield (_Chain(end, start, tuple(powers)),)
        return
    place = powers.index(0)
    for stop in resonant:
        head = _Chain(end, stop, tuple(powers[:place]))
        for rest in _paths(stop, start, powers[place + 1 :], resonant):
            yield (head, *rest)


def _canonical(chain: _Chain) -> _Chain:
    """Return the chain of equal value that is written, where f is real and nothing is damped."""
    turned = chain.powers[::-1]
    if chain.end == chain.start == "0":
        return _Chain("n", "n", turned)
    if {chain.end, chain.start} == {"0", "n"}:
        return _Chain(chain.end, chain.start, max(chain.powers, turned))
    return chain


def _product(chains: tuple[_Chain, ...], region: str, damped: bool) -> str:
    """Return a product of chains; sums last, in parentheses where they are not alone."""
    counts = Counter(chains)
    factors = []
    for chain, count in sorted(counts.items(), key=lambda item: (bool(item[0].powers), item[0])):
        text = _chain_latex(chain, region, damped)
        if chain.powers and len(counts) + count > 2:
            text = rf"\left({text}\right)"
        elif count > 1 and " " in text:
            text = f"({text})"
        factors.append(text if count == 1 else f"{text}^{{{count}}}")
    return " ".join(factors)


def _chain_latex(chain: _Chain, region: str, damped: bool) -> str:
    """Return a chain as a sum over the harmonics between."""
    names = [f"m_{i}" for i in range(1, len(chain.powers) + 1)]
    names = ["m"] if len(names) == 1 else names
    stops = [chain.end, *names, chain.start]
    steps = " ".join(_step(end, start, region, damped) for end, start in pairwise(stops))
    if not names:
        return steps
    levels = " ".join(_level(m, p, region) for m, p in zip(names, chain.powers, strict=True))
    return rf"\sum_{{{','.join(names)}}} \frac{{{steps}}}{{{levels}}}"


def _level(m: str, power: int, region: str) -> str:
    """Return a power of ``m (m - n)``."""
    if region == "0":
        return f"{m}^{{{2 * power}}}"
    raised = f"^{{{power}}}" if power > 1 else ""
    return f"{m}{raised} ({m}-{region}){raised}"


def _step(end: str, start: str, region: str, damped: bool) -> str:
    """Return ``c_(end - start)``, with the damping where there is any."""
    shown = {"n": region}
    first, last = shown.get(end, end), shown.get(start, start)
    fixed = end in ("0", "n"), start in ("0", "n")
    if all(fixed):
        if end == start:
            return f"i {region} K"
        return f"c_{{{region}}}" if end == "n" else rf"\bar{{c}}_{{{region}}}"
    if damped and not any(fixed):
        return f"v_{{{first},{last}}}"
    if last == "0":
        return f"c_{{{first}}}"
    return f"c_{{-{last}}}" if first == "0" else f"c_{{{first}-{last}}}"
