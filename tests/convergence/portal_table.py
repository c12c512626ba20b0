"""Aannaque's Table 5.1 as printed: natural frequencies of a portal frame, and relative errors.

Three equal inextensible bars, rigid corners, clamped feet.  The data of Fig. 5.2 are lost; one
factor takes frequencies over sqrt(EI / (rho A)) / L^2 to the printed ones.
"""

from elastolink.runtime.beams import Section, frame


def _numbers(text):
    return tuple(map(float, text.split()))


EXACT = _numbers(
    "56.603 223.405 364.376 394.637 798.420 974.976 1128.133 1713.310 2021.214 "
    "2135.532 2984.904 3321.571 3572.354 4596.701 5067.413 5273.455 6565.820 7062.693 "
    "7409.042 8874.718 9506.991"
)
ELEMENTS = {
    4: _numbers(
        "56.603 223.500 364.717 395.709 802.477 982.323 1138.522 1748.834 2065.320 "
        "2181.153 3328.206 3777.526 4166.017 5381.377 6243.021 6824.710 8597.032 9864.527 "
        "11024.125 12746.505 13849.266"
    ),
    3: _numbers(
        "56.605 223.701 365.411 396.801 810.153 994.177 1148.601 1919.682 2343.157 "
        "2584.211 3670.536 4431.450 5172.888 6614.060 7635.244"
    ),
    2: _numbers("56.612 224.831 368.517 401.590 908.950 1186.629 1490.239 2385.624 3195.329"),
    1: _numbers("56.706 267.346 577.263"),
    "p": _numbers("56.603 223.529 365.388 396.538 806.043 994.282 1155.056 2724.169 3974.050"),
}
ERRORS = {
    4: _numbers(
        "0.001 0.042 0.093 0.271 0.508 0.753 0.920 2.070 2.180 2.130 11.500 13.720 16.610 "
        "17.070 23.199 29.416 30.936 39.670 48.792 43.627 45.674"
    ),
    3: _numbers(
        "0.003 0.132 0.284 0.548 1.469 1.969 1.814 12.045 15.928 21.010 22.969 33.414 "
        "44.803 43.887 50.673"
    ),
    2: _numbers("0.016 0.638 1.136 1.761 13.843 21.708 32.097 39.240 58.089"),
    1: _numbers("0.182 19.668 58.425"),
    "p": _numbers("0.000 0.055 0.277 0.481 0.954 1.980 2.386 59.000 96.616"),
}
# The factor: from all printed numbers but the two wrong ones, within 4 units of the last digit.
FACTOR = 17.66323
# Numbers (from 1) of the frequencies whose "exact" value is wrong: both of clamped-clamped bars.
WRONG = (4, 10)

CLAMPED = ("x", "y", "rotation")


def portal(elements=1, kind="cubic"):
    """Return the frame with sqrt(EI / (rho A)) = 1 m^2/s and bars of 1 m."""
    bar = Section(area=1e-4, second_moment=1e-9, modulus=1e9, density=1e4)
    return frame(
        {"A": (0, 0), "B": (0, 1), "C": (1, 1), "D": (1, 0)},
        {"left": ("A", "B"), "beam": ("B", "C"), "right": ("D", "C")},
        bar,
        supports={"A": CLAMPED, "D": CLAMPED},
        elements=elements,
        kind=kind,
    )
