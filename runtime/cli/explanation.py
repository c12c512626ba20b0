"""``explain``: a scene's needs at derivation, emission, import and evaluation, each counted."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ...derive.spec import BEAM_FORMULATIONS, Entry, ModelSpec, read_manifest
from ..core.errors import ElastolinkError, bad
from ..core.families import MATRICES, VECTORS, LinearPeriodic
from ..core.modules import search_path
from ..core.plotting import Axes, axes_or_new
from ..core.results import Check, Result, provenance
from ..periodic.equation import SPEED_POWER, equation_of
from ..scenes import Scene, load_scene
from .probe import EMITTED, bare_name

# What must not load, whatever is asked of a scene; reading units takes pint, which takes Jinja2.
_UNWANTED = ("sympy", "jinja2", "mpmath", "matplotlib")
_BROUGHT = {"jinja2": "pint"}
# What the header of an emitted module says.
_COUNT = re.compile(r"^ {4}(\w+): (\d+) operations?$", re.MULTILINE)
_LEFT_OUT = re.compile(r"Left out of the energies: ([^.]*)\.")


@dataclass(frozen=True)
class Stage:
    """What one step of using a scene loads and runs, beyond the steps before it."""

    modules: int  # of this toolkit that load
    size: int  # bytes of their sources
    emitted: tuple[str, ...]  # emitted modules among them
    numpy: int  # modules of NumPy and of SciPy that load
    scipy: int
    heavy: tuple[str, ...]  # packages that load and that no solver needs, such as SymPy
    calls: Mapping[str, int]  # how often each emitted function is called, by module.function
    points: Mapping[str, int]  # at how many points in all: angles, sections, roots
    operations: int  # arithmetic of these calls: operations of the function times points
    refused: str  # why the scene cannot do this step; empty where it can


@dataclass(frozen=True)
class EmittedUse:
    """What one emitted module costs, and how a scene uses it."""

    size: int  # bytes of its text
    operations: int  # of all its functions together
    functions: Mapping[str, int]  # operations per evaluation of each function
    left_out: tuple[str, ...]  # terms that the formulation itself leaves out of the energies
    kept: tuple[str, ...] = ()  # physical terms that the model can leave out, and that stayed
    dropped: tuple[str, ...] = ()  # and those that did not
    called: tuple[str, ...] = ()  # functions that some step of Explanation.stages called
    # Of the module of the same formulation with every term and output; None if not emitted.
    full_size: int | None = None
    full_operations: int | None = None


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

    def lines(self) -> list[str]:
        """Return the explanation as text: derivation, emission, import, evaluation."""
        title = f"{self.scene}: module {self.model}"
        return [title, *_emission_lines(self), *_import_lines(self), *_evaluation_lines(self)]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the operations of each step and return the axes."""
        ax = axes_or_new(ax)
        done = {name: s.operations for name, s in self.stages.items() if s.calls}
        names = list(done)[::-1]
        ax.barh(names, [done[name] for name in names], color="C0")
        look: dict[str, Any] = {"va": "center", "fontsize": "small", "color": "0.3"}
        for place, name in enumerate(names):
            ax.annotate(f" {done[name]}", (done[name], place), **look)
        ax.set_xscale("symlog", linthresh=10.0)
        ax.margins(x=0.12)
        ax.set_xlabel("operations of emitted functions")
        ax.set_title(self.scene, fontsize="medium")
        return ax


