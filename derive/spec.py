"""What is to be derived, and where its module is: the records that both sides of the house share.

Standard library only; loads with SymPy, Jinja2 and NumPy blocked.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

MANIFEST = "manifest.json"
Family = Literal["closed_form", "linear_periodic", "constrained", "transcendental", "recursion"]
# Formulations of scenes whose module is that of another formulation, by mechanism and name.
DERIVED_AS = {
    ("quick_return", name): "moving_basis"
    for name in ("overhang", "polynomial", "two_segment", "free_free_linear")
}
# Formulations in which every link is a beam, by the element that they are made of.
BEAM_FORMULATIONS = {
    f"{kind}_beams": kind for kind in ("cubic", "internal_node", "curvature", "timoshenko")
}
# Formulations of a coupler that bends without becoming longer.
INEXTENSIBLE = ("inextensible", "inextensible_cubic")
# Names for sets of terms left out, by mechanism and formulation of the module.
NAMED_DROPS: Mapping[tuple[str, str], Mapping[str, tuple[str, ...]]] = {
    ("quick_return", "moving_basis"): {"as_printed": ("frame", "tension")},
    ("quick_return", "free_free"): {"as_printed": ("tension",)},
}
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


@dataclass(frozen=True)
class ModelSpec:
    """A mechanism, the way it is formulated, and what is wanted of it.

    Attributes
    ----------
    mechanism : str
        Name of the mechanism, for example ``"four_bar"``.
    formulation : str
        Named set of assumptions, for example ``"complete"``.
    flexible : tuple of str
        Links that bend; empty for a rigid mechanism.
    modes : int or None
        Number of modes, or None where one module serves any number.
    drop : tuple of str
        Physical terms left out before anything is derived.
    balanced : tuple of str
        Links whose centre of mass lies at their first joint.
    outputs : tuple of str
        What the module is wanted for, for example ``("stability",)``; empty for everything.
    """

    mechanism: str
    formulation: str
    flexible: tuple[str, ...] = ()
    modes: int | None = None
    drop: tuple[str, ...] = ()
    balanced: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Bring the unordered fields into one order, so that equal specs hash equally."""
        for name in ("flexible", "drop", "balanced", "outputs"):
            object.__setattr__(self, name, tuple(sorted(set(getattr(self, name)))))
        if set(self.outputs) == {"forcing", "stability"}:  # everything there is
            object.__setattr__(self, "outputs", ())

    def canonical(self) -> str:
        """Return the spec as canonical JSON text."""
        return json.dumps(asdict(self), sort_keys=True, separators=(",", ":"))

    def key(self) -> str:
        """Return the 16 hexadecimal digits by which a manifest lists this spec."""
        return hashlib.sha256(self.canonical().encode()).hexdigest()[:16]

    def name(self) -> str:
        """Return the name of the emitted module, readable and unique to the spec."""
        parts = [self.mechanism, *self.flexible, self.formulation]
        if self.modes is not None:
            parts.append(f"{self.modes}_modes")
        parts += [f"balanced_{link}" for link in self.balanced]
        parts += [f"without_{term}" for term in self.drop]
        parts += [f"for_{output}" for output in self.outputs]
        return "_".join(parts).replace("-", "_")

    def with_(self, **changes: Any) -> ModelSpec:
        """Return a copy with some fields changed."""
        return replace(self, **changes)

    def derived(self) -> ModelSpec:
        """Return the spec of the module that serves this one, names for sets of terms spelt out.

        Links that are beams are put together at run time from the element that they are made of.
        """
        if self.formulation in BEAM_FORMULATIONS:
            return ModelSpec("beam_element", BEAM_FORMULATIONS[self.formulation])
        formulation = DERIVED_AS.get((self.mechanism, self.formulation), self.formulation)
        sets = NAMED_DROPS.get((self.mechanism, formulation), {})
        drop = tuple(term for name in self.drop for term in sets.get(name, (name,)))
        return replace(self, formulation=formulation, drop=drop)

    @classmethod
    def from_mapping(cls, table: Mapping[str, Any]) -> ModelSpec:
        """Return the spec described by the ``[model]`` table of a scene.

        Parameters
        ----------
        table : Mapping
            Keys are the names of the attributes; lists become tuples.

        Raises
        ------
        ValueError
            If a key is unknown, a required one is missing, or a value is of the wrong kind.
        """
        if not isinstance(table, Mapping):
            raise ValueError(f"found {table!r}; expected a table of {cls._keys()}")
        unknown = sorted(set(table) - set(cls._keys()))
        if unknown:
            raise ValueError(f"unknown keys {unknown}; expected some of {cls._keys()}")
        missing = sorted({"mechanism", "formulation"} - set(table))
        if missing:
            raise ValueError(f"missing keys {missing}")
        return cls(**{key: _checked(key, value) for key, value in table.items()})

    @classmethod
    def _keys(cls) -> list[str]:
        return sorted(field.name for field in fields(cls))


