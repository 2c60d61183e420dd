//! Robots in single precision, compared with double precision: closed forms, forward kinematics,
//! Newton's method on the joints.
#![deny(warnings, missing_docs)]

use overact::redundant_robot;

/// Double precision.
pub mod double {
    #[overact::redundant_robot("descriptions/five_bar.toml")]
    pub struct FiveBar;
    #[overact::redundant_robot("descriptions/newton_point.toml", effort = "none", functions = ["joints", "bias"])]
    pub struct NewtonPoint;
}

#[redundant_robot("descriptions/five_bar.toml", float = "f32")]
pub struct FiveBar;

#[redundant_robot(
    "descriptions/newton_point.toml",
    float = "f32",
    effort = "none",
    functions = ["joints", "bias"],
)]
pub struct NewtonPoint;

/// Compares numbers in double and single precision, with the largest difference allowed.
fn same(double: &[f64], single: &[f32], allowed: f64) {
    assert_eq!(double.len(), single.len());
    for (a, b) in double.iter().zip(single) {
        assert!((a - f64::from(*b)).abs() < allowed, "{double:?} {single:?}");
    }
}

fn five_bar() -> Result<(), overact::Error> {
    let (pose, twist, acceleration) = ([0.02_f32, 0.31], [0.3, -0.2], [1.5, 0.5]);
    let (long, long_twist, long_acceleration) =
        (pose.map(f64::from), twist.map(f64::from), acceleration.map(f64::from));
    let actuators = FiveBar::actuator_positions(&pose)?;
    same(&double::FiveBar::actuator_positions(&long)?, &actuators, 1e-6);
    let single = FiveBar::idm_red_platform(&pose, &twist, &acceleration)?;
    let wanted = double::FiveBar::idm_red_platform(&long, &long_twist, &long_acceleration)?;
    same(wanted.as_flattened(), single.as_flattened(), 1e-4);
    let found = FiveBar::pose_from_actuators(&actuators, &FiveBar::HOME_POSE)?;
    same(&long, &found, 1e-6);
    let far = FiveBar::joints(&[9.0, 9.0]);
    assert!(matches!(far, Err(overact::Error::OutOfReach { .. })), "{far:?}");
    let none = FiveBar::joints(&[f32::NAN, 0.0]);
    assert_eq!(none, Err(overact::Error::NotFinite { input: "pose" }));
    Ok(())
}

fn newton() -> Result<(), overact::Error> {
    let mut pose = NewtonPoint::HOME_POSE;
    pose[0] += 0.02;
    let (joints, long) = (NewtonPoint::joints(&pose)?, pose.map(f64::from));
    same(&double::NewtonPoint::joints(&long)?, &joints, 1e-5);
    Ok(())
}

fn main() {
    five_bar().unwrap();
    newton().unwrap();
}
