//! Results on estimates and runs, for printing and serialisation.
//!
//! The field names are keys of the document.

mod cross_validation;
mod estimate;
mod function_parameter;
mod motor;
mod regrouping;
mod run;
mod stage;
mod stage_time;

pub use cross_validation::CrossValidation;
pub use estimate::{Estimate, Estimator, ParameterEstimate};
pub use function_parameter::FunctionParameter;
pub use motor::MotorParameter;
pub use regrouping::Regrouping;
pub use run::RunSummary;
pub use stage::Stage;
pub use stage_time::StageTime;
