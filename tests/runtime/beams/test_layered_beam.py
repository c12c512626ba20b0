"""Three-layer beams with a viscoelastic core: limits, formulas, plane elasticity, refusals."""

import mpmath
import numpy as np
import pytest
from elastolink.runtime.beams.layered import ElasticLayer, ViscoelasticLayer, sandwich_section
from refusals import refused

BASE = ElasticLayer(3e-3, 70e9, 2700.0)
COVER = ElasticLayer(1e-3, 70e9, 2700.0)
WIDTH, WAVE = 0.025, np.pi / 0.5


def core(shear=2e6, loss=1.0, thickness=1e-3):
    return ViscoelasticLayer(thickness, shear, loss, 1200.0)


def section(middle=None, base=BASE, cover=COVER, **changes):
    numbers = {"width": WIDTH, "wave_number": WAVE, **changes}
    return sandwich_section(base, core() if middle is None else middle, cover, **numbers)


def geometry(middle, wave):
    """Return Mead and Markus' D, Y and g: outer layers alone, coupling, shear parameter."""
    b, c, h = BASE, COVER, middle.thickness
    alone = WIDTH * (b.modulus * b.thickness**3 + c.modulus * c.thickness**3) / 12
    first, third = b.modulus * b.thickness * WIDTH, c.modulus * c.thickness * WIDTH
    arm = h + (b.thickness + c.thickness) / 2
    y = arm**2 * first * third / (first + third) / alone
    g = middle.shear_modulus * WIDTH / h * (1 / first + 1 / third)
    return alone, y, g / wave**2


def test_slack_and_rigid_core():
    alone, y, _ = geometry(core(), WAVE)
    soft, hard = section(core(1e-9)), section(core(1e18))
    assert soft.bending_stiffness == pytest.approx(alone, rel=1e-12)
    assert hard.bending_stiffness == pytest.approx(alone * (1 + y), rel=1e-10)
    assert soft.loss_factor < 1e-12 and hard.loss_factor < 1e-10
    assert soft.slack == pytest.approx(alone, rel=1e-14)
    assert hard.bonded == pytest.approx(alone * (1 + y), rel=1e-14)


@pytest.mark.parametrize("loss", [0.0, 0.3, 1.5])
@pytest.mark.parametrize("wave", [1.0, 10.0, 300.0])
def test_the_equation_of_sixth_order(loss, wave):
    """Mead and Markus: ``D (w6 - g (1 + Y) w4) = ..`` with w = sin kx and a complex g."""
    middle = core(loss=loss)
    alone, y, x = geometry(middle, wave)
    shear = mpmath.mpc(x, x * loss)
    stiffness = alone * (1 + shear * (1 + y)) / (1 + shear)
    found = section(middle, wave_number=wave)
    assert found.bending_stiffness == pytest.approx(float(stiffness.real), rel=1e-13)
    expected = float(stiffness.imag / stiffness.real)
    assert found.loss_factor == pytest.approx(expected, rel=1e-12, abs=1e-300)


def elastic(wave, layers, poisson=0.3):
    """Return the bending stiffness per width of a laminate in plane stress, sinusoidal along it.

    State (U, W, T, S): displacements along and across, shear and normal stress; free below, a
    normal load above; each layer is the exponential of a 4 x 4 matrix.
    """
    k, nu = mpmath.mpf(wave), mpmath.mpf(poisson)
    whole = mpmath.eye(4)
    for thickness, young in layers:
        shear = young / (2 * (1 + nu))
        rates = mpmath.matrix(
            [
                [0, -k, 1 / shear, 0],
                [nu * k, 0, 0, (1 - nu**2) / young],
                [young * k**2, 0, 0, -nu * k],
                [0, 0, k, 0],
            ]
        )
        whole = mpmath.expm(rates * thickness) * whole
    start = mpmath.lu_solve(whole[2:4, 0:2], mpmath.matrix([0, 1]))
    return 1 / (k**4 * start[1])


def test_plane_elasticity_tends_to_the_layer_model():
    """Long waves over a soft core, the shear parameter kept: the difference goes as (k h)^2."""
    loss, differences = 0.7, []
    with mpmath.workdps(40):
        for wave in (1.0, 0.5, 0.25):
            shear = mpmath.mpf(50e3) * wave**2
            young = shear * mpmath.mpc(1, loss) * 2 * (1 + mpmath.mpf("0.3"))
            layers = [(3e-3, mpmath.mpf(70e9)), (1e-3, young), (1e-3, mpmath.mpf(70e9))]
            exact = WIDTH * elastic(wave, layers)
            model = section(core(float(shear), loss), wave_number=wave)
            both = mpmath.mpc(1, model.loss_factor) * model.bending_stiffness
            differences.append(float(abs(both / exact - 1)))
    assert differences[0] < 1e-4
    orders = np.log2(np.array(differences[:-1]) / differences[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.05)


@pytest.mark.smoke
def test_equivalent_section_keeps_stiffness_mass_and_loss():
    found = section(frequency=100.0)
    mass = WIDTH * (4e-3 * 2700.0 + 1e-3 * 1200.0)
    assert found.mass_per_length == pytest.approx(mass, rel=1e-14)
    again = section(wave_number=None, frequency=section().frequency)
    assert again.wave_number == pytest.approx(WAVE, rel=1e-13)
    same = found.section()
    assert same.modulus * same.second_moment == pytest.approx(found.bending_stiffness, rel=1e-14)
    assert same.modulus * same.area == pytest.approx(found.axial_stiffness, rel=1e-14)
    assert same.density * same.area == pytest.approx(found.mass_per_length, rel=1e-14)
    assert same.retardation * 100.0 == pytest.approx(found.loss_factor, rel=1e-14)


test_unusable_numbers_are_refused = refused(
    lambda make: make(),
    [
        (lambda: ElasticLayer(0.0, 70e9, 2700.0), "thickness"),
        (lambda: ElasticLayer(1e-3, float("nan"), 2700.0), "modulus"),
        (lambda: ViscoelasticLayer(1e-3, 1e6, -0.1, 1200.0), "loss_factor"),
        (lambda: section(width=0.0), "width"),
        (lambda: section(wave_number=None), "frequency"),
        (lambda: section(wave_number=-1.0), "wave_number"),
        (lambda: section(frequency=float("inf")), "frequency"),
        (lambda: section(core(1e19)), "core_shear_modulus"),
    ],
)
