//! Identification of the dynamic parameters of a parallel robot, overactuated or not, from measured
//! motion and torque: sections 3.2, 4 and 5.3 of Briot, Krut, Gautier 2015.
//!
//! [`identify()`] is all of it; [`study()`] compares case 2 for every choice of kept actuators. Robots are
//! seen through [`overact::Model`] only, so compiled and interpreted ones are served alike.
//!
//! Folders, from the bottom up; each imports from those above it in this table only, and a test holds
//! the order:
//!
//! | folder | what |
//! |---|---|
//! | `error`, `significant`, `blocks` | problems with a place and a way out; numbers in sentences; a model evaluated in blocks |
//! | `finding`, `series` | what is suspicious, with its thresholds; series that are plotted |
//! | [`data`] | a run is read from CSV or MATLAB and checked; a mapping names its columns and units |
//! | [`filters`] | zero-phase filtering, decimation, differences |
//! | `settings` | what an identification is told beside the data |
//! | `monitor` | what raw numbers tell by themselves while they are gone through |
//! | `kinematics` | forward kinematics, platform motion, conditioning and distribution of actuators |
//! | `regression` | columns of the model, and the decimated system (39)-(41) of case 1, case 2 or all joints, as R factors |
//! | `estimation` | base parameters (42)-(43), least squares with standard deviations (44)-(48), elimination |
//! | `validation` | prediction against measurement, on any run |
//! | `assessment` | data that contradict the loops or the model, and the fault that would explain them |
//! | `identify` | the procedure, its result and the verdicts on it |

mod assessment;
mod blocks;
pub mod data;
mod error;
mod estimation;
pub mod filters;
mod finding;
mod identify;
mod kinematics;
mod monitor;
mod regression;
mod series;
mod settings;
mod significant;
mod validation;

pub use data::{Gain, Log, Mapping};
pub use error::{Error, Problem};
pub use estimation::{
    base::{BaseParameters, PayloadUse, base_parameters},
    essential::{Drift, Essential, Removal, essential},
    estimate::{Estimation, LineError, estimate},
};
pub use finding::{Finding, FindingKind, Thresholds};
pub use identify::{
    BaseParameter, CrossValidation, Dataset, Estimate, Identification, Outcome, ParameterEstimate,
    Prepared, Progress, RankedProjection, Regrouping, RunSummary, Stage, Study,
    estimate_projection,
    figures::{Figures, PredictionFigures, ResidualFigures},
    identify, prepare, study,
    verdict::{TrackingError, Verdict},
};
pub use kinematics::{Motion, Motions, motion};
pub use regression::{
    columns::{Column, ColumnSet, Direction},
    factor::Factor,
    projection::{ModelKind, Projection},
    system::{Part, PartitionCondition, Stretch, System},
};
pub use series::{ConditionSeries, LineResidual, ResidualSeries, RunFigures, Series};
pub use settings::{Normalisation, Settings};
pub use significant::significant;
pub use validation::{TorqueComparison, Validation};
