"""Which modules are packaged and where each is derived.  Standard library only."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from .spec import Choices, ModelSpec

_MODELS = Path(__file__).parent / "models"


@dataclass(frozen=True)
class CatalogueEntry:
    """One model file: the mechanism and formulations that it derives, and the packaged specs.

    Attributes
    ----------
    mechanism : str
        Name that specs use.
    formulations : tuple of str
        Named sets of assumptions that the file knows.
    module : str
        Importable name of the file, relative to ``elastolink.derive``; its ``MODEL`` is used, or
        what is named behind a colon.
    sources : tuple of str
        Files in ``models`` that the derivation reads, for the content hash.
    specs : tuple of ModelSpec
        Packaged modules.
    closed_in_modes : bool
        True where one module serves any number of modes.
    choices : Choices
        Names that specs may use.
    """

    mechanism: str
    formulations: tuple[str, ...]
    module: str
    sources: tuple[str, ...]
    specs: tuple[ModelSpec, ...]
    closed_in_modes: bool = False
    choices: Choices = field(default_factory=Choices)

    def paths(self) -> tuple[Path, ...]:
        """Return the source files."""
        return tuple(_MODELS / name for name in self.sources)


def _rigid(mechanism: str, formulation: str, part: str, *drop: str) -> CatalogueEntry:
    """Return the entry of a rigid linkage's forces, or of its redundant coordinates."""
    return CatalogueEntry(
        mechanism=mechanism,
        formulations=(formulation,),
        module=f".models.{mechanism}_forces{part}",
        sources=(f"{mechanism}.py", f"{mechanism}_forces.py"),
        specs=(ModelSpec(mechanism, formulation),),
        choices=Choices(drop=("across", *drop)),
    )


_LINKAGES = ("four_bar", "slider_crank", "quick_return")
_BEAMS = ("cubic", "internal_node", "curvature", "timoshenko")
_COUPLER = ("complete", "printed", "reduced")
_EXPANDED = (
    "beam_tangent_harmonics.py",
    "four_bar.py",
    "slider_crank.py",
    "inextensible_coupler.py",
    "inextensible_cubic.py",
)

