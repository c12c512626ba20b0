"""``explain``: a scene's needs at derivation, emission, import and evaluation, each counted."""

from __future__ import annotations

import ast
import json
import pickle
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ....derive.spec import BEAM_FORMULATIONS, Entry, ModelSpec, read_manifest
from ...core.errors import ElastolinkError, bad
from ...core.families import MATRICES, VECTORS, LinearPeriodic
from ...core.modules import search_path
from ...core.results import Check, provenance
from ...periodic.equation import SPEED_POWER, equation_of
from ...scenes import Scene, load_scene
from .explanation import EmittedUse, Explanation, Stage
from .probe import emitted

# What must not load, whatever is asked of a scene; reading units takes pint, which takes Jinja2.
_UNWANTED = ("sympy", "jinja2", "mpmath", "matplotlib")
_BROUGHT = {"jinja2": "pint"}


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
    >>> found = explain("mathieu")
    >>> found.array_kinds["M"], found.array_kinds["Kg"], found.array_kinds["C"]
    ('constant', 'periodic', 'zero')
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
    known = _known()
    costs = {
        entry.module: read_cost(folder / f"{entry.module}.py") for folder, entry in known.values()
    }
    entries = {key: entry for key, (_, entry) in known.items()}
    called = {_bare(call[0]) for stage in counted for call in stage["calls"]}
    serving = sorted(called & set(costs))
    stages = {found["name"]: _stage(found, costs) for found in counted}
    unwanted = sum(_unwanted(stage) for stage in stages.values())
    evaluated: dict[str, Any] = {}
    if isinstance(system, LinearPeriodic):
        evaluated = _of_linear(system, 1.0 if speed is None else speed)
    elif system is not None:
        evaluated = {"array_kinds": _filled_entries([costs[name] for name in serving])}
    return Explanation(
        scene=loaded.name,
        model=loaded.model_spec().name(),
        terms=_terms(loaded),
        outputs=_outputs(loaded),
        emitted={name: _use(costs[name], loaded, entries, costs, stages) for name in serving},
        packaged=(
            len(costs),
            sum(cost.size for cost in costs.values()),
            sum(cost.total for cost in costs.values()),
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


def _counted(request: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the stages as counted in a fresh process."""
    path = [entry for entry in sys.path if entry]
    code = f"import sys; sys.path[:] = {path!r}; from {__package__}.probe import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code],
        input=pickle.dumps(dict(request)),
        capture_output=True,
        timeout=600.0,
        check=False,
    )
    if done.returncode:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        raise ElastolinkError(f"explain: the counting process failed: {' '.join(last)}")
    stages: list[dict[str, Any]] = json.loads(done.stdout)
    return stages


def _known() -> dict[str, tuple[Path, Entry]]:
    """Return folder and entry of every emitted module that can be found, by spec key."""
    found: dict[str, tuple[Path, Entry]] = {}
    for folder in search_path():
        for key, entry in read_manifest(folder).items():
            if key not in found and (folder / f"{entry.module}.py").is_file():
                found[key] = (folder, entry)
    return found


def _bare(module: str) -> str:
    """Return an emitted module's own name: outside the package its hash is part of another."""
    prefix = "elastolink_emitted_"
    return module.removeprefix(prefix).rpartition("_")[0] if module.startswith(prefix) else module


def _stage(found: Mapping[str, Any], costs: Mapping[str, EmittedCost]) -> Stage:
    calls, points, operations = {}, {}, 0
    for module, function, times, evaluated in found["calls"]:
        name = f"{_bare(module)}.{function}"
        calls[name], points[name] = times, evaluated
        cost = costs.get(_bare(module))
        operations += evaluated * (cost.operations.get(function, 0) if cost else 0)
    names = list(found["modules"])
    return Stage(
        modules=len(names),
        size=sum(found["modules"].values()),
        emitted=tuple(_bare(name.rpartition(".")[2]) for name in names if emitted(name)),
        numpy=found["others"]["numpy"],
        scipy=found["others"]["scipy"],
        heavy=tuple(found["heavy"]),
        calls=calls,
        points=points,
        operations=operations,
        refused=found["refused"],
    )


def _unwanted(stage: Stage) -> int:
    """Return how many packages loaded that nothing at run time has a use for."""
    return sum(name in _UNWANTED and _BROUGHT.get(name) not in stage.heavy for name in stage.heavy)


def _choices(spec: ModelSpec) -> tuple[str, ...]:
    """Return the terms that the packaged model of a spec can leave out."""
    from ....derive.catalogue import find

    try:
        return find(spec).choices.drop
    except LookupError:  # a model of the user's own, which says so in no manifest
        return spec.drop


def _terms(scene: Scene) -> dict[str, str]:
    """Return the terms that a scene may leave out, and whether it does."""
    spec = scene.model_spec()
    offered: tuple[str, ...] = _choices(spec)
    dropped = set(spec.drop)
    if scene.model["formulation"] in BEAM_FORMULATIONS:
        from ...scenes.beam_tables import DROPPED

        offered, dropped = DROPPED, set(scene.model["drop"])
    return {name: "dropped" if name in dropped else "kept" for name in sorted(offered)}


def _outputs(scene: Scene) -> dict[str, str]:
    wanted = set(scene.model["outputs"]) or set(scene.layout.outputs)
    known = sorted(scene.layout.outputs)
    return {name: "wanted" if name in wanted else "not wanted" for name in known}


def _use(
    cost: EmittedCost,
    scene: Scene,
    entries: Mapping[str, Entry],
    costs: Mapping[str, EmittedCost],
    stages: Mapping[str, Stage],
) -> EmittedUse:
    """Put a module beside the one of the same formulation that leaves nothing out."""
    spec = next(entry.spec for entry in entries.values() if entry.module == cost.module)
    wanted = scene.model_spec()
    if spec == wanted.with_(drop=(), modes=spec.modes):
        spec = spec.with_(drop=wanted.drop)  # a general module leaves the terms out itself
    whole = entries.get(spec.with_(drop=(), balanced=(), outputs=()).key())
    full = costs[whole.module] if whole else None
    called = {name for stage in stages.values() for name in stage.calls}
    return EmittedUse(
        kept=tuple(term for term in sorted(_choices(spec)) if term not in spec.drop),
        dropped=spec.drop,
        size=cost.size,
        operations=cost.total,
        full_size=full.size if full else None,
        full_operations=full.total if full else None,
        functions=cost.operations,
        called=tuple(n for n in cost.operations if f"{cost.module}.{n}" in called),
        left_out=cost.left_out,
    )


# What an emitted module costs, read from its text: nothing of it is imported or run.
_COUNT = re.compile(r"^ {4}(\w+): (\d+) operations?$", re.MULTILINE)
_LEFT_OUT = re.compile(r"Left out of the energies: ([^.]*)\.")
_TABLES = ("FAMILY", "ARRAYS")


@dataclass(frozen=True)
class EmittedCost:
    """What one emitted module costs.

    Attributes
    ----------
    module : str
        Its name.
    family : str
        System family, empty where it names none.
    size : int
        Bytes of its text.
    operations : mapping of str to int
        Arithmetic operations per evaluation of each function, from its header.
    entries : mapping of str to (int, int)
        Of each array of explicit entries, by ``function.array``: entries that are evaluated, and
        entries in all; the others are zero.
    left_out : tuple of str
        Terms that the formulation left out of the energies, from its header.
    """

    module: str
    family: str
    size: int
    operations: Mapping[str, int]
    entries: Mapping[str, tuple[int, int]]
    left_out: tuple[str, ...]

    @property
    def total(self) -> int:
        """Operations of all functions together."""
        return sum(self.operations.values())


def read_cost(path: Path) -> EmittedCost:
    """Read the cost of an emitted module from its header and tables.

    Parameters
    ----------
    path : Path
        Of the ``.py`` file.

    Raises
    ------
    BadInput
        If it is no emitted module.
    """
    text = path.read_text()
    tree = ast.parse(text)
    header = ast.get_docstring(tree, clean=False) or ""
    counts = {name: int(count) for name, count in _COUNT.findall(header)}
    if not counts:
        raise bad(str(path), "no operation counts", "an emitted module", "choose another file")
    left_out = _LEFT_OUT.search(header)
    tables = _tables(tree)
    return EmittedCost(
        module=path.stem,
        family=tables.get("FAMILY", ""),
        size=len(text.encode()),
        operations=counts,
        entries={
            f"{function}.{name}": (len(filled), rows * columns)
            for function, arrays in tables.get("ARRAYS", {}).items()
            for name, ((rows, columns), filled) in arrays.items()
        },
        left_out=tuple(left_out.group(1).split(", ")) if left_out else (),
    )


def _tables(tree: ast.Module) -> dict[str, Any]:
    """Return the literal tables of a module by name."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            if name in _TABLES:
                found[name] = ast.literal_eval(node.value)
    return found


def _of_linear(system: LinearPeriodic, speed: float) -> dict[str, Any]:
    """Return what a linear-periodic system evaluates, as fields of an :class:`Explanation`.

    What the system's own parameters make zero counts as zero; harmonics are judged at ``speed``.
    """
    alive = _alive(system)
    kinds = {}
    for array in MATRICES + VECTORS:
        rows = [row for row, term in enumerate(system.terms) if term.array == array]
        acting = [system.terms[row] for row in rows if row in alive]
        constant = all(term.constant for term in acting)
        kind = ("constant" if constant else "periodic") if acting else "zero"
        kinds[array] = kind if rows else "absent"
    steady = [row for row in alive if system.terms[row].array in SPEED_POWER]
    moving = [row for row in steady if not system.terms[row].constant]
    equation = equation_of(system, speed, forcing=True) if moving else None
    return {
        "array_kinds": kinds,
        "powers": _powers(system, alive),
        "samples": len(steady),
        "angles": len(equation.even_angles()) if equation else 0,
        "harmonics": equation.reach if equation else 0,
    }


def _alive(system: LinearPeriodic) -> list[int]:
    """Return the rows of the terms that are not zero at the system's parameters."""
    scales = system.scale_values()
    return [
        row
        for row, (term, amplitude) in enumerate(zip(system.terms, system.spectra, strict=True))
        if np.any(amplitude) and (term.scale is None or np.any(scales[term.scale]))
    ]


def _powers(system: LinearPeriodic, alive: list[int]) -> dict[str, tuple[str, ...]]:
    """Return the monomials by the power of the speed in the equation of motion in time.

    ``M qdd`` with ``qdd = w^2 q''`` counts as power 2; what acts only while the crank accelerates
    stands apart.
    """
    found: dict[str, set[str]] = {}
    for row in alive:
        term = system.terms[row]
        known = SPEED_POWER.get(term.array)
        key = "acceleration" if known is None else str(known + 2 + term.power)
        monomial = "1" if term.scale is None else term.scale
        found.setdefault(key, set()).add(f"{term.array}: {monomial}")
    return {key: tuple(sorted(names)) for key, names in sorted(found.items(), reverse=True)}


def _filled_entries(costs: list[EmittedCost]) -> dict[str, str]:
    """Return how many entries of each array a constrained system evaluates; the rest is zero."""
    return {
        array: f"{filled} of {entries}"
        for cost in costs
        if cost.family == "constrained"
        for array, (filled, entries) in cost.entries.items()
    }
