//! Torques that contradict the model, and which single fault would explain them: a drive of the wrong
//! sign or gain, two that are swapped, a run that is labelled with the wrong payload; or two joints that are
//! swapped as a whole, gravity that points the other way or does not act.
//!
//! Any linear change of the torques changes Γ¹ = Σ_i J_iᵀ τ_i into a combination of the products
//! J_iᵀ τ_j, and what the model can't explain of a combination follows from the R factor of
//! [W, J_1ᵀ τ_1, J_1ᵀ τ_2, ...]. So one pass over the beginning of the runs judges all faults of
//! torques. Faults of positions that the loops do not tell need a pass of their own each.

use nalgebra::{DMatrix, DVector};
use overact::{Function, Model, StandardParameter};
use rayon::prelude::*;

use super::{
    check::{About, Check, CheckKind, Grade},
    whole::Whole,
};
use crate::{
    blocks::{BLOCK, slice},
    data::Log,
    error::Error,
    estimation::base::{BaseParameters, PayloadUse, base_parameters},
    kinematics::Motions,
    regression::{
        columns::ColumnSet,
        factor::{Factor, Reduced},
    },
    settings::Settings,
};

/// A fault that explains the torques leaves this part of the error, at most, ...
const EXPLAINED: f64 = 0.5;

/// ... and takes away this part of the inputs, at least; of those of one line, where it is one of a drive.
const WORTHWHILE: f64 = 0.03;

/// One that leaves no more than so many times as much explains them as well.
const AS_GOOD: f64 = 1.2;

/// Gains by which a drive may be wrong; the first is the wrong sign.
const GAINS: [f64; 11] = [
    -1.0, 1e-3, 0.01, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0, 100.0, 1000.0,
];

/// What may have happened.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    /// The torque of a drive has to be multiplied by a factor.
    Gain(usize, f64),
    /// The torques of two drives are exchanged.
    Swapped(usize, usize),
    /// The payload of a run is labelled wrongly.
    Label(usize),
}

