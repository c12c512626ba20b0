"""What functions are given: whole numbers of any integer type, and arrays of real numbers."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.core.inputs import is_whole, numbers, require_whole


@pytest.mark.parametrize("value", [1, 7, np.int64(3), np.uint8(7)])
def test_integers_of_any_type_come_back_as_plain_ones(value):
    found = require_whole("modes", value, 1, 7)
    assert type(found) is int
    assert found == value


@pytest.mark.parametrize("value", [0, 8, True, np.True_, 3.0, "3", None, [3], np.array([3])])
def test_everything_else_is_refused_by_name(value):
    assert not is_whole(value, 1, 7)
    with pytest.raises(BadInput, match=r"modes.*a whole number from 1 to 7.*choose 3"):
        require_whole("modes", value, 1, 7, "choose 3")


@pytest.mark.parametrize(
    "value",
    [
        1j,
        [1.0, 2j],
        np.ma.array([1.0, 2.0], mask=[False, True]),
        np.datetime64("2020-01-01"),
        "1.0",
        ["1", "2"],
        True,
        None,
        [[1.0], [2.0, 3.0]],
        {"a": 1.0},
        10**400,
    ],
)
def test_what_is_made_of_no_real_numbers_is_refused(value):
    with pytest.raises(BadInput, match="theta: found"):
        numbers("theta", value)


def test_an_array_that_masks_nothing_is_taken():
    assert numbers("theta", np.ma.array([1.0, 2.0])).tolist() == [1.0, 2.0]


def test_a_speed_as_text_is_told_its_unit():
    with pytest.raises(BadInput, match=r"give numbers in rad/s: 400 rpm is 400 \* math.pi / 30"):
        numbers("speed", "400 rpm")
