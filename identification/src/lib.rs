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
//! | `error`, `significant`, `widest`, `blocks` | problems with a place and a way out; numbers in sentences; work with wide vectors; a model evaluated in blocks |
//! | `thresholds`, `series` | thresholds of the elimination and the conditioning; series that are plotted |
//! | [`data`] | a run is read from text or MATLAB and checked; a mapping names its columns and units |
//! | [`filters`] | zero-phase filtering, decimation, differences |
//! | `prior`, `settings` | what is believed of the standard parameters, and what else an identification is told beside the data |
//! | `monitor` | what raw numbers tell by themselves while they are gone through |
//! | `kinematics` | forward kinematics, platform motion, conditioning and distribution of actuators |
//! | `regression` | columns of the model, and the decimated system (39)-(41) of case 1, case 2 or all joints, as R factors |
//! | `estimation` | base parameters (42)-(43), least squares with standard deviations (44)-(48), elimination |
//! | `calibration` | encoder offsets and lengths from the closure of redundant loops |
//! | `gains` | gains of the drives, from parameters whose values are known |
//! | `gravity` | the direction of gravity, together with the parameters |
//! | `validation` | prediction against measurement, on any run |
//! | `result` | what is told of estimates and runs |
//! | `consistent` | standard parameters that a robot can have, the nearest to a prior that the data allow |
//! | `assessment` | checks of data, model, fit and extrapolation, and the verdict that follows from them alone |
//! | `identify` | the procedure and its result |
//! | [`factors`] | runs as factor files, merged and identified without their logs |

mod assessment;
mod blocks;
mod calibration;
mod called;
mod consistent;
pub mod data;
mod error;
mod estimation;
pub mod factors;
pub mod filters;
mod gains;
mod gravity;
mod identify;
mod kinematics;
mod monitor;
mod prior;
mod regression;
mod result;
mod series;
mod settings;
mod significant;
mod thresholds;
mod units;
mod validation;
mod widest;

pub use assessment::{
    check::{About, Check, CheckKind, Detectable, Grade},
    evidence::{Axis, Curve, Evidence},
    verdict::{Objections, StageVerdict, Verdict, objections},
};
pub use calibration::{
    CalibratedParameter, Calibration, CalibrationScope, ChangedGeometry, DescribedGeometry,
    Geometry, GeometryParameter, HeldParameter, ParameterKind, Reached, SensorNoise, calibrate,
};
pub use called::{called, titled};
pub use consistent::{Consistent, ConsistentBody, ConsistentParameter};
pub use data::{Dataset, Gain, Load, Log, Mapping, Periods, Scales, Time, Variant};
pub use error::{Error, Problem};
pub use estimation::{
    base::{BaseParameters, PayloadUse, base_parameters},
    essential::{Drift, Essential, Removal, essential},
    estimate::{Estimation, LineError, estimate},
    instruments::regressor::{
        Agreement, ErrorsInRegressor, RegressorError, RepeatedRun, SimulatedRun,
    },
};
pub use gains::{DriveGain, Gains, JointParameter, drive_gains};
pub use gravity::{Fields, GravityDirection, gravity_direction};
pub use identify::{
    BaseParameter, Before, Identification, Outcome, Prepared, Progress, RankedProjection, Study,
    estimate_projection,
    figures::{Figures, PredictionFigures, ResidualFigures},
    identify, identify_after, prepare, study,
    tracking::TrackingError,
};
pub use kinematics::{Motion, Motions, motion};
pub use prior::Prior;
pub use regression::{
    columns::{Column, ColumnSet, Direction, is_carried},
    factor::Factor,
    projection::{ModelKind, Projection},
    system::{Part, PartitionCondition, Stretch, System},
};
pub use result::{
    CrossValidation, Estimate, Estimator, FunctionParameter, MotorParameter, ParameterEstimate,
    Regrouping, RunSummary, Stage,
};
pub use series::{ConditionSeries, LineResidual, ResidualSeries, RunFigures, Series};
pub use settings::{Instruments, Normalisation, Settings};
pub use significant::significant;
pub use thresholds::Thresholds;
pub use validation::{TorqueComparison, Validation};
