//! Functions that iterate: forward kinematics by Gauss and Newton, inverse kinematics by Newton's method, and
//! partitions of case 2. They are the counterparts of `overact::forward`, `overact::inverse` and
//! `overact::partition`, operation by operation; `codegen/src/emission/model_impl.rs` and `inverse.rs` are
//! their Rust.
//!
//! In the texts `rob_` and `ROB_` stand for the robot's prefix.

use super::errors;
use super::function::{has_quaternion, signature};
use super::lines::documentation;
use super::naming::Naming;
use crate::derivation::{JointsBy, MotionInput};
use crate::lowering::Array;
use crate::model::RobotModel;
use overact_core::Function;

const DISPLACE: &str = "\
/* Moves a pose by a small displacement along the twist coordinates. */
static void rob_displace(double *pose, const double *step)
{
    for (int i = 0; i < ROB_DOF; i++) {
        pose[i] += step[i];
    }
}
";

const DISPLACE_QUATERNION: &str = "\
/* Moves a pose that ends with a unit quaternion (w, x, y, z): the last three numbers of a step are a rotation
 * vector in the base frame, by whose exponential the quaternion is multiplied from the left. */
static void rob_displace(double *pose, const double *step)
{
    const double *const turn = &step[ROB_DOF - 3];
    double *const q = &pose[ROB_POSE - 4];
    const double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    /* sin(a/2)/a tends to 1/2. */
    const double scale = (angle > 1e-12) ? (sin(0.5 * angle) / angle) : 0.5;
    const double a = cos(0.5 * angle);
    const double b = scale * turn[0];
    const double c = scale * turn[1];
    const double d = scale * turn[2];
    double product[4];
    double sum = 0.0;
    for (int i = 0; i < (ROB_DOF - 3); i++) {
        pose[i] += step[i];
    }
    product[0] = a * q[0] - b * q[1] - c * q[2] - d * q[3];
    product[1] = a * q[1] + b * q[0] + c * q[3] - d * q[2];
    product[2] = a * q[2] - b * q[3] + c * q[0] + d * q[1];
    product[3] = a * q[3] + b * q[2] - c * q[1] + d * q[0];
    for (int i = 0; i < 4; i++) {
        sum += product[i] * product[i];
    }
    sum = sqrt(sum);
    for (int i = 0; i < 4; i++) {
        q[i] = product[i] / sum;
    }
}
";

const GAUSS_NEWTON: &str = "\
/* Solves S x = y in place for a symmetric positive definite S, which is overwritten; 0 where a pivot vanishes. */
static int rob_solve(double matrix[ROB_DOF][ROB_DOF], double vector[ROB_DOF])
{
    double largest = 0.0;
    int is_regular = 1;
    for (int k = 0; k < ROB_DOF; k++) {
        largest = (matrix[k][k] > largest) ? matrix[k][k] : largest;
    }
    for (int k = 0; (k < ROB_DOF) && (is_regular != 0); k++) {
        const double pivot = matrix[k][k];
        if (pivot > (1e-15 * largest)) {
            for (int row = k + 1; row < ROB_DOF; row++) {
                const double factor = matrix[row][k] / pivot;
                for (int column = k + 1; column < ROB_DOF; column++) {
                    matrix[row][column] -= factor * matrix[k][column];
                }
                vector[row] -= factor * vector[k];
            }
        } else {
            is_regular = 0;
        }
    }
    if (is_regular != 0) {
        for (int k = ROB_DOF - 1; k >= 0; k--) {
            double rest = 0.0;
            for (int column = k + 1; column < ROB_DOF; column++) {
                rest += matrix[k][column] * vector[column];
            }
            vector[k] = (vector[k] - rest) / matrix[k][k];
        }
    }
    return is_regular;
}

