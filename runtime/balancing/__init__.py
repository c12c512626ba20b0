"""Balancing: counterweights, the classic cases, and the best compromise."""

from __future__ import annotations

from .bounds import Bounds
from .cases import balance_case, case_counterweights, fully_balanced
from .counterweights import Counterweight, with_counterweights
from .link_inertia import (
    BalancedLink,
    balanced_link_inertia,
    density_number,
    offset_function,
    optimal_offset,
)
from .optimum import Balancing, balance, compare_case, peaks_of
from .peaks import ForcePeak, force_peaks
from .reciprocating import ReciprocatingBalance, reciprocating_balance
from .trade_off import TradeOff, trade_off

__all__ = [
    "BalancedLink",
    "Balancing",
    "Bounds",
    "Counterweight",
    "ForcePeak",
    "ReciprocatingBalance",
    "TradeOff",
    "balance",
    "balance_case",
    "balanced_link_inertia",
    "case_counterweights",
    "compare_case",
    "density_number",
    "force_peaks",
    "fully_balanced",
    "offset_function",
    "optimal_offset",
    "peaks_of",
    "reciprocating_balance",
    "trade_off",
    "with_counterweights",
]
