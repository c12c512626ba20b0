"""The record of what a scene needs and what it skips, in numbers and in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ...core.plotting import axes_or_new
from ...core.results import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Stage:
    """What one step of using a scene loads and runs, beyond the steps before it.

    Attributes
    ----------
    modules, size : int
        Modules of this toolkit that load, and bytes of their sources.
    emitted : tuple of str
        Emitted modules among them.
    numpy, scipy : int
        Modules of NumPy and SciPy that load.
    heavy : tuple of str
        Packages that load and that no solver needs, such as SymPy.
    calls : mapping of str to int
        How often each emitted function is called, by ``module.function``.
    points : mapping of str to int
        At how many points in all: angles, sections, roots.
    operations : int
        Arithmetic operations of these calls: operations of the function times points.
    refused : str
        Why the scene cannot do this step; empty where it can.
    """

    modules: int
    size: int
    emitted: tuple[str, ...]
    numpy: int
    scipy: int
    heavy: tuple[str, ...]
    calls: Mapping[str, int]
    points: Mapping[str, int]
    operations: int
    refused: str = ""


@dataclass(frozen=True)
class EmittedUse:
    """One emitted module that serves the scene, beside the one that leaves nothing out.

    Attributes
    ----------
    kept, dropped : tuple of str
        Physical terms that the model can leave out: those that stayed, and those that did not.
    size, operations : int
        Bytes of its text; operations of all its functions together.
    full_size, full_operations : int or None
        The same of the module of the same formulation with every term and every output; None
        where that one was not emitted.
    functions : mapping of str to int
        Operations per evaluation of each function.
    called : tuple of str
        Functions that some step of :attr:`Explanation.stages` called.
    left_out : tuple of str
        Terms that the formulation itself leaves out of the energies.
    """

    kept: tuple[str, ...]
    dropped: tuple[str, ...]
    size: int
    operations: int
    full_size: int | None
    full_operations: int | None
    functions: Mapping[str, int]
    called: tuple[str, ...]
    left_out: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Explanation(Result):
    """What a scene needs, stage by stage, and what is skipped.

    Attributes
    ----------
    scene, model : str
        The scene, and the emitted module that its ``[model]`` table names.
    terms : mapping of str to str
        Physical terms that the scene may leave out: ``"kept"`` or ``"dropped"``.
    outputs : mapping of str to str
        What the module may be wanted for: ``"wanted"`` or ``"not wanted"``.
    emitted : mapping of str to EmittedUse
        Emitted modules that serve the scene.
    packaged : tuple of int
        Packaged modules, their bytes and operations, all together.
    stages : mapping of str to Stage
        Steps of using the scene in a fresh process, in order.
    array_kinds : mapping of str to str
        Each array of the scene's system: ``"absent"``, ``"zero"``, ``"constant"`` or
        ``"periodic"``; of a constrained system how many entries are evaluated.
    powers : mapping of str to tuple of str
        Powers of the crank speed at which a sweep needs arrays, each with the parameters'
        monomials that multiply them there.
    samples : int
        Arrays that are sampled over the angle, once for all points of a sweep at constant speed.
    angles : int
        Crank angles at which each is sampled; 0 where nothing depends on the angle.
    harmonics : int
        Highest harmonic of the crank's turn that a coefficient holds.
    """

    scene: str
    model: str
    terms: Mapping[str, str]
    outputs: Mapping[str, str]
    emitted: Mapping[str, EmittedUse]
    packaged: tuple[int, int, int]
    stages: Mapping[str, Stage]
    array_kinds: Mapping[str, str] = field(default_factory=dict)
    powers: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    samples: int = 0
    angles: int = 0
    harmonics: int = 0

    @property
    def skipped_arrays(self) -> tuple[str, ...]:
        """Arrays of the system that are absent or zero, and are never added up."""
        return tuple(name for name, kind in self.array_kinds.items() if kind in {"absent", "zero"})

    @property
    def modules(self) -> int:
        """Modules of this toolkit that load when every step is taken."""
        return sum(stage.modules for stage in self.stages.values())

    def lines(self) -> list[str]:
        """Return the explanation as text: derivation, emission, import, evaluation."""
        return [
            f"{self.scene}: module {self.model}",
            *_derivation(self),
            *_emission(self),
            *_imports(self),
            *_evaluation(self),
        ]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the operations of each step and return the axes."""
        ax = axes_or_new(ax)
        done = {name: s.operations for name, s in self.stages.items() if s.calls}
        names = list(done)[::-1]
        ax.barh(names, [done[name] for name in names], color="C0")
        for place, name in enumerate(names):
            ax.annotate(
                f" {done[name]}", (done[name], place), va="center", fontsize="small", color="0.3"
            )
        ax.set_xscale("symlog", linthresh=10.0)
        ax.margins(x=0.12)
        ax.set_xlabel("operations of emitted functions")
        ax.set_title(self.scene, fontsize="medium")
        return ax


