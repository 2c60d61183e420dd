//! Identification of Stribeck velocities by their profile likelihood, together with the parameters.
//!
//! The torques are linear in all parameters but the velocity v of Stribeck friction,
//! f sign(q̇)/(1 + (q̇/v)²). For each of several velocities, the other parameters have their best
//! values, and the sum of squared weighted residuals is the profile S(v). All columns of these
//! velocities are observed in one pass over the runs, so that the profile follows from one R
//! factor. The estimate is the minimum of S. The 95 % interval contains the velocities with
//!
//! ```text
//! S(v) - min S <= q² s²,
//! ```
//!
//! in which s² is the variance of the residuals. q is half the width of the interval of f by its
//! standard deviation for white residuals, so that it counts correlated residuals as well.
//! (D. M. Bates, D. G. Watts, *Nonlinear Regression Analysis and Its Applications*, 1988, chapter 6.)
//! Velocities of other joints keep their estimates.
//!
//! Passes are repeated in narrower ranges around the minima, until the points resolve the
//! intervals. A velocity is not determined if its interval leaves the first range; then that of the
//! description is kept.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use overact::Model;
use overact_logs::{Dataset, Error, Log, significant};
use serde::Serialize;

use super::{
    estimates::estimate_projection,
    prepare::{PreparedSystem, prepare},
    progress::Progress,
};
use crate::{
    regression::{
        factor::Factor, friction::stribeck_velocities as of_model, observation::MeasuredRun,
        observer::Observer, projection::Projection, system::System,
        uncertainty_propagation::PropagatedUncertainty,
    },
    result::Estimate,
    settings::{Instruments, Settings},
};

/// Largest number of passes.
const MOST_PASSES: usize = 6;

/// Velocities of each joint in a pass, an odd number.
const POINTS: usize = 13;

/// First range of velocities, on both sides of the described one: a factor of 8.
const FIRST_RANGE: f64 = 3.0 * std::f64::consts::LN_2;

/// Range of a later pass by the interval.
const MARGIN: f64 = 1.7;

/// Smallest ratio of interval and range at which the points resolve the interval.
const RESOLVED: f64 = 0.4;

/// Change of ln v for the derivative of a column.
const STEP: f64 = 1e-3;

/// Ratio of half a 95 % interval to the standard deviation of a normal distribution.
const NORMAL: f64 = 1.96;

/// Largest number of rounds through all joints for the minimum.
const ROUNDS: usize = 20;

/// Stribeck velocity of one joint or motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StribeckVelocity {
    /// Name of the parameter of its friction, `fst_…`.
    pub parameter: String,
    /// Unit of velocities, rad/s or m/s.
    pub unit: &'static str,
    /// Velocity of the description.
    pub described: f64,
    /// Estimate; `None` if the data do not determine it.
    pub estimate: Option<VelocityEstimate>,
}

/// Estimate of a Stribeck velocity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct VelocityEstimate {
    /// Velocity, rad/s or m/s.
    pub value: f64,
    /// 95 % interval.
    pub interval_95: [f64; 2],
}

/// Stribeck velocities of all joints and motors.
#[derive(Debug, Clone, PartialEq)]
pub struct StribeckVelocities {
    /// Each joint.
    pub joints: Vec<StribeckVelocity>,
    /// Coefficient f of each joint with an estimate, N m or N.
    coefficients: BTreeMap<String, f64>,
}

impl StribeckVelocities {
    /// Velocities by parameter, for [`Settings::stribeck_velocities`].
    #[must_use]
    pub fn velocities(&self) -> BTreeMap<String, f64> {
        let velocity = |joint: &StribeckVelocity| {
            let estimate = joint.estimate.map(|own| own.value);
            (joint.parameter.clone(), estimate.unwrap_or(joint.described))
        };
        self.joints.iter().map(velocity).collect()
    }