/// What would explain the torques of runs, if one fault does.
///
/// # Errors
/// As [`Motions::next`]; the runs have been gone through before.
pub(crate) fn explanation(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<Option<Check>, Error> {
    let columns = Columns::new(model, settings)?;
    let doubt = columns.doubt((model, runs), settings, Way::ONE_BY_ONE)?;
    let before = doubt.error(None);
    let of_one = of_one(model, runs, &doubt, before);
    Ok(of_one.or_else(|| of_all((model, &columns), runs, settings, before)))
}

/// What speaks for a fault.
fn so(before: f64, after: f64) -> String {
    format!(
        "then {:.1} % of the inputs are left unexplained, instead of {:.1} %",
        100.0 * after,
        100.0 * before
    )
}

/// The fault of one drive or label that explains the torques, of which so much is unexplained `before`.
fn of_one(model: &dyn Model, runs: &[Log], doubt: &Doubt<'_>, before: f64) -> Option<Check> {
    let info = model.info();
    let n = info.sizes.actuators;
    let mut faults: Vec<Fault> = Vec::new();
    faults.extend((0..n).flat_map(|i| GAINS.map(|gain| Fault::Gain(i, gain))));
    faults.extend((0..n).flat_map(|i| (i + 1..n).map(move |j| Fault::Swapped(i, j))));
    if !info.payload_parameters.is_empty() && runs.len() > 1 {
        faults.extend((0..runs.len()).map(Fault::Label));
    }
    let errors = faults
        .into_par_iter()
        .map(|fault| (fault, doubt.error(Some(fault))));
    let errors: Vec<(Fault, f64)> = errors.collect();
    // The error is a mean over lines: a drive of a serial robot shows in its own line alone.
    let lines = info.sizes.dof as f64;
    let explains = |(fault, after): &(Fault, f64)| {
        let taken = match fault {
            Fault::Label(_) => before - after,
            Fault::Gain(..) | Fault::Swapped(..) => {
                (lines * (before.powi(2) - after.powi(2)).max(0.0)).sqrt()
            }
        };
        *after < EXPLAINED * before && taken > WORTHWHILE
    };
    let best = errors.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let (mut fault, after) = best.filter(explains)?;
    if let Fault::Label(_) = fault {
        // Of two runs that differ by a payload either may be the one with it: a mass that is positive tells which.
        let as_good = errors
            .iter()
            .filter(|(other, error)| matches!(other, Fault::Label(_)) && *error <= AS_GOOD * after);
        let heavy = as_good.map(|(other, _)| *other);
        let mut heavy = heavy.filter(|other| doubt.mass(*other).is_some_and(|mass| mass > 0.0));
        fault = heavy.next().unwrap_or(fault);
    }
    let told = told(model, runs, fault, &so(before, after));
    Some(measured(told, (before, after), EXPLAINED))
}

/// The fault of all positions or of gravity that explains the torques: what happened to positions happened in all runs.
fn of_all(
    (model, columns): (&dyn Model, &Columns),
    runs: &[Log],
    settings: &Settings,
    before: f64,
) -> Option<Check> {
    let whole = Whole::all(model).into_par_iter().filter_map(|fault| {
        let repaired = |log: &Log| fault.repaired(model, log);
        let runs: Result<Vec<Log>, Error> = runs.iter().map(repaired).collect();
        // A change that leads out of the workspace explains nothing.
        let way = match fault {
            Whole::Gravity => Way::TOGETHER.without_gravity(2.0),
            Whole::Weightless => Way::TOGETHER.without_gravity(1.0),
            _ => Way::TOGETHER,
        };
        let doubt = columns.doubt((model, &runs.ok()?), settings, way);
        Some((fault, doubt.ok()?.error(None)))
    });
    let whole: Vec<(Whole, f64)> = whole.collect();
    let explains = |(fault, after): &(Whole, f64)| {
        *after < fault.explained(model, EXPLAINED) * before && before - after > WORTHWHILE
    };
    let best = whole.into_iter().filter(explains);
    let (fault, after) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let part = fault.explained(model, EXPLAINED);
    let told = fault.check(model, &so(before, after));
    Some(measured(told, (before, after), part))
}

/// A check with the part of the inputs that is left unexplained without the fault, of which it may leave a part.
fn measured(check: Check, (before, after): (f64, f64), part: f64) -> Check {
    let origin = format!(
        "{:.0} % of what is left unexplained with the fault",
        100.0 * part
    );
    check
        .measured(100.0 * after, "%")
        .against(100.0 * part * before, origin)
}

/// What is told of a fault; `so` says what speaks for it.
fn told(model: &dyn Model, runs: &[Log], fault: Fault, so: &str) -> Check {
    let info = model.info();
    let name = |index: usize| info.actuators.get(index).copied().unwrap_or_default();
    let (kind, run, actuator, message) = match fault {
        Fault::Gain(i, gain) if gain < 0.0 => (
            CheckKind::WrongSign,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks reversed: check the sign of its drive (a negative `torque_gain` in the table [data] turns it round)",
                name(i)
            ),
        ),
        Fault::Gain(i, gain) => (
            CheckKind::WrongGain,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks wrong by a factor, it should be about {gain} times as large: check its gain and unit",
                name(i)
            ),
        ),
        Fault::Swapped(i, j) => (
            CheckKind::SwappedColumns,
            None,
            Some(i),
            format!(
                "the torques of `{}` and `{}` look swapped: check the columns of the log",
                name(i),
                name(j)
            ),
        ),
        Fault::Label(run) => {
            let log = &runs[run];
            let (is, label) = if log.payload() {
                ("without", "with")
            } else {
                ("with", "without")
            };
            (
                CheckKind::PayloadLabel,
                Some(log.name().to_owned()),
                None,
                format!(
                    "the run looks like one {is} the payload, but is labelled as one {label} it"
                ),
            )
        }
    };
    Check {
        run,
        actuator: actuator.map(|index| name(index).to_owned()),
        ..Check::new(kind, About::Model, format!("{message}; {so}")).allowing(Grade::DoNotUse)
    }
}

/// The columns of the model, the payload's being there in any case.
struct Columns {
    columns: ColumnSet,
    base: BaseParameters,
    /// Places of the payload's columns among the base parameters.
    payload: Vec<usize>,
}

impl Columns {
    fn new(model: &dyn Model, settings: &Settings) -> Result<Self, Error> {
        let has_payload = !model.info().payload_parameters.is_empty();
        let columns = ColumnSet::new(
            model,
            has_payload,
            settings.asymmetric_friction,
            settings.seed,
        )?;
        let payload = if has_payload {
            PayloadUse::Separate
        } else {
            PayloadUse::Absent
        };
        let base = base_parameters(model, &columns, payload, settings.seed)?;
        let loads = columns.indices(true);
        let places = base.columns.iter().enumerate();
        let payload = places
            .filter(|(_, column)| loads.contains(column))
            .map(|(place, _)| place)
            .collect();
        Ok(Self {
            columns: columns.with_reversals(model, settings)?,
            base,
            payload,
        })
    }

