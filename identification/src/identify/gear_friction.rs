//! Identification of the friction of gears, together with the parameters.
//!
//! With the coefficients μ of an iteration, the torques x of the gears have the model x = W χ. An
//! error δ of μ_j adds to x the column σ |x_j|, in which x_j is the torque that the estimate
//! predicts. The predicted torque has none of the noise of the measured one, so it is its own
//! instrument. The score test of all these columns together gives δ with its covariance, for
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
        hypotheses::{Group, ScoreTest, Shape, WaldTest, gear_hypotheses},
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
const UNDETERMINED: f64 = 0.1;

/// Probability that an interval misses the true value.
const MISSES: f64 = 0.05;

/// Largest magnitude of a coefficient during the iteration; that of back-driving is below 1.
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
    /// Coefficient if the drive moves the load; `None` if the data do not determine it.
    pub driving: Option<GearCoefficient>,
    /// Coefficient if the load moves the drive; `None` if the data do not determine it.
    pub back_driving: Option<GearCoefficient>,
}

/// Estimated friction of all gears.
#[derive(Debug, Clone, PartialEq)]
pub struct GearFrictionEstimate {
    /// Each drive.
    pub drives: Vec<DriveGearFriction>,
    /// Actuator and shape of each determined coefficient.
    coefficients: Vec<(usize, Shape)>,
    /// Covariance of these coefficients.
    covariance: DMatrix<f64>,
}

impl GearFrictionEstimate {
    /// Friction of each gear, for [`Settings::gear_friction`]; undetermined coefficients are zero.
    #[must_use]
    pub fn gears(&self) -> Vec<GearFriction> {
        let value = |one: Option<GearCoefficient>| one.map_or(0.0, |one| one.value);
        let drives = self.drives.iter();
        drives
            .map(|drive| GearFriction {
                driving: value(drive.driving),
                back_driving: value(drive.back_driving),
            })
            .collect()
    }

