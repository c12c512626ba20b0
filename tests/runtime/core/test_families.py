"""System families at run time: shapes, hand cases, refusals."""

import types

import elastolink as el
import numpy as np
import pytest
import scipy.linalg
from elastolink.generated import hill_plain
from elastolink.runtime.core.families import MATRICES, VECTORS, Transcendental, array_function
from periodic_systems import named, wave
from refusals import refused

PLACES = {"K": ((2, 2), ((0, 0, 0), (0, 1, 1), (1, 0, 1))), "f": ((2, 1), ())}


def system(**changes) -> el.LinearPeriodic:
    terms = (
        el.Term("M", "mass", np.eye(2)),
        el.Term("K", None, np.diag([3.0, 5.0])),
        el.Term("Kg", "load", wave([[0.0, 1.0], [1.0, 0.0]])),
        el.Term("Kg", "load", np.eye(2), power=2),
        el.Term("f", None, wave([1.0, -1.0])),
    )
    values = {
        "size": 2,
        "terms": terms,
        "parameters": {"mass": 2.0, "load": 0.5},
        "scales": named(("mass", "load")),
        **changes,
    }
    return el.LinearPeriodic(**values)


def test_arrays_are_sums_of_their_terms():
    theta = np.array([0.0, 1.0, 2.0])
    found = system().array("Kg", theta, speed=3.0)
    expected = 0.5 * (np.cos(theta)[:, None, None] * np.array([[0, 1], [1, 0]]) + 9.0 * np.eye(2))
    np.testing.assert_allclose(found, expected, rtol=1e-15)
    np.testing.assert_array_equal(system().array("M", 0.0, mass=7.0), [7.0 * np.eye(2)])
    np.testing.assert_array_equal(system().array("f", np.pi), [[-1.0, 1.0]])


def test_absent_arrays_are_zero_and_declared_so():
    found = system()
    for name in MATRICES + VECTORS:
        present = name in ("M", "K", "Kg", "f")
        assert found.has(name) == present
        if not present:
            shape = (4, 2, 2) if name in MATRICES else (4, 2)
            np.testing.assert_array_equal(found.array(name, np.zeros(4)), np.zeros(shape))
    assert found.is_constant("M")
    assert not found.is_constant("Kg")


def test_parameters_and_terms_are_exchanged_by_copy():
    one = system()
    other = one.with_parameters(load=2.0)
    assert (one.parameters["load"], other.parameters["load"]) == (0.5, 2.0)
    damped = one.with_terms(el.Term("C", "loss", 2.0 * np.eye(2)), scales={"loss": 0.1})
    assert not one.has("C")
    np.testing.assert_array_equal(damped.array("C", 0.0), [0.2 * np.eye(2)])
    np.testing.assert_array_equal(damped.array("C", 0.0, loss=0.3), [0.6 * np.eye(2)])
    np.testing.assert_array_equal(damped.array("M", 0.0), one.array("M", 0.0))
    again = damped.with_terms(el.Term("K", "spring", np.eye(2)), scales={"spring": 1.0})
    assert set(again.parameters) == {"mass", "load", "loss", "spring"}
    np.testing.assert_array_equal(again.array("C", 0.0), damped.array("C", 0.0))


test_unusable_terms_are_refused = refused(
    lambda term: el.LinearPeriodic(2, (term,), {}, named(())),
    [
        (el.Term("G", None, np.eye(2)), "'G'"),
        (el.Term("M", None, np.eye(3)), r"\(1, 3, 3\)"),
        (el.Term("f", None, np.eye(2)), r"\(1, 2, 2\)"),
        (el.Term("K", None, lambda theta: np.cos(theta)), r"shape \(1,\)"),
    ],
)


def test_unknown_parameters_are_refused():
    with pytest.raises(el.BadInput, match="weight"):
        system().with_parameters(weight=1.0)


