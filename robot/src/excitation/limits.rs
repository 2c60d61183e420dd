//! Limits of exciting runs on coordinates, actuators and conditioning, and their origins.

use super::course::{Bench, Course};
use super::fourier_run::FourierRun;
use super::kind::LimitKind;
use overact_codegen::description::{self, Description};
use overact_identification::significant;
use overact_simulation::Trajectory;
use serde::Serialize;

/// Fraction of the torque limit for the desired motion; the rest is for the controller.
const TORQUE_SHARE: f64 = 0.9;

/// Condition number that counts as far from singular.
const SAFE_CONDITION: f64 = 10.0;

/// Samples of one period for limits taken from described runs.
const SAMPLES: usize = 1024;

/// Default displacement of a joint, rad or m.
const ASSUMED: [f64; 2] = [std::f64::consts::FRAC_PI_4, 0.1];

/// Fraction of the reach along single coordinates that all may use together.
const REACH_SHARE: f64 = 0.5;

/// Search for the reach along a coordinate: first step, growth factor and last step (m or rad).
const REACH: [f64; 3] = [1e-3, 1.1, 1.5];

/// Shortest first step, m or rad, for robots that do not reach that of [`REACH`].
const SHORTEST_REACH: f64 = 1e-6;

/// Origin of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// Given in the description.
    Described,
    /// Reached by the runs of the description.
    Runs,
    /// Assumed: half of the reach, or a default.
    Assumed,
}

impl Origin {
    /// Origin in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Described => "of the description",
            Self::Runs => "reached by its runs",
            Self::Assumed => "assumed",
        }
    }
}

/// A limit on runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Limit {
    /// Limited quantity.
    pub kind: LimitKind,
    /// Largest magnitude for each coordinate or actuator, SI; a single number for the condition.
    pub values: Vec<f64>,
    /// Units, for instance `rad/s`; empty for the condition.
    pub units: Vec<&'static str>,
    /// Origin of the limit.
    pub origin: Origin,
}

impl Limit {
    /// Largest ratio of a peak to its limit.
    fn used(&self, peaks: &[f64]) -> f64 {
        let part = |(peak, limit): (&f64, &f64)| if *peak == 0.0 { 0.0 } else { peak / limit };
        let parts = peaks.iter().zip(&self.values).map(part);
        parts.fold(0.0, |most: f64, part| {
            if part.is_nan() {
                f64::INFINITY
            } else {
                most.max(part)
            }
        })
    }
}

/// Largest ratio to each limit in a run, at the samples or also between them.
pub(super) fn uses(course: &Course, limits: &[Limit], between: bool) -> Vec<f64> {
    let used = |limit: &Limit| limit.used(&course.peaks(limit.kind, between));
    limits.iter().map(used).collect()
}

/// Sentence on the actuator speeds of runs that no limit bounds.
pub(super) fn unlimited_speeds(
    bench: &Bench<'_>,
    limits: &[Limit],
    found: &[(FourierRun, Trajectory)],
) -> Option<String> {
    if limits.iter().any(|limit| limit.kind == LimitKind::Velocity) {
        return None;
    }
    let courses = found.iter();
    let courses = courses.filter_map(|(frame, run)| bench.course(frame, run, SAMPLES).ok());
    let peaks = reached_by(&courses.collect::<Vec<_>>(), LimitKind::Velocity)?;
    let units = bench.units(LimitKind::Velocity);
    let names = bench.info.actuators.iter();
    let all = names.zip(peaks.iter().zip(units));
    let all: Vec<String> = all
        .map(|(name, (peak, unit))| format!("`{name}` {} {unit}", significant(*peak, 3)))
        .collect();
    Some(format!(
        "speeds have no limit (`velocity` of [excitation] sets one): the computed runs reach {}",
        all.join(", ")
    ))
}

