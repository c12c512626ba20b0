"""Bloch's recursion for the levels of a resonant group of states.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism hill, formulation recursion.
Equations: Smith (7.12)-(7.18), (7.42), (8.39)-(8.43), to any order and number of parameters.

An operator H + t V has a group of resonant states, on which H is one number, set to zero here.
With P the projector on them, (H + t V) Omega = Omega h and P Omega = P define the wave operator
Omega and the effective operator h; equating powers of t gives h_k = P V Omega_(k-1) and Omega_k =
R (V Omega_(k-1) - Omega_1 h_(k-1) - ... - Omega_(k-1) h_1), R being -1/H beyond the resonant
states and zero on them.  The eigenvalues of h = t h_1 + t^2 h_2 + ... are those of H + t V.

The algebra is the caller's.  Omega has as many columns as there are resonant states, r, and h is r
x r: with plain matrices, start is the (size, r) basis of the resonant states, act(x) is V @ x,
resolve(x) is R @ x, project(x) the resonant rows of x and combine(x, h) is x @ h.  For Hill's
equation r is 2, or 1 in region 0, and a symmetry gives one column from the other: there a column
may stand for the pair.  Where an operator is a polynomial in several parameters, a column of order
k holds its homogeneous part of degree k.  All that is asked of columns is a difference.  Where the
resonant states have different levels, with the matrix h_0, the same statements hold with
resolve(x) the y beyond the resonant states that solves y h_0 - H y = (1 - P) x.

WORDS lists the h_k written out: to each order the words and their coefficients.  An operation is
one call of the algebra or one difference.

Cost per evaluation:
    order_1: 3 operations
    order_2: 8 operations
    order_3: 15 operations
    order_4: 24 operations
    order_5: 35 operations
    order_6: 48 operations
    order_7: 63 operations
    order_8: 80 operations
    order_9: 99 operations
    order_10: 120 operations
Content hash fcffcfa684a7f55b11d6803e8234ab33; derived with SymPy 1.14.0.
"""

