//! Robots with every kind of friction, and the text of their descriptions.

robot!(friction_arm: FrictionArm);
robot!(friction_bar: FrictionBar);

/// The description of [`FrictionArm`].
pub const ARM: &str = include_str!("../friction/friction_arm.toml");
/// The description of [`FrictionBar`].
pub const BAR: &str = include_str!("../friction/friction_bar.toml");