/* The pose that fits the actuators best in the sense of least squares, found from the one in `pose`. */
static rob_error rob_gauss_newton(const double *actuators, double *pose)
{
    for (int count = 0; count < 20; count++) {
        double reached[ROB_ACTUATORS];
        double jacobian[ROB_ACTUATORS * ROB_DOF];
        double normal[ROB_DOF][ROB_DOF];
        double step[ROB_DOF];
        double largest = 0.0;
        rob_error error = rob_actuator_positions(pose, reached);
        if (error == ROB_OK) {
            error = rob_inverse_jacobian(pose, jacobian);
        }
        if (error != ROB_OK) {
            return error;
        }
        for (int row = 0; row < ROB_DOF; row++) {
            step[row] = 0.0;
            for (int column = 0; column < ROB_DOF; column++) {
                normal[row][column] = 0.0;
            }
        }
        for (int i = 0; i < ROB_ACTUATORS; i++) {
            const double *const entries = &jacobian[i * ROB_DOF];
            double difference = actuators[i] - reached[i];
            if (rob_actuator_is_revolute[i] != 0) {
                difference = rob_wrap_angle(difference);
            }
            for (int row = 0; row < ROB_DOF; row++) {
                step[row] += entries[row] * difference;
                for (int column = 0; column < ROB_DOF; column++) {
                    normal[row][column] += entries[row] * entries[column];
                }
            }
        }
        if (rob_solve(normal, step) == 0) {
            return ROB_SINGULAR_ACTUATORS;
        }
        rob_displace(pose, step);
        for (int row = 0; row < ROB_DOF; row++) {
            largest = (fabs(step[row]) > largest) ? fabs(step[row]) : largest;
        }
        if (!isfinite(largest)) {
            return ROB_NO_CONVERGENCE;
        }
        if (largest < 1e-12) {
            return ROB_OK;
        }
    }
    return ROB_NO_CONVERGENCE;
}
";

/// Arguments that are not finite.
const FORWARD_CHECKS: &str = "
{
    if (!(rob_is_finite(actuators, ROB_ACTUATORS))) {
        return ROB_NOT_FINITE_ACTUATORS;
    }
    if (!(rob_is_finite(start, ROB_POSE))) {
        return ROB_NOT_FINITE_START;
    }
";

const FORWARD_OF_A_TREE: &str = "\
    for (int i = 0; i < ROB_POSE; i++) {
        output[i] = actuators[i];
    }
    return ROB_OK;
}
";

const FORWARD_START: &str = "\
    double pose[ROB_POSE];
    for (int i = 0; i < ROB_POSE; i++) {
        pose[i] = start[i];
    }
";

const FORWARD_START_QUATERNION: &str = "\
    double pose[ROB_POSE];
    if (!(rob_unit_quaternion(start, pose))) {
        return ROB_ZERO_QUATERNION_START;
    }
";

const FORWARD_BY_RULE: &str = "\
    rob_error error = rob_pose_in_closed_form(actuators, pose);
    if (error != ROB_OK) {
        error = rob_gauss_newton(actuators, pose);
    }
";

const FORWARD_AGAIN_BY_RULE: &str = "\
    rob_error error = rob_gauss_newton(actuators, pose);
    if (error != ROB_OK) {
        if (rob_pose_in_closed_form(actuators, pose) == ROB_OK) {
            error = rob_gauss_newton(actuators, pose);
        }
    }
";

const FORWARD: &str = "\
    const rob_error error = rob_gauss_newton(actuators, pose);
";

const FORWARD_END: &str = "\
    if (error != ROB_OK) {
        return error;
    }
    for (int i = 0; i < ROB_POSE; i++) {
        output[i] = pose[i];
    }
    return ROB_OK;
}
";

const NEWTON: &str = "\
/* Solves a leg's block of J_k x = e in place by elimination with row pivoting; the sign of the block's
 * determinant. `condition` gets the ratio of its largest and smallest pivots. */
