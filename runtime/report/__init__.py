"""A report of a scene: one page that holds all that is known of the machine, and how well."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..core.lazy import on_first_use

if TYPE_CHECKING:
    from .page import Report as Report
    from .page import make_report as make_report

__all__ = on_first_use(globals())
