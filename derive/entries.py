"""Arrays with explicit entries: element matrices, constrained and transcendental systems."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import sympy as sp

from .external import ExternalValues, external_values
from .ir import Argument, Description, Kernel, ModuleSpec, Result, Table, drops_table
from .lowering import lower_kernel
from .modal import IDENTITY, Modes
from .records import EquationsOfMotion, VariationalEquations
from .spec import Family, ModelSpec
from .staged import Steps, chosen_outputs
from .stations import Block, Stations


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

        Raises ``ValueError`` if one is not there.
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
    modes : Modes, optional
        Where the last coordinate stands for one of each mode (see :mod:`.modal`).
    dropped : mapping
        Terms that a caller may leave out, to the parameters and numbers of modes that then vanish
        and the multipliers whose constraints are released.
    stations : Stations, optional
        Where the last coordinate stands for one of each station (see :mod:`.stations`).
    blocks : mapping
        Array name to its matrix over the stations.
    """

    equations: EquationsOfMotion
    variations: VariationalEquations | None = None
    steps: Steps = field(default_factory=Steps)
    modes: Modes | None = None
    dropped: Mapping[tuple[str, ...], tuple[str, ...]] = field(default_factory=dict)
    stations: Stations | None = None
    blocks: Mapping[str, Block] = field(default_factory=dict)


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

    Raises ``ValueError`` if an open function is applied to more than one argument.
    """
    e, v, modes, stations = system.equations, system.variations, system.modes, system.stations
    outer = {argument.name: argument for argument in description.arguments}
    for rates in (e.velocities, v.accelerations if v else ()):
        for q, rate in zip(e.coordinates, rates, strict=bool(rates)):
            if q.name in outer:
                outer[rate.name] = replace(outer[q.name], name=rate.name, meaning="")
    time = _argument(e.t, "Time", outer)
    positions = [_argument(q, "Coordinate", outer) for q in e.coordinates]
    velocities = [_argument(q, "", outer) for q in e.velocities]
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
    if stations is not None:  # what closes a loop at two levels, before the velocities are known
        arrays["constraints"]["velocity_rhs"] = e.velocity_rhs
    states = {"constraints": positions, "dynamics": [*positions, *velocities]}
    if v is not None:
        arrays["variations"] = {
            "damping": v.damping,
            "stiffness": v.stiffness,
            "jacobian_rate": v.jacobian_rate,
            "jacobian_acceleration": v.jacobian_acceleration,
        }
        more = [_argument(a, "", outer) for a in v.accelerations]
        more += [_argument(lam, "Multiplier", outer) for lam in e.multipliers]
        states["variations"] = [*positions, *velocities, *more]
    forms = [matrix for group in arrays.values() for matrix in group.values()]
    forms += [part for block in system.blocks.values() for part in block.expressions]
    values = external_values([*forms, *(value for _, value in system.steps.steps)])
    blocks = {name: block.with_each(values.plain) for name, block in system.blocks.items()}
    external = values.symbols if modes is None else sp.symbols(modes.external)
    passed = [_argument(s, "Passed in", outer) for s in external]
    indexed = modes or stations
    handed = (*(stations.tangent if stations else ()), *(indexed.numbers if indexed else ()))
    numbers = [outer[name] for name in handed]
    kernels = [
        _ArrayKernel(
            name,
            _SUMMARIES[name],
            (*states[name], time, *passed, *description.parameters, *numbers),
            {key: values.plain(matrix) for key, matrix in arrays[name].items()},
            () if modes is None else (IDENTITY.name, *modes.numbers),
            {key: block for key, block in blocks.items() if key in arrays[name]},
        )
        for name in arrays
    ]
    tables: tuple[Table, ...] = (
        Table("COORDINATES", tuple(q.name for q in e.coordinates)),
        Table("MULTIPLIERS", tuple(lam.name for lam in e.multipliers)),
        Table("EXTERNAL", tuple(s.name for s in external)),
    )
    if modes is not None:
        words = "Coordinate that stands for one of each mode, and the numbers of modes and pairs."
        tables += (Table("MODES", (modes.amplitude, modes.numbers), words),)
    if stations is not None:
        parts = (stations.angle, stations.tangent, stations.numbers)
        tables += (Table("STATIONS", parts, _STATION_WORDS),)
    tables += drops_table(system.dropped)
    steps = _plain_steps(system.steps, values)
    return _module(spec, "constrained", kernels, steps, description, tables)


_STATION_WORDS = (
    "Coordinate that stands for one of each station, its cosine and sine, and the numbers of "
    "stations and pairs.  In ARRAYS a matrix over the stations has its diagonal and, beside it, "
    "products of factors of the rows, a kernel, and factors of the columns."
)
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
    sizes = (Table("SIZE", system.matrix.rows),)
    return _module(spec, "transcendental", (kernel,), system.steps, description, sizes)


def _argument(symbol: sp.Symbol, word: str, known: Mapping[str, Argument]) -> Argument:
    """Return the argument as the description words it, or in a general form."""
    general = Argument(symbol.name, "float or ndarray, shape (...)", "", word)
    return known.get(symbol.name, general)


def _plain_steps(steps: Steps, values: ExternalValues) -> Steps:
    return Steps(tuple((symbol, values.plain(value)) for symbol, value in steps.steps))


@dataclass(frozen=True)
class _ArrayKernel:
    """One function that returns the entries of several arrays: no zeros, and equal ones once.

    An entry that is a sum of numbers times some of the ``matrices`` returns these numbers.
    """

    name: str
    summary: str
    arguments: tuple[Argument, ...]
    arrays: Mapping[str, sp.ImmutableDenseMatrix]
    matrices: tuple[str, ...] = ()
    blocks: Mapping[str, Block] = field(default_factory=dict)

    def lowered(self, steps: Steps) -> tuple[Kernel, dict[str, object]]:
        """Return the kernel and, by array, its shape and where each returned entry belongs."""
        found: dict[sp.Expr, int] = {}
        results: list[Result] = []
        places: dict[str, object] = {}

        def place(entry: sp.Expr, *name: str) -> int:
            if entry not in found:
                found[entry] = len(results)
                results.append(Result("_".join(name), "float or ndarray", "", ""))
            return found[entry]

        for array, matrix in self.arrays.items():
            entries: list[tuple[object, ...]] = []
            for (i, j), entry, kind in self._filled(matrix):
                at = place(entry, array, str(i + 1), str(j + 1), *kind)
                entries.append((i, j, at, *kind))
            if array in self.blocks:
                block, i, j = self.blocks[array], matrix.rows - 1, matrix.cols - 1
                where = array, str(i + 1), str(j + 1)
                if block.diagonal != 0:
                    entries.append((i, j, place(block.diagonal, *where, "diagonal")))
                for number, (left, kernel, right) in enumerate(block.products, start=1):
                    sides = (
                        place(side, *where, kernel.name, f"{word}{number}")
                        for side, word in ((left, "left"), (right, "right"))
                    )
                    first, second = sides
                    entries.append((i, j, first, kernel.name, second))
            places[array] = (matrix.shape, tuple(entries))
        outputs = list(zip(results, found, strict=True))
        return lower_kernel(self.name, self.summary, self.arguments, steps, outputs), places

    def _filled(
        self, matrix: sp.ImmutableDenseMatrix
    ) -> Iterable[tuple[tuple[int, int], sp.Expr, tuple[str, ...]]]:
        """Yield place, value and the matrix that the value multiplies, if there is one."""
        last = matrix.rows - 1, matrix.cols - 1
        for i, j in product(range(matrix.rows), range(matrix.cols)):
            if matrix[i, j] == 0:
                continue
            if not self.matrices or (i, j) != last or matrix.rows != matrix.cols:
                yield (i, j), matrix[i, j], ()
                continue
            for name in self.matrices:
                factor = sp.diff(matrix[i, j], sp.Symbol(name))
                if factor != 0:
                    yield (i, j), factor, (name,)


def _module(
    spec: ModelSpec,
    family: Family,
    kernels: Sequence[_ArrayKernel],
    steps: Steps,
    description: Description,
    tables: tuple[Table, ...],
) -> ModuleSpec:
    """Put a module together; a function all of whose entries are zero is not emitted."""
    lowered = [kernel.lowered(steps) for kernel in kernels]
    arrays = {kernel.name: places for kernel, places in lowered}
    words = "Of each function its arrays: shape, and row, column and place among what it returns."
    return ModuleSpec(
        spec=spec,
        family=family,
        title=description.title,
        notes=description.notes,
        references=description.references,
        kernels=tuple(kernel for kernel, _ in lowered if kernel.results),
        parameters=description.parameters,
        tables=(*tables, Table("ARRAYS", arrays, words)),
    )