    /// Goes through runs.
    fn doubt(
        &self,
        (model, runs): (&dyn Model, &[Log]),
        settings: &Settings,
        way: Way,
    ) -> Result<Doubt<'_>, Error> {
        let loaded = !model.info().payload_parameters.is_empty();
        let factors = |log: &Log| {
            let log = log.clone().with_payload(loaded);
            run_factors(model, &log, settings, self, way)
        };
        Ok(Doubt {
            columns: self,
            factors: runs.iter().map(factors).collect::<Result<_, _>>()?,
            labels: runs.iter().map(Log::payload).collect(),
            actuators: model.info().sizes.actuators,
            drives: way.drives,
        })
    }
}

/// The R factors of all runs.
struct Doubt<'a> {
    columns: &'a Columns,
    /// For each run and line, that of W and of what the drives add.
    factors: Vec<Vec<Factor>>,
    /// Whether each run is labelled as carrying the payload.
    labels: Vec<bool>,
    actuators: usize,
    drives: Drives,
}

impl Doubt<'_> {
    /// By what the columns of the drives are multiplied to add up to the inputs when a fault is taken back.
    fn share(&self, fault: Option<Fault>) -> DVector<f64> {
        let n = self.actuators;
        if self.drives == Drives::Together {
            return DVector::from_element(1, 1.0);
        }
        let mut share = DVector::zeros(n * n);
        for i in 0..n {
            let (from, gain) = match fault {
                Some(Fault::Gain(own, gain)) if own == i => (i, gain),
                Some(Fault::Swapped(a, b)) if a == i => (b, 1.0),
                Some(Fault::Swapped(a, b)) if b == i => (a, 1.0),
                _ => (i, 1.0),
            };
            share[i * n + from] = gain;
        }
        share
    }

    /// The part of the inputs that is left unexplained when a fault is taken back, each line being
    /// divided by its norm.
    fn error(&self, fault: Option<Fault>) -> f64 {
        let (all, lines) = self.stacked(fault);
        let selected: Vec<usize> = (0..self.columns.base.columns.len()).collect();
        all.smallest_residual(&selected) / f64::from(lines.max(1)).sqrt()
    }

    /// The payload's mass when a fault is taken back; none where it has none or these data do not tell it.
    fn mass(&self, fault: Fault) -> Option<f64> {
        let Columns { columns, base, .. } = self.columns;
        let is_mass = |place: &&usize| {
            let column = columns.as_slice().get(base.columns[**place]);
            column.is_some_and(|column| column.symbol == StandardParameter::M)
        };
        let place = *self.columns.payload.iter().find(is_mass)?;
        let selected: Vec<usize> = (0..base.columns.len()).collect();
        let Reduced { triangle, rhs, .. } = self.stacked(Some(fault)).0.reduced(&selected);
        let solved = triangle.solve_upper_triangular(&rhs)?;
        solved.get(place).copied().filter(|mass| mass.is_finite())
    }

    /// The factor of all lines, each divided by its norm, when a fault is taken back, and how many lines there are.
    fn stacked(&self, fault: Option<Fault>) -> (Factor, u32) {
        let p = self.columns.base.columns.len();
        let share = self.share(fault);
        let lines = self.factors.first().map_or(0, Vec::len);
        let mut stacked: Vec<DMatrix<f64>> = Vec::new();
        let mut count = 0;
        for line in 0..lines {
            let mut of_line = Vec::new();
            for (run, factors) in self.factors.iter().enumerate() {
                let r = factors[line].matrix();
                let sum = r.columns(p, share.len()) * &share;
                // Below the triangle of W only the size of the sum matters.
                let mut rows = DMatrix::zeros(p + 1, p + 1);
                rows.view_mut((0, 0), (p, p))
                    .copy_from(&r.view((0, 0), (p, p)));
                rows.view_mut((0, p), (p, 1)).copy_from(&sum.rows(0, p));
                rows[(p, p)] = sum.rows_range(p..).norm();
                let relabelled = fault == Some(Fault::Label(run));
                if self.labels[run] == relabelled {
                    for &column in &self.columns.payload {
                        rows.column_mut(column).fill(0.0);
                    }
                }
                of_line.push(rows);
            }
            let squares: f64 = of_line
                .iter()
                .map(|rows| rows.column(p).norm_squared())
                .sum();
            if squares > 0.0 {
                count += 1;
                let scale = 1.0 / squares.sqrt();
                stacked.extend(of_line.into_iter().map(|rows| rows * scale));
            }
        }
        let mut all = Factor::new(p);
        stacked.iter().for_each(|rows| all.push(rows));
        (all, count)
    }
}