__all__ = [
    "order_1", "order_2", "order_3", "order_4", "order_5", "order_6", "order_7", "order_8",
    "order_9", "order_10",
]
FAMILY = "recursion"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"recursion","mechanism":"hill","modes":n'
    'ull,"outputs":[]}'
)
CONTENT = "fcffcfa684a7f55b11d6803e8234ab33"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "start": ("", "The resonant states, ``Omega_0``"),
    "act": ("", "Applies V to a column, whose order rises by one"),
    "resolve": ("", "Applies R to a column"),
    "project": ("", "Takes P of a column, an effective operator"),
    "combine": ("", "Multiplies ``Omega_j`` by ``h_i``"),
    "effective": ("", "``h_1`` and on, each as ``project`` gives it"),
    "wave": ("", "``Omega_1`` and on, each as ``resolve`` gives it"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {
    "order_1": ("effective", "wave"),
    "order_2": ("effective", "wave"),
    "order_3": ("effective", "wave"),
    "order_4": ("effective", "wave"),
    "order_5": ("effective", "wave"),
    "order_6": ("effective", "wave"),
    "order_7": ("effective", "wave"),
    "order_8": ("effective", "wave"),
    "order_9": ("effective", "wave"),
    "order_10": ("effective", "wave"),
}

# The effective operator written out: order, then coefficient and word of each term.  Between two V
# stands P, or a power of R.
WORDS = {
    1: ((1, "P V P"),),
    2: ((1, "P V R V P"),),
    3: ((-1, "P V R^2 V P V P"), (1, "P V R V R V P")),
    4: (
        (1, "P V R^3 V P V P V P"),
        (-1, "P V R^2 V P V R V P"),
        (-1, "P V R^2 V R V P V P"),
        (-1, "P V R V R^2 V P V P"),
        (1, "P V R V R V R V P"),
    ),
    5: (
        (-1, "P V R^4 V P V P V P V P"),
        (1, "P V R^3 V P V P V R V P"),
        (1, "P V R^3 V P V R V P V P"),
        (1, "P V R^3 V R V P V P V P"),
        (1, "P V R^2 V P V R^2 V P V P"),
        (-1, "P V R^2 V P V R V R V P"),
        (1, "P V R^2 V R^2 V P V P V P"),
        (-1, "P V R^2 V R V P V R V P"),
        (-1, "P V R^2 V R V R V P V P"),
        (1, "P V R V R^3 V P V P V P"),
        (-1, "P V R V R^2 V P V R V P"),
        (-1, "P V R V R^2 V R V P V P"),
        (-1, "P V R V R V R^2 V P V P"),
        (1, "P V R V R V R V R V P"),
    ),
    6: (
        (1, "P V R^5 V P V P V P V P V P"),
        (-1, "P V R^4 V P V P V P V R V P"),
        (-1, "P V R^4 V P V P V R V P V P"),
        (-1, "P V R^4 V P V R V P V P V P"),
        (-1, "P V R^4 V R V P V P V P V P"),
        (-1, "P V R^3 V P V P V R^2 V P V P"),
        (1, "P V R^3 V P V P V R V R V P"),
        (-1, "P V R^3 V P V R^2 V P V P V P"),
        (1, "P V R^3 V P V R V P V R V P"),
        (1, "P V R^3 V P V R V R V P V P"),
        (-1, "P V R^3 V R^2 V P V P V P V P"),
        (1, "P V R^3 V R V P V P V R V P"),
        (1, "P V R^3 V R V P V R V P V P"),
        (1, "P V R^3 V R V R V P V P V P"),
        (-1, "P V R^2 V P V R^3 V P V P V P"),
        (1, "P V R^2 V P V R^2 V P V R V P"),
        (1, "P V R^2 V P V R^2 V R V P V P"),
        (1, "P V R^2 V P V R V R^2 V P V P"),
        (-1, "P V R^2 V P V R V R V R V P"),
        (-1, "P V R^2 V R^3 V P V P V P V P"),
        (1, "P V R^2 V R^2 V P V P V R V P"),
        (1, "P V R^2 V R^2 V P V R V P V P"),
        (1, "P V R^2 V R^2 V R V P V P V P"),
        (1, "P V R^2 V R V P V R^2 V P V P"),
        (-1, "P V R^2 V R V P V R V R V P"),
        (1, "P V R^2 V R V R^2 V P V P V P"),
        (-1, "P V R^2 V R V R V P V R V P"),
        (-1, "P V R^2 V R V R V R V P V P"),
        (-1, "P V R V R^4 V P V P V P V P"),
        (1, "P V R V R^3 V P V P V R V P"),
        (1, "P V R V R^3 V P V R V P V P"),
        (1, "P V R V R^3 V R V P V P V P"),
        (1, "P V R V R^2 V P V R^2 V P V P"),
        (-1, "P V R V R^2 V P V R V R V P"),
        (1, "P V R V R^2 V R^2 V P V P V P"),
        (-1, "P V R V R^2 V R V P V R V P"),
        (-1, "P V R V R^2 V R V R V P V P"),
        (1, "P V R V R V R^3 V P V P V P"),
        (-1, "P V R V R V R^2 V P V R V P"),
        (-1, "P V R V R V R^2 V R V P V P"),
        (-1, "P V R V R V R V R^2 V P V P"),
        (1, "P V R V R V R V R V R V P"),
    ),
}


def order_1(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 1.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 1 each.
    """
    v1 = act(start)
    h1 = project(v1)
    omega1 = resolve(v1)
    return (h1,), (omega1,)


def order_2(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 2.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 2 each.
    """
    effective, wave = order_1(start, act, resolve, project, combine)
    (h1,) = effective
    (omega1,) = wave
    v2 = act(omega1)
    h2 = project(v2)
    omega2 = resolve(v2 - combine(omega1, h1))
    return (*effective, h2), (*wave, omega2)


def order_3(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 3.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 3 each.
    """
    effective, wave = order_2(start, act, resolve, project, combine)
    h1, h2 = effective
    omega1, omega2 = wave
    v3 = act(omega2)
    h3 = project(v3)
    omega3 = resolve(v3 - combine(omega1, h2) - combine(omega2, h1))
    return (*effective, h3), (*wave, omega3)


def order_4(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 4.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 4 each.
    """
    effective, wave = order_3(start, act, resolve, project, combine)
    h1, h2, h3 = effective
    omega1, omega2, omega3 = wave
    v4 = act(omega3)
    h4 = project(v4)
    omega4 = resolve(v4 - combine(omega1, h3) - combine(omega2, h2) - combine(omega3, h1))
    return (*effective, h4), (*wave, omega4)


def order_5(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 5.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 5 each.
    """
    effective, wave = order_4(start, act, resolve, project, combine)
    h1, h2, h3, h4 = effective
    omega1, omega2, omega3, omega4 = wave
    v5 = act(omega4)
    h5 = project(v5)
    omega5 = (
        resolve(v5 - combine(omega1, h4) - combine(omega2, h3) - combine(omega3, h2)
        - combine(omega4, h1))
    )
    return (*effective, h5), (*wave, omega5)


def order_6(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 6.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 6 each.
    """
    effective, wave = order_5(start, act, resolve, project, combine)
    h1, h2, h3, h4, h5 = effective
    omega1, omega2, omega3, omega4, omega5 = wave
    v6 = act(omega5)
    h6 = project(v6)
    omega6 = (
        resolve(v6 - combine(omega1, h5) - combine(omega2, h4) - combine(omega3, h3)
        - combine(omega4, h2) - combine(omega5, h1))
    )
    return (*effective, h6), (*wave, omega6)


def order_7(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 7.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 7 each.
    """
    effective, wave = order_6(start, act, resolve, project, combine)
    h1, h2, h3, h4, h5, h6 = effective
    omega1, omega2, omega3, omega4, omega5, omega6 = wave
    v7 = act(omega6)
    h7 = project(v7)
    omega7 = (
        resolve(v7 - combine(omega1, h6) - combine(omega2, h5) - combine(omega3, h4)
        - combine(omega4, h3) - combine(omega5, h2) - combine(omega6, h1))
    )
    return (*effective, h7), (*wave, omega7)


def order_8(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 8.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 8 each.
    """
    effective, wave = order_7(start, act, resolve, project, combine)
    h1, h2, h3, h4, h5, h6, h7 = effective
    omega1, omega2, omega3, omega4, omega5, omega6, omega7 = wave
    v8 = act(omega7)
    h8 = project(v8)
    omega8 = (
        resolve(v8 - combine(omega1, h7) - combine(omega2, h6) - combine(omega3, h5)
        - combine(omega4, h4) - combine(omega5, h3) - combine(omega6, h2) - combine(omega7, h1))
    )
    return (*effective, h8), (*wave, omega8)


def order_9(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 9.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 9 each.
    """
    effective, wave = order_8(start, act, resolve, project, combine)
    h1, h2, h3, h4, h5, h6, h7, h8 = effective
    omega1, omega2, omega3, omega4, omega5, omega6, omega7, omega8 = wave
    v9 = act(omega8)
    h9 = project(v9)
    omega9 = (
        resolve(v9 - combine(omega1, h8) - combine(omega2, h7) - combine(omega3, h6)
        - combine(omega4, h5) - combine(omega5, h4) - combine(omega6, h3) - combine(omega7, h2)
        - combine(omega8, h1))
    )
    return (*effective, h9), (*wave, omega9)


def order_10(start, act, resolve, project, combine):
    """Return the effective operators and the columns up to order 10.

    start : column
    act, resolve, project, combine : callable
    Returns tuple of 10 each.
    """
    effective, wave = order_9(start, act, resolve, project, combine)
    h1, h2, h3, h4, h5, h6, h7, h8, h9 = effective
    omega1, omega2, omega3, omega4, omega5, omega6, omega7, omega8, omega9 = wave
    v10 = act(omega9)
    h10 = project(v10)
    omega10 = (
        resolve(v10 - combine(omega1, h9) - combine(omega2, h8) - combine(omega3, h7)
        - combine(omega4, h6) - combine(omega5, h5) - combine(omega6, h4) - combine(omega7, h3)
        - combine(omega8, h2) - combine(omega9, h1))
    )
    return (*effective, h10), (*wave, omega10)
