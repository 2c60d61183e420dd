"""Functions on arrays: shapes, number types, outputs, errors."""

import pickle
import threading
import time

import numpy as np
import pytest

import overact

POSE, TWIST, ACCELERATION = [0.02, -0.01, 0.1], [0.3, 0.0, 1.0], [0.0, 2.0, 0.0]


def states(count, seed=1):
    random = np.random.default_rng(seed)
    poses = random.uniform(-0.05, 0.05, (count, 3))
    return poses, random.normal(size=(count, 3)), random.normal(size=(count, 3))


def test_single_samples_equal_those_of_arrays(dualv):
    poses, twists, accelerations = states(200)
    many = dualv.idm_red_platform(poses, twists, accelerations)
    assert many.shape == (200, 3, 64) and many.dtype == np.float64
    one = dualv.idm_red_platform(poses[7], twists[7], accelerations[7])
    assert one.shape == (3, 64)
    # Blocks use other polynomials for sine and cosine than single samples.
    np.testing.assert_allclose(many[7], one, rtol=0, atol=1e-13 * np.abs(one).max())
    listed = dualv.idm_red_platform(poses[7].tolist(), list(twists[7]), tuple(accelerations[7]))
    np.testing.assert_array_equal(listed, one)
    named = dualv.idm_red_platform(poses, acceleration=accelerations, twist=twists)
    np.testing.assert_array_equal(named, many)
    grid = dualv.idm_red_platform(
        poses.reshape(10, 20, 3), twists.reshape(10, 20, 3), accelerations.reshape(10, 20, 3)
    )
    np.testing.assert_array_equal(grid, many.reshape(10, 20, 3, 64))
    # A single row is used for all samples.
    shared = dualv.idm_red_platform(poses, TWIST, ACCELERATION)
    full = dualv.idm_red_platform(poses, np.tile(TWIST, (200, 1)), np.tile(ACCELERATION, (200, 1)))
    np.testing.assert_array_equal(shared, full)
    assert dualv.idm_red_platform(np.empty((0, 3)), TWIST, ACCELERATION).shape == (0, 3, 64)


def test_other_dtypes_and_memory_layouts_are_converted(dualv):
    poses, twists, accelerations = states(130)
    expected = dualv.mass_matrix(poses, np.ones(68))
    wide = np.zeros((130, 6))
    wide[:, ::2] = poses
    for same in (np.asfortranarray(poses), wide[:, ::2], poses.astype(">f8"), poses[::-1][::-1]):
        np.testing.assert_array_equal(dualv.mass_matrix(same, np.ones(68)), expected)
    single = poses.astype(np.float32)
    np.testing.assert_array_equal(
        dualv.mass_matrix(single, np.ones(68, dtype=int)),
        dualv.mass_matrix(single.astype(np.float64), np.ones(68)),
    )


def test_arrays_longer_than_a_block_are_evaluated(dualv):
    poses, twists, _ = states(70_000)
    whole = dualv.joint_velocities(poses, twists)
    np.testing.assert_array_equal(whole[-30:], dualv.joint_velocities(poses[-94:], twists[-94:])[-30:])


def test_results_are_written_into_out(dualv):
    poses, twists, accelerations = states(50)
    expected = dualv.idm_red_platform(poses, twists, accelerations)
    room = np.full((100, 3, 64), np.nan)
    out = room[25:75]
    assert dualv.idm_red_platform(poses, twists, accelerations, out=out) is out
    np.testing.assert_array_equal(room[25:75], expected)
    assert np.isnan(room[:25]).all() and np.isnan(room[75:]).all()


@pytest.mark.parametrize(
    "out, error, message",
    [
        (np.zeros((2, 3, 64), dtype=np.float32), TypeError, "float32"),
        (np.zeros((3, 64)), ValueError, r"\(3, 64\).*\(2, 3, 64\)"),
        (np.zeros((2, 64, 3)).transpose(0, 2, 1), ValueError, "contiguous"),
        (np.zeros((4, 3, 64))[::2], ValueError, "contiguous"),
        ([[0.0]], TypeError, "a list"),
    ],
)
def test_out_arrays_of_wrong_shape_or_type_are_rejected(dualv, out, error, message):
    poses, twists, accelerations = states(2)
    with pytest.raises(error, match=message):
        dualv.idm_red_platform(poses, twists, accelerations, out=out)


def test_read_only_and_overlapping_out_arrays_are_rejected(dualv):
    poses, _, _ = states(4)
    kept = np.zeros((4, 3))
    kept.flags.writeable = False
    with pytest.raises(ValueError, match="`out` can't be written"):
        dualv.pose_from_actuators(np.zeros((4, 4)), out=kept)
    # An output that is also an input.
    joined = np.zeros((4, 3))
    joined[:] = poses
    torques = np.zeros((4, 4))
    with pytest.raises(ValueError, match="share memory"):
        dualv.project_torques(poses, torques, out=torques)