    /// Warnings about velocities that the data do not determine.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let joints = self.joints.iter().filter(|joint| joint.estimate.is_none());
        let warning = |joint: &StribeckVelocity| {
            format!(
                "the Stribeck velocity of `{}` is not determined and stays {} {}: record longer runs with slow motions and reversals of this joint",
                joint.parameter,
                significant(joint.described, 3),
                joint.unit
            )
        };
        joints.map(warning).collect()
    }

    /// The system with the uncertainty of the velocities.
    pub(super) fn propagated(
        &self,
        mut prepared: PreparedSystem,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<PreparedSystem, Error> {
        let mut columns = prepared.columns.clone();
        let (mut picked, count) = (prepared.base.columns.clone(), prepared.base.columns.len());
        let (mut coefficients, mut variances) = (Vec::new(), Vec::new());
        for joint in &self.joints {
            let own = { columns.as_slice() }
                .iter()
                .position(|one| one.name == joint.parameter);
            let (Some(column), Some(estimate)) = (own, joint.estimate) else {
                continue;
            };
            let Some(coefficient) = self.coefficients.get(&joint.parameter) else {
                continue;
            };
            for step in [-STEP, STEP] {
                picked.push(columns.add_stribeck(column, estimate.value * step.exp()));
            }
            coefficients.push(coefficient / (2.0 * STEP));
            let [low, high] = estimate.interval_95;
            variances.push(((high / low).ln() / (2.0 * NORMAL)).powi(2));
        }
        let Some(last) = coefficients.len().checked_sub(1) else {
            return Ok(prepared);
        };
        // Columns of the base, then derivatives by ln v; the last one replaces Y.
        let slope = |number: usize| {
            let mut slope = DVector::zeros(picked.len());
            slope[count + 2 * number] = -coefficients[number];
            slope[count + 2 * number + 1] = coefficients[number];
            slope
        };
        let mut all = DMatrix::identity(picked.len(), count + last);
        (0..last).for_each(|number| all.set_column(count + number, &slope(number)));
        let projections = &prepared.projections;
        let observer = Observer {
            model,
            columns: &columns,
            base: &picked,
            projections,
            settings,
        };
        let lines = |system: Result<System, Error>| {
            let lines = system.map_or_else(|_| Vec::new(), |own| own.lines);
            let combined = lines
                .iter()
                .map(|line| line.combined_with(&all, &slope(last)));
            combined.collect()
        };
        let projections = systems(&observer, runs)?.into_iter().map(lines).collect();
        let covariance = DMatrix::from_diagonal(&DVector::from_vec(variances));
        prepared.propagated_uncertainty =
            Some(PropagatedUncertainty::new(projections, count, covariance));
        Ok(prepared)
    }
}

