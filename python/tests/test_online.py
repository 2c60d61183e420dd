"""Online estimators."""

import numpy as np
import pytest

import overact
from overact import online


def rows_of(rng, samples, count):
    return rng.normal(size=(samples, count))


def test_the_estimate_is_that_of_batch_least_squares():
    rng = np.random.default_rng(3)
    truth = np.array([1.0, -2.0, 0.5])
    rows = rng.normal(size=(200, 2, 3))
    sigma = np.array([0.1, 0.4])
    y = rows @ truth + sigma * rng.normal(size=(200, 2))
    filter = online.Filter(3)
    innovation = filter.update(rows, y, sigma)
    assert innovation.residual.shape == (200, 2)
    assert not innovation.is_determined.ravel()[:3].any() and innovation.is_determined.ravel()[3:].all()
    white = (rows / sigma[:, None]).reshape(-1, 3)
    information = white.T @ white
    batch = np.linalg.solve(information, white.T @ (y / sigma).ravel())
    np.testing.assert_allclose(filter.estimate(), batch, rtol=1e-10)
    np.testing.assert_allclose(filter.covariance(), np.linalg.inv(information), rtol=1e-10, atol=1e-16)
    np.testing.assert_allclose(filter.standard_deviations() ** 2, np.diag(np.linalg.inv(information)), rtol=1e-10)
    factor, side = filter.factor()
    np.testing.assert_allclose(factor.T @ factor, information, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(factor @ batch, side, rtol=1e-9)
    assert filter.residual_deviation() == pytest.approx(1.0, abs=0.1)


def test_sample_by_sample_is_the_same_as_all_at_once():
    rng = np.random.default_rng(4)
    rows, y = rng.normal(size=(50, 2, 3)), rng.normal(size=(50, 2))
    for rule in ("none", "exponential", "directional"):
        together, single = (online.Filter.from_standard_deviations(np.zeros(3), np.full(3, 9.0)) for _ in range(2))
        together.set_forgetting(rule, 0.95)
        single.set_forgetting(rule, 0.95)
        at_once = together.update(rows, y, 0.1)
        for k in range(50):
            one = single.update(rows[k], y[k], 0.1)
            np.testing.assert_array_equal(one.normalised, at_once.normalised[k])
        np.testing.assert_array_equal(together.estimate(), single.estimate())


def test_priors():
    filter = online.Filter.from_covariance([1.0, 2.0], [[4.0, 1.0], [1.0, 1.0]])
    np.testing.assert_allclose(filter.covariance(), [[4.0, 1.0], [1.0, 1.0]], rtol=1e-12)
    np.testing.assert_allclose(filter.estimate(), [1.0, 2.0], rtol=1e-12)
    assert online.Filter.from_square_root([3.0], [[2.0]]).standard_deviations() == pytest.approx([0.5])
    for bad in (
        lambda: online.Filter.from_covariance([0.0, 0.0], [[1.0, 2.0], [2.0, 1.0]]),
        lambda: online.Filter.from_square_root([0.0, 0.0], [[1.0, 1.0], [1.0, 1.0]]),
        lambda: online.Filter.from_standard_deviations([0.0], [0.0]),
    ):
        with pytest.raises(overact.DataError, match="positive"):
            bad()


def test_determined_parameters_come_first():
    filter = online.Filter(2)
    filter.update([2.0, 0.0], 6.0, 1.0)
    with pytest.raises(overact.EvaluationError, match="determine"):
        filter.estimate()
    values, deviations = filter.determined()
    assert values[0] == 3.0 and deviations[0] == 0.5 and np.isnan(values[1])


def test_rejected_samples_change_nothing():
    rng = np.random.default_rng(5)
    filter = online.Filter.from_standard_deviations([0.0, 0.0], [9.0, 9.0])
    rows, y = rows_of(rng, 10, 2)[:, None, :], rng.normal(size=(10, 1))
    before = filter.factor()
    rows[7, 0, 1] = np.nan
    with pytest.raises(overact.EvaluationError, match="sample 7.*`row`") as error:
        filter.update(rows, y, 0.1)
    assert error.value.sample == 7
    np.testing.assert_array_equal(filter.factor()[0], before[0])
    assert filter.residual_deviation() is None


def test_wrong_arguments():
    filter = online.Filter(2)
    for rows, y, sigma, what in (
        ([1.0, 2.0, 3.0], 1.0, 0.1, "rows"),
        ([[1.0, 2.0]], 1.0, 0.1, "y"),
        ([[1.0, 2.0]], [1.0], [0.1, 0.2], "sigma"),
    ):
        with pytest.raises(ValueError, match=f"`{what}`"):
            filter.update(rows, y, sigma)
    with pytest.raises(TypeError, match="`rows`"):
        filter.update([1j, 2.0], 1.0, 0.1)
    with pytest.raises(overact.DataError, match="forgetting"):
        filter.set_forgetting("exponential", 1.5)
    with pytest.raises(ValueError, match="rule"):
        filter.set_forgetting("sometimes", 0.5)
    with pytest.raises(overact.DataError, match="columns"):
        online.PayloadEstimator(["m", "fv"], mass=1.0, length=1.0)
    with pytest.raises(overact.DataError, match="size"):
        online.PayloadEstimator(["m"], mass=-1.0, length=1.0)
    with pytest.raises(overact.DataError, match="order"):
        online.StateVariableFilter(2, 40.0, 1000.0)


def test_payload_of_the_dualv(dualv):
    """The payload that the virtual robot carries, from rows and torques of the model."""
    rng = np.random.default_rng(6)
    pose = dualv.home_pose + rng.uniform(-0.05, 0.05, (300, 3))
    twist, acceleration = rng.normal(size=(2, 300, 3))
    columns = [one.symbol for one in dualv.payload_parameters]
    rows = dualv.idm_red_payload(pose, twist, acceleration)
    truth = {"zz": 0.02, "mx": 0.05, "my": -0.03, "m": 1.5}
    residuals = rows @ np.array([truth[one] for one in columns]) + 0.01 * rng.normal(size=(300, 3))
    estimator = online.PayloadEstimator(dualv.payload_parameters, mass=5.0, length=0.3)
    estimator.update(rows, residuals, 0.01)
    payload = estimator.payload()
    assert payload.mass == pytest.approx(1.5, abs=0.01) and not payload.is_projected
    np.testing.assert_allclose(payload.centre[:2], [0.05 / 1.5, -0.03 / 1.5], atol=2e-3)
    assert payload.parameters[online.INERTIA.index("zz")] == pytest.approx(0.02, abs=2e-3)
    assert (np.linalg.eigvalsh(payload.inertia) > 0.0).all()
    estimator.discount(1e-9)
    assert estimator.standard_deviations()[columns.index("m")] > 0.5


def test_no_body_has_a_negative_mass():
    estimator = online.PayloadEstimator(["m"], mass=10.0, length=0.3)
    estimator.update([[1.0]], [-2.0], 0.1)
    payload = estimator.payload()
    assert payload.is_projected and 0.0 < payload.mass < 0.01


def test_changes_and_whitening():
    test = online.ChangeTest(1.0, 1e5)
    assert test.threshold == pytest.approx(10.3, abs=0.1)
    found = [test.update(1.5) for _ in range(11)]
    assert found == [None] * 10 + ["increase"]
    whitening = online.Whitening()
    white = whitening.update(np.sin(0.01 * np.arange(5000)))
    assert abs(white[-1]) < 1.0 and whitening.correlation > 0.98


def test_filters_of_position_and_torque_have_equal_delay():
    t = np.arange(4000) / 1000.0
    q = np.stack([np.sin(t), 0.5 * np.sin(2.0 * t)], axis=-1)
    torque = np.stack([-2.0 * np.sin(t), -4.0 * np.sin(2.0 * t)], axis=-1)
    position, load = (online.StateVariableFilter(3, 40.0, 1000.0, signals=2) for _ in range(2))
    moved, loaded = position.update(q), load.update(torque)
    assert moved.value.shape == (4000, 2)
    np.testing.assert_allclose(loaded.value[500:], 2.0 * moved.acceleration[500:], atol=1e-2)
    single = online.StateVariableFilter(3, 40.0, 1000.0)
    assert single.update(q[0, 0]).value.shape == ()
    np.testing.assert_allclose(single.update(q[1:, 0]).velocity, moved.velocity[1:, 0], rtol=1e-12, atol=1e-12)
    assert single.delay == pytest.approx(0.007957747)
    with pytest.raises(overact.EvaluationError, match="sample 0"):
        single.update(np.nan)
