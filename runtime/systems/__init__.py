"""From emitted modules and numbers to the systems that the solvers take.

- ``find_module`` finds the emitted module of a model, ``assemble`` makes a system of it.
- ``rod_system`` and ``free_free_rod`` are the flexible rod of a quick-return, linear on a moving
  basis, and nonlinear with constraints.
- ``with_modal_damping`` adds damping by modal ratios to any linear-periodic system.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from ..core.families.modal_damping import with_modal_damping
    from ..core.modules import EmittedModule, find_module
    from .assembly import assemble
    from .rod.floating import free_free_rod
    from .rod.linear import rod_system

_PUBLIC = {
    "EmittedModule": ".core.modules",
    "assemble": "assembly",
    "find_module": ".core.modules",
    "free_free_rod": "rod.floating",
    "rod_system": "rod.linear",
    "with_modal_damping": ".core.families.modal_damping",
}

__all__ = [
    "EmittedModule",
    "assemble",
    "find_module",
    "free_free_rod",
    "rod_system",
    "with_modal_damping",
]


__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