/// Identifies the Stribeck velocities of a model from the training runs of a data set.
///
/// # Errors
/// As [`prepare`](super::prepare()).
pub fn stribeck_velocities(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<StribeckVelocities, Error> {
    let settings = Settings {
        instruments: Instruments::None,
        r_sigma: f64::INFINITY,
        ..settings.clone()
    };
    let of_model = of_model(model, settings.seed)?;
    let mut search = Search {
        model,
        dataset,
        settings,
        joints: Joint::all(model, &of_model),
    };
    for _ in 0..MOST_PASSES {
        if search.joints.iter().all(|joint| joint.is_finished) {
            break;
        }
        search.pass(progress)?;
    }
    Ok(search.result())
}

/// Equations of each projection in the columns of an observer.
fn systems(observer: &Observer<'_>, runs: &[Log]) -> Result<Vec<Result<System, Error>>, Error> {
    let info = observer.model.info();
    let new = |projection: &Projection| {
        let system = System::new(projection.clone(), &info, observer.base.len());
        Ok(system)
    };
    let mut systems: Vec<Result<System, Error>> = observer.projections.iter().map(new).collect();
    for (number, log) in runs.iter().enumerate() {
        let run = MeasuredRun {
            number,
            log,
            instruments: None,
            budget: 0,
            periodic_motion: None,
        };
        let (equations, _) = observer.run(&run, &|_, _| {})?;
        for (system, own) in systems.iter_mut().zip(equations) {
            match (system.as_mut(), own) {
                (Ok(system), Ok(own)) => system.extend(own),
                (Ok(_), Err(error)) => *system = Err(error),
                (Err(_), _) => {}
            }
        }
    }
    Ok(systems)
}

/// State of the search for one velocity.
struct Joint {
    parameter: String,
    unit: &'static str,
    described: f64,
    /// Middle of the next range, ln v.
    centre: f64,
    /// Half of the range.
    range: f64,
    found: Option<Minimum>,
    is_finished: bool,
}

/// Minimum of a profile over ln v, and the coefficient f there.
#[derive(Clone, Copy)]
struct Minimum {
    at: f64,
    interval: [f64; 2],
    coefficient: f64,
}

impl Joint {
    fn all(model: &dyn Model, velocities: &[(&'static str, f64)]) -> Vec<Self> {
        let parameters = model.info().parameters;
        let joint = |&(name, described): &(&'static str, f64)| {
            let mut parameters = parameters.iter();
            let is_force = parameters.any(|one| one.name == name && one.unit == "N");
            Self {
                parameter: name.to_owned(),
                unit: if is_force { "m/s" } else { "rad/s" },
                // It is recognised from numbers of the model, with rounding errors.
                described: significant(described, 12).parse().unwrap_or(described),
                centre: described.ln(),
                range: FIRST_RANGE,
                found: None,
                is_finished: false,
            }
        };
        velocities.iter().map(joint).collect()
    }

    /// ln v of a point of the next pass.
    fn point(&self, point: usize) -> f64 {
        self.centre + self.range * (2.0 * point as f64 / (POINTS - 1) as f64 - 1.0)
    }

    /// Ends the search without an estimate.
    fn give_up(&mut self) {
        self.found = None;
        self.is_finished = true;
    }

    /// Evaluates the profile at the points of a pass, and chooses the next range.
    ///
    /// `rise` is q² s², and `coefficient` the value of f at the lowest point.
    fn examine(&mut self, profile: &[f64], rise: f64, coefficient: f64) {
        let lowest = (0..POINTS).min_by(|a, b| profile[*a].total_cmp(&profile[*b]));
        let lowest = lowest.unwrap_or(POINTS / 2);
        let spacing = 2.0 * self.range / (POINTS - 1) as f64;
        let is_inside = lowest > 0 && lowest + 1 < POINTS;
        let (shift, least) = if is_inside {
            vertex([profile[lowest - 1], profile[lowest], profile[lowest + 1]])
        } else {
            (0.0, profile[lowest])
        };
        let at = self.point(lowest) + shift * spacing;
        // The square root of a parabola is linear.
        let rooted = |point: usize| (profile[point] - least).max(0.0).sqrt();
        let level = rise.sqrt();
        let crossing = |mut points: Box<dyn Iterator<Item = usize>>| {
            let mut last = (at, 0.0);
            points.find_map(|point| {
                let own = (self.point(point), rooted(point));
                let before = std::mem::replace(&mut last, own);
                let part = (level - before.1) / (own.1 - before.1);
                (own.1 > level).then_some(before.0 + part * (own.0 - before.0))
            })
        };
        let below = (0..=lowest).rev().filter(|&point| self.point(point) < at);
        let above = (lowest..POINTS).filter(|&point| self.point(point) > at);
        let ends = (crossing(Box::new(below)), crossing(Box::new(above)));
        let (Some(low), Some(high)) = ends else {
            self.centre = at;
            self.range *= 2.0;
            if self.range > FIRST_RANGE {
                self.give_up();
            }
            return;
        };
        let half = (high - at).max(at - low);
        self.is_finished = half >= RESOLVED * self.range;
        self.found = Some(Minimum {
            at,
            interval: [low, high],
            coefficient,
        });
        (self.centre, self.range) = (at, MARGIN * half);
    }
}

/// Position and value of the lowest point of the parabola through three points at -1, 0 and 1.
fn vertex([before, middle, after]: [f64; 3]) -> (f64, f64) {
    let curvature = before - 2.0 * middle + after;
    if curvature <= 0.0 {
        return (0.0, middle);
    }
    let slope = 0.5 * (after - before);
    let shift = (-slope / curvature).clamp(-0.5, 0.5);
    (shift, middle + shift * (slope + 0.5 * curvature * shift))
}

/// State of the search for all velocities.
struct Search<'a> {
    model: &'a dyn Model,
    dataset: &'a Dataset<'a>,
    settings: Settings,
    joints: Vec<Joint>,
}

impl Search<'_> {
    /// Evaluates the profiles of the unfinished velocities from one pass over the runs.
    fn pass(&mut self, progress: &dyn Fn(Progress<'_>)) -> Result<(), Error> {
        let velocity = |joint: &Joint| (joint.parameter.clone(), joint.centre.exp());
        self.settings.stribeck_velocities = self.joints.iter().map(velocity).collect();
        let (settings, runs) = (&self.settings, self.dataset.runs);
        let mut projections = Projection::usual(&self.model.info(), &settings.kept_actuators);
        projections.truncate(1);
        let prepared = prepare(self.model, runs, &projections, settings, progress)?;
        let estimate = estimate_projection(&prepared, 0, settings, None)?.base;
        let mut sought = Vec::new();
        for joint in self.joints.iter_mut().filter(|joint| !joint.is_finished) {
            let mut parameters = estimate.parameters.iter();
            match parameters.position(|one| one.name == joint.parameter) {
                Some(parameter) => sought.push((parameter, joint)),
                None => joint.give_up(),
            }
        }
        if sought.is_empty() {
            return Ok(());
        }
        let mut columns = prepared.columns.clone();
        let mut picked = prepared.base.columns.clone();
        let mut candidates = Vec::new();
        for (parameter, joint) in &sought {
            let column = prepared.base.columns[estimate.parameters[*parameter].column];
            candidates.push(Candidates {
                parameter: *parameter,
                first: picked.len(),
            });
            let points = (0..POINTS).map(|point| joint.point(point).exp());
            picked.extend(points.map(|velocity| columns.add_stribeck(column, velocity)));
        }
        let observer = Observer {
            model: self.model,
            columns: &columns,
            base: &picked,
            projections: &projections,
            settings,
        };
        let mut systems = systems(&observer, runs)?;
        let lines = systems.swap_remove(0)?.lines;
        let profiles = Profiles {
            factor: Factor::merged(&lines, &estimate.weights),
            estimate: &estimate,
            candidates,
        };
        let chosen = profiles.minimum();
        for (number, (parameter, joint)) in sought.into_iter().enumerate() {
            let of_point = |point: usize| {
                let mut points = chosen.clone();
                points[number] = point;
                profiles.squares(&points)
            };
            let profile: Vec<f64> = (0..POINTS).map(of_point).collect();
            let own = &estimate.parameters[parameter];
            let [low, high] = own.interval_95;
            let ratio = 0.5 * (high - low) / own.standard_deviation;
            let rise = ratio * ratio * profiles.variance(&chosen);
            joint.examine(&profile, rise, profiles.coefficient(&chosen, number));
        }
        Ok(())
    }

    fn result(self) -> StribeckVelocities {
        let found = |joint: &Joint| Some((joint.parameter.clone(), joint.found?.coefficient));
        let coefficients = self.joints.iter().filter_map(found).collect();
        let joint = |joint: Joint| StribeckVelocity {
            estimate: joint.found.map(|found| VelocityEstimate {
                value: found.at.exp(),
                interval_95: found.interval.map(f64::exp),
            }),
            parameter: joint.parameter,
            unit: joint.unit,
            described: joint.described,
        };
        StribeckVelocities {
            coefficients,
            joints: self.joints.into_iter().map(joint).collect(),
        }
    }
}

/// Columns of the velocities of a joint.
struct Candidates {
    /// Index of the parameter f in the estimate.
    parameter: usize,
    /// Place of the first of them in the factor.
    first: usize,
}

/// Residuals for any choice of one velocity for each joint.
struct Profiles<'a> {
    factor: Factor,
    estimate: &'a Estimate,
    candidates: Vec<Candidates>,
}

impl Profiles<'_> {
    /// Columns of the factor for these points of the joints, in the order of the estimate.
    fn selected(&self, points: &[usize]) -> Vec<usize> {
        let mut selected = self.estimate.columns();
        for (own, point) in self.candidates.iter().zip(points) {
            selected[own.parameter] = own.first + point;
        }
        selected
    }

    /// Smallest sum of squared residuals.
    fn squares(&self, points: &[usize]) -> f64 {
        let selected = self.selected(points);
        self.factor.smallest_residual(&selected).powi(2)
    }

    /// Points with the smallest sum, joint by joint.
    fn minimum(&self) -> Vec<usize> {
        let mut points = vec![POINTS / 2; self.candidates.len()];
        for _ in 0..ROUNDS {
            let before = points.clone();
            for joint in 0..points.len() {
                let value = |point: usize| {
                    let mut points = points.clone();
                    points[joint] = point;
                    self.squares(&points)
                };
                let best = (0..POINTS).map(|point| (value(point), point));
                let best = best.min_by(|a, b| a.0.total_cmp(&b.0));
                points[joint] = best.map_or(points[joint], |(_, point)| point);
            }
            if points == before {
                break;
            }
        }
        points
    }

    /// Variance of the weighted residuals.
    fn variance(&self, points: &[usize]) -> f64 {
        let unknowns = self.estimate.parameters.len() + points.len();
        let freedom = self.factor.equations().saturating_sub(unknowns);
        self.squares(points) / freedom.max(1) as f64
    }

    /// Coefficient f of a joint.
    fn coefficient(&self, points: &[usize], joint: usize) -> f64 {
        let reduced = self.factor.reduced(&self.selected(points));
        let values = reduced.triangle.solve_upper_triangular(&reduced.rhs);
        let parameter = self.candidates[joint].parameter;
        values.map_or(0.0, |values| values[parameter])
    }
}