@pytest.mark.parametrize(
    "pose, error, message",
    [
        ([0.0, 0.0], ValueError, r"`pose` has the shape \(2,\).*3 numbers \(x, y, phi\)"),
        (np.zeros((3, 5)), ValueError, r"`pose.T`"),
        (0.0, ValueError, r"shape \(\)"),
        (["a", "b", "c"], TypeError, "dtype <U1"),
        (np.zeros(3, dtype=complex), TypeError, "complex128"),
        ([[1.0, 2.0], [3.0]], TypeError, "not an array of numbers"),
        (None, TypeError, "dtype object"),
        (np.ma.masked_array(np.zeros(3), [0, 1, 0]), TypeError, "masked"),
    ],
)
def test_inputs_of_wrong_shape_are_rejected(dualv, pose, error, message):
    with pytest.raises(error, match=message):
        dualv.joints(pose)


def test_invalid_calls_are_rejected(dualv):
    poses, twists, _ = states(5)
    with pytest.raises(TypeError, match="needs `twist`"):
        dualv.joint_velocities(poses)
    with pytest.raises(TypeError, match="takes 2 inputs, but 3"):
        dualv.joint_velocities(poses, twists, twists)
    with pytest.raises(TypeError, match="has no input `speed`"):
        dualv.joint_velocities(poses, speed=twists)
    with pytest.raises(TypeError, match="`pose` twice"):
        dualv.joint_velocities(poses, twists, pose=poses)
    with pytest.raises(ValueError, match=r"different samples.*\(5, 3\) and \(4, 3\)"):
        dualv.joint_velocities(poses, twists[:4])
    with pytest.raises(TypeError, match="no `start`"):
        dualv.joint_velocities(poses, twists, start=POSE)
    with pytest.raises(ValueError, match='invalid="skip"'):
        dualv.joints(poses, invalid="skip")
    with pytest.raises(AttributeError, match="did you mean `idm_red_platform`"):
        dualv.idm_red_platfrom


def test_failing_samples_are_reported_by_index(dualv):
    poses, _, _ = states(300)
    poses[211, 1] = np.nan
    with pytest.raises(overact.EvaluationError, match="`pose` has a number that is not finite") as error:
        dualv.inverse_jacobian(poses)
    assert error.value.sample == 211
    poses[77] = [9.0, 0.0, 0.0]
    with pytest.raises(overact.EvaluationError, match="out of reach of leg `leg1`") as error:
        dualv.inverse_jacobian(poses)
    assert error.value.sample == 77 and "leg1" in error.value.reason
    assert isinstance(pickle.loads(pickle.dumps(error.value)), overact.EvaluationError)


def test_failing_samples_can_become_nan(dualv):
    poses, _, _ = states(300)
    expected = dualv.inverse_jacobian(poses)
    poses[211, 1], poses[77], poses[0, 2] = np.inf, [9.0, 0.0, 0.0], np.nan
    found = dualv.inverse_jacobian(poses, invalid="nan")
    bad = np.isnan(found).all(axis=(1, 2))
    assert np.flatnonzero(bad).tolist() == [0, 77, 211]
    np.testing.assert_allclose(found[~bad], expected[~bad], rtol=0, atol=1e-13)
    assert np.isnan(dualv.inverse_jacobian([9.0, 0.0, 0.0], invalid="nan")).all()


def test_all_forms_of_a_function_agree(dualv):
    poses, twists, accelerations = states(40)
    expected = dualv.idm_red_platform_base(poses, twists, accelerations)
    joints = dualv.joints(poses)
    actuators = dualv.actuator_positions(poses)
    size = np.abs(expected).max()
    found = dualv.pose_from_actuators(actuators)
    np.testing.assert_allclose(found, poses, atol=1e-11)
    form = dualv.idm_red_platform_base_from_actuators
    places = [int(np.argmin(np.abs(joints[0] - one))) for one in actuators[0]]
    rates = dualv.joint_velocities(poses, twists)[:, places]
    changes = dualv.joint_accelerations(poses, twists, accelerations)[:, places]
    np.testing.assert_allclose(form(actuators, rates, changes), expected, atol=1e-9 * size)
    np.testing.assert_allclose(
        form(actuators[3], rates[3], changes[3], start=poses[3]), expected[3], atol=1e-9 * size
    )
    form = dualv.idm_red_platform_base_from_joints
    given = {"pose": poses, "joints": joints, "twist": twists, "acceleration": accelerations}
    found = form(**{name: given[name] for name in form.inputs})
    np.testing.assert_allclose(found, expected, atol=1e-12 * size)
    assert form.columns == [one.name for one in dualv.base_parameters]
    assert dualv.idm_red_platform.columns == [one.name for one in dualv.parameters]
    assert dualv.joints.columns == [] and dualv.joints.shape == (12,)
    assert "(30)" in dualv.idm_red_platform.summary
    assert repr(dualv.idm_red_platform).startswith("<idm_red_platform(pose: (3,), twist: (3,)")


