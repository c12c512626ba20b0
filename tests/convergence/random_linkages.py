"""Random linkages of every kind, class and assembly; the class of a four-bar by its table."""

from elastolink.runtime.core.errors import BadInput
from elastolink.runtime.linkages import FourBar, QuickReturn, SliderCrank

KINDS = ("four-bar", "slider-crank", "quick-return")


def random_linkage(rng, kind, size=1.0):
    """Return a linkage that closes, its links a tenth to the whole of a size."""
    while True:
        lengths = [float(length) for length in size * rng.uniform(0.1, 1.0, 4)]
        assembly = str(rng.choice(["open", "crossed"]))
        offset = float(size * rng.choice([0.0, *rng.uniform(-0.5, 0.5, 2)]))
        try:
            if kind == "four-bar":
                return FourBar(*lengths, assembly)
            if kind == "slider-crank":
                return SliderCrank(*lengths[:2], offset, assembly)
            return QuickReturn(*lengths[:2], float(rng.uniform(1.0, 4.0)) * sum(lengths[:2]))
        except BadInput:
            continue


def grashof_symbol(lengths):
    """Barker's table word by word; '' where the four cannot move."""
    s, p, q, longest = sorted(lengths)
    lengths = list(lengths)
    if longest >= s + p + q:
        return ""
    if s + longest < p + q:
        return ("GCCC", "GCRR", "GRCR", "GRRC")[lengths.index(s)]
    if s + longest > p + q:
        return f"RRR{lengths.index(longest) + 1}"
    if s == longest:
        return "CP3X"
    if s == p:
        return "CP2X"
    return ("CPCCC", "CPCRR", "CPRCR", "CPRRC")[lengths.index(s)]
