"""What ``regenerate-equations`` is asked for: specs, and the files that derive them.

Standard library only until a model is loaded.
"""

from __future__ import annotations

import importlib
import json
import tomllib
import traceback
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from .._files import run_module
from .catalogue import CATALOGUE, find
from .manifest import content_hash
from .spec import ModelSpec

if TYPE_CHECKING:
    from .pipeline import Model


class UsageError(Exception):
    """The command line asks for something that does not exist or cannot be done."""


@dataclass(frozen=True)
class Job:
    """One module to derive.

    Attributes
    ----------
    spec : ModelSpec
        What is wanted.
    module : str
        Name of the packaged module that derives it, relative to this package, or a file's path.
    content : str
        Hash of everything that the text will be made from.
    """

    spec: ModelSpec
    module: str
    content: str

    @property
    def name(self) -> str:
        """Name of the emitted module."""
        return self.spec.name()

    def model(self) -> Model:
        """Import what derives it; from here on SymPy is needed.

        Raises ``UsageError`` if a user's file cannot be imported or defines no model.
        """
        if self.module.startswith("."):
            file, _, name = self.module.partition(":")
            packaged: Model = getattr(importlib.import_module(file, __package__), name or "MODEL")
            return packaged
        own: Model = _load_file(Path(self.module)).MODEL
        return own

    def text(self) -> str:
        """Run the whole pipeline.

        Raises ``UsageError`` if the model refuses the spec, or cannot be brought into its family's
        form.
        """
        from .emission import TemplateKeys
        from .lowering import CannotPrint
        from .pipeline import module_text

        model = self.model()
        try:
            return module_text(self.spec, model, self.content)
        except (ValueError, CannotPrint, TemplateKeys) as problem:
            message = f"model {self.name}: {_one_line(problem)}{_where(problem, self.module)}"
            raise UsageError(message) from problem


def jobs_of(
    names: Sequence[str], scenes: Sequence[str], texts: Sequence[str], model: str | None
) -> list[Job]:
    """Return what was asked for, each spec once, in one order.

    ``names``: names of modules as ``--list`` prints them; ``scenes``: scene files, for their
    ``[model]`` tables; ``texts``: ``[model]`` tables as JSON; ``model``: a user's model file;
    without it the packaged models are meant. Raises ``UsageError`` if one of them does not exist or
    makes no sense.
    """
    specs = [_spec_of_scene(Path(file)) for file in scenes]
    specs += [_spec_of_text(text) for text in texts]
    jobs = _packaged_jobs(names, specs) if model is None else _own_jobs(Path(model), names, specs)
    unique = {job.spec.key(): job for job in jobs}
    twice = [name for name, n in Counter(job.name for job in unique.values()).items() if n > 1]
    if twice:
        raise UsageError(f"different models would both be called {sorted(twice)}; rename a part")
    return sorted(unique.values(), key=lambda job: job.name)


def _packaged_jobs(names: Sequence[str], specs: Sequence[ModelSpec]) -> list[Job]:
    offered = {spec.name(): spec for entry in CATALOGUE for spec in entry.specs}
    chosen = [*specs, *_chosen(names, offered, "packaged are")]
    return [_packaged_job(spec) for spec in chosen or offered.values()]


def _packaged_job(spec: ModelSpec) -> Job:
    try:
        entry = find(spec)
        entry.choices.refuse_unknown(spec)
    except (LookupError, ValueError) as problem:
        raise UsageError(f"model {spec.name()}: {_one_line(problem)}") from None
    if entry.closed_in_modes:
        spec = spec.with_(modes=None)
    return Job(spec, entry.module, content_hash(spec, entry.paths()))


def _own_jobs(file: Path, names: Sequence[str], specs: Sequence[ModelSpec]) -> list[Job]:
    if not file.is_file():
        raise UsageError(f"model file {file}: found no such file")
    module = _load_file(file)
    for wanted in ("MODEL", "SPECS"):
        if not hasattr(module, wanted):
            raise UsageError(f"model file {file}: defines no {wanted}")
    model: Model = module.MODEL
    offered = {spec.name(): spec for spec in module.SPECS}
    chosen = [*specs, *_chosen(names, offered, f"{file} defines")] or module.SPECS
    jobs = []
    for spec in chosen:
        if spec.mechanism != model.mechanism or spec.formulation not in model.formulations:
            known = [f"{model.mechanism}/{formulation}" for formulation in model.formulations]
            raise UsageError(
                f"model {spec.name()}: found {spec.mechanism}/{spec.formulation}; {file} derives "
                f"{known}"
            )
        try:
            model.choices.refuse_unknown(spec)
        except ValueError as problem:
            raise UsageError(f"model {spec.name()}: {problem}") from None
        one = spec.with_(modes=None) if model.closed_in_modes else spec
        path = file.resolve()
        jobs.append(Job(one, str(path), content_hash(one, (path,))))
    return jobs


def _chosen(names: Sequence[str], offered: dict[str, ModelSpec], words: str) -> list[ModelSpec]:
    unknown = sorted(set(names) - set(offered))
    if unknown:
        raise UsageError(f"unknown models {unknown}; {words} {sorted(offered)}")
    return [offered[name] for name in names]


def _spec_of_scene(file: Path) -> ModelSpec:
    try:
        table = tomllib.loads(file.read_bytes().decode())
    except OSError as problem:
        raise UsageError(f"scene file {file}: {problem.strerror}") from None
    except (ValueError, RecursionError) as problem:  # broken TOML, or no text in UTF-8
        raise UsageError(f"scene file {file}: {_one_line(problem)}") from None
    if "model" not in table:
        raise UsageError(f"scene file {file}: has no [model] table")
    try:
        return ModelSpec.from_mapping(table["model"]).derived()
    except ValueError as problem:
        raise UsageError(f"scene file {file}: model: {problem}") from None


def _spec_of_text(text: str) -> ModelSpec:
    try:
        return ModelSpec.from_mapping(json.loads(text))
    except (ValueError, RecursionError) as problem:
        raise UsageError(f"--spec {text[:200]}: {_one_line(problem)}") from None


def _load_file(file: Path) -> ModuleType:
    if file.suffix != ".py":
        raise UsageError(f"model file {file}: not a Python file")
    try:
        return run_module(f"elastolink_user_{file.stem}", file)
    except (SyntaxError, ImportError, NameError, AttributeError, TypeError, ValueError) as problem:
        kind, line = type(problem).__name__, _where(problem, str(file))
        message = f"model file {file}: {kind}: {_one_line(problem)}{line}"
        raise UsageError(message) from problem


def _one_line(problem: Exception) -> str:
    """Return the message of an exception in one line; a KeyError's would come quoted."""
    text = problem.args[0] if isinstance(problem, KeyError) and problem.args else problem
    return " ".join(str(text).split())


def _where(problem: Exception, file: str) -> str:
    """Say in which line of a user's file it happened."""
    lines = [f.lineno for f in traceback.extract_tb(problem.__traceback__) if f.filename == file]
    return f" (line {lines[-1]})" if lines else ""
