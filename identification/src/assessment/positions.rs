//! Corrections of positions that violate the loop closure: units, swapped columns, signs.

use std::f64::consts::PI;

use overact::{Function, Model, math::wrap_angle};

use super::check::{About, Check, CheckKind, Grade};
use crate::{
    kinematics::approach,
    units::{Signal, UNIT_ERRORS, UnitError},
};
use overact_logs::{Error, Log};

/// Number of rows of a run that are tested, and their distance in time (s).
const ROWS: usize = 200;
const INTERVAL: f64 = 0.01;

/// Distance of rows for a whole run, s: several in a period of what the filter removes.
const OFTEN: f64 = 0.002;

/// Largest fraction of the closure residual that may remain after a correction.
const EXPLAINED: f64 = 0.1;

/// Possible faults of positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    /// Angles are in degrees.
    Degrees,
    /// Two actuators are swapped.
    Swapped(usize, usize),
    /// An actuator has the opposite sign.
    Reversed(usize),
    /// Positions of one or all revolute (or prismatic) actuators are in another unit.
    Unit(&'static UnitError, Option<usize>),
}

impl Fault {
    /// All faults of a robot, without units other than degrees.
    pub(crate) fn all(model: &dyn Model) -> Vec<Self> {
        let info = model.info();
        let n = info.sizes.actuators;
        let mut faults = Vec::new();
        if info.actuator_is_revolute.contains(&true) {
            faults.push(Self::Degrees);
        }
        faults.extend((0..n).flat_map(|i| (i + 1..n).map(move |j| Self::Swapped(i, j))));
        faults.extend((0..n).map(Self::Reversed));
        faults
    }

    /// Units of single drives.
    pub(crate) fn single_units(model: &dyn Model) -> Vec<Self> {
        let all = Self::with_units(model).into_iter();
        all.filter(|fault| matches!(fault, Self::Unit(_, Some(_))))
            .collect()
    }

