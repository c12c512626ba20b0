"""The record of what a scene needs and what it skips, in numbers and in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
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
    array_kinds: Mapping[str, str]
    powers: Mapping[str, tuple[str, ...]]
    samples: int
    angles: int
    harmonics: int

    @property
    def skipped_arrays(self) -> tuple[str, ...]:
        """Arrays of the system that are absent or zero, and are never added up."""
        return tuple(name for name, kind in self.array_kinds.items() if kind in {"absent", "zero"})

    @property
    def modules(self) -> int:
        """Modules of this toolkit that load when every step is taken."""
        return sum(stage.modules for stage in self.stages.values())

    def lines(self) -> list[str]:
        """Return the explanation as lines of text."""
        from .wording import lines_of

        return lines_of(self)

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
