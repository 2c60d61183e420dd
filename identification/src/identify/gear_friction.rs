//! Identification of the friction of gears, together with the parameters.
//!
//! With the coefficients μ of an iteration, the torques x of the gears have the model x = W χ. An
//! error δ of μ_j adds to x_j the column |x_j| sign(q̇_j), in which x_j is the torque that the
//! estimate predicts. The predicted torque has none of the noise of the measured one, so it is its
//! own instrument. The score test of all these columns together gives δ with its covariance, for
//! correlated residuals as well. Corrected coefficients give other torques, and the steps are
//! repeated until δ is small against its standard deviation.
//!
//! A coefficient stays zero if the data do not separate it from Coulomb friction, as with a load
//! of constant size.

use nalgebra::DMatrix;
use overact::{Code, Model};
use overact_logs::{Dataset, Error, Log, Problem, significant};
use serde::Serialize;

use super::{
    estimates::estimate_projection,
    position_ranges,
    prepare::{PreparedSystem, prepare},
    progress::Progress,
};
use crate::{
    assessment::{
        RunMonitor,
        hypotheses::{Group, ScoreTest, WaldTest, gear_hypotheses},
    },
    gear_friction::GearFriction,
    regression::{projection::Projection, torque_uncertainty::TorqueCorrection},
    settings::{Instruments, Settings},
};

/// Largest number of corrections.
const MOST_STEPS: usize = 12;

/// Correction, in standard deviations, at which the iteration ends.
const SMALL_STEP: f64 = 0.02;

/// Standard deviation above which a coefficient counts as not determined.
const UNDETERMINED: f64 = 0.05;

/// Probability that an interval misses the true value.
const MISSES: f64 = 0.05;

/// Largest magnitude of a coefficient during the iteration.
const LARGEST: f64 = 0.9;

/// A coefficient of gear friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GearCoefficient {
    /// Estimate, without unit.
    pub value: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// 95 % confidence interval.
    pub interval_95: [f64; 2],
}

/// Friction of the gear of one drive.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveGearFriction {
    /// Name of the actuator.
    pub actuator: String,
    /// Coefficient μ; `None` if the data do not determine it.
    pub coefficient: Option<GearCoefficient>,
}

/// Estimated friction of all gears.
#[derive(Debug, Clone, PartialEq)]
pub struct GearFrictionEstimate {
    /// Each drive.
    pub drives: Vec<DriveGearFriction>,
    /// Actuators with a determined coefficient.
    determined: Vec<usize>,
    /// Covariance of these coefficients.
    covariance: DMatrix<f64>,
}

impl GearFrictionEstimate {
    /// Friction of each gear, for [`Settings::gear_friction`]; undetermined coefficients are zero.
    #[must_use]
    pub fn gears(&self) -> Vec<GearFriction> {
        let gear = |drive: &DriveGearFriction| GearFriction {
            coefficient: drive.coefficient.map_or(0.0, |one| one.value),
        };
        self.drives.iter().map(gear).collect()
    }

    /// Warnings about coefficients that the data do not determine, or that are negative.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let warning = |drive: &DriveGearFriction| {
            let actuator = &drive.actuator;
            match drive.coefficient {
                None => Some(format!(
                    "the friction coefficient of the gear of `{actuator}` is not determined and counts as zero: the data do not separate it from Coulomb friction; record runs in which the torque changes at equal speeds"
                )),
                Some(own) if own.interval_95[1] < 0.0 => Some(format!(
                    "the friction coefficient of the gear of `{actuator}` is {}, with the 95 % interval {} to {}: it cannot be negative, so another effect of the torque is missing in the model",
                    significant(own.value, 2),
                    significant(own.interval_95[0], 2),
                    significant(own.interval_95[1], 2)
                )),
                Some(_) => None,
            }
        };
        self.drives.iter().filter_map(warning).collect()
    }

    /// The system with the uncertainty of the coefficients, by which the torques were corrected.
    pub(super) fn propagated(
        &self,
        prepared: PreparedSystem,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<PreparedSystem, Error> {
        if self.determined.is_empty() {
            return Ok(prepared);
        }
        let gears = self.gears();
        let derivative = |number: usize, torque: f64, velocity: f64| {
            let is_moving = velocity != 0.0;
            let sign = if is_moving { velocity.signum() } else { 0.0 };
            gears[self.determined[number]].derivative(torque, sign)
        };
        let correction = TorqueCorrection {
            actuators: self.determined.clone(),
            covariance: self.covariance.clone(),
            derivative: &derivative,
        };
        prepared.with_correction(model, runs, &correction, settings)
    }
}

