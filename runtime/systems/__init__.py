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
    from ..core.families.modal_damping import with_modal_damping as with_modal_damping
    from ..core.modules import find_module as find_module
    from .assembly import assemble as assemble
    from .rod.floating import free_free_rod as free_free_rod
    from .rod.linear import rod_system as rod_system

__all__ = on_first_use(globals())
