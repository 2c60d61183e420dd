//! Identification of dynamic parameters of robots from measured motion and torque.
//!
//! It implements sections 3.2, 4 and 5.3 of Briot, Krut, Gautier 2015 for parallel robots,
//! overactuated or not, and for serial robots. [`identify()`] is the complete procedure.
//! [`study()`] compares the actuator projection for all partitions. Robots are accessed through
//! [`overact::Model`] only, so compiled and interpreted models are equivalent. Runs are
//! [`Log`]s, read by [`overact_logs`].
//!
//! ```
//! use overact_identification::{Dataset, Error, Identification, Log, Settings, identify};
//!
//! /// Identifies a robot, and keeps the last of its logs for validation.
//! fn parameters(
//!     robot: &dyn overact::Model,
//!     logs: &[Log],
//!     settings: &Settings,
//! ) -> Result<Identification, Error> {
//!     let (validation, runs) = logs.split_last().map_or((logs, logs), |(last, rest)| {
//!         (std::slice::from_ref(last), rest)
//!     });
//!     let dataset = Dataset { runs, validation, true_values: None, variants: &[], scales: None };
//!     let result = identify(robot, &dataset, settings, &|_| {})?;
//!     for verdict in &result.verdicts {
//!         println!("{}: {:?} {:?}", verdict.subject, verdict.grade, verdict.reasons);
//!     }
//!     Ok(result)
//! }
//! ```
//!
//! The crate `overact-robot` makes model, logs and settings from a description; start there unless
//! you have a model of your own.
//!
//! Each folder imports only from those above it in this table, and a test checks the order:
//!
//! | folder | content |
//! |---|---|
//! | `with_avx`, `units`, `blocks` | vectorisation; plausible ranges of quantities; evaluation of a model in blocks |
//! | `thresholds`, `series` | thresholds of the elimination and the conditioning; series for plots |
//! | [`filters`] | zero-phase filtering, decimation, differences |
//! | `gear_friction` | friction of gears, removed from measured torques |
//! | `prior`, `online_settings`, `settings` | prior values of standard parameters; settings of an identification |
//! | `kinematics` | forward kinematics, platform motion, conditioning and distribution of actuators |
//! | `regression` | columns of the model; decimated systems (39)-(41) of all projections, as R factors |
//! | `estimation` | base parameters (42)-(43), least squares with standard deviations (44)-(48), elimination |
//! | `calibration` | encoder offsets and lengths from the closure of redundant loops |
//! | `gains` | gains of the drives, from known parameters |
//! | `gravity` | direction of gravity, together with the parameters |
//! | `validation` | prediction and measurement on any run |
//! | `result` | results on estimates and runs |
//! | `online` | replay of the runs through the online filter |
//! | `consistent` | physically consistent standard parameters |
//! | `assessment` | checks of data, model, fit and extrapolation, and the verdict |
//! | `identify` | the procedure and its result |
//! | [`factors`] | runs as factor files, merged and identified without their logs |

mod assessment;
mod blocks;
mod calibration;
mod consistent;
mod estimation;
pub mod factors;
pub mod filters;
mod gains;
mod gear_friction;
mod gravity;
mod identify;
mod kinematics;
mod online;
mod online_settings;
mod prior;
mod regression;
mod result;
mod series;
mod settings;
mod thresholds;
mod units;
mod validation;
mod with_avx;

pub use assessment::{
    check::{About, Check, CheckKind, Grade},
    detectable::{Detectable, DetectableShift, FaultKind},
    evidence::{Axis, Curve, Evidence},
    verdict::{FailedChecks, StageVerdict, Verdict, failed_checks},
};
pub use calibration::{
    CalibratedParameter, Calibration, CalibrationScope, ChangedGeometry, DescribedGeometry,
    Geometry, GeometryParameter, HeldParameter, ParameterKind, Reached, SensorNoise, calibrate,
};
pub use consistent::{Consistent, ConsistentBody, ConsistentParameter};
pub use estimation::{
    base::{BaseParameters, PayloadUse, base_parameters, names_of_loads},
    essential::{Drift, Essential, Removal, essential},
    estimate::{Estimation, LineError, LineNorms, estimate},
    instruments::regressor::{
        Agreement, ErrorsInRegressor, RegressorError, RepeatedRun, SimulatedRun,
    },
};
pub use gains::{DriveGain, Gains, JointParameter, drive_gains};
pub use gear_friction::GearFriction;
pub use gravity::{Fields, GravityDirection, gravity_direction};
pub use identify::{
    BaseParameter, DriveGearFriction, GearCoefficient, GearFrictionEstimate, Identification,
    PreparedSystem, PriorStage, Progress, ProjectionEstimates, RankedProjection,
    StribeckVelocities, StribeckVelocity, Study, VelocityEstimate, estimate_projection,
    figures::{ActuatorRange, CorrelationFigures, Figures, PredictionFigures, ResidualFigures},
    gear_friction, identify, identify_after, prepare, stribeck_velocities, study,
    tracking::TrackingError,
};
pub use kinematics::{Motion, Motions, motion};
pub use online::{OnlineChange, OnlineEstimate};
pub use online_settings::{ForgettingRule, OnlineSettings};
pub use overact_logs::{
    Dataset, Error, Gain, Load, Log, Mapping, Periods, Problem, Scales, Time, Variant, called,
    carried_payloads, significant, titled,
};
pub use prior::Prior;
pub use regression::{
    columns::{Column, ColumnSet, Direction, is_carried, load_of},
    factor::Factor,
    projection::{ModelKind, Projection},
    states::SampledStates,
    system::{PartitionCondition, RunPart, Stretch, System},
};
pub use result::{
    CrossValidation, Estimate, Estimator, FunctionParameter, MotorParameter, ParameterEstimate,
    Regrouping, RunSummary, Stage, StageTime,
};
pub use series::{
    ConditionSeries, LineResidual, ResidualSeries, RunFigures, Series, VelocitySeries,
};
pub use settings::{CheckScope, Instruments, Normalisation, Settings};
pub use thresholds::Thresholds;
pub use validation::{TorqueComparison, Validation};
