//! What exciting runs keep to: limits of coordinates, actuators and conditioning, and where they come from.

use super::course::{Bench, Course};
use super::frame::Frame;
use super::kind::LimitKind;
use overact_codegen::description::{self, Description};
use overact_identification::significant;
use overact_simulation::Trajectory;
use serde::Serialize;

/// Part of an actuator's largest torque that a desired motion may ask for: the rest is the controller's.
const TORQUE_SHARE: f64 = 0.9;

/// A condition number that is far from singular.
const SAFE_CONDITION: f64 = 10.0;

/// Samples of one period from which the limits of described runs are taken.
const SAMPLES: usize = 1024;

/// Displacement of a joint that nothing is known of, rad or m.
const ASSUMED: [f64; 2] = [std::f64::consts::FRAC_PI_4, 0.1];

/// Part of what is reached along a single coordinate that all of them may take together.
const REACH_SHARE: f64 = 0.5;

/// The first step along a coordinate when the reach is found out, m or rad, its growth and the last one.
const REACH: [f64; 3] = [1e-3, 1.1, 1.5];

/// The shortest first step, m or rad, of coordinates that do not reach that of [`REACH`].
const SHORTEST_REACH: f64 = 1e-6;

/// Where a limit comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// The description gives it.
    Described,
    /// The runs of the description reach it.
    Runs,
    /// Neither: half of what is reached, or a usual value.
    Assumed,
}

impl Origin {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Described => "of the description",
            Self::Runs => "reached by its runs",
            Self::Assumed => "assumed",
        }
    }
}

/// A limit that runs keep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Limit {
    /// Of what.
    pub kind: LimitKind,
    /// The largest magnitude of each coordinate or actuator, SI; a single number for the condition.
    pub values: Vec<f64>,
    /// Their units, for instance `rad/s`; nothing for the condition.
    pub units: Vec<&'static str>,
    /// Where it comes from.
    pub origin: Origin,
}

impl Limit {
    /// The largest part of the limit that peaks take: 1 is all of it.
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

/// The largest part of each limit that a run takes, at the samples, or also between them.
pub(super) fn uses(course: &Course, limits: &[Limit], between: bool) -> Vec<f64> {
    let used = |limit: &Limit| limit.used(&course.peaks(limit.kind, between));
    limits.iter().map(used).collect()
}

/// What runs ask of the actuators' speeds where nothing limits them, in words.
pub(super) fn unlimited_speeds(
    bench: &Bench<'_>,
    limits: &[Limit],
    found: &[(Frame, Trajectory)],
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
        "nothing limits the speeds (`velocity` of [excitation] does): the runs that were found reach {}",
        all.join(", ")
    ))
}

/// The limits of a description; `described` are its own runs to identify from.
pub(super) fn limits(
    bench: &Bench<'_>,
    description: &Description,
    described: &[(Frame, Trajectory)],
) -> Vec<Limit> {
    let reach =
        |(frame, trajectory): &(Frame, Trajectory)| bench.course(frame, trajectory, SAMPLES);
    // A run that the robot can't follow tells nothing; making it fails with its own error.
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
    // Where home itself is not far from singular, motion has to have some room.
    let at_home = bench.condition_at(&vec![0.0; bench.info.sizes.dof]);
    let safe = SAFE_CONDITION.max(2.0 * at_home.filter(|own| own.is_finite()).unwrap_or_default());
    let condition = own
        .clone()
        .or(runs.clone())
        .map_or(safe, |values| values[0]);
    let assumed = match moving.is_some() {
        true => None,
        false => Some(reached(bench, condition)),
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

/// A limit of what the description says, of what its runs reach or of what is assumed, the first that there is.
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

/// The largest magnitudes in any of the runs; none without runs.
fn reached_by(courses: &[Course], kind: LimitKind) -> Option<Vec<f64>> {
    let all = courses.iter().map(|course| course.peaks(kind, false));
    all.reduce(|a, b| a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect())
}

/// What a desired motion may ask of the largest torques of the virtual experiment.
fn torque_share(description: &Description) -> Option<Vec<f64>> {
    let largest = description.experiment.as_ref()?.torque_limit.as_ref()?;
    Some(largest.iter().map(|limit| TORQUE_SHARE * limit).collect())
}

/// Displacements of the coordinates where no run tells of them: half of what is reached along each alone on
/// both sides without a larger condition number; of joints of a robot without platform at most a usual value.
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
        // A small robot may not reach the usual first step.
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