#[cfg(test)]
mod tests {
    use super::{Joint, POINTS, vertex};

    #[test]
    fn the_vertex_of_a_parabola_is_exact() {
        let value = |x: f64| 3.0 + 2.0 * (x - 0.25).powi(2);
        let (at, least) = vertex([value(-1.0), value(0.0), value(1.0)]);
        assert!((at - 0.25).abs() < 1e-15 && (least - 3.0).abs() < 1e-15);
        assert_eq!(vertex([1.0, 1.0, 1.0]), (0.0, 1.0));
    }

    #[test]
    fn a_parabolic_profile_gives_its_minimum_and_interval() {
        let mut joint = Joint {
            parameter: String::from("fst_1"),
            unit: "rad/s",
            described: 1.0,
            centre: 0.0,
            range: 2.0,
            found: None,
            is_finished: false,
        };
        let of = |joint: &Joint| -> Vec<f64> {
            let value = |point| 5.0 + 8.0 * (joint.point(point) - 0.1_f64).powi(2);
            (0..POINTS).map(value).collect()
        };
        for _ in 0..3 {
            let profile = of(&joint);
            joint.examine(&profile, 2.0, 1.0);
        }
        let found = joint.found.expect("a minimum");
        assert!(joint.is_finished && (found.at - 0.1).abs() < 1e-12);
        for (end, expected) in found.interval.iter().zip([-0.4, 0.6]) {
            assert!((end - expected).abs() < 1e-12, "{:?}", found.interval);
        }
    }

    #[test]
    fn a_flat_profile_gives_no_estimate() {
        let mut joint = Joint {
            parameter: String::from("fst_1"),
            unit: "rad/s",
            described: 1.0,
            centre: 0.0,
            range: super::FIRST_RANGE,
            found: None,
            is_finished: false,
        };
        joint.examine(&[5.0; POINTS], 2.0, 1.0);
        assert!(joint.is_finished && joint.found.is_none());
    }
}
