"""The process in which a scene is used while its imports and emitted functions are counted.

Standard library only at its top, so that everything that is loaded is the scene's doing.
"""

from __future__ import annotations

import os
import pickle
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, TypeAlias

# What no scene needs in order to be solved.
HEAVY = ("sympy", "jinja2", "mpmath", "matplotlib", "pint", "tqdm", "xarray", "numba", "heyoka")
EMITTED = ("elastolink.generated.", "elastolink_emitted_")
_COMMAND = __name__.rpartition(".")[0]

Step: TypeAlias = Callable[[str], AbstractContextManager[None]]


class Counter:
    """Counts, stage by stage, modules that load and emitted functions that run."""

    def __init__(self) -> None:
        self.stages: dict[str, dict[str, Any]] = {}
        self._known: set[str] = set()
        self._calls: dict[str, list[int]] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count what happens inside under a name; a refusal of the toolkit ends the stage."""
        from ..core.errors import ElastolinkError

        self._calls, refused = {}, ""
        sys.setprofile(self._watch)
        try:
            yield
        except ElastolinkError as error:
            refused = " ".join(str(error).split())
        finally:
            sys.setprofile(None)
        new = [loaded for loaded in list(sys.modules) if loaded not in self._known]
        self._known.update(new)
        emitted = [loaded for loaded in sorted(new) if loaded.startswith(EMITTED)]
        mine = [loaded for loaded in new if _inside(loaded, "elastolink") or loaded in emitted]
        mine = [loaded for loaded in mine if not _inside(loaded, _COMMAND)]
        calls = sorted(self._calls.items())
        self.stages[name] = {
            "modules": len(mine),
            "size": sum(map(_size, mine)),
            "emitted": tuple(map(bare_name, emitted)),
            **{top: sum(_inside(loaded, top) for loaded in new) for top in ("numpy", "scipy")},
            "heavy": tuple(top for top in HEAVY if top in new),
            "calls": {function: times for function, (times, _) in calls},
            "points": {function: points for function, (_, points) in calls},
            "refused": refused,
        }

    def _watch(self, frame: Any, event: str, _: object) -> None:
        if event != "call":
            return
        module = frame.f_globals.get("__name__", "")
        name = frame.f_code.co_name
        if not module.startswith(EMITTED) or name not in frame.f_globals.get("__all__", ()):
            return
        code = frame.f_code
        given = [frame.f_locals[key] for key in code.co_varnames[: code.co_argcount]]
        counts = self._calls.setdefault(f"{bare_name(module)}.{name}", [0, 0])
        counts[0] += 1
        counts[1] += max((int(getattr(value, "size", 1)) for value in given), default=1)


def bare_name(module: str) -> str:
    """Return an emitted module's own name: outside the package its hash is part of another."""
    name, prefix = module.rpartition(".")[2], EMITTED[1]
    return name.removeprefix(prefix).rpartition("_")[0] if name.startswith(prefix) else name


def _inside(name: str, package: str) -> bool:
    return name == package or name.startswith(f"{package}.")


def _size(name: str) -> int:
    path = getattr(sys.modules[name], "__file__", None)
    return os.path.getsize(path) if path else 0  # noqa: PTH202 - pathlib is one import more


def main() -> None:
    """Read a request from standard input, use its scene, write the counts to standard output."""
    request = pickle.load(sys.stdin.buffer)
    counter = Counter()
    warnings.simplefilter("ignore")
    scene = None
    with counter.stage("scene"):
        scene = _scene(request)
    if request["speed"] is None:
        _rigid(counter.stage, scene)
    else:
        _flexible(counter.stage, scene, request["speed"])
    pickle.dump(counter.stages, sys.stdout.buffer)


def _scene(request: dict[str, Any]) -> Any:
    if "scene" in request:
        return pickle.loads(request["scene"])
    from ..scenes import load_scene

    return load_scene(request["name"], request["overrides"])


def _rigid(stage: Step, scene: Any) -> None:
    """Move a linkage over what its crank can reach, and ask for the forces, one by one and all."""
    theta = machine = None
    with stage("motion"):
        import numpy as np

        linkage = scene.mechanism()
        low, high = linkage.crank_ranges()[0]
        inset = 0.0 if linkage.crank_turns else 0.02 * (high - low)
        theta = np.linspace(low + inset, high - inset, 64, endpoint=False)
        linkage.motion(theta)
    with stage("machine"):
        machine = scene.machine()
    if theta is None or machine is None:
        return
    speed = float(scene.get("operation.speed", 1.0))
    forces: tuple[Any, ...] = ("pins", "torque", "shaking_force", "shaking_moment")
    for name, outputs in (*((force, (force,)) for force in forces), ("everything", forces)):
        with stage(f"rigid_forces {name}"):
            from ..rigid import rigid_forces

            rigid_forces(machine, theta, speed, outputs=outputs)


def _flexible(stage: Step, scene: Any, speed: float) -> None:
    """Build the system, and put the questions that its family answers."""
    system = None
    with stage("system"):
        system = scene.system()
    if system is None:
        return
    if not hasattr(system, "terms"):
        _constrained(stage, system)
        return
    with stage("floquet_multipliers"):
        from ..periodic import floquet_multipliers

        floquet_multipliers(system, speed)
    if any(system.has(array) for array in "fhp"):
        with stage("steady_state"):
            from ..periodic import steady_state

            steady_state(system, speed)
    if system.structure is not None:
        with stage("natural_frequencies"):
            from ..frequencies import natural_frequencies

            natural_frequencies(system)


def _constrained(stage: Step, system: Any) -> None:
    import numpy as np

    q, rates = np.zeros(system.size), np.zeros(system.size)
    with stage("violation"):
        system.violation(q, 0.0)
    with stage("dynamics"):
        system.dynamics(q, rates, 0.0)
    if system.variations is not None:
        with stage("variations"):
            system.variations(q, rates, rates, np.zeros(system.constraints), 0.0)