def explain(
    scene: Scene | str | PathLike[str], overrides: Mapping[str, Any] | None = None
) -> Explanation:
    """Report what a scene needs and what is pruned and shared, stage by stage.

    Derivation and emission are read from the manifests and the headers of the emitted modules;
    imports and calls are counted in a fresh process that loads the scene, builds its system and
    puts the usual questions to it.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, or its built-in name or file: then loading is counted, too, and with it what
        reading units takes.
    overrides : mapping, optional
        As for :func:`~elastolink.runtime.scenes.load_scene`; with a name or file only.

    Returns
    -------
    Explanation
        Counts, exact for the version in use; :meth:`Explanation.lines` says them in words.

    Raises
    ------
    BadInput
        If there is no such scene, something in it is wrong, or its module was not emitted yet.

    Examples
    --------
    >>> import elastolink as el
    >>> print(el.explain("mathieu").array_kinds["Kg"])
    periodic
    """
    request: dict[str, Any]
    if isinstance(scene, Scene):
        if overrides:
            raise bad("overrides", "some, beside a scene", "none", "load the scene with them")
        loaded, request = scene, {"scene": pickle.dumps(scene)}
    else:
        loaded = load_scene(scene, overrides)
        request = {"name": str(scene), "overrides": dict(overrides or {})}
    system = _system(loaded)
    speed = None if system is None else _speed(loaded, system)
    counted = _counted({**request, "speed": speed})
    outputs = sorted(loaded.layout.outputs)
    wanted = loaded.model["outputs"] or outputs
    known = _known()
    costs = {entry.module: cost for entry, cost in known.values()}
    each = {f"{name}.{f}": n for name, cost in costs.items() for f, n in cost.functions.items()}
    stages = {}
    for name, counts in counted.items():
        operations = sum(count * each.get(called, 0) for called, count in counts["points"].items())
        stages[name] = Stage(**counts, operations=operations)
    called = {name for stage in stages.values() for name in stage.calls}
    serving = sorted({name.rpartition(".")[0] for name in called} & set(costs))
    evaluated: dict[str, Any] = {}
    if isinstance(system, LinearPeriodic):
        evaluated = _of_linear(system, 1.0 if speed is None else speed)
    elif system is not None:
        evaluated = {"array_kinds": _filled_entries(serving)}
    unwanted = sum(
        package in _UNWANTED and _BROUGHT.get(package) not in stage.heavy
        for stage in stages.values()
        for package in stage.heavy
    )
    return Explanation(
        scene=loaded.name,
        model=loaded.model_spec().name(),
        terms=_terms(loaded),
        outputs={name: "wanted" if name in wanted else "not wanted" for name in outputs},
        emitted={name: _use(name, loaded, known, called) for name in serving},
        packaged=(
            len(costs),
            sum(cost.size for cost in costs.values()),
            sum(cost.operations for cost in costs.values()),
        ),
        stages=stages,
        **evaluated,
        method="manifests and headers read, a process counted",
        error=0.0,
        error_norm="counts, exact",
        error_kind="bound",
        checks={"packages that load and solve nothing": Check(float(unwanted), 0.0)},
        provenance=provenance({"scene": loaded.name, "scene_digest": loaded.digest()}),
    )


def _system(scene: Scene) -> Any:
    """Return the system of a scene; None where its links are rigid."""
    if scene.layout.flexible or not scene.layout.formulations or "links" not in scene:
        return scene.system()
    scene.mechanism()
    return None


def _speed(scene: Scene, system: Any) -> float:
    """Return the scene's crank speed, or one at which its system vibrates [rad/s]."""
    if (speed := scene.get("operation.speed", None)) is not None:
        return float(speed)
    if (ends := scene.get("operation.speed_range", None)) is not None:
        return float(ends[0] + ends[1]) / 2.0
    if scene.model["mechanism"] == "hill" or not isinstance(system, LinearPeriodic):
        return 1.0
    mass, stiffness = system.array("M", 0.0)[0], system.array("K", 0.0)[0]
    lowest = float(np.min(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))
    return lowest**0.5 if lowest > 0.0 else 1.0


