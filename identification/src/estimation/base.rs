//! Base parameters, by QR without pivoting in the symmetric order (43), section 4.1 of the paper.
//!
//! Columns are ordered platform first, then by body and symbol for all legs together, so that equal
//! legs keep equal parameters. Columns that the functions of base parameters keep
//! ([`Model::base_columns`]) precede all others. The base parameters are then the inputs of these
//! functions, and one name means one sum. The rank is determined on random states without noise: it
//! is a property of the robot, not of the data.
//!
//! With loaded and unloaded runs, the payload columns are an independent block (49). With loaded
//! runs only, they are regrouped into the platform's.
//!
//! A deleted column d is W_d = Σ_k c_dk W_k, so the base parameter k is χ_k + Σ_d c_dk χ_d.

use overact::Code;
use std::collections::BTreeMap;

use nalgebra::DMatrix;
use overact::{Body, Info, Model, StandardParameter};

use crate::regression::{
    columns::{Column, ColumnSet, Direction, has_payload, load_of},
    elimination::{Elimination, eliminate},
    states::random_states,
};
use overact_logs::{Error, Load, Log, Problem, carried_payloads};

/// A column is dependent if its part outside the kept ones is below this fraction of its norm.
pub(crate) const RANK_TOLERANCE: f64 = 1e-9;

/// Treatment of the payload columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PayloadUse {
    /// No run carries the payload.
    Absent,
    /// Some runs carry it and some do not: an independent block (49).
    Separate,
    /// All runs carry it: it cannot be separated from the platform.
    Regrouped,
}

impl PayloadUse {
    /// Determines how the runs carry the payload.
    ///
    /// # Errors
    /// No run, runs with a payload that the model lacks, or payloads that the runs do not
    /// distinguish.
    pub(crate) fn of(info: &Info<'_>, runs: &[Log]) -> Result<Self, Error> {
        check_payloads(info, runs)?;
        let of_bodies = info
            .payload_parameters
            .iter()
            .any(|one| load_of(one).is_some());
        let loads: Vec<Load<'_>> = runs.iter().map(Log::carried).collect();
        let own = Self::of_loads(&loads)?;
        if of_bodies && own == Self::Regrouped && payload_names(runs).len() > 1 {
            let message = "all runs carry a payload, and the payloads are on bodies of their own: none of them can be distinguished from its body";
            let help = "record a run without payload, or identify the payloads one by one";
            return Err(Problem::new(Code::LOG_PAYLOAD, message).help(help).into());
        }
        Ok(own)
    }