    /// All faults, including units.
    fn with_units(model: &dyn Model) -> Vec<Self> {
        let info = model.info();
        let mut faults = Self::all(model);
        let of_all = |unit_error: &'static UnitError| {
            let turns = unit_error.signal == Signal::Angles;
            let own = info.actuator_is_revolute.iter().enumerate();
            let own = own.filter(move |(_, revolute)| **revolute == turns);
            let own: Vec<Option<usize>> = own.map(|(index, _)| Some(index)).collect();
            let all = (own.len() > 1).then_some(None);
            all.into_iter()
                .chain(own)
                .map(move |which| Self::Unit(unit_error, which))
        };
        let positions = UNIT_ERRORS
            .iter()
            .filter(|unit_error| matches!(unit_error.signal, Signal::Angles | Signal::Lengths));
        faults.extend(positions.flat_map(of_all));
        faults
    }

    /// Size of the correction, to rank faults that restore the closure.
    ///
    /// Corrections that shrink positions close the loops of many robots near their home pose. The
    /// smallest correction is therefore preferred, and one drive before all drives.
    fn change(self) -> f64 {
        const ALL: f64 = 0.1;
        match self {
            Self::Swapped(..) | Self::Reversed(_) => 0.0,
            Self::Degrees => (180.0 / PI).ln() + ALL,
            Self::Unit(unit_error, Some(_)) => unit_error.factor.ln().abs(),
            Self::Unit(unit_error, None) => unit_error.factor.ln().abs() + ALL,
        }
    }

    /// Corrects the fault in rows of positions.
    pub(crate) fn repair(self, model: &dyn Model, positions: &mut [f64]) {
        let info = model.info();
        for row in positions.chunks_exact_mut(info.sizes.actuators) {
            match self {
                Self::Degrees => {
                    let angles = row.iter_mut().zip(info.actuator_is_revolute);
                    angles
                        .filter(|(_, revolute)| **revolute)
                        .for_each(|(q, _)| *q *= PI / 180.0);
                }
                Self::Swapped(i, j) => row.swap(i, j),
                Self::Reversed(i) => row[i] = -row[i],
                Self::Unit(unit_error, Some(i)) => row[i] /= unit_error.factor,
                Self::Unit(unit_error, None) => {
                    let turns = unit_error.signal == Signal::Angles;
                    let positions = row.iter_mut().zip(info.actuator_is_revolute);
                    positions
                        .filter(|(_, revolute)| **revolute == turns)
                        .for_each(|(q, _)| *q /= unit_error.factor);
                }
            }
        }
    }

    /// The failed check of this fault in a run; `so` is the reason.
    pub(crate) fn check(self, model: &dyn Model, run: &str, so: &str) -> Check {
        let info = model.info();
        let name = |index: usize| info.actuators.get(index).copied().unwrap_or_default();
        let (kind, actuator, message) = match self {
            Self::Unit(unit_error, which) => {
                let of = which.map_or_else(
                    || String::from("all drives of the kind"),
                    |index| format!("`{}`", name(index)),
                );
                let message = format!("{of}: {}", unit_error.advice());
                (CheckKind::Unit, which.map(name), message)
            }
            Self::Degrees => (
                CheckKind::Degrees,
                None,
                String::from(
                    "the positions look like degrees, or like motor angles: give `position_scale = \"1 deg\"` in the table [data], or the inverse of each gear ratio, or `coordinates = \"motors\"` if the description has motors with ratios",
                ),
            ),
            Self::Swapped(i, j) => (
                CheckKind::SwappedColumns,
                Some(name(i)),
                format!(
                    "the positions of `{}` and `{}` look swapped: check the columns of the log",
                    name(i),
                    name(j)
                ),
            ),
            Self::Reversed(i) => (
                CheckKind::WrongSign,
                Some(name(i)),
                format!(
                    "the position of `{}` looks reversed: check its sign (a negative `position_scale` in the table [data] reverses it)",
                    name(i)
                ),
            ),
        };
        let check = Check::new(kind, About::Model, format!("{message}; {so}"))
            .in_run(run)
            .with_grade(Grade::DoNotUse);
        let check = match self {
            Self::Degrees => check.in_unit(Signal::Angles.name(), 180.0 / PI),
            Self::Unit(unit_error, _) => check.in_unit(unit_error.signal.name(), unit_error.factor),
            Self::Swapped(..) | Self::Reversed(_) => check,
        };
        match actuator {
            Some(actuator) => check.of_actuator(actuator),
            None => check,
        }
    }
}

/// The correction that closes the loops of a run to a `tolerance` (m, rad), if there is one.
///
/// # Errors
/// A file cannot be read any more.
pub(crate) fn explanation(
    model: &dyn Model,
    log: &Log,
    tolerance: f64,
) -> Result<Option<Check>, Error> {
    let rows = rows(log)?;
    let miss = miss(model, &rows);
    if miss.is_some_and(|miss| miss <= tolerance) {
        return Ok(None);
    }
    let repaired = |fault: &Fault| {
        let mut rows = rows.clone();
        fault.repair(model, &mut rows);
        self::miss(model, &rows)
    };
    let misses = Fault::with_units(model).into_iter().filter_map(|fault| {
        let left = repaired(&fault)?;
        explains(left, miss, tolerance).then_some((fault, left))
    });
    let best = misses.min_by(|a, b| {
        let change = a.0.change().total_cmp(&b.0.change());
        change.then(a.1.total_cmp(&b.1))
    });
    Ok(best.map(|(fault, left)| {
        let before = miss.map_or_else(
            || String::from("where no pose is found without the change"),
            |miss| format!("instead of missing by {miss:.3} m or rad"),
        );
        let so = format!("then the loops close to {left:.1e} m or rad {before}");
        fault
            .check(model, log.name(), &so)
            .measured(left, "m or rad")
            .against(tolerance, "the limit of the closure")
    }))
}

/// Whether a correction that leaves the residual `left` explains the positions.
///
/// The loops must close, and must not have nearly closed before. If there was no pose before,
/// closing is enough.
fn explains(left: f64, miss: Option<f64>, tolerance: f64) -> bool {
    left <= tolerance && miss.is_none_or(|miss| left <= EXPLAINED * miss)
}