def _checked(key: str, value: object) -> Any:
    """Return one value of a ``[model]`` table, lists as tuples.

    Names end up in names of files and functions, hence the narrow alphabet.
    """
    if key == "modes":
        if value is None or (isinstance(value, int) and value >= 1 and value is not True):
            return value
        raise ValueError(f"modes: found {value!r}; expected a whole number from 1")
    single = key in {"mechanism", "formulation"}
    names = (value,) if single else value
    if isinstance(names, (list, tuple)) and all(
        isinstance(name, str) and _NAME.fullmatch(name) for name in names
    ):
        return value if single else tuple(names)
    expected = "a name" if single else "a list of names"
    raise ValueError(f"{key}: found {value!r}; expected {expected} of letters, digits and _")


@dataclass(frozen=True)
class Choices:
    """The names that a model knows for the parts of a spec.

    Attributes
    ----------
    flexible : tuple of str
        Links that it can let bend; where there are any, a spec has to name one.
    drop : tuple of str
        Physical terms that it can leave out.
    balanced : tuple of str
        Links whose centre of mass it can put at the first joint.
    """

    flexible: tuple[str, ...] = ()
    drop: tuple[str, ...] = ()
    balanced: tuple[str, ...] = ()

    def unknown(self, spec: ModelSpec) -> tuple[str, str, str] | None:
        """Return the part of a spec that the model does not know, with found and expected."""
        for part in ("flexible", "drop", "balanced"):
            found, known = getattr(spec, part), getattr(self, part)
            strange = sorted(set(found) - set(known))
            if strange:
                return part, str(strange), f"some of {sorted(known)}" if known else "none"
        if self.flexible and not spec.flexible:
            return "flexible", "none", f"some of {sorted(self.flexible)}"
        return None

    def refuse_unknown(self, spec: ModelSpec) -> None:
        """Refuse a spec that names what the model does not know.

        Raises
        ------
        ValueError
            With what was found and what is expected.
        """
        wrong = self.unknown(spec)
        if wrong is not None:
            raise ValueError("{}: found {}; expected {}".format(*wrong))


@dataclass(frozen=True)
class Entry:
    """What the manifest says of one emitted module.

    Attributes
    ----------
    module : str
        Name of the module, its file without the ending.
    spec : ModelSpec
        The model that it stands for.
    content : str
        Hash of everything that the text was made from.
    text : str
        SHA-256 of the emitted text; tells an edited file.
    """

    module: str
    spec: ModelSpec
    content: str
    text: str


def read_manifest(folder: Path) -> dict[str, Entry]:
    """Return the entries of a folder's manifest by spec key.

    Empty where there is no manifest or it cannot be read; what another version wrote and this
    one does not understand is left out, and what does not stand where its spec belongs.  Either way
    the module counts as missing, and the command that makes it writes the manifest anew.
    """
    try:
        rows = json.loads((folder / MANIFEST).read_bytes())["modules"].items()
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return {}
    found: dict[str, Entry] = {}
    for key, row in rows:
        try:
            spec = ModelSpec.from_mapping(row["spec"])
            entry = Entry(row["module"], spec, row["content"], row["text"])
        except (ValueError, LookupError, TypeError):
            continue
        if (key, entry.module) == (spec.key(), spec.name()):
            found[key] = entry
    return found


def cache_folder() -> Path:
    """Return the user's folder for emitted modules."""
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA")
    if base:
        return Path(base) / "elastolink" / "modules"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "elastolink" / "modules"
    return Path.home() / ".cache" / "elastolink" / "modules"