def _derivation(found: Explanation) -> Iterator[str]:
    yield "derivation"
    yield f"  terms kept: {_with(found.terms, 'kept')}; left out: {_with(found.terms, 'dropped')}"
    for name, use in found.emitted.items():
        if use.left_out:
            yield f"  left out by the formulation of {name}: {', '.join(use.left_out)}"
    if found.outputs:
        wanted, rest = _with(found.outputs, "wanted"), _with(found.outputs, "not wanted")
        yield f"  outputs wanted: {wanted}; not wanted: {rest}"


def _with(table: Mapping[str, str], kind: str) -> str:
    return ", ".join(name for name, own in table.items() if own == kind) or "none"


def _emission(found: Explanation) -> Iterator[str]:
    count, size, operations = found.packaged
    yield "emission"
    yield (
        f"  {len(found.emitted)} of {count} emitted modules serve it: "
        f"{sum(use.size for use in found.emitted.values())} of {size} bytes, "
        f"{sum(use.operations for use in found.emitted.values())} of {operations} operations"
    )
    for name, use in found.emitted.items():
        yield f"  {name}: {use.size} bytes, {use.operations} operations{_beside(use)}"
        if use.dropped:
            yield f"    without {', '.join(use.dropped)}"
        yield "    called: " + _counts({n: use.functions[n] for n in use.called})
        idle = {n: c for n, c in use.functions.items() if n not in use.called}
        if idle:
            yield "    not called: " + _counts(idle)


def _beside(use: EmittedUse) -> str:
    if use.full_operations is None or use.full_size == use.size:
        return ""
    return f" (with every term {use.full_size} bytes, {use.full_operations} operations)"


def _counts(functions: Mapping[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in functions.items()) or "none"


def _imports(found: Explanation) -> Iterator[str]:
    yield "import, in a fresh process, each step beyond the ones before it"
    for name, stage in found.stages.items():
        yield f"  {name}: {_loaded(stage)}"
    heavy = sorted({package for stage in found.stages.values() for package in stage.heavy})
    idle = sorted(
        {module for stage in found.stages.values() for module in stage.emitted} - set(found.emitted)
    )
    if idle:
        yield f"  loaded and never called: {', '.join(idle)}"
    yield f"  of SymPy, Jinja2, matplotlib, pint and their like: {', '.join(heavy) or 'none'}"


def _loaded(stage: Stage) -> str:
    text = f"{stage.modules} modules, {stage.size} bytes"
    others = [
        f"{getattr(stage, top)} of {top}" for top in ("numpy", "scipy") if getattr(stage, top)
    ]
    return ", ".join([text, *others]) + (f"; refused: {stage.refused}" if stage.refused else "")


def _evaluation(found: Explanation) -> Iterator[str]:
    yield "evaluation"
    for name, stage in found.stages.items():
        if stage.calls:
            yield f"  {name}: {stage.operations} operations of emitted functions"
            yield from _called(stage)
    kinds: dict[str, list[str]] = {}
    for name, kind in found.array_kinds.items():
        kinds.setdefault(kind, []).append(name)
    if kinds:
        yield "  arrays of the system" + ("" if found.powers else ", entries that are evaluated")
    for kind, names in kinds.items():
        yield f"    {kind}: {', '.join(names)}"
    if found.powers:
        yield from _shared(found)


def _called(stage: Stage) -> Iterator[str]:
    """Yield a line for each emitted module that a stage calls."""
    told: dict[str, list[str]] = {}
    for name, times in stage.calls.items():
        module, _, function = name.rpartition(".")
        points = stage.points[name]
        more = f" in {times} calls" if times > 1 else ""
        told.setdefault(module, []).append(
            f"{function} at {points} point{'s' * (points > 1)}{more}"
        )
    for module, functions in told.items():
        yield f"    {module}: {', '.join(functions)}"


def _shared(found: Explanation) -> Iterator[str]:
    where = f"at {found.angles} angles (harmonics to {found.harmonics})" if found.angles else "once"
    share = f"{found.samples} arrays, sampled {where}"
    yield f"  shared by all points of a sweep at constant speed: {share}"
    for power, monomials in found.powers.items():
        label = "while the crank accelerates" if power == "acceleration" else f"speed^{power}"
        yield f"    {label}: {', '.join(monomials)}"
