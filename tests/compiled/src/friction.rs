//! Robots with all kinds of friction, with springs, screws and coupled motors, and the text of their
//! descriptions.

robot!(friction_arm: FrictionArm);
robot!(friction_bar: FrictionBar);
robot!(motor_bar: MotorBar);
robot!(screw_arm: ScrewArm);
robot!(spring_bar: SpringBar);

/// The description of [`FrictionArm`].
pub const ARM: &str = include_str!("../friction/friction_arm.toml");
/// The description of [`FrictionBar`].
pub const BAR: &str = include_str!("../friction/friction_bar.toml");
/// The description of [`MotorBar`].
pub const MOTOR: &str = include_str!("../friction/motor_bar.toml");
/// The description of [`ScrewArm`].
pub const SCREW: &str = include_str!("../friction/screw_arm.toml");
/// The description of [`SpringBar`].
pub const SPRING: &str = include_str!("../friction/spring_bar.toml");