static double rob_eliminate(
    double matrix[ROB_JOINTS][ROB_JOINTS],
    double vector[ROB_JOINTS],
    int leg,
    double *condition)
{
    const int begin = rob_first_joints[leg];
    const int end = rob_first_joints[leg + 1];
    double sign = 1.0;
    double largest = 0.0;
    double smallest = HUGE_VAL;
    *condition = HUGE_VAL;
    for (int k = begin; k < end; k++) {
        int pivot_row = k;
        double pivot = 0.0;
        for (int row = k + 1; row < end; row++) {
            if (fabs(matrix[row][k]) > fabs(matrix[pivot_row][k])) {
                pivot_row = row;
            }
        }
        if (pivot_row != k) {
            const double side = vector[k];
            vector[k] = vector[pivot_row];
            vector[pivot_row] = side;
            for (int column = begin; column < end; column++) {
                const double entry = matrix[k][column];
                matrix[k][column] = matrix[pivot_row][column];
                matrix[pivot_row][column] = entry;
            }
            sign = -sign;
        }
        pivot = matrix[k][k];
        largest = (fabs(pivot) > largest) ? fabs(pivot) : largest;
        smallest = (fabs(pivot) < smallest) ? fabs(pivot) : smallest;
        if (!(fabs(pivot) > 0.0) || !isfinite(pivot)) {
            return 0.0;
        }
        sign = (pivot < 0.0) ? -sign : sign;
        for (int row = k + 1; row < end; row++) {
            const double factor = matrix[row][k] / pivot;
            for (int column = k; column < end; column++) {
                matrix[row][column] -= factor * matrix[k][column];
            }
            vector[row] -= factor * vector[k];
        }
    }
    for (int k = end - 1; k >= begin; k--) {
        for (int column = k + 1; column < end; column++) {
            vector[k] -= matrix[k][column] * vector[column];
        }
        vector[k] /= matrix[k][k];
    }
    *condition = largest / smallest;
    return sign;
}

/* Closure error and Jacobian of the legs. */
static rob_error rob_closure(
    const double *pose,
    const double *joints,
    double matrix[ROB_JOINTS][ROB_JOINTS],
    double vector[ROB_JOINTS])
{
    rob_error error = rob_closure_error_from_joints(pose, joints, vector);
    if (error == ROB_OK) {
        error = rob_legs_jacobian_from_joints(pose, joints, &matrix[0][0]);
    }
    return error;
}

/* Largest magnitude of a leg's part of a vector. */
static double rob_largest(const double *vector, int leg)
{
    double largest = 0.0;
    for (int i = rob_first_joints[leg]; i < rob_first_joints[leg + 1]; i++) {
        largest = (fabs(vector[i]) > largest) ? fabs(vector[i]) : largest;
    }
    return largest;
}

/* Newton's method from the joints in `joints`. */
static rob_error rob_newton(const double *pose, double *joints)
{
    double matrix[ROB_JOINTS][ROB_JOINTS];
    double vector[ROB_JOINTS];
    rob_error error = ROB_OK;
    double worst = 0.0;
    for (int count = 0; count < 30; count++) {
        double largest = 0.0;
        error = rob_closure(pose, joints, matrix, vector);
        if (error != ROB_OK) {
            return error;
        }
        for (int leg = 0; leg < ROB_LEGS; leg++) {
            double condition = 0.0;
            double step = 0.0;
            double scale = 1.0;
            (void)rob_eliminate(matrix, vector, leg, &condition);
            if (!((condition * 1e-9) <= 1.0)) {
                return rob_singular_legs[leg];
            }
            step = rob_largest(vector, leg);
            scale = (step > 0.5) ? (0.5 / step) : 1.0;
            for (int i = rob_first_joints[leg]; i < rob_first_joints[leg + 1]; i++) {
                joints[i] += scale * vector[i];
            }
            largest = (step > largest) ? step : largest;
        }
        if (largest < 1e-13) {
            return ROB_OK;
        }
    }
    error = rob_closure(pose, joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    /* The leg whose error is the largest is the one that cannot follow. */
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        const double size = rob_largest(vector, leg);
        if ((size >= 1e-10) && (size > worst)) {
            worst = size;
            error = rob_legs_out_of_reach[leg];
        }
    }
    return error;
}

