//! Dimensions of the standard parameters of a body and its joint.

use super::dimension::Dimension;
use super::model::JointKind;

use overact_core::StandardParameter;

/// Dimension of a parameter of a joint of this kind.
pub(super) fn dimension(parameter: StandardParameter, kind: JointKind) -> Dimension {
    let slides = kind == JointKind::Prismatic;
    match parameter {
        StandardParameter::Mx | StandardParameter::My | StandardParameter::Mz => {
            Dimension::FIRST_MOMENT
        }
        StandardParameter::M => Dimension::MASS,
        StandardParameter::Ia if slides => Dimension::MASS,
        StandardParameter::K if slides => Dimension::LINEAR_STIFFNESS,
        StandardParameter::K => Dimension::ANGULAR_STIFFNESS,
        StandardParameter::Fv if slides => Dimension::LINEAR_VISCOSITY,
        StandardParameter::Fv => Dimension::ANGULAR_VISCOSITY,
        StandardParameter::Fs | StandardParameter::Off if slides => Dimension::FORCE,
        StandardParameter::Fs | StandardParameter::Off => Dimension::TORQUE,
        _ => Dimension::INERTIA,
    }
}
