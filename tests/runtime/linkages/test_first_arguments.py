"""What is no machine or no linkage is refused in one line, never by an AttributeError."""

import elastolink as el
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.rigid import case_counterweights, force_peaks, with_counterweights


@pytest.mark.parametrize("wrong", [None, (1, 2, 3, 4), "crank"])
@pytest.mark.parametrize(
    "call",
    [
        lambda it: el.balance(it, 10.0),
        lambda it: el.balance(it, 10.0, case="b"),
        lambda it: el.trade_off(it, 1.0),
        lambda it: case_counterweights(it, "a"),
        lambda it: force_peaks(it, 1.0),
        lambda it: with_counterweights(it, ()),
        lambda it: el.coupler_curve(it, 1.0),
        lambda it: el.transmission_angle(it),
        lambda it: el.harmonics(it),
        lambda it: el.harmonics((it, "theta4")),
        lambda it: el.harmonics((it, "torque", 1.0)),
    ],
)
def test_refused_in_one_line(call, wrong):
    with pytest.raises(BadInput) as refusal:
        call(wrong)
    assert "\n" not in str(refusal.value)