/// Identifies the friction of all gears from the training runs of a data set.
///
/// # Errors
/// As [`prepare`](super::prepare()), or an iteration that does not converge.
pub fn gear_friction(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<GearFrictionEstimate, Error> {
    let names = model.info().actuators;
    let mut search = Search {
        model,
        dataset,
        settings,
        gears: vec![GearFriction::default(); names.len()],
        sought: (0..names.len()).collect(),
    };
    for _ in 0..MOST_STEPS {
        let Some(step) = search.step(progress)? else {
            search.sought.clear();
            return Ok(search.estimate(names, None));
        };
        if search.without_undetermined(&step) {
            continue;
        }
        if search.correct(&step) {
            return Ok(search.estimate(names, Some(&step)));
        }
    }
    let message = "the friction of the gears is not determined: the iteration does not converge";
    let help = "identify without `gear_friction`; record longer runs with varying loads";
    Err(Problem::new(Code::NOTHING_DETERMINED, message)
        .help(help)
        .into())
}

/// Corrections δ of the coefficients.
struct Step {
    sizes: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Ratio of the half width of an interval to the standard deviation.
    quantile: f64,
    /// Whether the data separate each coefficient from the model.
    separable: Vec<bool>,
}

impl Step {
    /// Standard deviation of a coefficient.
    fn deviation(&self, number: usize) -> f64 {
        self.covariance[(number, number)].sqrt()
    }
}

/// State of the iteration.
struct Search<'a> {
    model: &'a dyn Model,
    dataset: &'a Dataset<'a>,
    settings: &'a Settings,
    gears: Vec<GearFriction>,
    /// Actuators whose coefficients are estimated.
    sought: Vec<usize>,
}

impl Search<'_> {
    /// Estimates the corrections; `None` if the data separate no coefficient from the model.
    fn step(&self, progress: &dyn Fn(Progress<'_>)) -> Result<Option<Step>, Error> {
        if self.sought.is_empty() {
            return Ok(None);
        }
        let settings = Settings {
            gear_friction: self.gears.clone(),
            instruments: Instruments::None,
            r_sigma: f64::INFINITY,
            ..self.settings.clone()
        };
        let info = self.model.info();
        let mut projections = Projection::usual(&info, &settings.kept_actuators);
        projections.truncate(1);
        let runs = self.dataset.runs;
        let prepared = prepare(self.model, runs, &projections, &settings, progress)?;
        let estimates = estimate_projection(&prepared, 0, &settings, None)?;
        let watched = prepared.observations.iter().map(|observation| RunMonitor {
            monitor: observation.monitor.clone(),
            closure_residual: observation.closure_residual,
        });
        let test = ScoreTest {
            model: self.model,
            dataset: &Dataset {
                variants: &[],
                ..*self.dataset
            },
            columns: &prepared.columns,
            base: &prepared.base.columns,
            estimate: &estimates.base,
            hypotheses: gear_hypotheses(info.sizes.actuators, &self.sought),
            position_ranges: &position_ranges(&watched.collect::<Vec<_>>()),
            periodic_motions: &prepared.periodic_motions,
            settings: &settings,
        };
        let scores = test.scores(1)?;
        let joined = Group::hypothesis(scores.hypotheses.len() - 1);
        let found = scores.test(&joined, scores.selected());
        Ok(found.map(|found| self.step_of(&found)))
    }

    /// The result of a test as corrections of all coefficients.
    fn step_of(&self, found: &WaldTest) -> Step {
        let count = self.sought.len();
        let mut step = Step {
            sizes: vec![0.0; count],
            covariance: DMatrix::zeros(count, count),
            quantile: found.quantile(MISSES),
            separable: vec![false; count],
        };
        for (row, &(place, size)) in found.sizes.iter().enumerate() {
            step.sizes[place] = size;
            step.separable[place] = true;
            for (column, &(other, _)) in found.sizes.iter().enumerate() {
                step.covariance[(place, other)] = found.covariance[(row, column)];
            }
        }
        step
    }

    /// Excludes coefficients that a step does not determine; whether there are any.
    fn without_undetermined(&mut self, step: &Step) -> bool {
        let is_determined =
            |number: &usize| step.separable[*number] && step.deviation(*number) < UNDETERMINED;
        let kept = (0..self.sought.len()).filter(is_determined);
        let kept: Vec<usize> = kept.map(|number| self.sought[number]).collect();
        if kept.len() == self.sought.len() {
            return false;
        }
        for (actuator, gear) in self.gears.iter_mut().enumerate() {
            if !kept.contains(&actuator) {
                *gear = GearFriction::default();
            }
        }
        self.sought = kept;
        true
    }

    /// Adds the corrections; whether all are small.
    fn correct(&mut self, step: &Step) -> bool {
        let mut is_small = true;
        for (number, &actuator) in self.sought.iter().enumerate() {
            let own = &mut self.gears[actuator].coefficient;
            *own = (*own + step.sizes[number]).clamp(-LARGEST, LARGEST);
            is_small &= step.sizes[number].abs() <= SMALL_STEP * step.deviation(number);
        }
        is_small
    }

    /// The result, with the covariance of the last step.
    fn estimate(self, names: &[&str], step: Option<&Step>) -> GearFrictionEstimate {
        let of = |actuator: usize| -> Option<GearCoefficient> {
            let step = step?;
            let number = self.sought.iter().position(|own| *own == actuator)?;
            let (value, deviation) = (self.gears[actuator].coefficient, step.deviation(number));
            let half = step.quantile * deviation;
            Some(GearCoefficient {
                value,
                deviation,
                interval_95: [value - half, value + half],
            })
        };
        let drives = names.iter().enumerate();
        GearFrictionEstimate {
            drives: drives
                .map(|(actuator, name)| DriveGearFriction {
                    actuator: (*name).to_owned(),
                    coefficient: of(actuator),
                })
                .collect(),
            covariance: step.map_or_else(|| DMatrix::zeros(0, 0), |step| step.covariance.clone()),
            determined: self.sought,
        }
    }
}