/* Whether every leg's determinant has the sign that it has at home. */
static rob_error rob_same_mode(const double *pose, const double *joints)
{
    double matrix[ROB_JOINTS][ROB_JOINTS];
    double vector[ROB_JOINTS];
    double home[ROB_LEGS];
    double condition = 0.0;
    rob_error error = rob_closure(rob_home_pose, rob_home_joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        home[leg] = rob_eliminate(matrix, vector, leg, &condition);
    }
    error = rob_closure(pose, joints, matrix, vector);
    if (error != ROB_OK) {
        return error;
    }
    for (int leg = 0; leg < ROB_LEGS; leg++) {
        const double here = rob_eliminate(matrix, vector, leg, &condition);
        if ((home[leg] * here) <= 0.0) {
            return rob_singular_legs[leg];
        }
    }
    return ROB_OK;
}
";

/// What `ROB_WAY` stands for is the scaling of the quaternion on the way.
const JOINTS: &str = "\
    const double *const goal = ROB_GOAL;
    static const int parts[3] = { 1, 8, 64 };
    rob_error error = ROB_OK;
    for (int attempt = 0; attempt < 3; attempt++) {
        double joints[ROB_JOINTS];
        error = ROB_OK;
        for (int i = 0; i < ROB_JOINTS; i++) {
            joints[i] = rob_home_joints[i];
        }
        for (int part = 1; (part <= parts[attempt]) && (error == ROB_OK); part++) {
            /* The pose a part of the way from home. */
            const double share = (double)part / (double)parts[attempt];
            double way[ROB_POSE];
            for (int i = 0; i < ROB_POSE; i++) {
                const double home = rob_home_pose[i];
                way[i] = (part == parts[attempt]) ? goal[i] : (home + share * (goal[i] - home));
            }
ROB_WAY            error = rob_newton(way, joints);
        }
        if (error == ROB_OK) {
            error = rob_same_mode(goal, joints);
        }
        if (error == ROB_OK) {
            for (int i = 0; i < ROB_JOINTS; i++) {
                output[i] = joints[i];
            }
            return ROB_OK;
        }
    }
    return error;
}
";

/// The quaternion of a pose on the way, scaled to length 1.
const WAY_OF_A_QUATERNION: &str = "\
            {
                double *const q = &way[ROB_POSE - 4];
                const double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
                for (int i = 0; i < 4; i++) {
                    q[i] /= norm;
                }
            }
";

