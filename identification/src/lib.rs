//! Identification of the dynamic parameters of a parallel robot, overactuated or not, from measured
//! motion and torque: sections 3.2, 4 and 5.3 of Briot, Krut, Gautier 2015.
//!
//! The stages, in the order in which data pass them:
//!
//! 1. [`data`]: a run is read from CSV or MATLAB and checked; a mapping names its columns and units.
//! 2. [`kinematics`]: zero-phase filtering and differentiation ([`filters`]), forward kinematics,
//!    platform motion.
//! 3. [`columns`]: the columns of the model: standard parameters, payload, split friction.
//! 4. [`base`]: base parameters in the symmetric order (42)-(43).
//! 5. [`regression`]: the decimated system (39)-(41) of case 1, case 2 or all joints, kept as one R
//!    [`factor`] per line of Γ.
//! 6. [`mod@estimate`]: ordinary or weighted least squares with standard deviations (44)-(48).
//! 7. [`mod@essential`]: backward elimination of parameters that the data do not determine.
//! 8. [`validation`]: prediction against measurement, on any run.
//! 9. [`mod@identify`]: all of it.
//!
//! Robots are seen through [`overact::Model`] only, so compiled and interpreted ones are served
//! alike.

pub mod base;
mod blocks;
mod checks;
pub mod columns;
mod conditioning;
mod correlation;
pub mod data;
mod elimination;
mod error;
pub mod essential;
pub mod estimate;
pub mod factor;
pub mod filters;
mod fourier;
pub mod identify;
pub mod kinematics;
mod observation;
pub mod regression;
pub mod settings;
mod significant;
mod sink;
pub mod states;
pub mod validation;

pub use base::{BaseParameters, PayloadUse, base_parameters};
pub use columns::{Column, ColumnSet};
pub use data::{Gain, Log, Mapping};
pub use error::{Error, Problem};
pub use essential::{Drift, Essential, Removal, essential};
pub use estimate::{Estimation, LineError, estimate};
pub use identify::{
    BaseParameter, CrossValidation, Estimate, Experiment, Identification, ParameterEstimate,
    Progress, Run, Stage,
    figures::{
        ConditionSeries, Figures, LineResidual, PredictionFigures, ResidualFigures, ResidualSeries,
        RunFigures,
    },
    identify,
    verdict::{Finding, FindingKind, Thresholds, TrackingError, Verdict},
};
pub use kinematics::{Motion, Motions, motion};
pub use regression::{Part, PartitionCondition, Projection, Stretch, System};
pub use settings::{Normalisation, Settings};
pub use significant::significant;
pub use validation::{Series, TorqueComparison, Validation};