CATALOGUE = (
    CatalogueEntry(
        mechanism="four_bar",
        formulations=("kinematics",),
        module=".models.four_bar",
        sources=("four_bar.py",),
        specs=(ModelSpec("four_bar", "kinematics"),),
    ),
    CatalogueEntry(
        mechanism="four_bar",
        formulations=("sensitivities",),
        module=".models.four_bar_sensitivities",
        sources=("four_bar.py", "four_bar_sensitivities.py"),
        specs=(ModelSpec("four_bar", "sensitivities"),),
    ),
    CatalogueEntry(
        mechanism="four_bar",
        formulations=("clearance",),
        module=".models.four_bar_clearance",
        sources=("four_bar.py", "four_bar_clearance.py"),
        specs=(ModelSpec("four_bar", "clearance"),),
    ),
    CatalogueEntry(
        mechanism="four_bar",
        formulations=_COUPLER,
        module=".models.coupler",
        sources=("four_bar.py", "coupler.py"),
        specs=tuple(ModelSpec("four_bar", name, flexible=("coupler",)) for name in _COUPLER),
        closed_in_modes=True,
        choices=Choices(
            flexible=("coupler",),
            drop=("axial_inertia", "spin", "coupler_end_load", "follower_end_load"),
            balanced=("coupler",),
        ),
    ),
    CatalogueEntry(
        mechanism="slider_crank",
        formulations=("kinematics",),
        module=".models.slider_crank",
        sources=("slider_crank.py",),
        specs=(ModelSpec("slider_crank", "kinematics"),),
    ),
    CatalogueEntry(
        mechanism="quick_return",
        formulations=("kinematics",),
        module=".models.quick_return",
        sources=("quick_return.py",),
        specs=(ModelSpec("quick_return", "kinematics"),),
    ),
    CatalogueEntry(
        mechanism="quick_return",
        formulations=("rod_polynomials",),
        module=".models.rod_polynomials",
        sources=("rod_polynomials.py",),
        specs=(ModelSpec("quick_return", "rod_polynomials"),),
    ),
    CatalogueEntry(
        mechanism="beam",
        formulations=("free_free_modes",),
        module=".models.free_free_modes",
        sources=("free_free_modes.py",),
        specs=(ModelSpec("beam", "free_free_modes"),),
    ),
    CatalogueEntry(
        mechanism="beam",
        formulations=("tangent_harmonics",),
        module=".models.beam_tangent_harmonics",
        sources=("beam_tangent_harmonics.py",),
        specs=(ModelSpec("beam", "tangent_harmonics"),),
    ),
    CatalogueEntry(
        mechanism="beam_element",
        formulations=_BEAMS,
        module=".models.beam_elements",
        sources=("beam_elements.py", "beam_shapes.py"),
        specs=tuple(ModelSpec("beam_element", name) for name in _BEAMS),
    ),
    CatalogueEntry(
        mechanism="beam_shapes",
        formulations=_BEAMS,
        module=".models.beam_shapes",
        sources=("beam_shapes.py",),
        specs=tuple(ModelSpec("beam_shapes", name) for name in _BEAMS),
    ),
    CatalogueEntry(
        mechanism="beam_section",
        formulations=("sandwich",),
        module=".models.beam_sandwich",
        sources=("beam_sandwich.py",),
        specs=(ModelSpec("beam_section", "sandwich"),),
    ),
    CatalogueEntry(
        mechanism="beam",
        formulations=("dynamic_stiffness",),
        module=".models.beam_dynamic_stiffness",
        sources=(
            "beam_dynamic_stiffness.py",
            "beam_frequency_functions.py",
            "beam_frequency_problem.py",
            "beam_frequency_shapes.py",
            "overhang_waves.py",
        ),
        specs=(ModelSpec("beam", "dynamic_stiffness"),),
    ),
    CatalogueEntry(
        mechanism="quick_return",
        formulations=("free_free",),
        module=".models.free_free_rod",
        sources=("free_free_modes.py", "free_free_rod.py"),
        specs=(ModelSpec("quick_return", "free_free", flexible=("rod",)),),
        closed_in_modes=True,
        choices=Choices(flexible=("rod",), drop=("tension",)),
    ),
    CatalogueEntry(
        mechanism="quick_return",
        formulations=("moving_basis",),
        module=".models.flexible_rod",
        sources=("quick_return.py", "flexible_rod.py"),
        specs=(ModelSpec("quick_return", "moving_basis", flexible=("rod",)),),
        closed_in_modes=True,
        choices=Choices(flexible=("rod",), drop=("frame", "tension")),
    ),
    CatalogueEntry(
        mechanism="quick_return",
        formulations=("overhang_modes",),
        module=".models.overhang_modes",
        sources=(
            "overhang_ends.py",
            "overhang_integrals.py",
            "overhang_modes.py",
            "overhang_waves.py",
        ),
        specs=(ModelSpec("quick_return", "overhang_modes"),),
    ),
    *(
        CatalogueEntry(
            mechanism=name,
            formulations=(formulation,),
            module=f".models.{sources[-1][:-3]}:{name.upper()}",
            sources=sources,
            specs=tuple(ModelSpec(name, formulation, ("coupler",), modes) for modes in numbers),
            closed_in_modes=numbers == (None,),
            choices=Choices(flexible=("coupler",)),
        )
        for name in ("four_bar", "slider_crank")
        for formulation, sources, numbers in (
            ("inextensible", ("inextensible_coupler.py",), (None,)),
            ("inextensible_cubic", _EXPANDED, (1, 2)),
        )
    ),
    CatalogueEntry(
        mechanism="beam",
        formulations=("amplitude_law",),
        module=".models.amplitude_law",
        sources=(*_EXPANDED, "amplitude_law.py"),
        specs=(ModelSpec("beam", "amplitude_law"),),
    ),
    *(_rigid(name, "forces", "", "crank_acceleration") for name in _LINKAGES),
    *(_rigid(name, "multibody", ":MULTIBODY", "drive") for name in _LINKAGES),
    CatalogueEntry(
        mechanism="hill",
        formulations=("plain",),
        module=".models.hill",
        sources=("hill.py",),
        specs=(ModelSpec("hill", "plain"),),
    ),
    CatalogueEntry(
        mechanism="hill",
        formulations=("recursion",),
        module=".models.hill:RECURSION",
        sources=("hill.py",),
        specs=(ModelSpec("hill", "recursion"),),
    ),
    CatalogueEntry(
        mechanism="hill",
        formulations=("meissner",),
        module=".models.hill_meissner",
        sources=("hill_meissner.py",),
        specs=(ModelSpec("hill", "meissner"),),
    ),
)


def find(spec: ModelSpec) -> CatalogueEntry:
    """Return the entry that derives ``spec``.

    Raises ``LookupError`` if no packaged model does; the message lists what there is.
    """
    for entry in CATALOGUE:
        if entry.mechanism == spec.mechanism and spec.formulation in entry.formulations:
            return entry
    known = sorted(f"{e.mechanism}/{f}" for e in CATALOGUE for f in e.formulations)
    raise LookupError(
        f"no packaged model derives {spec.mechanism}/{spec.formulation}; expected one of {known}, "
        "or give your own with --model FILE.py"
    )
