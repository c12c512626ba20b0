"""Arrays with explicit entries: element matrices, constrained and transcendental systems."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import sympy as sp

from .describe import Description
from .external import ExternalValues, external_values
from .ir import Argument, Kernel, ModuleSpec, Result
from .lowering import lower_kernel
from .records import EquationsOfMotion, VariationalEquations
from .spec import Family, ModelSpec
from .staged import Steps, chosen_outputs


@dataclass(frozen=True)
class MatrixForm:
    """Matrices as functions of inputs, for example those of a finite element.

    Attributes
    ----------
    arrays : tuple of (str, Matrix)
        What is returned, by name.
    steps : Steps
        Named intermediate quantities.
    """

    arrays: tuple[tuple[str, sp.ImmutableDenseMatrix], ...]
    steps: Steps = field(default_factory=Steps)

    def __post_init__(self) -> None:
        """Refuse a name that occurs twice."""
        names = [name for name, _ in self.arrays]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"arrays named twice: {twice}")

    def only(self, names: Iterable[str]) -> MatrixForm:
        """Return the form with some of its arrays.

        Raises
        ------
        ValueError
            If one is not there.
        """
        return replace(self, arrays=chosen_outputs(self.arrays, names))


@dataclass(frozen=True)
class ConstrainedSystem:
    """Equations of motion with what is needed to evaluate them.

    Functions that the equations apply to time or to a coordinate and leave open (a prescribed
    motion, mode shapes at a sliding point) become arguments of the emitted functions: ``phi`` for
    ``phi(s)``, ``phi_d1`` for its derivative, and so on.

    Attributes
    ----------
    equations : EquationsOfMotion
        ``M qdd + c = Phi_q^T lam + Q``, ``Phi = 0``.
    variations : VariationalEquations, optional
        Emitted too where given, for the linearised motion.
    steps : Steps
        Closed forms of prescribed quantities.
    """

    equations: EquationsOfMotion
    variations: VariationalEquations | None = None
    steps: Steps = field(default_factory=Steps)


@dataclass(frozen=True)
class TranscendentalSystem:
    """``D(Omega) u = 0`` with the number of poles of D below Omega.

    Attributes
    ----------
    frequency : Symbol
        Omega [rad/s].
    matrix : Matrix, (n, n)
        D, the dynamic stiffness, written without cancellation or overflow.
    poles : Expr
        Number of natural frequencies below Omega of the parts with their nodes held; with the
        negative eigenvalues of D it counts all natural frequencies (Wittrick and Williams).
    steps : Steps
        Named intermediate quantities.
    """

    frequency: sp.Symbol
    matrix: sp.ImmutableDenseMatrix
    poles: sp.Expr
    steps: Steps = field(default_factory=Steps)

    def __post_init__(self) -> None:
        """Refuse a matrix that is not square."""
        if self.matrix.rows != self.matrix.cols:
            raise ValueError(f"dynamic stiffness of shape {self.matrix.shape} is not square")


def lower_matrices(spec: ModelSpec, form: MatrixForm, description: Description) -> ModuleSpec:
    """Return the module of a matrix form: one function that returns the entries of all arrays."""
    kernel = _ArrayKernel(
        description.kernel,
        description.summary,
        (*description.arguments, *description.parameters),
        dict(form.arrays),
    )
    return _module(spec, "closed_form", (kernel,), form.steps, description, ())


def lower_constrained(
    spec: ModelSpec, system: ConstrainedSystem, description: Description
) -> ModuleSpec:
    """Return the module of a constrained system: ``constraints``, ``dynamics``, ``variations``.

    Raises
    ------
    ValueError
        If an open function is applied to more than one argument.
    """
    e, v = system.equations, system.variations
    outer = {argument.name: argument for argument in description.arguments}
    time = _argument(e.t, "Time", outer)
    positions = [_argument(q, "Coordinate", outer) for q in e.coordinates]
    velocities = [_argument(q, "Velocity", outer) for q in e.velocities]
    arrays = {
        "constraints": {"constraints": e.constraints, "jacobian": e.jacobian},
        "dynamics": {
            "mass": e.mass,
            "rest": e.rest,
            "forces": e.forces,
            "jacobian": e.jacobian,
            "velocity_rhs": e.velocity_rhs,
            "gamma": e.gamma,
        },
    }
    states = {"constraints": positions, "dynamics": [*positions, *velocities]}
    if v is not None:
        arrays["variations"] = {
            "damping": v.damping,
            "stiffness": v.stiffness,
            "jacobian_rate": v.jacobian_rate,
            "jacobian_acceleration": v.jacobian_acceleration,
        }
        more = [_argument(a, "Acceleration", outer) for a in v.accelerations]
        more += [_argument(lam, "Multiplier", outer) for lam in e.multipliers]
        states["variations"] = [*positions, *velocities, *more]
    forms = [matrix for group in arrays.values() for matrix in group.values()]
    values = external_values([*forms, *(value for _, value in system.steps.steps)])
    passed = [_argument(s, "Passed in", outer) for s in values.symbols]
    kernels = [
        _ArrayKernel(
            name,
            _SUMMARIES[name],
            (*states[name], time, *passed, *description.parameters),
            {key: values.plain(matrix) for key, matrix in arrays[name].items()},
        )
        for name in arrays
    ]
    tables = (
        ("COORDINATES", repr(tuple(q.name for q in e.coordinates))),
        ("MULTIPLIERS", repr(tuple(lam.name for lam in e.multipliers))),
        ("EXTERNAL", repr(tuple(s.name for s in values.symbols))),
    )
    steps = _plain_steps(system.steps, values)
    return _module(spec, "constrained", kernels, steps, description, tables)


_SUMMARIES = {
    "constraints": "Return the constraints and their Jacobian",
    "dynamics": "Return everything in the equations of motion at acceleration level",
    "variations": "Return the arrays of the motion linearised about a given one",
}


def lower_transcendental(
    spec: ModelSpec, system: TranscendentalSystem, description: Description
) -> ModuleSpec:
    """Return the module of a transcendental eigenproblem: ``dynamic_stiffness``."""
    frequency = Argument(system.frequency.name, "array_like, shape (...)", "rad/s", "Frequency")
    kernel = _ArrayKernel(
        "dynamic_stiffness",
        "Return the dynamic stiffness and its number of poles below the frequency",
        (frequency, *description.arguments, *description.parameters),
        {"stiffness": system.matrix, "poles": sp.ImmutableDenseMatrix([[system.poles]])},
    )
    sizes = (("SIZE", repr(system.matrix.rows)),)
    return _module(spec, "transcendental", (kernel,), system.steps, description, sizes)


def _argument(symbol: sp.Symbol, word: str, known: Mapping[str, Argument]) -> Argument:
    """Return the argument as the description words it, or in a general form."""
    general = Argument(symbol.name, "float or ndarray, shape (...)", "", f"{word} {symbol.name}")
    return known.get(symbol.name, general)


def _plain_steps(steps: Steps, values: ExternalValues) -> Steps:
    return Steps(tuple((symbol, values.plain(value)) for symbol, value in steps.steps))


@dataclass(frozen=True)
class _ArrayKernel:
    """One function that returns the entries of several arrays: no zeros, and equal ones once."""

    name: str
    summary: str
    arguments: tuple[Argument, ...]
    arrays: Mapping[str, sp.ImmutableDenseMatrix]

    def lowered(self, steps: Steps, references: Sequence[str]) -> tuple[Kernel, str]:
        """Return the kernel and, as text, where each returned entry belongs."""
        found: dict[sp.Expr, int] = {}
        results: list[Result] = []
        places: list[str] = []
        for array, matrix in self.arrays.items():
            entries = []
            for (i, j), entry in _filled(matrix):
                if entry not in found:
                    found[entry] = len(results)
                    name = f"{array}_{i + 1}_{j + 1}"
                    results.append(Result(name, "float or ndarray", "", f"Entry of {array}"))
                entries.append(f"({i}, {j}, {found[entry]})")
            listed = "".join(f"{entry}, " for entry in entries).strip()
            places.append(f"'{array}': ({matrix.shape}, ({listed}))")
        outputs = list(zip(results, found, strict=True))
        kernel = lower_kernel(self.name, self.summary, self.arguments, steps, outputs, references)
        return kernel, f"'{self.name}': {{{', '.join(places)}}}"


def _filled(matrix: sp.ImmutableDenseMatrix) -> Iterable[tuple[tuple[int, int], sp.Expr]]:
    for i in range(matrix.rows):
        for j in range(matrix.cols):
            if matrix[i, j] != 0:
                yield (i, j), matrix[i, j]


def _module(
    spec: ModelSpec,
    family: Family,
    kernels: Sequence[_ArrayKernel],
    steps: Steps,
    description: Description,
    tables: tuple[tuple[str, str], ...],
) -> ModuleSpec:
    """Put a module together; a function all of whose entries are zero is not emitted."""
    lowered = [kernel.lowered(steps, description.references) for kernel in kernels]
    arrays = "{" + ", ".join(places for _, places in lowered) + "}"
    return ModuleSpec(
        spec=spec,
        family=family,
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=tuple(kernel for kernel, _ in lowered if kernel.results),
        parameters=description.parameters,
        tables=(*tables, ("ARRAYS", arrays)),
    )
