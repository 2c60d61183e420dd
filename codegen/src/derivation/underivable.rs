//! Why a function of a robot cannot be derived.

use crate::description::Description;
use crate::diagnostic::{Diagnostic, Diagnostics};

/// Why a model cannot be derived in the wanted form.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Underivable {
    /// No rule gives this leg's joints from the pose in closed form.
    InverseKinematics {
        /// Name of the leg.
        leg: String,
    },
    /// No rule gives the pose from the actuators in closed form.
    ForwardKinematics,
    /// The leg's Jacobian has no structural inverse.
    SingularLeg {
        /// Name of the leg.
        leg: String,
    },
    /// The Jacobian of the kept actuators has no structural inverse.
    SingularPartition,
}

impl Underivable {
    /// The error at its place in the description.
    #[must_use]
    pub fn locate(&self, description: &Description) -> Diagnostics {
        let place = |leg: &str| description.legs.iter().find(|l| l.name.value == leg);
        let diagnostic = match self {
            Self::InverseKinematics { leg } => {
                let span = place(leg).map_or(description.name.span.clone(), |l| l.span.clone());
                Diagnostic::new(
                    format!("no rule solves the inverse kinematics of leg `{leg}`"),
                    span,
                )
                .help("the robot's functions then start from Newton's method")
            }
            Self::ForwardKinematics => Diagnostic::new(
                "no rule gives the robot's pose from its actuators",
                description.name.span.clone(),
            ),
            Self::SingularLeg { leg } => {
                let span = place(leg).map_or(description.name.span.clone(), |l| l.span.clone());
                Diagnostic::new(format!("leg `{leg}` is singular in every configuration"), span)
                .help("its joint rates are never determined by the platform's motion: check attachment and axes")
            }
            Self::SingularPartition => Diagnostic::new(
                "the kept actuators of case 2 never determine the platform's motion",
                description.name.span.clone(),
            )
            .help("choose other `kept_actuators`"),
        };
        Diagnostics::from(diagnostic)
    }
}
