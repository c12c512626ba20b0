"""``explain``: a scene's needs at derivation, emission, import and evaluation, each counted."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from ...derive.spec import BEAM_FORMULATIONS, Entry, ModelSpec, read_manifest
from ..core.errors import ElastolinkError, bad
from ..core.families import LinearPeriodic
from ..core.modules import search_path
from ..core.results import Check, provenance
from ..scenes import Scene, load_scene
from .emitted import EmittedCost, read_cost
from .evaluation import Evaluated, of_entries, of_linear
from .explanation import EmittedUse, Explanation, Stage

# What must not load, whatever is asked of a scene; reading units takes pint, which takes Jinja2.
_UNWANTED = ("sympy", "jinja2", "mpmath", "matplotlib")
_BROUGHT = {"jinja2": "pint"}
_PATIENCE = 600.0


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
    costs = _costs(counted, known)
    if isinstance(system, LinearPeriodic):
        evaluated = of_linear(system, 1.0 if speed is None else speed)
    else:
        evaluated = Evaluated() if system is None else of_entries(costs)
    return _explanation(loaded, counted, known, costs, evaluated)


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
    import numpy as np

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
        timeout=_PATIENCE,
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


def _costs(
    counted: list[dict[str, Any]], known: Mapping[str, tuple[Path, Entry]]
) -> dict[str, EmittedCost]:
    """Return the costs of the emitted modules that some stage called, by module."""
    called = {_bare(call[0]) for stage in counted for call in stage["calls"]}
    by_name = {entry.module: folder for folder, entry in known.values()}
    return {
        name: read_cost(by_name[name] / f"{name}.py") for name in sorted(called) if name in by_name
    }


def _bare(module: str) -> str:
    """Return an emitted module's own name: outside the package its hash is part of another."""
    prefix = "elastolink_emitted_"
    return module.removeprefix(prefix).rpartition("_")[0] if module.startswith(prefix) else module


def _explanation(
    scene: Scene,
    counted: list[dict[str, Any]],
    known: Mapping[str, tuple[Path, Entry]],
    costs: Mapping[str, EmittedCost],
    evaluated: Evaluated,
) -> Explanation:
    stages = {found["name"]: _stage(found, costs) for found in counted}
    unwanted = sum(_unwanted(stage) for stage in stages.values())
    entries = {entry.module: entry.spec for _, entry in known.values()}
    packaged = [read_cost(folder / f"{entry.module}.py") for folder, entry in known.values()]
    return Explanation(
        scene=scene.name,
        model=scene.model_spec().name(),
        terms=_terms(scene),
        outputs=_outputs(scene),
        emitted={
            name: _use(cost, _as_used(entries[name], scene.model_spec()), known, counted)
            for name, cost in costs.items()
        },
        packaged=(
            len(packaged),
            sum(cost.size for cost in packaged),
            sum(cost.total for cost in packaged),
        ),
        stages=stages,
        array_kinds=evaluated.arrays,
        powers=evaluated.powers,
        samples=evaluated.samples,
        angles=evaluated.angles,
        harmonics=evaluated.harmonics,
        method="manifests and headers read, a process counted",
        error=0.0,
        error_norm="counts, exact",
        error_kind="bound",
        checks={"packages that load and solve nothing": Check(float(unwanted), 0.0)},
        provenance=provenance({"scene": scene.name, "scene_digest": scene.digest()}),
    )


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
        emitted=tuple(_last(name) for name in names if _is_emitted(name)),
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


def _is_emitted(name: str) -> bool:
    return name.startswith(("elastolink.generated.", "elastolink_emitted_"))


def _last(name: str) -> str:
    return _bare(name.rpartition(".")[2])


def _choices(spec: ModelSpec) -> tuple[str, ...]:
    """Return the terms that the packaged model of a spec can leave out."""
    from ...derive.catalogue import find

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
        from ..scenes.beam_tables import DROPPED

        offered, dropped = DROPPED, set(scene.model["drop"])
    return {name: "dropped" if name in dropped else "kept" for name in sorted(offered)}


def _outputs(scene: Scene) -> dict[str, str]:
    wanted = set(scene.model["outputs"]) or set(scene.layout.outputs)
    return {
        name: "wanted" if name in wanted else "not wanted" for name in sorted(scene.layout.outputs)
    }


def _as_used(spec: ModelSpec, wanted: ModelSpec) -> ModelSpec:
    """Return the spec of a module, with the terms that it leaves out itself for a scene."""
    general = wanted.with_(drop=(), modes=spec.modes)
    return spec.with_(drop=wanted.drop) if spec == general else spec


def _use(
    cost: EmittedCost,
    spec: ModelSpec,
    known: Mapping[str, tuple[Path, Entry]],
    counted: list[dict[str, Any]],
) -> EmittedUse:
    """Put a module beside the one of the same formulation that leaves nothing out."""
    whole = known.get(spec.with_(drop=(), balanced=(), outputs=()).key())
    full = read_cost(whole[0] / f"{whole[1].module}.py") if whole else None
    called = {
        call[1] for stage in counted for call in stage["calls"] if _bare(call[0]) == cost.module
    }
    return EmittedUse(
        kept=tuple(term for term in sorted(_choices(spec)) if term not in spec.drop),
        dropped=spec.drop,
        size=cost.size,
        operations=cost.total,
        full_size=full.size if full else None,
        full_operations=full.total if full else None,
        functions=cost.operations,
        called=tuple(name for name in cost.operations if name in called),
        left_out=cost.left_out,
    )
