"""Emitted equations that are closed in modes or stations, with scalars for arguments and results.

A family evaluates them for a number of modes or stations; the truth is what is derived for just
that number, in many digits.
"""

import inspect
from collections.abc import Iterator, Mapping

import numpy as np
import sympy as sp
from elastolink.derive.external import external_values
from elastolink.derive.lagrange import euler_lagrange, variational_equations
from judging import Point, Reference, reference_of


def derived_reference(lagrangian, arrays) -> Reference:
    """Return all entries of the arrays of a Lagrangian's equations, in many digits."""
    equations = euler_lagrange(lagrangian)
    varied = variational_equations(equations)
    made = {name: getattr(equations, name, None) or getattr(varied, name) for name in arrays}
    values = external_values(made.values())
    outputs = [
        (f"{name}_{i + 1}_{j + 1}", values.plain(matrix)[i, j])
        for name, matrix in made.items()
        for i in range(matrix.rows)
        for j in range(matrix.cols)
    ]
    inputs: set[sp.Symbol] = set().union(*(value.free_symbols for _, value in outputs))
    return reference_of(sorted(inputs, key=str), outputs)


class ScalarEntries:
    """A function of an emitted module, as its family evaluates it for so many modes or stations.

    What it takes and returns are scalars: each entry that is not zero by form.  Kinds define
    ``components(name)``, the names of the components of a parameter of the emitted function, and
    ``system(given, row)``, the family's system at numbers given, where ``row`` makes arrays.
    """

    def __init__(self, module, function: str, count: int) -> None:
        self.module, self.function, self.count = module, function, count
        self.every = range(1, count + 1)
        self.scalars = self._scalars(*inspect.signature(module.variations).parameters)
        kind = inspect.Parameter.KEYWORD_ONLY
        self.__signature__ = inspect.Signature([inspect.Parameter(n, kind) for n in self.scalars])
        generic = self.entries({name: 1.0 + 0.1 * k for k, name in enumerate(self.scalars)})
        self.names = tuple(name for name, value in generic.items() if value != 0.0)

    def __call__(self, **given: float) -> tuple[float, ...]:
        entries = self.entries(given)
        return tuple(entries[name] for name in self.names)

    def _scalars(self, *parameters: str) -> list[str]:
        return [scalar for name in parameters for scalar in self.components(name)]

    def square(self, given: Mapping[str, float], name: str) -> np.ndarray:
        """Return a symmetric matrix of which the upper half is given."""
        pairs = [[f"{name}_{min(i, j)}_{max(i, j)}" for j in self.every] for i in self.every]
        return np.array([[given[pair] for pair in line] for line in pairs])

    def entries(self, given: Mapping[str, float]) -> dict[str, float]:
        """Return all entries by name."""
        module = self.module

        def row(*names: str) -> np.ndarray:
            return np.array([given[name] for name in self._scalars(*names)])

        system = self.system(given, row)
        state = [
            row(*(f"{name}{order}" for name in module.COORDINATES))
            for order in ("", "_dot", "_ddot")
        ]
        called, vectors = {
            "constraints": (system.violation, state[:1]),
            "dynamics": (system.dynamics, state[:2]),
            "variations": (system.variations, [*state, row(*module.MULTIPLIERS)]),
        }[self.function]
        return {
            f"{array}_{i + 1}_{j + 1}": float(value)
            for array, matrix in called(*vectors, given["t"]).items()
            for (i, j), value in np.ndenumerate(matrix)
        }

    def states(self, seed: int, positive, special: str, still) -> Iterator[Point]:
        """Yield three states of any size, in the special first one of them some numbers changed.

        ``still`` returns these changes for the other numbers.
        """
        random = np.random.default_rng(seed + self.count)
        for k in range(3):
            inputs = {}
            for name in self.scalars:
                size = 10.0 ** random.uniform(-2, 2)
                inputs[name] = float(size if name in positive else random.choice((-1, 1)) * size)
            if k == 0:
                inputs |= still(inputs)
            yield Point(f"random {k}" if k else special, inputs)