const JOINTS_CHECKS: &str = "
{
    if (!(rob_is_finite(pose, ROB_POSE))) {
        return ROB_NOT_FINITE_POSE;
    }
";

const JOINTS_CHECKS_QUATERNION: &str = "\
    double unit_pose[ROB_POSE];
    if (!(rob_unit_quaternion(pose, unit_pose))) {
        return ROB_ZERO_QUATERNION_POSE;
    }
";

const PARTITION_TYPE: &str = "\
/** Case 2 for any kept actuators, eq. (36): the factors of J_a transposed in one configuration. */
typedef struct rob_partition {
    double factors[ROB_DOF][ROB_DOF]; /**< L below the diagonal, U on and above it */
    int order[ROB_DOF];               /**< which row of J_a transposed stands in each row */
    double condition;                 /**< condition number of J_a, free of units */
} rob_partition;

/**
 * The partition that keeps some actuators.
 *
 * @param inverse_jacobian J_p^inv, as rob_inverse_jacobian writes it (ROB_ACTUATORS * ROB_DOF)
 * @param kept indices of the kept actuators, from 0 (ROB_DOF)
 * @param[out] partition is left as it was where there is an error
 * @return 0, or an error: a number that is not finite, an actuator that there is not, or actuators that do not
 * determine the platform's motion (a condition number above 1e9).
 */
rob_error rob_partition_of(
    const double *ROB_RESTRICT inverse_jacobian,
    const int *ROB_RESTRICT kept,
    rob_partition *ROB_RESTRICT partition);

/**
 * From what is projected on the platform to what is projected on the kept actuators, in place: a regressor of
 * case 1 becomes that of case 2, and so do torques.
 *
 * @param partition as rob_partition_of writes it
 * @param inputs ROB_DOF rows of `columns` numbers, row by row
 * @param columns how many columns there are
 */
void rob_partition_project(
    const rob_partition *ROB_RESTRICT partition,
    double *ROB_RESTRICT inputs,
    int columns);

";

const PARTITION: &str = "\
/* L U of a matrix, the largest pivot of each column first. */
static void rob_factorise(rob_partition *partition)
{
    double(*const m)[ROB_DOF] = partition->factors;
    for (int row = 0; row < ROB_DOF; row++) {
        partition->order[row] = row;
    }
    for (int k = 0; k < ROB_DOF; k++) {
        int pivot = k;
        for (int row = k + 1; row < ROB_DOF; row++) {
            pivot = (fabs(m[row][k]) > fabs(m[pivot][k])) ? row : pivot;
        }
        if (pivot != k) {
            const int place = partition->order[k];
            partition->order[k] = partition->order[pivot];
            partition->order[pivot] = place;
            for (int column = 0; column < ROB_DOF; column++) {
                const double entry = m[k][column];
                m[k][column] = m[pivot][column];
                m[pivot][column] = entry;
            }
        }
        for (int row = k + 1; row < ROB_DOF; row++) {
            m[row][k] /= m[k][k];
            for (int column = k + 1; column < ROB_DOF; column++) {
                m[row][column] -= m[row][k] * m[k][column];
            }
        }
    }
}

/* The inverse of J_a transposed times a vector. */
static void rob_partition_solve(
    const rob_partition *partition, const double vector[ROB_DOF], double solution[ROB_DOF])
{
    for (int row = 0; row < ROB_DOF; row++) {
        double known = 0.0;
        for (int column = 0; column < row; column++) {
            known += partition->factors[row][column] * solution[column];
        }
        solution[row] = vector[partition->order[row]] - known;
    }
    for (int row = ROB_DOF - 1; row >= 0; row--) {
        double known = 0.0;
        for (int column = row + 1; column < ROB_DOF; column++) {
            known += partition->factors[row][column] * solution[column];
        }
        solution[row] = (solution[row] - known) / partition->factors[row][row];
    }
}

/* The condition number after every coordinate is scaled by the length of its column in J_p^inv, a shorter one
 * than 1e-5 of the longest by that. */
static double rob_partition_condition(
    const rob_partition *partition, const double *inverse_jacobian, const int *kept)
{
    double scales[ROB_DOF];
    double sums[ROB_DOF];
    double longest = 0.0;
    double largest = 0.0;
    double worst = 0.0;
    int finite = 1;
    for (int i = 0; i < ROB_DOF; i++) {
        double squares = 0.0;
        for (int row = 0; row < ROB_ACTUATORS; row++) {
            const double entry = inverse_jacobian[row * ROB_DOF + i];
            squares += entry * entry;
        }
        scales[i] = sqrt(squares);
        sums[i] = 0.0;
        longest = (scales[i] > longest) ? scales[i] : longest;
    }
    for (int i = 0; i < ROB_DOF; i++) {
        double size = 0.0;
        scales[i] = (scales[i] > (1e-5 * longest)) ? scales[i] : (1e-5 * longest);
        for (int column = 0; column < ROB_DOF; column++) {
            size += fabs(inverse_jacobian[kept[column] * ROB_DOF + i]);
        }
        size /= scales[i];
        largest = (size > largest) ? size : largest;
    }
    for (int i = 0; i < ROB_DOF; i++) {
        double unit[ROB_DOF] = { 0.0 };
        double solution[ROB_DOF];
        unit[i] = scales[i];
        rob_partition_solve(partition, unit, solution);
        for (int row = 0; row < ROB_DOF; row++) {
            sums[row] += fabs(solution[row]);
        }
    }
    for (int row = 0; row < ROB_DOF; row++) {
        /* A maximum would pass over what is no number. */
        finite = (isfinite(sums[row]) && (finite != 0)) ? 1 : 0;
        worst = (sums[row] > worst) ? sums[row] : worst;
    }
    return ((finite != 0) && isfinite(largest)) ? (largest * worst) : HUGE_VAL;
}

rob_error rob_partition_of(
    const double *ROB_RESTRICT inverse_jacobian,
    const int *ROB_RESTRICT kept,
    rob_partition *ROB_RESTRICT partition)
{
    rob_partition found;
    for (int i = 0; i < ROB_DOF; i++) {
        if ((kept[i] < 0) || (kept[i] >= ROB_ACTUATORS)) {
            return ROB_NO_ACTUATOR;
        }
    }
    if (!(rob_is_finite(inverse_jacobian, ROB_ACTUATORS * ROB_DOF))) {
        return ROB_NOT_FINITE_INVERSE_JACOBIAN;
    }
    for (int column = 0; column < ROB_DOF; column++) {
        for (int row = 0; row < ROB_DOF; row++) {
            found.factors[row][column] = inverse_jacobian[kept[column] * ROB_DOF + row];
        }
    }
    rob_factorise(&found);
    found.condition = rob_partition_condition(&found, inverse_jacobian, kept);
    if (!(found.condition < 1e9)) {
        return ROB_SINGULAR_PARTITION;
    }
    *partition = found;
    return ROB_OK;
}

void rob_partition_project(
    const rob_partition *ROB_RESTRICT partition,
    double *ROB_RESTRICT inputs,
    int columns)
{
    for (int column = 0; column < columns; column++) {
        double vector[ROB_DOF];
        double solution[ROB_DOF];
        for (int row = 0; row < ROB_DOF; row++) {
            vector[row] = inputs[row * columns + column];
        }
        rob_partition_solve(partition, vector, solution);
        for (int row = 0; row < ROB_DOF; row++) {
            inputs[row * columns + column] = solution[row];
        }
    }
}
";

/// Whether partitions of case 2 are written: for redundant robots with all that they are made from.
fn has_partitions(model: &RobotModel) -> bool {
    let is_redundant = model.mechanism.actuated().len() > model.mechanism.dof();
    let jacobian = model.function(Function::InverseJacobian, MotionInput::Pose);
    let regressor = model.function(
        Function::IdmRedPlatform(overact_core::Columns::Standard),
        MotionInput::Pose,
    );
    is_redundant && jacobian.is_some() && regressor.is_some()
}

/// The arguments of `pose_from_actuators`.
fn forward_arguments(model: &RobotModel) -> [Array; 2] {
    let array = |name: &str, length: usize| Array {
        name: name.to_owned(),
        shape: vec![length],
    };
    let mechanism = &model.mechanism;
    [
        array("actuators", mechanism.actuated().len()),
        array("start", mechanism.pose_len()),
    ]
}

/// What is declared in the header.
#[must_use]
pub fn declarations(model: &RobotModel, naming: &Naming) -> String {
    let mut out = String::new();
    if model.forward_kinematics {
        let way = match closed_form(model) {
            ClosedForm::None => "",
            ClosedForm::Alone => " It is pose_in_closed_form where that has a value.",
            ClosedForm::Again => {
                " Where the iteration fails from there, it starts again from pose_in_closed_form."
            }
        };
        let lines = [
            format!("Forward kinematics: the pose that fits all actuators best in the sense of least squares, found from the pose `start`, whose assembly mode it keeps.{way}"),
            String::new(),
            "@param actuators q, positions of the actuated joints (m, rad) (ROB_ACTUATORS)".to_owned(),
            "@param start a pose near the wanted one, in its assembly mode (m, rad) (ROB_POSE)".to_owned(),
            "@param[out] output [ROB_POSE]".to_owned(),
            "@return 0, or an error: an input that is not finite, no convergence, or a singular or unreachable configuration on the way.".to_owned(),
        ];
        out += &naming.apply(&documentation(&lines));
        let signature = signature("pose_from_actuators", &forward_arguments(model), naming);
        out += &format!("{signature};\n\n");
    }
    if has_partitions(model) {
        out += &naming.apply(PARTITION_TYPE);
    }
    out
}

/// How forward kinematics uses a closed form.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ClosedForm {
    /// There is none.
    None,
    /// It is the pose, as there is no actuator too many.
    Alone,
    /// It is where the iteration starts again.
    Again,
}