def test_dynamics_are_linear_in_the_parameters(dualv):
    poses, twists, accelerations = states(20)
    values = dualv.parameter_vector(dualv.true_values)
    base = dualv.base_parameter_vector(dualv.true_values)
    torques = dualv.inverse_dynamics(poses, twists, accelerations, values)
    same = dualv.inverse_dynamics_base(poses, twists, accelerations, base)
    np.testing.assert_allclose(torques, same, atol=1e-11)
    generalised = np.concatenate(
        [
            dualv.idm_red_platform(poses, twists, accelerations),
            dualv.idm_red_payload(poses, twists, accelerations),
        ],
        axis=2,
    )
    projected = dualv.project_platform(poses, torques)
    np.testing.assert_allclose(generalised @ values, projected, atol=1e-11)
    found = dualv.forward_dynamics(poses, twists, torques, values)
    np.testing.assert_allclose(found, accelerations, atol=1e-9)
    with pytest.raises(ValueError, match="no parameters nonsense"):
        dualv.parameter_vector({**dualv.true_values, "nonsense": 1.0})
    with pytest.raises(ValueError, match="missing parameters: .*m_platform"):
        dualv.parameter_vector({"zz_1_leg1": 1.0})


def test_evaluation_releases_the_interpreter_lock(dualv):
    poses, twists, accelerations = states(64_000)
    out = np.empty((64_000, 3, 64))
    dualv.idm_red_platform(poses, twists, accelerations, out=out)
    ended = threading.Event()

    def work():
        for _ in range(5):
            dualv.idm_red_platform(poses, twists, accelerations, out=out)
        ended.set()

    thread = threading.Thread(target=work)
    turns, begin = 0, time.perf_counter()
    thread.start()
    while not ended.is_set():
        time.sleep(1e-4)
        turns += 1
    seconds = time.perf_counter() - begin
    thread.join()
    # If the lock were held, other threads would run between calls only.
    assert turns > 20, f"{turns} turns in {seconds} s"


def test_robot_attributes_describe_the_dualv(dualv, emps):
    assert (dualv.name, dualv.r, dualv.n, len(dualv.joint_names)) == ("DualV", 3, 4, 12)
    assert repr(dualv) == (
        "<Robot DualV: r = 3, n = 4, 12 joints, parameters: 64 standard, 49 base, 4 payload>"
    )
    assert dualv.pose_coordinates == ("x", "y", "phi")
    assert dualv.actuators == ("leg1", "leg2", "leg3", "leg4") and len(dualv.kept_actuators) == 3
    base = dualv.base_parameters["m_platformR"]
    assert base.parameter == "m_platform" and base.unit == "kg" and len(base.regrouped) > 0
    assert repr(base).startswith("<m_platformR = m_platform ") and repr(base).endswith(", kg>")
    truth = dualv.true_values
    assert base.value(truth) == pytest.approx(
        truth["m_platform"] + sum(c * truth[name] for name, c in base.regrouped.items())
    )
    assert repr(dualv.parameters["zz_1_leg1"]) == "<zz_1_leg1, kg m^2>"
    assert {"idm_red_platform", "null_space", "name"} <= set(dir(dualv))
    assert "<svg" in dualv.drawing() and "<svg" in dualv._repr_html_()
    assert emps.functions and "null_space" not in emps.functions
    again = pickle.loads(pickle.dumps(dualv))
    np.testing.assert_array_equal(again.joints(POSE), dualv.joints(POSE))


def test_costs_equal_those_of_the_command_line(dualv, command):
    document = command.json("inspect", dualv.file, "--effort", "quick")
    cost = dualv.costs()
    for function in document["functions"]:
        own = cost[function["function"]]
        assert own.operations == function["operations"], function["function"]
        assert own.trigonometric_pairs == function["trigonometric_pairs"]
    assert set(cost) == {function["function"] for function in document["functions"]}
    # The others are generated on request.
    assert set(cost) < set(dualv.functions)
    assert dualv.cost("total_mass").operations < 100
    one = dualv.cost("idm_red_platform_from_joints")
    assert one == cost["idm_red_platform_from_joints"]
    assert repr(one).startswith(f"<{one.operations} operations (")
    with pytest.raises(ValueError, match="no robot has a function `idm`"):
        dualv.cost("idm")
    with pytest.raises(ValueError, match="effort"):
        dualv.cost("joints", effort="much")
