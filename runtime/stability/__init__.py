"""Where linear periodic systems are unstable: resonances of coupled modes and the tongues there.

- :func:`resonances`: speeds at which exponents of the mean system meet;
- :func:`tongue`: the unstable range that starts at one of them, as a series to an order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .meetings import Resonance, resonances
    from .tongues import Tongue, tongue

_PUBLIC = {
    "Resonance": "meetings",
    "Tongue": "tongues",
    "resonances": "meetings",
    "tongue": "tongues",
}

__all__ = ["Resonance", "Tongue", "resonances", "tongue"]

__getattr__, __dir__ = on_first_use(globals(), _PUBLIC)
