"""Random linear periodic systems with derivatives of their answers to 40 digits.

The equation is summed as a Taylor series over pieces of the period in ball arithmetic of 70 digits,
and differentiated by differences of 1e-24: no code of the package has part in it.
"""

from dataclasses import dataclass, field

import flint
import mpmath as mp
import numpy as np
from elastolink.runtime.core.families import LinearPeriodic, Term

DIGITS, STEP = 70, 24
# Waves a cos(k theta) + b sin(k theta) that the terms have, by name: array, k, cosine, sine.
WAVES = {
    "m": ("M", 0, 1, 0),
    "v": ("M", 1, 1, 0),
    "a": ("A", 1, 0, 1),
    "b": ("B", 2, 1, 0),
    "c": ("C", 0, 1, 0),
    "k": ("K", 0, 1, 0),
    "e": ("K", 1, 1, 0),
    "g": ("K", 2, 0, 1),
    "f": ("f", 1, 1, 0),
    "p": ("p", 2, 0, 1),
}
POWERS = {"M": 0, "A": 0, "B": 0, "C": -1, "K": -2, "f": 0, "p": -2}


@dataclass
class Truth:
    """One random system of n freedoms: matrices by name, and values of the parameters."""

    size: int
    values: dict
    matrices: dict = field(repr=False)

    def system(self):
        """Return the system for the package; monomials are squares of the parameters."""

        def term(name):
            array, k, cosine, sine = WAVES[name]
            matrix = self.matrices[name]

            def function(theta):
                wave = cosine * np.cos(k * theta) + sine * np.sin(k * theta)
                return wave.reshape(-1, *(1,) * matrix.ndim) * matrix

            return Term(array, name, matrix if k == 0 else function)

        return LinearPeriodic(
            self.size,
            tuple(term(name) for name in self.values),
            dict(self.values),
            lambda values: {name: np.square(values[name]) for name in self.values},
        )

    def map(self, speed, changes=None, begin=0.0, pieces=40, order=46):
        """Return the transition matrix of a turn from an angle, with the force's column."""
        flint.ctx.dps = mp.mp.dps = DIGITS
        n, w = self.size, _ball(speed)
        values = {name: flint.arb(value) for name, value in self.values.items()}
        values |= {name: _ball(value) for name, value in (changes or {}).items()}
        scales = {name: values[name] ** 2 * w ** POWERS[WAVES[name][0]] for name in values}
        exact = {
            name: flint.arb_mat(*np.atleast_2d(m).shape, [flint.arb(x) for x in m.ravel().tolist()])
            for name, m in self.matrices.items()
        }
        width = 2 * n + 1
        state = flint.arb_mat(width, width, np.eye(width).ravel().tolist())
        h = 2 * flint.arb.pi() / pieces
        for piece in range(pieces):
            coefficients = self._series(scales, exact, _ball(begin) + piece * h, order)
            state = _step(coefficients, state, n, h, order)
        return mp.matrix([[_float(state[i, j]) for j in range(width)] for i in range(width)])

    def array(self, array, angle, changes):
        """Return one array at an angle, for changed parameters."""
        values = self.values | changes
        total = mp.zeros(self.size, self.size)
        for name, matrix in self.matrices.items():
            own, k, cosine, sine = WAVES[name]
            if own == array:
                wave = cosine * mp.cos(k * angle) + sine * mp.sin(k * angle)
                total += mp.mpf(values[name]) ** 2 * wave * mp.matrix(matrix.tolist())
        return total

    def _series(self, scales, exact, angle, order):
        """Return Taylor coefficients of M, A, C, N and F at an angle."""
        n = self.size
        fields = {key: [] for key in "MACNF"}
        signs = {"M": ("M", 1), "A": ("A", 1), "C": ("C", 1), "B": ("N", 1), "K": ("N", -1)}
        signs |= {"f": ("F", 1), "p": ("F", 1)}
        for degree in range(order):
            made = {key: flint.arb_mat(n, 1 if key == "F" else n) for key in fields}
            for name, scale in scales.items():
                array, k, cosine, sine = WAVES[name]
                if k == 0 and degree:
                    continue
                turned = k * angle + degree * flint.arb.pi() / 2
                wave = cosine * turned.cos() + sine * turned.sin()
                power = flint.arb(k) ** degree if degree else 1
                weight = scale * wave * power / flint.arb(degree).fac()
                key, sign = signs[array]
                matrix = exact[name]
                made[key] += (sign * weight) * (matrix.transpose() if key == "F" else matrix)
            for key, value in made.items():
                fields[key].append(value)
        return fields


def _ball(number):
    return flint.arb(mp.nstr(mp.mpf(number), DIGITS))


def _float(ball):
    return mp.mpf(ball.mid().str(DIGITS, radius=False))


def _step(fields, state, n, h, order):
    rows = [[state[i, j] for j in range(2 * n + 1)] for i in range(2 * n + 1)]
    width = 2 * n + 1
    q = [flint.arb_mat(rows[:n])]
    p = [flint.arb_mat(rows[n : 2 * n])]
    unit = flint.arb_mat(1, width, [0] * (width - 1) + [1])
    inverse, slopes = fields["M"][0].inv(), []
    for k in range(order - 1):
        right = p[k]
        for j in range(k + 1):
            right -= fields["A"][j] * q[k - j]
        for j in range(1, k + 1):
            right -= fields["M"][j] * slopes[k - j]
        slopes.append(inverse * right)
        rate = fields["F"][k] * unit
        for j in range(k + 1):
            turned = fields["A"][j].transpose() - fields["C"][j]
            rate += turned * slopes[k - j] + fields["N"][j] * q[k - j]
        q.append(slopes[k] * (flint.arb(1) / (k + 1)))
        p.append(rate * (flint.arb(1) / (k + 1)))
    end_q, end_p = q[-1], p[-1]
    for k in range(order - 1)[::-1]:
        end_q, end_p = q[k] + h * end_q, p[k] + h * end_p
    table = [[end_q[i, j] for j in range(width)] for i in range(n)]
    table += [[end_p[i, j] for j in range(width)] for i in range(n)]
    return flint.arb_mat([*table, [0] * (width - 1) + [1]])


def random_truth(rng, size=None, damped=None, forced=False):
    """Return a random system; its parameters are about 1, waves are weak."""
    n = int(rng.integers(1, 3)) if size is None else size
    damped = bool(rng.integers(2)) if damped is None else damped

    def symmetric(strength, definite=False):
        matrix = rng.normal(size=(n, n)) * strength
        matrix = 0.5 * (matrix + matrix.T)
        return matrix @ matrix + strength * np.eye(n) if definite else matrix

    matrices = {"m": symmetric(1.0, True), "k": symmetric(2.0, True)}
    matrices |= {"v": 0.1 * matrices["m"], "a": 0.2 * rng.normal(size=(n, n))}
    matrices |= {"e": symmetric(0.5), "b": symmetric(0.1), "g": symmetric(0.3)}
    if damped:
        matrices["c"] = symmetric(0.1, True)
    if forced:
        matrices |= {"f": rng.normal(size=n), "p": rng.normal(size=n)}
    values = {name: float(rng.uniform(0.8, 1.2)) for name in matrices}
    return Truth(n, values, matrices)


def slope(function, value):
    """Return the derivative of a function of one number."""
    mp.mp.dps = DIGITS
    step = mp.mpf(10) ** -STEP
    exact = mp.mpf(value)
    sides = function(exact + step), function(exact - step)
    return (sides[0] - sides[1]) / (2 * step)
