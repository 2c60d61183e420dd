//! Dimensions of the standard parameters of a body and its joint.

use crate::expressions::dimension::Dimension;
use crate::robot::model::JointKind;

use overact_core::StandardParameter;

/// Dimension of a parameter for a joint of this kind.
pub(crate) fn dimension(parameter: StandardParameter, kind: JointKind) -> Dimension {
    let slides = kind == JointKind::Prismatic;
    match parameter {
        StandardParameter::Mx | StandardParameter::My | StandardParameter::Mz => {
            Dimension::FIRST_MOMENT
        }
        StandardParameter::M => Dimension::MASS,
        StandardParameter::Ia if slides => Dimension::MASS,
        StandardParameter::K if slides => Dimension::LINEAR_STIFFNESS,
        StandardParameter::K => Dimension::ANGULAR_STIFFNESS,
        viscous if viscous.is_viscous() && slides => Dimension::LINEAR_VISCOSITY,
        viscous if viscous.is_viscous() => Dimension::ANGULAR_VISCOSITY,
        dry if dry.has_sign() || dry == StandardParameter::Off => {
            if slides {
                Dimension::FORCE
            } else {
                Dimension::TORQUE
            }
        }
        _ => Dimension::INERTIA,
    }
}
