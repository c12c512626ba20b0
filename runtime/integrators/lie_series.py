"""Truncated series in letters that do not commute: the exact arithmetic that proves coefficients.

A letter stands for a matrix that shrinks with a known power of the step, its *weight*.  A series
maps words (tuples of letters) to coefficients and drops words whose weight passes a limit, so that
two methods agree to order p exactly where their series agree up to weight p.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

Word = tuple[int, ...]


@dataclass(frozen=True)
class LieSeries:
    """A truncated series in letters that do not commute.

    Attributes
    ----------
    terms : mapping of word to Fraction
        Coefficients other than zero.
    weights : tuple of int
        Weight of each letter, by its number.
    limit : int
        Largest weight kept.
    """

    terms: Mapping[Word, Fraction]
    weights: tuple[int, ...]
    limit: int

    def weight(self, word: Word) -> int:
        """Return the weight of a word: the sum of those of its letters."""
        return sum(self.weights[letter] for letter in word)

    def _like(self, terms: Mapping[Word, Fraction]) -> LieSeries:
        return LieSeries({w: c for w, c in terms.items() if c}, self.weights, self.limit)

    def __add__(self, other: LieSeries) -> LieSeries:
        """Return the sum."""
        total = dict(self.terms)
        for word, value in other.terms.items():
            total[word] = total.get(word, Fraction(0)) + value
        return self._like(total)

    def __sub__(self, other: LieSeries) -> LieSeries:
        """Return the difference."""
        return self + other.times(Fraction(-1))

    def times(self, factor: Fraction) -> LieSeries:
        """Return the series times a number."""
        return self._like({word: factor * value for word, value in self.terms.items()})

    def __matmul__(self, other: LieSeries) -> LieSeries:
        """Return the product, words joined in order."""
        total: dict[Word, Fraction] = {}
        right = [(word, value, self.weight(word)) for word, value in other.terms.items()]
        for first, factor in self.terms.items():
            room = self.limit - self.weight(first)
            for second, value, weight in right:
                if weight <= room:
                    word = first + second
                    total[word] = total.get(word, Fraction(0)) + factor * value
        return self._like(total)

    def commutator(self, other: LieSeries) -> LieSeries:
        """Return ``[self, other]``."""
        return self @ other - other @ self

    def exp(self) -> LieSeries:
        """Return the exponential of a series without a constant."""
        total = power = one(self.weights, self.limit)
        for k in range(1, self.limit + 1):
            power = (power @ self).times(Fraction(1, k))
            total = total + power
        return total

    def log(self) -> LieSeries:
        """Return the logarithm of a series whose constant is 1."""
        rest = self - one(self.weights, self.limit)
        power, total = rest, rest
        for k in range(2, self.limit + 1):
            power = power @ rest
            total = total + power.times(Fraction((-1) ** (k + 1), k))
        return total

    def largest(self, weight: int) -> Fraction:
        """Return the largest coefficient by size among words of a weight."""
        sizes = [abs(value) for word, value in self.terms.items() if self.weight(word) == weight]
        return max(sizes, default=Fraction(0))


def one(weights: tuple[int, ...], limit: int) -> LieSeries:
    """Return the series 1."""
    return LieSeries({(): Fraction(1)}, weights, limit)


def letters(weights: tuple[int, ...], limit: int) -> tuple[LieSeries, ...]:
    """Return each letter as a series; the weight of each is given."""
    return tuple(LieSeries({(k,): Fraction(1)}, weights, limit) for k in range(len(weights)))


def legendre(count: int) -> tuple[tuple[Fraction, ...], ...]:
    """Return the Legendre polynomials of [0, 1] as coefficients of ascending powers.

    They solve ``(k + 1) P_{k+1} = (2k + 1)(2x - 1) P_k - k P_{k-1}``.
    """
    found: list[list[Fraction]] = [[Fraction(1)], [Fraction(-1), Fraction(2)]]
    while len(found) < count:
        k = len(found) - 1
        next_one = [Fraction(0)] * (k + 2)
        for power, value in enumerate(found[k]):
            next_one[power] -= Fraction(2 * k + 1, k + 1) * value
            next_one[power + 1] += Fraction(2 * (2 * k + 1), k + 1) * value
        for power, value in enumerate(found[k - 1]):
            next_one[power] -= Fraction(k, k + 1) * value
        found.append(next_one)
    return tuple(tuple(row) for row in found[:count])


def legendre_flow(count: int, limit: int) -> LieSeries:
    """Return the exact flow of ``y' = sum_k M_k P_k(x) y`` over [0, 1], P_k Legendre's polynomials.

    Letter k is M_k, of weight k + 1: the moment of a smooth generator against P_k shrinks so.  The
    coefficient of a word is its iterated integral, a rational number.
    """
    weights = tuple(range(1, count + 1))
    shapes = legendre(count)
    terms: dict[Word, Fraction] = {(): Fraction(1)}
    paths: dict[Word, list[Fraction]] = {(): [Fraction(1)]}
    while paths:
        longer: dict[Word, list[Fraction]] = {}
        for word, path in paths.items():
            used = sum(weights[letter] for letter in word)
            for letter, shape in enumerate(shapes):
                if used + weights[letter] <= limit:
                    # A later factor stands on the left.
                    grown = (letter, *word)
                    longer[grown] = _integral(_product(shape, path))
                    terms[grown] = sum(longer[grown], Fraction(0))
        paths = longer
    return LieSeries({w: c for w, c in terms.items() if c}, weights, limit)


def _product(first: Sequence[Fraction], second: Sequence[Fraction]) -> list[Fraction]:
    total = [Fraction(0)] * (len(first) + len(second) - 1)
    for i, a in enumerate(first):
        for j, b in enumerate(second):
            total[i + j] += a * b
    return total


def _integral(polynomial: Sequence[Fraction]) -> list[Fraction]:
    return [Fraction(0), *(value / (k + 1) for k, value in enumerate(polynomial))]
