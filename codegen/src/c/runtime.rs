//! What functions call that is no function of the robot: checks at their boundary and signs. The Rust functions
//! have them from the runtime crate (`overact::guard`, `overact::math`), of which these are the counterparts,
//! operation by operation.
//!
//! In the texts `rob_` and `ROB_` stand for the robot's prefix. Each is written where it is called.

const IS_FINITE: &str = "\
/* Whether all numbers are finite. */
static int rob_is_finite(const double *values, int count)
{
    int finite = 1;
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            finite = 0;
        }
    }
    return finite;
}
";

const UNIT_QUATERNION: &str = "\
/* Copies a pose with its quaternion scaled to length 1; 0 if the quaternion is zero. */
static int rob_unit_quaternion(const double *pose, double *unit)
{
    double *const q = &unit[ROB_POSE - 4];
    double square = 0.0;
    int is_rotation = 1;
    for (int i = 0; i < ROB_POSE; i++) {
        unit[i] = pose[i];
    }
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (fabs(square - 1.0) > 1e-8) {
        /* The largest number is scaled to 1 first, so that squares are neither too small nor too large. */
        double largest = 0.0;
        for (int i = 0; i < 4; i++) {
            largest = (fabs(q[i]) > largest) ? fabs(q[i]) : largest;
        }
        if (largest > 0.0) {
            double sum = 0.0;
            for (int i = 0; i < 4; i++) {
                q[i] /= largest;
                sum += q[i] * q[i];
            }
            sum = sqrt(sum);
            for (int i = 0; i < 4; i++) {
                q[i] /= sum;
            }
        } else {
            is_rotation = 0;
        }
    } else {
        /* Mostly the length is 1 but for rounding; one over its root is (3 - square)/2 then. */
        const double scale = 1.5 - 0.5 * square;
        for (int i = 0; i < 4; i++) {
            q[i] *= scale;
        }
    }
    return is_rotation;
}
";

const SIGN: &str = "\
/* Sign of a velocity as Coulomb friction wants it: -1, 0 or 1. */
static double rob_sign(double velocity)
{
    return (double)((velocity > 0.0) - (velocity < 0.0));
}
";

const SIGNED: &str = "\
/* A value with the sign of a velocity: a product, as a selection would be a branch that is often guessed wrong. */
static double rob_signed(double value, double velocity)
{
    return value * rob_sign(velocity);
}
";

const WRAP_ANGLE: &str = "\
/* The angle nearest to zero that differs from another one by whole turns. */
static double rob_wrap_angle(double angle)
{
    return (fabs(angle) <= 3.141592653589793) ? angle : atan2(sin(angle), cos(angle));
}
";

/// All, each behind those that it calls, with the name that it is called by.
const ALL: [(&str, &str); 5] = [
    ("is_finite(", IS_FINITE),
    ("unit_quaternion(", UNIT_QUATERNION),
    ("sign(", SIGN),
    ("signed(", SIGNED),
    ("wrap_angle(", WRAP_ANGLE),
];

/// Those that a code calls, whose names begin with a prefix.
#[must_use]
pub fn needed(prefix: &str, code: &str) -> Vec<&'static str> {
    let is_called = |name: &str| code.contains(&format!("{prefix}_{name}"));
    let is_needed = |name: &str| {
        let by_another = name == "sign(" && is_called("signed(");
        is_called(name) || by_another
    };
    let needed = ALL.iter().filter(|(name, _)| is_needed(name));
    needed.map(|(_, text)| *text).collect()
}