/// Positions at the start of a run, samples × n.
fn rows(log: &Log) -> Result<Vec<f64>, Error> {
    let n = log.actuators();
    let stride = ((INTERVAL * log.sampling_frequency()) as usize).max(1);
    let mut rows = Vec::new();
    let mut reader = log.reader()?;
    let mut sample = 0_usize;
    while let Some(block) = reader.next()? {
        for row in block.positions.chunks_exact(n) {
            if sample.is_multiple_of(stride) {
                rows.extend_from_slice(row);
            }
            sample += 1;
        }
        if rows.len() >= ROWS * n {
            rows.truncate(ROWS * n);
            break;
        }
    }
    Ok(rows)
}

/// Largest difference between positions and those of their poses; `None` without a pose.
fn miss(model: &dyn Model, rows: &[f64]) -> Option<f64> {
    let mut misses = Misses::new(model);
    misses.take(rows).then_some(misses.largest)
}

/// Largest difference between the unfiltered positions of a run and those of their poses.
///
/// `None` if a row has no pose.
///
/// # Errors
/// A file cannot be read any more.
pub(crate) fn unfiltered_miss(model: &dyn Model, log: &Log) -> Result<Option<f64>, Error> {
    let n = log.actuators();
    let stride = ((OFTEN * log.sampling_frequency()) as usize).max(1);
    let mut misses = Misses::new(model);
    let mut reader = log.reader()?;
    let mut sample = 0_usize;
    while let Some(block) = reader.next()? {
        for row in block.positions.chunks_exact(n) {
            if sample.is_multiple_of(stride) && !misses.take(row) {
                return Ok(None);
            }
            sample += 1;
        }
    }
    Ok(Some(misses.largest))
}

/// Closure residual of positions, row by row.
struct Misses<'a> {
    model: &'a dyn Model,
    /// Pose of the previous row; `None` before the first one.
    pose: Option<Vec<f64>>,
    reached: Vec<f64>,
    largest: f64,
}

impl<'a> Misses<'a> {
    fn new(model: &'a dyn Model) -> Self {
        Self {
            model,
            pose: None,
            reached: vec![0.0; model.info().sizes.actuators],
            largest: 0.0,
        }
    }

    /// Adds successive rows; false if one has no pose.
    fn take(&mut self, rows: &[f64]) -> bool {
        let n = self.reached.len();
        rows.chunks_exact(n).all(|row| self.one(row).is_some())
    }

    /// Adds one row; `None` if it has no pose.
    fn one(&mut self, row: &[f64]) -> Option<()> {
        let (model, info) = (self.model, self.model.info());
        let pose = self.pose.get_or_insert_with(|| {
            let mut pose = info.home_pose.to_vec();
            approach(model, row, &mut pose);
            pose
        });
        model.pose_from_actuators(row, pose).ok()?;
        let function = Function::ActuatorPositions;
        model.evaluate(function, &[pose], &mut self.reached).ok()?;
        let both = row.iter().zip(&self.reached);
        for ((q, reached), revolute) in both.zip(info.actuator_is_revolute) {
            let difference = if *revolute {
                wrap_angle(q - reached)
            } else {
                q - reached
            };
            self.largest = self.largest.max(difference.abs());
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::explains;

    #[test]
    fn a_change_explains_a_residual_if_little_remains() {
        let tolerance = 1e-3;
        assert!(explains(1e-4, Some(0.5), tolerance));
        // The loops stay open, although the residual is much smaller.
        assert!(!explains(2e-3, Some(0.5), tolerance));
        assert!(!explains(2e-3, None, tolerance));
        // The loops close within a tolerance that was only just exceeded before.
        assert!(explains(5e-4, Some(6e-3), tolerance));
        assert!(!explains(5e-4, Some(4e-3), tolerance));
        assert!(explains(5e-4, None, tolerance));
    }
}
