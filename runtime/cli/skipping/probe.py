"""The process in which a scene is used while its imports and emitted functions are counted.

Standard library only at its top, so that everything that is loaded is the scene's doing.
"""

from __future__ import annotations

import json
import os
import pickle
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# What no scene needs in order to be solved.
HEAVY = ("sympy", "jinja2", "mpmath", "matplotlib", "pint", "tqdm", "xarray", "numba", "heyoka")
_EMITTED = ("elastolink.generated.", "elastolink_emitted_")
_OWN = __name__.rpartition(".")[0]
_ANGLES = 64


class Counter:
    """Counts, stage by stage, modules that load and emitted functions that run."""

    def __init__(self) -> None:
        self.stages: list[dict[str, Any]] = []
        self._known: set[str] = set()
        self._calls: dict[tuple[str, str], list[int]] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Count what happens inside under a name; a refusal of the toolkit ends the stage."""
        from ...core.errors import ElastolinkError

        self._calls, refused = {}, ""
        sys.setprofile(self._watch)
        try:
            yield
        except ElastolinkError as error:
            refused = " ".join(str(error).split())
        finally:
            sys.setprofile(None)
        loaded = [found for found in list(sys.modules) if not inside(found, _OWN)]
        new = [found for found in loaded if found not in self._known]
        self._known.update(new)
        mine = sorted(found for found in new if inside(found, "elastolink") or emitted(found))
        self.stages.append(
            {
                "name": name,
                "refused": refused,
                "modules": {found: _size(found) for found in mine},
                "others": {top: _count(new, top) for top in ("numpy", "scipy")},
                "heavy": [top for top in HEAVY if top in new],
                "calls": [[*key, *counts] for key, counts in sorted(self._calls.items())],
            }
        )

    def _watch(self, frame: Any, event: str, _: object) -> None:
        if event != "call":
            return
        module = frame.f_globals.get("__name__", "")
        name = frame.f_code.co_name
        if not emitted(module) or name not in frame.f_globals.get("__all__", ()):
            return
        code = frame.f_code
        given = [frame.f_locals[key] for key in code.co_varnames[: code.co_argcount]]
        counts = self._calls.setdefault((module.rpartition(".")[2], name), [0, 0])
        counts[0] += 1
        counts[1] += max((int(getattr(value, "size", 1)) for value in given), default=1)


def inside(name: str, package: str) -> bool:
    """Return True for a package and what is in it."""
    return name == package or name.startswith(f"{package}.")


def emitted(name: str) -> bool:
    """Return True for the name of an emitted module."""
    return name.startswith(_EMITTED)


def _count(names: list[str], top: str) -> int:
    return sum(inside(name, top) for name in names)


def _size(name: str) -> int:
    path = getattr(sys.modules[name], "__file__", None)
    return os.path.getsize(path) if path else 0  # noqa: PTH202 - pathlib is one import more


def main() -> None:
    """Read a request from standard input, use its scene, write the counts to standard output."""
    request = pickle.load(sys.stdin.buffer)
    counter = Counter()
    warnings.simplefilter("ignore")
    with counter.stage("scene"):
        scene = _scene(request)
    for name, act in _acts(scene, request["speed"]):
        with counter.stage(name):
            act()
    json.dump(counter.stages, sys.stdout)


def _scene(request: dict[str, Any]) -> Any:
    if "scene" in request:
        return pickle.loads(request["scene"])
    from ...scenes import load_scene

    return load_scene(request["name"], request["overrides"])


def _acts(scene: Any, speed: float | None) -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield what is asked of a scene, each with its name; a later one may use an earlier one."""
    if speed is None:
        yield from _rigid(scene)
        return
    made: list[Any] = []
    yield "system", lambda: made.append(scene.system())
    if not made:
        return
    (system,) = made
    if hasattr(system, "terms"):
        yield from _linear(system, speed)
    else:
        yield from _constrained(system)


def _rigid(scene: Any) -> Iterator[tuple[str, Callable[[], object]]]:
    made: list[Any] = []
    yield "motion", lambda: made.append(_moved(scene.mechanism()))
    machines: list[Any] = []
    yield "machine", lambda: machines.append(scene.machine())
    if not (made and machines):
        return
    machine, theta = machines[0], made[0]
    speed = float(scene.get("operation.speed", 1.0))

    def ask(*outputs: str) -> Callable[[], object]:
        def act() -> object:
            from ...rigid import rigid_forces

            return rigid_forces(machine, theta, speed, outputs=outputs)  # type: ignore[arg-type]

        return act

    single = ("pins", "torque", "shaking_force", "shaking_moment")
    for output in single:
        yield f"rigid_forces {output}", ask(output)
    yield "rigid_forces everything", ask(*single)


def _moved(linkage: Any) -> Any:
    """Move a linkage over what its crank can reach, and return the crank angles."""
    import numpy as np

    low, high = linkage.crank_ranges()[0]
    inset = 0.0 if linkage.crank_turns else 0.02 * (high - low)
    theta = np.linspace(low + inset, high - inset, _ANGLES, endpoint=False)
    linkage.motion(theta)
    return theta


def _linear(system: Any, speed: float) -> Iterator[tuple[str, Callable[[], object]]]:
    def multipliers() -> object:
        from ...periodic import floquet_multipliers

        return floquet_multipliers(system, speed)

    def response() -> object:
        from ...periodic import steady_state

        return steady_state(system, speed)

    def frequencies() -> object:
        from ...frequencies import natural_frequencies

        return natural_frequencies(system)

    yield "floquet_multipliers", multipliers
    if any(system.has(array) for array in "fhp"):
        yield "steady_state", response
    if system.structure is not None:
        yield "natural_frequencies", frequencies


def _constrained(system: Any) -> Iterator[tuple[str, Callable[[], object]]]:
    import numpy as np

    q, rates = np.zeros(system.size), np.zeros(system.size)
    forces = np.zeros(system.constraints)
    yield "violation", lambda: system.violation(q, 0.0)
    yield "dynamics", lambda: system.dynamics(q, rates, 0.0)
    if system.variations is not None:
        yield "variations", lambda: system.variations(q, rates, rates, forces, 0.0)


if __name__ == "__main__":
    main()
