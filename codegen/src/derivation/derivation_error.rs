//! Error type of the derivation, with its message in the description.

use overact_description::Description;
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics, InternalError};

/// The reason why a model cannot be derived in the requested form.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum DerivationError {
    /// No rule solves this leg's joints from the pose in closed form.
    InverseKinematics {
        /// Name of the leg.
        leg: String,
    },
    /// No rule solves the pose from the actuators in closed form.
    ForwardKinematics,
    /// The leg's Jacobian has no structural inverse.
    SingularLeg {
        /// Name of the leg.
        leg: String,
    },
    /// A divisor in the equations of a leg has no value at home.
    SingularHome {
        /// Name of the leg; empty for the platform.
        leg: String,
    },
    /// The position of a joint that a motor turns does not follow from the pose.
    UndeterminedMotor {
        /// Name of the motor.
        motor: String,
        /// Name of the joint.
        joint: String,
    },
    /// The force of a spring between two points does not follow from the configuration.
    UndeterminedSpring {
        /// Name of the spring.
        spring: String,
    },
    /// The Jacobian of the kept actuators has no structural inverse.
    SingularPartition,
    /// Requested functions that the robot does not have.
    ///
    /// Each has the end of a sentence, such as `has no function …`, and a remedy.
    NotOffered(Vec<(String, String)>),
    /// A function contains a number that its floating-point type cannot represent.
    Unrepresentable {
        /// Name of the function.
        function: String,
        /// The number.
        value: String,
        /// Name of the floating-point type.
        float: &'static str,
    },
    /// A bug of the generator.
    Internal(InternalError),
}

impl From<InternalError> for DerivationError {
    fn from(error: InternalError) -> Self {
        Self::Internal(error)
    }
}

impl DerivationError {
    /// Diagnostics of the error, with the lines of the description that cause it.
    #[must_use]
    pub(crate) fn locate(&self, description: &Description) -> Diagnostics {
        let place = |leg: &str| description.legs.iter().find(|l| l.name.value == leg);
        let motion = match description.platform {
            Some(_) => "the platform's motion",
            None => "the robot's motion",
        };
        let diagnostic = match self {
            Self::InverseKinematics { leg } => {
                let span = place(leg).map_or(description.name.span.clone(), |l| l.span.clone());
                Diagnostic::new(
                    Code::NO_CLOSED_SOLUTION,
                    format!("the inverse kinematics of leg `{leg}` has no closed form"),
                    span,
                )
                .help("the robot's functions then start from Newton's method")
            }
            Self::ForwardKinematics => Diagnostic::new(
                Code::NO_CLOSED_SOLUTION,
                "the robot's pose has no closed form in its actuators",
                description.name.span.clone(),
            ),
            Self::SingularLeg { leg } => {
                let span = place(leg).map_or(description.name.span.clone(), |l| l.span.clone());
                Diagnostic::new(
                    Code::ALWAYS_SINGULAR,
                    format!("leg `{leg}` is singular in every configuration"),
                    span,
                )
                .help(format!(
                    "its joint rates are never determined by {motion}: check attachment and axes"
                ))
            }
            Self::SingularHome { leg } => {
                let platform = || description.platform.as_ref().map(|p| p.motion.span.clone());
                let (what, span) = match place(leg) {
                    Some(place) => (format!("leg `{leg}`"), Some(place.span.clone())),
                    None => ("the robot".to_owned(), platform()),
                };
                let span = span.unwrap_or_else(|| description.name.span.clone());
                Diagnostic::new(Code::SINGULAR_HOME, format!("{what} is singular at the home configuration"), span)
                    .help("choose a home pose where no leg is stretched or folded and the actuators determine its motion")
            }
            Self::UndeterminedMotor { motor, joint } => {
                let mut motors = description.motors.iter();
                let own = motors.find(|own| own.name.value == *motor);
                let span = own.map_or(&description.name.span, |own| &own.span);
                let message = format!(
                    "the motor `{motor}` turns the joint `{joint}`, whose position does not follow from the pose"
                );
                Diagnostic::new(Code::NO_CLOSED_SOLUTION, message, span.clone())
                    .help("let the motor turn joints that the closures determine")
            }
            Self::UndeterminedSpring { spring } => {
                let mut springs = description.springs.iter();
                let own = springs.find(|own| own.name.value == *spring);
                let span = own.map_or(&description.name.span, |own| &own.span);
                let message = format!(
                    "the length and force of the spring `{spring}` do not follow from the robot's configuration"
                );
                Diagnostic::new(Code::NO_CLOSED_SOLUTION, message, span.clone())
                    .help("connect it to other bodies, or write its force with smaller numbers")
            }
            Self::SingularPartition => Diagnostic::new(
                Code::ALWAYS_SINGULAR,
                format!("the kept actuators never determine {motion}"),
                description.name.span.clone(),
            )
            .help("choose other `kept_actuators`"),
            Self::Unrepresentable {
                function,
                value,
                float,
            } => Diagnostic::new(
                Code::OUT_OF_RANGE,
                format!("`{function}` contains the number {value}, which is not a valid `{float}`"),
                description.name.span.clone(),
            )
            .help(
                "leave out `float`, or describe lengths, masses and inertias that are no smaller",
            ),
            Self::NotOffered(sentences) => {
                let name = &description.name;
                let mut all = Diagnostics::default();
                for (sentence, help) in sentences {
                    let message = format!("the robot `{}` {sentence}", name.value);
                    let diagnostic =
                        Diagnostic::new(Code::NO_SUCH_FUNCTION, message, name.span.clone());
                    all.push(diagnostic.help(help.as_str()));
                }
                return all;
            }
            Self::Internal(error) => {
                return error.clone().of_robot(&description.name.value).into();
            }
        };
        Diagnostics::from(diagnostic)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use overact_description::diagnostic::Source;

    #[test]
    fn internal_errors_state_robot_version_and_pass() {
        let toml = include_str!("../../../robots/emps.toml");
        let source = Source::new("emps.toml", toml);
        let description = overact_description::parse(&source).expect("a robot");
        let broken = "node 3 has lost its value".to_owned();
        let errors = DerivationError::from(InternalError::new("walk", broken)).locate(&description);
        assert!(errors.internal().is_some());
        let text = errors.render_plain(&source);
        for part in [
            &format!("internal error of overact {}", env!("CARGO_PKG_VERSION")),
            &description.name.value,
            "`walk`",
            "node 3 has lost its value",
            "please report it",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        let other = DerivationError::ForwardKinematics.locate(&description);
        assert!(other.internal().is_none());
        let spring = String::from("gas");
        let spring = DerivationError::UndeterminedSpring { spring }.locate(&description);
        assert!(spring.render_plain(&source).contains("the spring `gas`"));
        let leg = String::new();
        let home = DerivationError::SingularHome { leg }.locate(&description);
        assert!(home.internal().is_none());
        assert!(
            home.render_plain(&source)
                .contains("is singular at the home configuration")
        );
    }
}