/// How torques stand beside the columns of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Drives {
    /// Every J_iᵀ τ_j in a column of its own.
    OneByOne,
    /// Σ_i J_iᵀ τ_i in one column.
    Together,
}

/// How equations are made.
#[derive(Debug, Clone, Copy)]
struct Way {
    drives: Drives,
    /// How many times what gravity does is taken away: once where it does not act, twice where it is turned round.
    without_gravity: f64,
}

impl Way {
    const ONE_BY_ONE: Self = Self {
        drives: Drives::OneByOne,
        without_gravity: 0.0,
    };
    const TOGETHER: Self = Self {
        drives: Drives::Together,
        without_gravity: 0.0,
    };

    /// The same, with what gravity does taken away so many times.
    const fn without_gravity(self, times: f64) -> Self {
        Self {
            without_gravity: times,
            ..self
        }
    }
}

/// The factor of each line of a run: W, then what the drives add.
fn run_factors(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    Columns { columns, base, .. }: &Columns,
    Way {
        drives,
        without_gravity,
    }: Way,
) -> Result<Vec<Factor>, Error> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let mut motions = Motions::new(model, log, settings)?.unwatched();
    let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
    let more = match drives {
        Drives::OneByOne => n * n,
        Drives::Together => 1,
    };
    let (p, width) = (base.columns.len(), base.columns.len() + more);
    let is_heavy = |place: &usize| {
        let column = columns.as_slice().get(base.columns[*place]);
        column.is_some_and(|column| column.symbol.is_inertial())
    };
    let heavy: Vec<usize> = (0..p).filter(is_heavy).collect();
    let mut streams = (0..r)
        .map(|_| decimator.stream(width, motions.samples()))
        .collect::<Result<Vec<_>, _>>()?;
    let mut factors = vec![Factor::new(width - 1); r];
    while let Some(motion) = motions.next()? {
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let at = |error: overact::SampleError| {
                Error::from(motion.outside(first + error.sample, error.error))
            };
            let pose = slice(&motion.pose, info.sizes.pose, first, count);
            let states = [
                pose,
                slice(&motion.twist, r, first, count),
                slice(&motion.acceleration, r, first, count),
            ];
            let interval = 1.0 / motion.sampling_frequency;
            let evaluate = |states: &[&[f64]; 3]| {
                let picked = (&base.columns[..], more);
                let carried = motion.carried();
                let lines = columns.evaluate(model, states, (count, interval), carried, picked);
                lines.map_err(at)
            };
            let mut lines = evaluate(&states)?;
            if without_gravity > 0.0 {
                // At rest there is of the columns of masses what gravity does.
                let rest = vec![0.0; r * count];
                let at_rest = evaluate(&[pose, &rest, &rest])?;
                for (own, rest) in lines.iter_mut().zip(&at_rest) {
                    let rows = own.chunks_exact_mut(width).zip(rest.chunks_exact(width));
                    for (own, rest) in rows {
                        for place in heavy.iter().copied() {
                            own[place] -= without_gravity * rest[place];
                        }
                    }
                }
            }
            let mut jacobians = vec![0.0; count * n * r];
            model
                .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
                .map_err(at)?;
            let torques = slice(&motion.torques, n, first, count);
            for (line, rows) in lines.iter_mut().enumerate() {
                for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
                    let jacobian = slice(&jacobians, n * r, sample, 1);
                    let torques = slice(torques, n, sample, 1);
                    let share = |i: usize| jacobian[i * r + line];
                    if drives == Drives::Together {
                        let all = torques.iter().enumerate();
                        row[p] = all.map(|(i, torque)| share(i) * torque).sum();
                        continue;
                    }
                    let products =
                        (0..n).flat_map(|i| torques.iter().map(move |torque| share(i) * torque));
                    row[p..]
                        .iter_mut()
                        .zip(products)
                        .for_each(|(to, x)| *to = x);
                }
            }
            for ((stream, rows), factor) in streams.iter_mut().zip(&lines).zip(&mut factors) {
                let mut kept = Vec::new();
                stream.push(rows, &mut kept);
                if !kept.is_empty() {
                    factor.push_rows(&kept);
                }
            }
        }
    }
    Ok(factors)
}
