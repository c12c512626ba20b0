"""Magnus methods of order 4, 6 and 8: one exponential per step, exact for constant coefficients.

The exponents are those of Blanes, Casas, Oteo and Ros (BIT 42 (2002) 262): one, three and six
commutators.  In the moments M_k of :mod:`~.commutators` the logarithm of the flow begins

    M_0 - [M_0, M_1]/6 + [M_0, [M_0, M_2]]/60 - [M_1, [M_0, M_1]]/60 - [M_1, M_2]/30
    + [M_0, [M_0, [M_0, M_1]]]/360 + O(h^7).

Order 8 has a family of forms in six commutators.  The one here was found by solving the 19
independent conditions in 80 digits with the other coefficients set to short decimals.
"""

from __future__ import annotations

from .commutators import MagnusExponent, combination, moments_of
from .expm import expm
from .protocol import Array, Generator, OneStep

MAGNUS4 = MagnusExponent(
    name="magnus4",
    order=4,
    brackets=((combination((0, "1")), combination((1, "1"))),),
    exponent=combination((0, "1"), (2, "-1/6")),
)

# With alpha_1 = M_0 - M_2/2, alpha_2 = 2 M_1 and alpha_3 = 6 M_2 (the Taylor coefficients about the
# middle), C_1 = [alpha_1, alpha_2] and C_2 = -[alpha_1, 2 alpha_3 + C_1]/60, the exponent is
# alpha_1 + alpha_3/12 + [-20 alpha_1 - alpha_3 + C_1, alpha_2 + C_2]/240.
MAGNUS6 = MagnusExponent(
    name="magnus6",
    order=6,
    brackets=(
        (combination((0, "1"), (2, "-1/2")), combination((1, "2"))),
        (combination((0, "-1/60"), (2, "1/120")), combination((2, "12"), (3, "1"))),
        (combination((0, "-20"), (2, "4"), (3, "1")), combination((1, "2"), (4, "1"))),
    ),
    exponent=combination((0, "1"), (5, "1/240")),
)

MAGNUS8 = MagnusExponent(
    name="magnus8",
    order=8,
    brackets=(
        (
            combination((0, "1"), (2, "-1/2")),
            combination(
                (1, "-0.247723836790447823270042308437662469670993"),
                (3, "0.331382336296574324707655311994186878765613"),
            ),
        ),
        (
            combination((0, "1")),
            combination(
                (2, "-0.0561176405873833858118536892638835883008589"),
                (4, "0.0377555112139207682588563563775464643235593"),
            ),
        ),
        (
            combination((0, "1"), (4, "0.3")),
            combination(
                (1, "0.179622758982959264799276261052986537755855"),
                (5, "0.672815527315423001964662661653950463966445"),
            ),
        ),
        (
            combination((0, "1"), (6, "-0.608779158206357533354564539424571121501073")),
            combination((2, "-0.215547310779551117759131513263583845307026"), (6, "-0.2")),
        ),
        (
            combination(
                (0, "1"),
                (2, "-0.261203874963741442514768206917056593877049"),
                (4, "0.475735931288071485359493382737090576429098"),
            ),
            combination(
                (1, "-0.660165737003624282113852771704354463345011"), (5, "0.3"), (7, "-0.4")
            ),
        ),
        (
            combination(
                (0, "1"),
                (4, "-1.34558441227157108784303970357745654142541"),
                (6, "-0.815300968740935360628692051729264148469262"),
                (8, "0.53555246929049995359717212388101695388399"),
            ),
            combination((1, "0.6"), (3, "0.756722324978244865508860924150233956326229")),
        ),
    ),
    exponent=combination(
        (0, "1"),
        (4, "0.0862189243118204471036526053054335381228104"),
        (6, "-0.2"),
        (8, "0.131375403642056400261955021553860061862193"),
        (9, "-0.0377568199434977369332931256140548076531031"),
    ),
)


def magnus(exponent: MagnusExponent) -> OneStep:
    """Return the one-step method of an exponent: symplectic for undamped systems, not A-stable.

    Its error grows with the commutators of the generator at different angles, not with the
    generator itself.
    """

    def maps(generator: Generator, theta: Array, step: float) -> Array:
        return expm(exponent.matrices(moments_of(generator, theta, step, exponent.order // 2)))

    return OneStep(exponent.name, order=exponent.order, maps=maps, explicit=False, symplectic=True)


METHODS = tuple(magnus(exponent) for exponent in (MAGNUS4, MAGNUS6, MAGNUS8))
