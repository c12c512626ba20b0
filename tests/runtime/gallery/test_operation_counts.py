"""Operation counts: printed formulas, our own counts against operations really taken."""

import numpy as np
import pytest
from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.response import run_times
from elastolink.runtime.response.operation_counts import (
    ALGORITHMS,
    TABLE_6_2,
    TABLE_6_3,
    Tally,
    operation_count,
    printed_count,
    wrong_entries,
)
from manufactured import manufactured


def test_a_decomposition_and_its_solutions_are_counted_as_they_are_made():
    # Gauss's elimination by hand, one operation at a time.
    for n in (1, 2, 5, 9):
        operations = 0
        for k in range(n):
            for _ in range(k + 1, n):
                operations += 1 + 2 * (n - k - 1)
        tally = Tally()
        tally.solve(n, 0)
        assert tally.operations == operations
        # Two triangles: n divisions, n (n - 1) products and as many differences.
        tally = Tally()
        tally.solve(n, 3)
        assert tally.steps["solutions"] == 3 * (n + 2 * n * (n - 1))
    tally = Tally()
    tally.product(2, 3, 4)
    assert tally.operations == 2 * 4 * (3 + 2)


def test_counts_grow_as_the_algorithms_do():
    for name in ALGORITHMS[:-1]:
        one, two = (
            operation_count(name, intervals=n, freedoms=8, cycles=10).operations for n in (100, 200)
        )
        assert 1.9 < two / one <= 2.01
    marching = [
        operation_count("time_marching", intervals=90, freedoms=9, cycles=c) for c in (1, 31)
    ]
    per_cycle = (marching[1].operations - marching[0].operations) / 30
    assert per_cycle == 90 * ((2 * 18 - 1) * 18 + 18)
    kept, anew = (
        operation_count("time_marching", intervals=90, freedoms=9, cycles=31, storage=s).operations
        for s in (True, False)
    )
    assert anew > 5 * kept


def test_the_wrong_entries_are_named_and_the_right_ones_are_not():
    wrong = wrong_entries()
    assert len(wrong) == 7 and len(TABLE_6_2) + len(TABLE_6_3) == 18
    assert all(where.startswith("Table 6.3") for where, _, _ in wrong)
    assert wrong_entries(0.1) == []
    assert printed_count("transition_matrix", intervals=90, freedoms=10) == 3776100


def test_bad_input_is_refused():
    with pytest.raises(BadInput, match="one of"):
        operation_count("shooting", intervals=1, freedoms=1)
    with pytest.raises(BadInput, match="without storage"):
        printed_count("harmonic_balance", intervals=1, freedoms=1, storage=False)
    with pytest.raises(BadInput, match="whole numbers"):
        operation_count("cyclic", intervals=0, freedoms=1)
    with pytest.raises(BadInput, match="whole numbers"):
        printed_count("closed_form", intervals=1.5, freedoms=np.int64(2))


def test_run_times_are_of_all_algorithms():
    system, speed, _ = manufactured(1)
    found = run_times(system, speed, intervals=64, cycles=3, repeats=1)
    assert set(found) == {"steps", *ALGORITHMS[:-1]} and min(found.values()) > 0.0