fn closed_form(model: &RobotModel) -> ClosedForm {
    let is_redundant = model.mechanism.actuated().len() > model.mechanism.dof();
    match model.function(Function::PoseInClosedForm, MotionInput::Actuators) {
        Some(_) if is_redundant => ClosedForm::Again,
        Some(_) => ClosedForm::Alone,
        None => ClosedForm::None,
    }
}

/// What stands in the source file.
#[must_use]
pub fn definitions(model: &RobotModel, naming: &Naming) -> String {
    let mut parts = Vec::new();
    if model.selection.joints == JointsBy::Newton && has_joints(model) {
        parts.push(joints(model, naming));
    }
    if model.forward_kinematics {
        parts.push(forward(model, naming));
    }
    if has_partitions(model) {
        parts.push(naming.apply(PARTITION));
    }
    parts.join("\n")
}

fn has_joints(model: &RobotModel) -> bool {
    model
        .function(Function::Joints, MotionInput::Pose)
        .is_some()
}

fn forward(model: &RobotModel, naming: &Naming) -> String {
    let head = signature("pose_from_actuators", &forward_arguments(model), naming);
    let text = |parts: &[&str]| naming.apply(&parts.concat());
    if model.is_tree() {
        return format!("{head}{}", text(&[FORWARD_CHECKS, FORWARD_OF_A_TREE]));
    }
    let (displace, start) = match has_quaternion(model) {
        true => (DISPLACE_QUATERNION, FORWARD_START_QUATERNION),
        false => (DISPLACE, FORWARD_START),
    };
    let found = match closed_form(model) {
        ClosedForm::None => FORWARD,
        ClosedForm::Alone => FORWARD_BY_RULE,
        ClosedForm::Again => FORWARD_AGAIN_BY_RULE,
    };
    let helpers = text(&[displace, "\n", GAUSS_NEWTON, "\n"]);
    let body = text(&[FORWARD_CHECKS, start, found, FORWARD_END]);
    format!("{helpers}{head}{body}")
}