    /// Determines how runs with these loads carry payloads.
    ///
    /// The torques of a run are those of the robot and of each carried payload. They are separate if
    /// the labels, as rows of a 1 for the robot and one for each carried payload, have full rank.
    ///
    /// # Errors
    /// Payloads that the labels do not distinguish from each other, or from the robot.
    pub fn of_loads(runs: &[Load<'_>]) -> Result<Self, Error> {
        let loaded = runs.iter().filter(|run| run.is_some()).count();
        let names = names_of_loads(runs.iter().copied());
        if loaded == 0 {
            return Ok(Self::Absent);
        }
        if names.is_empty() {
            let all = loaded == runs.len();
            return Ok(if all { Self::Regrouped } else { Self::Separate });
        }
        let carried = |row: usize, column: usize| {
            let is_carried = column == 0 || runs[row].contains(&names[column - 1]);
            f64::from(u8::from(is_carried))
        };
        let rows = DMatrix::from_fn(runs.len(), names.len() + 1, carried);
        if rows.rank(RANK_TOLERANCE) > names.len() {
            return Ok(Self::Separate);
        }
        let mut all = runs.iter();
        if loaded == runs.len() && all.all(|run| names_of_loads([*run].into_iter()).len() == 1) {
            return Ok(Self::Regrouped);
        }
        let message = format!(
            "the runs do not distinguish the payloads {} from each other and from the robot",
            names.join(", ")
        );
        let help = "record a run without payload and one with each payload alone, or describe payloads that are always carried together as one, and one that all runs carry as a part of its body";
        Err(Problem::new(Code::LOG_PAYLOAD, message).help(help).into())
    }
}

/// Checks that there are runs, and that the model has the payloads that they carry.
///
/// # Errors
/// No run, named and unnamed payloads, or runs with a payload that the model lacks.
pub(crate) fn check_payloads(info: &Info<'_>, runs: &[Log]) -> Result<(), Error> {
    if runs.is_empty() {
        return Err(
            Problem::new(Code::NOTHING_DETERMINED, "there is no training run")
                .help("give at least one log with --data, or runs in [[experiment.run]]")
                .into(),
        );
    }
    let loaded = || runs.iter().filter(|log| log.payload());
    let unnamed = loaded().find(|log| log.payload_name().is_none());
    let named = loaded().find_map(Log::payload_name);
    if let (Some(unnamed), Some(named)) = (unnamed, named) {
        let message = format!(
            "the run carries a payload without a name, another one the payload `{named}`: they can't be distinguished"
        );
        let help = "name the payload of each run";
        return Err(Problem::new(Code::LOG_PAYLOAD, message)
            .file(unnamed.name())
            .help(help)
            .into());
    }
    if has_payload(info) {
        return Ok(());
    }
    let problem = |log: &Log| {
        Problem::new(
            Code::LOG_PAYLOAD,
            format!(
                "the run carries a payload, but the description of `{}` has none",
                info.name
            ),
        )
        .file(log.name())
        .help("describe the payload in [platform.payload], or declare the run unloaded")
    };
    Error::check(loaded().map(problem).collect())
}

/// Base parameters of a column set.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct BaseParameters {
    /// Kept columns, in the symmetric order.
    pub columns: Vec<usize>,
    /// For each kept column, the deleted columns regrouped into it and their coefficients.
    pub regroupings: Vec<Vec<(usize, f64)>>,
    /// Columns that have no effect on the model.
    pub without_effect: Vec<usize>,
    /// Names of the kept parameters, with the suffix `R` if others are regrouped into them.
    pub names: Vec<String>,
}

impl BaseParameters {
    /// Base parameters from standard parameters by name; `None` if a required value is missing.
    #[must_use]
    pub fn regrouped(
        &self,
        columns: &ColumnSet,
        values: &BTreeMap<String, f64>,
    ) -> Vec<Option<f64>> {
        let all = columns.as_slice();
        let value = |index: usize| all.get(index).and_then(|column| true_value(column, values));
        self.columns
            .iter()
            .zip(&self.regroupings)
            .map(|(&kept, regrouping)| {
                regrouping
                    .iter()
                    .try_fold(value(kept)?, |sum, &(deleted, coefficient)| {
                        Some(sum + coefficient * value(deleted)?)
                    })
            })
            .collect()
    }
}

/// Value of a column's parameter.
///
/// With friction split by direction, both directions have fv, and fs plus or minus the offset.
fn true_value(column: &Column, values: &BTreeMap<String, f64>) -> Option<f64> {
    if let Some(value) = values.get(&column.name) {
        return Some(*value);
    }
    let value = values.get(&column.standard).copied()?;
    match (column.direction, column.symbol) {
        (Some(direction), StandardParameter::Fs) => {
            let offset = column
                .standard
                .strip_prefix(StandardParameter::Fs.name())
                .and_then(|rest| values.get(&format!("{}{rest}", StandardParameter::Off.name())))
                .copied()
                .unwrap_or(0.0);
            Some(match direction {
                Direction::Positive => value + offset,
                Direction::Negative => value - offset,
            })
        }
        _ => Some(value),
    }
}

/// Finds the base parameters of a model's columns on random states drawn with `seed`.
///
/// # Errors
/// A model that cannot be evaluated near its home pose, or one without parameters.
pub fn base_parameters(
    model: &dyn Model,
    columns: &ColumnSet,
    payload: PayloadUse,
    seed: u64,
) -> Result<BaseParameters, Error> {
    let regressor = random_regressor(model, columns, seed)?;
    let mut base = BaseParameters::default();
    for order in blocks(model, columns, payload) {
        let found = eliminate(&regressor, &order, RANK_TOLERANCE);
        collect(&mut base, columns, found);
    }
    if payload == PayloadUse::Regrouped {
        relative(&mut base, columns);
    }
    if base.columns.is_empty() {
        return Err(Problem::new(
            Code::NO_EFFECT,
            format!(
                "no parameter of `{}` has an effect on its model",
                model.info().name
            ),
        )
        .help("list `parameters` of bodies and joints in the description")
        .into());
    }
    Ok(base)
}

