"""Smith (7.26)-(7.37): the second-order boundaries, each step against Fourier series."""

import numpy as np
import pytest
from seed_formula import Formula
from seed_ledger import Ledger, hold, holds, quoted, table
from seed_rigs import RIGS, linkage_function
from seed_truth import boundaries, fourier
from seed_waves import HARMONICS, Coefficients, region, second, second_order

row = Ledger("Smith", __file__)


def cases():
    """Return regions 1 to 6 with both signs of the root."""
    return [second(n, sign) for n in (4, 1, 2, 3, 5, 6) for sign in (1, -1)]


def numbered():
    """Return the cases with each number m of the sums."""
    for point in cases():
        yield from ({**point, "m": m} for m in range(1, max(point["N"], 1) + 1))


row("7.26", "7.27", "7.29", "7.30", "7.1.3.3 product y1 f", check=holds(cases))
row("7.31", "7.32", check=holds(cases, tol=1e-7))
row("7.35", check=holds(lambda: map(sums, cases()), tol=1e-7))


@row("7.28")
def letters(entry):
    """P to S hold as printed, for m of their sums; T only without its halves."""
    for point in numbered():
        for k, name in enumerate("PQRS"):
            if name in "PQ" or point["m"] <= point["N"]:
                for form in (entry.printed[k], entry.corrected[k]):
                    hold(form, point)
        hold(entry.corrected[4], point)
        printed = entry.printed[4].sides(**point)[0]
        assert 2 * printed[1] == pytest.approx(printed[0], abs=1e-12)


@row("7.1.3.3 divisors of the primed coefficients")
def divisors(entry):
    for point in numbered():
        last = 4 if point["m"] <= point["N"] else 2
        hold(Formula("; ".join(str(entry.printed).split("; ")[:last])), point)


def sums(point):
    """Return the point with the sums of (7.31), (7.32) without their minus signs, sigma and tau."""
    more = {}
    for name, label in (("Sigma_31", "7.31"), ("Sigma_32", "7.32")):
        form = Formula(table("Smith")[label]["printed"])
        bare = {f"{name}{k}": 0.0 for k in (0, 1) for name in "AB"} | {"T": Coefficients()}
        more[name] = -form.sides(**{**point, **bare})[0][0]
    x = point["alpha1"] + point["a0"]
    a_n, b_n = point["a"][point["n"]] / 2, point["b"][point["n"]] / 2
    sigma = b_n * point["B1"] + point["A0"] * point["alpha2"]
    tau = (x - a_n) * point["B1"] + point["B0"] * point["alpha2"]
    return {**point, **more, "sigma": sigma, "tau": tau}


@row("7.33")
def abbreviations(entry):
    for point in cases():
        hold(entry.corrected, sums(point), tol=1e-8)
    point = sums(second(4, -1))
    literal = [side for sides in entry.printed.sides(**point) for side in sides]
    quoted(literal, "-3.0407", "-1.6934", "2.0916", "1.7955")
    # Read so that the coefficients cancel, the printed form is the right one.
    odd = sums(second(3, 1))
    hold(entry.printed, odd, tol=1e-8)


@row("7.34")
def simultaneous_equations(entry):
    """With sigma and tau of the mended (7.33)."""
    definitions = Formula(table("Smith")["7.33"]["corrected"])
    for point in cases():
        with_sums = {k: v for k, v in sums(point).items() if k not in ("sigma", "tau")}
        hold(entry.printed, {**with_sums, **definitions.values(**with_sums)}, tol=1e-8)


def example(sign):
    """Return the case of the remark on (7.36): f = 2 cos + sin + cos 2 theta, n = 1."""
    return sums(
        second_order(region(Coefficients({1: 2.0, 2: 1.0}), Coefficients({1: 1.0}), 1, sign))
    )


@row("7.36")
def wrong_simplification(entry):
    for point in cases():
        hold(entry.corrected, sums(point), tol=1e-7)
        (B1, printed_B1), (alpha2, printed) = entry.printed.sides(**sums(point))
        assert point["pm"] * printed_B1 == pytest.approx(B1)
        assert abs(printed - alpha2) > 1e-3
    samples = example(1)["f"][:128]
    for sign, true, wrong in ((1, "-0.456", "-0.816"), (-1, "-1.127", "-0.361")):
        point = example(sign)
        _, (alpha2, printed) = entry.printed.sides(**point)
        quoted([alpha2, printed], true, wrong)
        # The exact boundary decides: its second difference at small mu.
        mu = 1e-3
        exact = boundaries(mu * samples, 1)[(1 + sign) // 2]
        assert (exact - 0.25 - point["alpha1"] * mu) / mu**2 == pytest.approx(alpha2, abs=3e-3)


def orders(samples, n):
    """Return alpha1 and alpha2 of both boundaries, upper first, of a function given by samples."""
    values = fourier(samples)
    a = Coefficients(enumerate(2.0 * values[: HARMONICS + 1].real))
    b = Coefficients(enumerate(-2.0 * values[: HARMONICS + 1].imag))
    a[0], b[0] = values[0].real, 0.0
    points = [second_order(region(a, b, n, sign)) for sign in (1, -1)]
    names = ("alpha1_p", "alpha2_p", "alpha1_pp", "alpha2_pp")
    pairs = [p[name] for p in points for name in ("alpha1", "alpha2")]
    return {**dict(zip(names, pairs, strict=True)), "n": n, "lam_p": 3.0, "lam_pp": 2.0}


def uniform(entry, samples, n, mu):
    """Return both boundaries by the derived form of (7.37), lower first."""
    c = fourier(samples)
    series = {"c": {k: c[k] for k in range(-40, 41)}, "mu": mu, "n": n, "a0": c[0].real, "lam": 2.0}
    both = [entry.corrected.sides(**series, pm=sign, oo=18)[0] for sign in (-1, 1)]
    assert both[0][0] == 4
    return sorted(right.real for _, right in both)


@row("7.37")
def second_order_boundaries(entry):
    errors = []
    for name in RIGS:
        f3 = linkage_function(name)
        # What is kept of f3, so that the sums of the machine are whole.
        kept = np.fft.fft(f3)
        kept[HARMONICS + 1 : -HARMONICS] = 0.0
        f3 = np.fft.ifft(kept).real
        for n in (1, 2, 3, 4):
            letters = orders(f3, n)

            def error(mu, f3=f3, letters=letters):
                (one, upper), (other, lower) = entry.printed.sides(**letters, mu=mu)
                assert (one, other) == (9.0, 4.0)
                return np.abs(np.sort([lower, upper]) - boundaries(mu * f3, letters["n"])).max()

            assert np.log2(error(0.008) / error(0.004)) == pytest.approx(3.0, abs=0.1)
            if n in (2, 4):
                errors.append(error(RIGS[name].epsilon(0.0058)[2]))
            for samples in (f3, f3 - harmonic(f3, n)):
                gaps = [
                    np.abs(
                        uniform(entry, samples, n, mu) - np.array(boundaries(mu * samples, n))
                    ).max()
                    for mu in (0.04, 0.02)
                ]
                assert np.log2(gaps[0] / gaps[1]) > 2.8
    quoted(errors, "0.54", "0.068", "0.046", "0.0028")


def harmonic(samples, n):
    """Return the part of a function in cos and sin n theta."""
    kept = np.zeros(samples.size, dtype=complex)
    kept[[n, -n]] = np.fft.fft(samples)[[n, -n]]
    return np.fft.ifft(kept).real


test_row, test_falsified_row = row.tests()