def _counted(request: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the stages as counted in a fresh process."""
    path = [entry for entry in sys.path if entry]
    code = f"import sys; sys.path[:] = {path!r}; from {__package__}.probe import main; main()"
    command, given = [sys.executable, "-c", code], pickle.dumps(dict(request))
    done = subprocess.run(command, input=given, capture_output=True, timeout=600.0, check=False)
    if done.returncode:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        raise ElastolinkError(f"explain: the counting process failed: {' '.join(last)}")
    stages: dict[str, dict[str, Any]] = pickle.loads(done.stdout)
    return stages


def _known() -> dict[str, tuple[Entry, EmittedUse]]:
    """Return entry and cost of every emitted module that can be found, by spec key."""
    found: dict[str, tuple[Entry, EmittedUse]] = {}
    for folder in search_path():
        for key, entry in read_manifest(folder).items():
            file = folder / f"{entry.module}.py"
            if key not in found and file.is_file():
                found[key] = entry, read_cost(file)
    return found


def read_cost(path: Path) -> EmittedUse:
    """Read the cost of an emitted module from the header of its file; refuse any other file.

    Nothing of it is imported or run.
    """
    content = path.read_bytes()
    header = content.decode().partition('"""')[2].partition('"""')[0]
    counts = {name: int(count) for name, count in _COUNT.findall(header)}
    if not counts:
        raise bad(str(path), "no operation counts", "an emitted module", "choose another file")
    left_out = _LEFT_OUT.search(header)
    terms = tuple(left_out.group(1).split(", ")) if left_out else ()
    return EmittedUse(len(content), sum(counts.values()), counts, terms)


def _use(
    name: str, scene: Scene, known: Mapping[str, tuple[Entry, EmittedUse]], called: set[str]
) -> EmittedUse:
    """Put a module beside the one of the same formulation that leaves nothing out."""
    spec, cost = next((entry.spec, cost) for entry, cost in known.values() if entry.module == name)
    wanted = scene.model_spec()
    if spec == wanted.with_(drop=(), modes=spec.modes):
        spec = spec.with_(drop=wanted.drop)  # a general module leaves the terms out itself
    _, full = known.get(spec.with_(drop=(), balanced=(), outputs=()).key(), (None, None))
    return replace(
        cost,
        kept=tuple(term for term in sorted(_choices(spec)) if term not in spec.drop),
        dropped=spec.drop,
        called=tuple(n for n in cost.functions if f"{name}.{n}" in called),
        full_size=full.size if full else None,
        full_operations=full.operations if full else None,
    )


def _choices(spec: ModelSpec) -> tuple[str, ...]:
    """Return the terms that the packaged model of a spec can leave out."""
    from ...derive.catalogue import find

    try:
        return find(spec).choices.drop
    except LookupError:  # a model of the user's own, which says so in no manifest
        return spec.drop


def _terms(scene: Scene) -> dict[str, str]:
    spec = scene.model_spec()
    offered, dropped = _choices(spec), set(spec.drop)
    if scene.model["formulation"] in BEAM_FORMULATIONS:
        from ..scenes.beam_tables import DROPPED

        offered, dropped = DROPPED, set(scene.model["drop"])
    return {name: "dropped" if name in dropped else "kept" for name in sorted(offered)}


def _of_linear(system: LinearPeriodic, speed: float) -> dict[str, Any]:
    """Return what a linear-periodic system evaluates, as fields of an :class:`Explanation`.

    What the system's own parameters make zero counts as zero; harmonics are judged at ``speed``.
    Among the powers of the speed in the equation of motion in time ``M qdd``, with
    ``qdd = w^2 q''``, counts as 2; what acts only while the crank accelerates stands apart.
    """
    scales = system.scale_values()
    alive = [
        term
        for row, term in enumerate(system.terms)
        if np.any(system.spectrum(row)) and (term.scale is None or np.any(scales[term.scale]))
    ]
    kinds = {}
    for array in MATRICES + VECTORS:
        acting = [term for term in alive if term.array == array]
        kinds[array] = "zero" if system.has(array) else "absent"
        if acting:
            kinds[array] = "constant" if all(term.constant for term in acting) else "periodic"
    steady = [term for term in alive if term.array in SPEED_POWER]
    moving = any(not term.constant for term in steady)
    equation = equation_of(system, speed, forcing=True) if moving else None
    powers: dict[str, set[str]] = {}
    for term in alive:
        power = SPEED_POWER.get(term.array)
        key = "acceleration" if power is None else str(power + 2 + term.power)
        powers.setdefault(key, set()).add(f"{term.array}: {term.scale or '1'}")
    return {
        "array_kinds": kinds,
        "powers": {key: tuple(sorted(powers[key])) for key in sorted(powers, reverse=True)},
        "samples": len(steady),
        "angles": len(equation.even_angles()) if equation else 0,
        "harmonics": equation.reach if equation else 0,
    }


def _filled_entries(serving: list[str]) -> dict[str, str]:
    """Return how many entries of each array a constrained system evaluates; the rest is zero."""
    loaded = [name for name in sys.modules if name.startswith(EMITTED)]
    modules = {bare_name(name): sys.modules[name] for name in loaded}
    return {
        f"{function}.{array}": f"{len(filled)} of {rows * columns}"
        for name in serving
        if name in modules and modules[name].FAMILY == "constrained"
        for function, arrays in modules[name].ARRAYS.items()
        for array, ((rows, columns), filled) in arrays.items()
    }


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "none"


def _by_kind(kinds: Mapping[str, str]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = defaultdict(list)
    for name, kind in kinds.items():
        found[kind].append(name)
    return found


def _emission_lines(found: Explanation) -> Iterator[str]:
    terms, outputs = _by_kind(found.terms), _by_kind(found.outputs)
    yield "derivation"
    yield f"  terms kept: {_listed(terms['kept'])}; left out: {_listed(terms['dropped'])}"
    for name, use in found.emitted.items():
        if use.left_out:
            yield f"  left out by the formulation of {name}: {', '.join(use.left_out)}"
    if found.outputs:
        wanted, others = (_listed(outputs[kind]) for kind in ("wanted", "not wanted"))
        yield f"  outputs wanted: {wanted}; not wanted: {others}"
    count, size, operations = found.packaged
    uses = found.emitted.values()
    yield "emission"
    yield (
        f"  {len(uses)} of {count} emitted modules serve it: "
        f"{sum(use.size for use in uses)} of {size} bytes, "
        f"{sum(use.operations for use in uses)} of {operations} operations"
    )
    for name, use in found.emitted.items():
        beside = ""
        if use.full_operations is not None and use.full_size != use.size:
            full = f"{use.full_size} bytes, {use.full_operations} operations"
            beside = f" (with every term {full})"
        yield f"  {name}: {use.size} bytes, {use.operations} operations{beside}"
        if use.dropped:
            yield f"    without {', '.join(use.dropped)}"
        yield "    called: " + _listed([f"{n} {use.functions[n]}" for n in use.called])
        idle = [f"{n} {c}" for n, c in use.functions.items() if n not in use.called]
        if idle:
            yield f"    not called: {', '.join(idle)}"


def _import_lines(found: Explanation) -> Iterator[str]:
    yield "import, in a fresh process, each step beyond the ones before it"
    for name, stage in found.stages.items():
        tops = {"numpy": stage.numpy, "scipy": stage.scipy}
        others = "".join(f", {count} of {top}" for top, count in tops.items() if count)
        refused = f"; refused: {stage.refused}" if stage.refused else ""
        yield f"  {name}: {stage.modules} modules, {stage.size} bytes{others}{refused}"
    stages = found.stages.values()
    heavy = {package for stage in stages for package in stage.heavy}
    idle = {module for stage in stages for module in stage.emitted} - set(found.emitted)
    if idle:
        yield f"  loaded and never called: {', '.join(sorted(idle))}"
    yield f"  of SymPy, Jinja2, matplotlib, pint and their like: {_listed(sorted(heavy))}"


def _evaluation_lines(found: Explanation) -> Iterator[str]:
    yield "evaluation"
    for name, stage in found.stages.items():
        if not stage.calls:
            continue
        yield f"  {name}: {stage.operations} operations of emitted functions"
        calls: dict[str, list[str]] = defaultdict(list)
        for called, times in stage.calls.items():
            module, _, function = called.rpartition(".")
            points = stage.points[called]
            more = f" in {times} calls" if times > 1 else ""
            calls[module].append(f"{function} at {points} point{'s' * (points > 1)}{more}")
        yield from (f"    {module}: {', '.join(functions)}" for module, functions in calls.items())
    kinds = _by_kind(found.array_kinds)
    if kinds:
        yield "  arrays of the system" + ("" if found.powers else ", entries that are evaluated")
    yield from (f"    {kind}: {', '.join(names)}" for kind, names in kinds.items())
    if found.powers:
        sampled = f"at {found.angles} angles (harmonics to {found.harmonics})"
        shared = f"{found.samples} arrays, sampled {sampled if found.angles else 'once'}"
        yield f"  shared by all points of a sweep at constant speed: {shared}"
    for power, monomials in found.powers.items():
        label = "while the crank accelerates" if power == "acceleration" else f"speed^{power}"
        yield f"    {label}: {', '.join(monomials)}"