/// Columns that a column is a linear combination of; `None` if it is independent of all others.
pub(crate) type Combination = Option<Vec<usize>>;

/// Base parameters of the columns not in `known`, and the combination of each known column.
///
/// The combination is `None` if the known column is outside the span of the others. Data then
/// separate its contribution from theirs.
///
/// # Errors
/// A model that cannot be evaluated near its home pose.
pub(crate) fn base_parameters_with_known(
    model: &dyn Model,
    columns: &ColumnSet,
    payload: PayloadUse,
    known: &[usize],
    seed: u64,
) -> Result<(BaseParameters, Vec<Combination>), Error> {
    let regressor = random_regressor(model, columns, seed)?;
    let mut base = BaseParameters::default();
    let mut combinations = vec![Some(Vec::new()); known.len()];
    let several = payload == PayloadUse::Regrouped && columns.loads().len() > 1;
    for order in blocks(model, columns, payload) {
        let (own, mut unknown): (Vec<usize>, Vec<usize>) =
            order.into_iter().partition(|column| known.contains(column));
        let found = eliminate(&regressor, &unknown, RANK_TOLERANCE);
        collect(&mut base, columns, found);
        for column in own {
            unknown.push(column);
            let found = eliminate(&regressor, &unknown, RANK_TOLERANCE);
            unknown.pop();
            let mut dependent = found.dependent.into_iter();
            let others = dependent.find(|(one, _)| *one == column);
            let others = others.map(|(_, terms)| terms.into_iter().map(|(one, _)| one).collect());
            let place = known.iter().position(|one| *one == column);
            if let Some(place) = place.and_then(|place| combinations.get_mut(place)) {
                let is_load = columns.indices(true).contains(&column);
                *place = if found.zero.contains(&column) {
                    Some(Vec::new())
                } else if several && is_load {
                    // It is relative to the payload that is always present, which has no column of
                    // its own.
                    Some(columns.loads().concat())
                } else {
                    others
                };
            }
        }
    }
    if several {
        relative(&mut base, columns);
    }
    Ok((base, combinations))
}

/// Columns in the order of elimination, in blocks that are independent of each other.
///
/// Columns of the robot are in the symmetric order, those of the base functions first.
fn blocks(model: &dyn Model, columns: &ColumnSet, payload: PayloadUse) -> Vec<Vec<usize>> {
    let robot = symmetric_order(columns, columns.indices(false));
    let of_functions = model.base_columns();
    let is_of_functions = |index: &usize| {
        let column = columns.as_slice().get(*index);
        column.is_some_and(|own| of_functions.contains(&own.standard.as_str()))
    };
    let (first, others): (Vec<usize>, Vec<usize>) = robot.into_iter().partition(is_of_functions);
    let robot = [first, others].concat();
    let loads = columns.loads().into_iter();
    let mut loads: Vec<Vec<usize>> = loads.map(|own| symmetric_order(columns, own)).collect();
    if payload == PayloadUse::Regrouped {
        // One payload is always present; the others are relative to it.
        let always = loads.pop().unwrap_or_default();
        loads.insert(0, [robot, always].concat());
    } else {
        loads.insert(0, robot);
    }
    loads
}

/// Makes payload parameters relative to the last payload, if one is always present.
///
/// The last payload is regrouped into the robot.
fn relative(base: &mut BaseParameters, columns: &ColumnSet) {
    let mut loads = columns.loads();
    let always = loads.pop().unwrap_or_default();
    let all = columns.as_slice();
    let counterpart = |index: usize| {
        let mut same = always.iter();
        same.find(|other| all[**other].symbol == all[index].symbol)
            .copied()
    };
    for (place, kept) in base.columns.iter().enumerate() {
        if !loads.iter().any(|own| own.contains(kept)) {
            continue;
        }
        let terms = base.regroupings[place].iter().copied();
        let more: Vec<(usize, f64)> = terms
            .chain([(*kept, 1.0)])
            .filter_map(|(index, coefficient)| Some((counterpart(index)?, -coefficient)))
            .collect();
        if base.regroupings[place].is_empty() && !more.is_empty() {
            base.names[place].push('R');
        }
        base.regroupings[place].extend(more);
    }
}

