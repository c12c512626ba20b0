"""An explanation in lines of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .explanation import EmittedUse, Explanation, Stage


def lines_of(found: Explanation) -> list[str]:
    """Return the four parts of an explanation: derivation, emission, import, evaluation."""
    return [
        f"{found.scene}: module {found.model}",
        *_derivation(found),
        *_emission(found),
        *_imports(found),
        *_evaluation(found),
    ]


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
