"""What the machine-derived perturbation leaves out: powers, coefficients, values to 90 digits.

A curve through the origin, ``eps_l = d_l t`` and ``K = beta_1 t + beta_2 t^2 + ...``, turns A and B
of the exact operator into polynomials in t with rational coefficients.  The ends are

    lam2 = n^2/4 + sum_k (c_k +- r_k sqrt(q)) t^k,   c, r, q rational.

That of the truncated forms is compared with that of a higher order, coefficient by coefficient and
exactly: the first difference is what the error has to tend to.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from boundary_truth import DIGITS, MP, boundary
from exact_hill import exact_operator

ZERO = Fraction(0)
FORMS = ("series", "uniform")


def times(one, other, length):
    """Return the product of two polynomials, cut after ``length`` coefficients."""
    out = [ZERO] * length
    for i, x in enumerate(one[:length]):
        if x:
            for j, y in enumerate(other[: length - i]):
                out[i + j] += x * y
    return out


@dataclass(frozen=True)
class Curve:
    """Functions, their weights and the rates of damping: a problem with the one parameter t.

    Region n, derived up to the total degree ``highest``.
    """

    functions: tuple
    weights: tuple
    drag: tuple
    n: int
    highest: int

    @property
    def damped(self):
        return any(self.drag)

    def friction(self, t):
        return sum((beta * t**j for j, beta in enumerate(self.drag, 1)), ZERO)

    def operator(self):
        return _operator(self.functions, self.n, self.highest, self.damped)

    def polynomials(self, order):
        """Return Re A, Im A, Re B, Im B in powers of t, from total degrees up to ``order``."""
        operator, length = self.operator(), self.highest + 1
        rows = [[ZERO] * length for _ in range(4)]
        powers = [[Fraction(1)] + [ZERO] * self.highest]
        for _ in range(self.highest):
            powers.append(times(powers[-1], [ZERO, *self.drag], length))
        for degree in range(order):
            for place, exponents in enumerate(operator.exponents[degree]):
                own, last = exponents, 0
                if self.damped:
                    *own, last = exponents
                weight = Fraction(1)
                for value, power in zip(self.weights, own, strict=True):
                    weight *= value**power
                four = (*operator.diagonal[degree][place], *operator.coupling[degree][place])
                start = sum(own)
                for j, factor in enumerate(powers[last][: length - start]):
                    for row, value in zip(rows, four, strict=True):
                        row[start + j] += weight * factor * value
        return rows

    def expansion(self, order):
        """Return (c_0 ...), (r_0 ...), q of the uniform form of an order, as far as ``highest``.

        None where the region is closed for small t.
        """
        return _expansion(self, order)

    def _expanded(self, order):
        centre, drag, re, im = self.polynomials(order)
        length = 2 * len(centre)
        parts = [times(row, row, length) for row in (re, im, drag)]
        square = [x + y - z for x, y, z in zip(*parts, strict=True)]
        start = next((k for k, row in enumerate(zip(re, im, drag, strict=True)) if any(row)), None)
        if start is None:
            return centre, [ZERO] * len(centre), ZERO
        if any(square[: 2 * start]) or square[2 * start] <= 0:
            return None
        first = square[2 * start]
        ratio = [x / first for x in square[2 * start :]]
        root = [Fraction(1)]
        for k in range(1, len(centre) - start):
            inner = sum((root[i] * root[k - i] for i in range(1, k)), ZERO)
            root.append((ratio[k] - inner) / 2)
        return centre, [ZERO] * start + root, first

    def approximation(self, form, order, side, t):
        """Return one end of the form of an order at t, to 90 digits; None where it is closed."""
        values = [w * t for w in self.weights]
        if form == "series":
            centre, root, square = self.expansion(self.highest)
            flat = sum((c * t**k for k, c in enumerate(centre[: order + 1])), ZERO)
            slant = sum((r * t**k for k, r in enumerate(root[: order + 1])), ZERO)
            return self.level() + real(flat) + side * real(slant) * MP.sqrt(real(square))
        if self.damped:
            values.append(self.friction(t))
        a, b = self.operator().components(values)
        flat, drag, re, im = (
            sum((pair[part] for pair in row[:order]), ZERO)
            for row, part in ((a, 0), (a, 1), (b, 0), (b, 1))
        )
        square = re * re + im * im - drag * drag
        if square < 0:
            return None
        return self.level() + real(flat) + side * MP.sqrt(real(square))

    def level(self):
        return real(Fraction(self.n * self.n, 4))

    def coefficients(self, side):
        """Return those of t, t^2, ... of one end, to 90 digits."""
        centre, root, square = self.expansion(self.highest)
        width = side * MP.sqrt(real(square))
        return [real(c) + width * real(r) for c, r in zip(centre[1:], root[1:], strict=True)]

    def omitted(self, form, order, side):
        """Return (p, coefficient): what ``approximation - truth`` tends to, over t^p.

        (None, 0) where nothing is left out through ``highest``.
        """
        centre, root, square = self.expansion(self.highest)
        if form == "series":
            keep = [ZERO] * (order + 1)
            flat, slant = keep + centre[order + 1 :], keep + root[order + 1 :]
        else:
            other = self.expansion(order)
            assert other[2] in (ZERO, square)
            flat = [x - y for x, y in zip(centre, other[0], strict=True)]
            slant = [x - y for x, y in zip(root, other[1], strict=True)]
        for k, (c, r) in enumerate(zip(flat, slant, strict=True)):
            opposite = c * c == r * r * square and c * r * side < 0
            if (c or (r and square)) and not opposite:
                return k, -(real(c) + side * real(r) * MP.sqrt(real(square)))
        return None, MP.zero

    def truth(self, side, t, digits=DIGITS):
        return _truth(self, side, t, digits)


@cache
def _operator(functions, n, order, damped):
    return exact_operator(functions, n, order, damped)


@cache
def _expansion(curve, order):
    return curve._expanded(order)


@cache
def _truth(curve, side, t, digits):
    weights = [w * t for w in curve.weights]
    return boundary(curve.functions, weights, curve.friction(t), curve.n, side, digits=digits)


def real(value):
    """Return a rational number to 90 digits."""
    return MP.mpf(value.numerator) / value.denominator