/// Limits for a description; `described` are its training runs.
pub(super) fn limits(
    bench: &Bench<'_>,
    description: &Description,
    described: &[(FourierRun, Trajectory)],
) -> Vec<Limit> {
    let reach =
        |(frame, trajectory): &(FourierRun, Trajectory)| bench.course(frame, trajectory, SAMPLES);
    // Ignore unreachable runs; simulating them reports the error.
    let courses: Vec<Course> = described.iter().filter_map(|run| reach(run).ok()).collect();
    let of_runs = |kind| reached_by(&courses, kind);
    let table = description.excitation.as_ref();
    let key =
        |get: fn(&description::Excitation) -> &Option<Vec<f64>>| table.and_then(|t| get(t).clone());
    let mut all = Vec::new();
    let mut add = |kind, own, runs, assumed| all.extend(chosen(bench, kind, own, runs, assumed));
    let moving = of_runs(LimitKind::Position).filter(|peaks| peaks.iter().any(|peak| *peak > 0.0));
    let own = table.and_then(|t| t.condition).map(|value| vec![value]);
    let runs = of_runs(LimitKind::Condition)
        .filter(|peak| peak.iter().all(|p| p.is_finite() && *p > SAFE_CONDITION));
    // If home itself is nearly singular, allow twice its condition number.
    let at_home = bench.condition_at(&vec![0.0; bench.info.sizes.dof]);
    let safe = SAFE_CONDITION.max(2.0 * at_home.filter(|own| own.is_finite()).unwrap_or_default());
    let condition = own
        .clone()
        .or(runs.clone())
        .map_or(safe, |values| values[0]);
    let assumed = if moving.is_some() {
        None
    } else {
        Some(reached(bench, condition))
    };
    add(LimitKind::Position, key(|t| &t.position), moving, assumed);
    add(LimitKind::Travel, key(|t| &t.travel), None, None);
    let rates = |kind| of_runs(kind).filter(|peaks| peaks.iter().all(|peak| *peak > 0.0));
    add(
        LimitKind::Velocity,
        key(|t| &t.velocity),
        rates(LimitKind::Velocity),
        None,
    );
    add(
        LimitKind::Acceleration,
        key(|t| &t.acceleration),
        rates(LimitKind::Acceleration),
        None,
    );
    if bench.parameters.is_some() {
        let share = torque_share(description);
        add(LimitKind::Torque, share, rates(LimitKind::Torque), None);
    }
    if bench.has_loop {
        add(LimitKind::Condition, own, runs, Some(vec![safe]));
    }
    all
}

/// Limit from the description, its runs or an assumption, in this order.
fn chosen(
    bench: &Bench<'_>,
    kind: LimitKind,
    own: Option<Vec<f64>>,
    runs: Option<Vec<f64>>,
    assumed: Option<Vec<f64>>,
) -> Option<Limit> {
    let own = own.map(|values| (values, Origin::Described));
    let runs = runs.map(|values| (values, Origin::Runs));
    let assumed = assumed.map(|values| (values, Origin::Assumed));
    let (values, origin) = own.or(runs).or(assumed)?;
    Some(Limit {
        kind,
        values,
        units: bench.units(kind),
        origin,
    })
}

/// Largest magnitudes over all runs; `None` without runs.
fn reached_by(courses: &[Course], kind: LimitKind) -> Option<Vec<f64>> {
    let all = courses.iter().map(|course| course.peaks(kind, false));
    all.reduce(|a, b| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect())
}

/// Torque limits for the desired motion, from those of the virtual experiment.
fn torque_share(description: &Description) -> Option<Vec<f64>> {
    let largest = description.experiment.as_ref()?.torque_limit.as_ref()?;
    Some(largest.iter().map(|limit| TORQUE_SHARE * limit).collect())
}

/// Assumed displacements if no run gives them.
///
/// They are half of the reach along each coordinate alone, on both sides, within the condition
/// limit. Joints of serial robots also have the default as an upper bound.
fn reached(bench: &Bench<'_>, condition: f64) -> Vec<f64> {
    let dof = bench.info.sizes.dof;
    let along = |coordinate: usize, sign: f64| {
        let is_reached = |distance: f64| {
            let mut step = vec![0.0; dof];
            step[coordinate] = sign * distance;
            let found = bench.condition_at(&step);
            found.is_some_and(|found| found <= condition)
        };
        let [mut at, growth, last] = REACH;
        // Small robots may not reach the first step.
        while !is_reached(at) && at > SHORTEST_REACH {
            at /= 2.0;
        }
        let mut good = 0.0;
        while at < last && is_reached(at) {
            good = at;
            at *= growth;
        }
        good
    };
    let share =
        |coordinate: usize| REACH_SHARE * along(coordinate, 1.0).min(along(coordinate, -1.0));
    let of = |coordinate: usize| {
        let usual = ASSUMED[usize::from(bench.is_length(coordinate))];
        match (bench.has_platform, bench.has_loop) {
            (true, _) => share(coordinate),
            (false, true) => usual.min(share(coordinate)),
            (false, false) => usual,
        }
    };
    (0..dof).map(of).collect()
}