/// Names of the payloads that runs carry, in the order of the runs; empty without names.
pub(crate) fn payload_names(runs: &[Log]) -> Vec<String> {
    names_of_loads(runs.iter().map(Log::carried))
}

/// Names of the payloads of loads, in their order; empty without names.
pub fn names_of_loads<'a>(loads: impl Iterator<Item = Load<'a>>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in loads.filter_map(Load::name).flat_map(carried_payloads) {
        if !names.iter().any(|one| one == name) {
            names.push(name.to_owned());
        }
    }
    names
}

/// Adds the result of one block to the base parameters.
fn collect(base: &mut BaseParameters, columns: &ColumnSet, found: Elimination) {
    for kept in symmetric_order(columns, found.kept) {
        let regrouping: Vec<(usize, f64)> = found
            .dependent
            .iter()
            .flat_map(|(deleted, coefficients)| {
                coefficients
                    .iter()
                    .filter(|(column, _)| *column == kept)
                    .map(|(_, coefficient)| (*deleted, *coefficient))
            })
            .collect();
        let name = columns
            .as_slice()
            .get(kept)
            .map_or("", |column| column.name.as_str());
        let suffix = if regrouping.is_empty() { "" } else { "R" };
        base.names.push(format!("{name}{suffix}"));
        base.columns.push(kept);
        base.regroupings.push(regrouping);
    }
    base.without_effect.extend(found.zero);
}

/// Sorts columns as in eq. (43): platform, body, symbol, direction, equal legs, payload.
fn symmetric_order(columns: &ColumnSet, mut indices: Vec<usize>) -> Vec<usize> {
    indices.sort_by_key(|&index| {
        columns.as_slice().get(index).map(|column| {
            let direction = column.direction;
            match column.body {
                Body::Platform => (0, 0, column.symbol, direction, 0, 0),
                Body::Leg { leg, index, shape } => (1, index, column.symbol, direction, shape, leg),
                Body::Spring { index } => (1, u16::MAX, column.symbol, direction, 0, index),
                Body::Motor { index } => (1, u16::MAX, column.symbol, direction, 1, index),
                Body::Payload => (2, 0, column.symbol, direction, 0, 0),
            }
        })
    });
    indices
}

/// Regressor on random states, (states r) × columns.
///
/// The rows of a state are divided by their largest entry, so that states near a singularity do not
/// dominate. Relations between columns hold in each row, so this does not change them.
fn random_regressor(
    model: &dyn Model,
    columns: &ColumnSet,
    seed: u64,
) -> Result<DMatrix<f64>, Error> {
    let r = model.info().sizes.dof.max(1);
    let count = (3 * columns.len()).div_ceil(r) + 20;
    let states = random_states(model, count, seed)?;
    let (samples, width) = (states.samples, columns.len());
    let all: Vec<usize> = (0..width).collect();
    let lines = columns
        .evaluate(model, &states.sampled(), &all, 0)
        .map_err(|error| Error::from(Problem::new(Code::NO_EFFECT, error.to_string())))?;
    let mut regressor = DMatrix::zeros(samples * r, width);
    for sample in 0..samples {
        let rows = || {
            lines
                .iter()
                .map(|line| &line[sample * width..(sample + 1) * width])
        };
        let largest = rows()
            .flatten()
            .fold(0.0_f64, |m, value| m.max(value.abs()));
        if largest > 0.0 {
            for (line, row) in rows().enumerate() {
                let mut place = regressor.row_mut(sample * r + line);
                let scaled = row.iter().map(|value| value / largest);
                place
                    .iter_mut()
                    .zip(scaled)
                    .for_each(|(to, value)| *to = value);
            }
        }
    }
    Ok(regressor)
}
