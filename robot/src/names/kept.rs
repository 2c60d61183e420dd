//! Kept actuators of the actuator projection by name.

use crate::error::{Error, Problem};
use overact_codegen::RobotModel;
use overact_codegen::diagnostic::Code;

/// Indices of kept actuators given by name; as many as degrees of freedom, all different.
///
/// # Errors
/// All unknown and repeated names, or a wrong number of names.
pub fn kept_actuators(model: &RobotModel, names: &[String]) -> Result<Vec<usize>, Error> {
    let known = model.mechanism.named_actuators();
    let mut kept = Vec::new();
    let mut problems = Vec::new();
    for name in names {
        match known.find(name) {
            Some(index) if kept.contains(&index) => {
                problems.push(Problem::new(
                    Code::KEPT_ACTUATORS,
                    format!("the actuator `{name}` is listed twice"),
                ));
            }
            Some(index) => kept.push(index),
            None => {
                let message = format!("there is no actuator `{name}`");
                problems.push(Problem::new(Code::KEPT_ACTUATORS, message).help(known.help(name)));
            }
        }
    }
    let dof = model.mechanism.dof();
    if problems.is_empty() && kept.len() != dof {
        let message = format!(
            "the actuator projection keeps {dof} actuators, one for each degree of freedom, not {}",
            kept.len()
        );
        problems.push(Problem::new(Code::KEPT_ACTUATORS, message));
    }
    if problems.is_empty() {
        Ok(kept)
    } else {
        Err(Error::Problems(problems))
    }
}