def test_count_on_a_chain_whose_answer_is_known():
    """Masses as D = K - Omega^2 M without poles: the count is that of the eigenvalues below."""
    stiffness = 2.0 * np.eye(5) - np.eye(5, k=1) - np.eye(5, k=-1)
    chain = Transcendental(
        5,
        lambda w: stiffness - np.asarray(w)[..., None, None] ** 2 * np.eye(5),
        lambda w: np.zeros(np.shape(w)),
    )
    exact = np.sqrt(scipy.linalg.eigvalsh(stiffness))
    frequency = np.linspace(0.01, 2.1, 40).reshape(8, 5)
    found = chain.count(frequency)
    assert found.dtype == np.int64
    np.testing.assert_array_equal(found, np.sum(frequency[..., None] > exact, axis=-1))


def module(**changes) -> types.SimpleNamespace:
    values = {
        "__name__": "emitted",
        "FAMILY": "closed_form",
        "PARAMETERS": ("m", "k"),
        "ARRAYS": {"element": PLACES, "idle": {"f": PLACES["f"]}},
        "element": lambda x, m, k: (k * x, -m),
        **changes,
    }
    return types.SimpleNamespace(**values)


def test_functions_of_arrays_broadcast_all_their_arguments():
    function = array_function(module(), "element")
    found = function(np.ones((4, 1)), m=np.array([1.0, 2.0, 3.0]), k=2.0)
    assert found["K"].shape == (4, 3, 2, 2)
    np.testing.assert_array_equal(found["K"][0, 2], [[2.0, -3.0], [-3.0, 0.0]])
    np.testing.assert_array_equal(found["f"], np.zeros((4, 3, 2, 1)))
    np.testing.assert_array_equal(function(2.0, 3.0, 4.0)["K"], [[8.0, -3.0], [-3.0, 0.0]])
    np.testing.assert_array_equal(
        array_function(module(), "idle")(np.ones(2))["f"].shape, (2, 2, 1)
    )


def test_unknown_functions_of_arrays_are_refused():
    with pytest.raises(el.BadInput, match="dynamics"):
        array_function(module(), "dynamics")
    with pytest.raises(el.BadInput, match="motion"):
        array_function(types.SimpleNamespace(__name__="closed", FAMILY="closed_form"), "motion")


def test_modules_of_another_family_are_refused():
    for family in (el.Constrained, Transcendental):
        with pytest.raises(el.BadInput, match="family linear_periodic"):
            family.from_module(hill_plain, {"lam2": 1.0, "mu": 0.0, "damping": 0.0})


def test_arguments_beside_the_frequency():
    emitted = module(
        FAMILY="transcendental",
        SIZE=1,
        ARRAYS={"dynamic_stiffness": {"stiffness": ((1, 1), ((0, 0, 0),)), "poles": ((1, 1), ())}},
        dynamic_stiffness=lambda frequency, theta, m, k: (k * np.cos(theta) - m * frequency**2,),
    )
    given = {"m": 1.0, "k": 4.0}
    found = Transcendental.from_module(emitted, given, geometry={"theta": np.array([0.0, 1.5])})
    np.testing.assert_array_equal(found.count(1.0), [0, 1])
    with pytest.raises(el.BadInput, match="theta"):
        Transcendental.from_module(emitted, given)


@pytest.mark.parametrize(
    "scene",
    [
        "smith_1972_5152_sixteenth_inch",
        "beale_1992_flexible_rod",
        "aannaque_1996_table_4_1",
        "hill_example",
    ],
)
def test_parameters_given_at_a_call_obey_the_limits_of_the_scene(scene):
    """Only what may have either sign has none."""
    system = el.load_scene(scene).system()
    free = {"coupler_first_moment", "lam2", "mu"}
    assert set(system.parameters) == set(system.limits) | (free & set(system.parameters))
    for name, limit in system.limits.items():
        for value in (-1.0, np.nan, *([0.0] if limit == "positive" else [])):
            with pytest.raises(el.BadInput, match=f"{name}: found"):
                el.floquet_multipliers(system, 80.0, **{name: [1.0, value]})
