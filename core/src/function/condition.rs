//! Conditions for a robot to have a function.

/// Condition for a robot to have a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Condition {
    /// None: every robot has the function.
    Any,
    /// A platform; without one there is no closure.
    Platform,
    /// More actuators than degrees of freedom.
    Redundancy,
    /// A payload on the platform.
    Payload,
    /// Forward kinematics in closed form.
    ClosedForm,
    /// Joints by Newton's method, without closed form.
    NumericJoints,
    /// A platform with parasitic motion.
    Parasitic,
    /// A skeleton with dependent joints.
    DependentJoints,
    /// Loops, with joints in closed form.
    JointsByRule,
    /// A mass among the parameters.
    Masses,
}