    /// Warnings about coefficients that the data do not determine, or that are negative.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut all = Vec::new();
        for drive in &self.drives {
            let both = [
                ("driving", drive.driving),
                ("back-driving", drive.back_driving),
            ];
            for (name, coefficient) in both {
                let actuator = &drive.actuator;
                match coefficient {
                    None => all.push(format!(
                        "the friction coefficient of {name} of the gear of `{actuator}` is not determined and counts as zero: the data do not separate it from Coulomb friction and offset; record runs in which the torque changes at equal speeds"
                    )),
                    Some(own) if own.interval_95[1] < 0.0 => all.push(format!(
                        "the friction coefficient of {name} of the gear of `{actuator}` is {}, with the 95 % interval {} to {}: it cannot be negative, so another effect of the torque is missing in the model",
                        significant(own.value, 2),
                        significant(own.interval_95[0], 2),
                        significant(own.interval_95[1], 2)
                    )),
                    Some(_) => {}
                }
            }
        }
        all
    }

    /// The system with the uncertainty of the coefficients, by which the torques were corrected.
    pub(super) fn propagated(
        &self,
        prepared: PreparedSystem,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<PreparedSystem, Error> {
        if self.coefficients.is_empty() {
            return Ok(prepared);
        }
        let gears = self.gears();
        let derivative = |number: usize, torque: f64, velocity: f64| {
            let (actuator, shape) = self.coefficients[number];
            let sign = if velocity == 0.0 {
                0.0
            } else {
                velocity.signum()
            };
            let [driving, back_driving] = gears[actuator].derivatives(torque, sign);
            if shape == Shape::Driving {
                driving
            } else {
                back_driving
            }
        };
        let correction = TorqueCorrection {
            actuators: self.coefficients.iter().map(|one| one.0).collect(),
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
    let shapes = [Shape::Driving, Shape::BackDriving];
    let both = |actuator| shapes.map(|shape| (actuator, shape));
    let mut search = Search {
        model,
        dataset,
        settings,
        gears: vec![GearFriction::default(); names.len()],
        coefficients: (0..names.len()).flat_map(both).collect(),
    };
    let mut last = None;
    for _ in 0..MOST_STEPS {
        let Some(step) = search.step(progress)? else {
            break;
        };
        if search.without_undetermined(&step) {
            continue;
        }
        let is_small = search.correct(&step);
        last = Some(step);
        if is_small {
            return Ok(search.estimate(names, last.as_ref()));
        }
    }
    if last.is_none() {
        search.gears.fill(GearFriction::default());
        return Ok(search.estimate(names, None));
    }
    let help = "identify without `gear_friction`; record longer runs with varying loads";
    Err(Problem::new(
        Code::NOTHING_DETERMINED,
        "the friction of the gears is not determined: the iteration does not converge",
    )
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

/// State of the iteration.
struct Search<'a> {
    model: &'a dyn Model,
    dataset: &'a Dataset<'a>,
    settings: &'a Settings,
    gears: Vec<GearFriction>,
    /// Actuator and shape of each estimated coefficient.
    coefficients: Vec<(usize, Shape)>,
}

impl Search<'_> {
    /// Estimates the corrections; `None` if the data separate no coefficient from the model.
    fn step(&self, progress: &dyn Fn(Progress<'_>)) -> Result<Option<Step>, Error> {
        if self.coefficients.is_empty() {
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
            hypotheses: gear_hypotheses(info.sizes.actuators, &self.coefficients),
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
        let count = self.coefficients.len();
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
        // x changes by -σ x/(1 + μ σ) with μ.
        for (number, &(actuator, shape)) in self.coefficients.iter().enumerate() {
            let factor = match shape {
                Shape::Driving => 1.0 + self.gears[actuator].driving,
                _ => 1.0 - self.gears[actuator].back_driving,
            };
            step.sizes[number] *= factor;
            step.covariance.row_mut(number).scale_mut(factor);
            step.covariance.column_mut(number).scale_mut(factor);
        }
        step
    }

    /// Excludes coefficients that a step does not determine; whether there are any.
    fn without_undetermined(&mut self, step: &Step) -> bool {
        let is_determined = |number: usize| {
            let deviation = step.covariance[(number, number)].sqrt();
            step.separable[number] && deviation < UNDETERMINED
        };
        let kept = (0..self.coefficients.len()).filter(|number| is_determined(*number));
        let kept: Vec<(usize, Shape)> = kept.map(|number| self.coefficients[number]).collect();
        if kept.len() == self.coefficients.len() {
            return false;
        }
        for &(actuator, shape) in &self.coefficients {
            if !kept.contains(&(actuator, shape)) {
                *coefficient(&mut self.gears[actuator], shape) = 0.0;
            }
        }
        self.coefficients = kept;
        true
    }

    /// Adds the corrections; whether all are small.
    fn correct(&mut self, step: &Step) -> bool {
        let mut is_small = true;
        for (number, &(actuator, shape)) in self.coefficients.iter().enumerate() {
            let own = coefficient(&mut self.gears[actuator], shape);
            *own = (*own + step.sizes[number]).clamp(-LARGEST, LARGEST);
            let deviation = step.covariance[(number, number)].sqrt();
            is_small &= step.sizes[number].abs() <= SMALL_STEP * deviation;
        }
        is_small
    }

    /// The result, with the covariance of the last step.
    fn estimate(self, names: &[&str], step: Option<&Step>) -> GearFrictionEstimate {
        let of = |actuator: usize, shape: Shape| -> Option<GearCoefficient> {
            let step = step?;
            let mut all = self.coefficients.iter();
            let number = all.position(|own| *own == (actuator, shape))?;
            let value = *coefficient(&mut self.gears[actuator].clone(), shape);
            let deviation = step.covariance[(number, number)].sqrt();
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
                    driving: of(actuator, Shape::Driving),
                    back_driving: of(actuator, Shape::BackDriving),
                })
                .collect(),
            covariance: step.map_or_else(|| DMatrix::zeros(0, 0), |step| step.covariance.clone()),
            coefficients: self.coefficients,
        }
    }
}

/// The coefficient of this shape.
fn coefficient(gear: &mut GearFriction, shape: Shape) -> &mut f64 {
    match shape {
        Shape::Driving => &mut gear.driving,
        _ => &mut gear.back_driving,
    }
}
