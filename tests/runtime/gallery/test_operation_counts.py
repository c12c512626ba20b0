"""Operation counts: printed formulas, our own counts against operations really taken."""

from elastolink.runtime.gallery.operation_counts import Tally, operation_count, printed_count


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
    for name in ("time_marching", "transition_matrix", "closed_form"):
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


def test_a_printed_formula_by_hand():
    # N (38 n^3 + 37 n^2 + 7 n) + 16 n^3 + 8 n^2 with N = 90, n = 10.
    assert printed_count("transition_matrix", intervals=90, freedoms=10) == 3776100
