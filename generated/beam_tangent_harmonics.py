"""Integrals along a beam whose tangent is a sum of cosines.

Emitted by regenerate-equations from a symbolic derivation.  Do not edit.

Model: mechanism beam, formulation tangent_harmonics.
Equations: Smith 9.6, further work 2.

Cost per evaluation:
    integrals: 14 operations
Content hash aa1204476a1889c03b67c4a28e801493; derived with SymPy 1.14.0.
"""

__all__ = ["integrals"]
FAMILY = "closed_form"
SPEC = (
    '{"balanced":[],"drop":[],"flexible":[],"formulation":"tangent_harmonics","mechanism":"beam","'
    'modes":null,"outputs":[]}'
)
CONTENT = "aa1204476a1889c03b67c4a28e801493"

# Unit and meaning of arguments and results.
QUANTITIES = {
    "n": ("", "Number of the harmonic, from 1"),
    "moment": ("", "int (1 - s) cos(n pi s) ds"),
    "beside_mean": ("", "int s (int cos(n pi s)) ds, the pair of harmonics 0 and n"),
    "inertia": ("", "int (int cos(n pi s))^2 ds, the pair of n with itself"),
    "bending": ("", "int (d/ds cos(n pi s))^2 ds"),
}
PARAMETERS = ()

# Names of what each function returns, in order.
RETURNS = {"integrals": ("moment", "beside_mean", "inertia", "bending")}


def integrals(n):
    """Return the integrals of one harmonic.

    n : ndarray, shape (...)
    Returns ndarray, shape (...) each.
    """
    x0 = 9.869604401089358
    x1 = n**2
    x2 = 1 / (x0 * x1)
    return x2 * (1 - (1 - 2 * ((n) % 2))), x2 * (1 - 2 * ((n + 1) % 2)), x2 / 2, x0 * x1 / 2