/// Inverse kinematics by Newton's method, with the tables that it needs of the legs.
fn joints(model: &RobotModel, naming: &Naming) -> String {
    let mechanism = &model.mechanism;
    let mut first = vec!["0".to_owned()];
    let starts = (0..mechanism.legs.len()).map(|leg| mechanism.leg_range(leg).end.to_string());
    first.extend(starts);
    let legs = errors::leg_constants(model);
    let of_legs = |kind: &str| {
        let names = legs
            .iter()
            .map(|leg| naming.constant(&format!("{kind}_{leg}")));
        names.collect::<Vec<_>>().join(", ")
    };
    let count = legs.len();
    let table = |kind: &str, name: &str, count: usize, elements: &str| {
        let head = naming.apply(&format!("static const {kind} rob_{name}[{count}]"));
        format!("{head} = {{ {elements} }};\n")
    };
    let mut out = table("int", "first_joints", count + 1, &first.join(", "));
    out += &table(
        "rob_error",
        "legs_out_of_reach",
        count,
        &of_legs("OUT_OF_REACH"),
    );
    out += &table(
        "rob_error",
        "singular_legs",
        count,
        &of_legs("SINGULAR_LEG"),
    );
    let pose = Array {
        name: "pose".to_owned(),
        shape: vec![mechanism.pose_len()],
    };
    let head = signature("joints", &[pose], naming);
    let (scaled, goal, way) = match has_quaternion(model) {
        true => (JOINTS_CHECKS_QUATERNION, "unit_pose", WAY_OF_A_QUATERNION),
        false => ("", "pose", ""),
    };
    let body = JOINTS.replace("ROB_GOAL", goal).replace("ROB_WAY", way);
    let text = |parts: &[&str]| naming.apply(&parts.concat());
    out += &text(&["\n", NEWTON, "\n"]);
    out + &head + &text(&[JOINTS_CHECKS, scaled, &body])
}
