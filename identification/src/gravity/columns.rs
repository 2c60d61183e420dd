//! Independent columns of the described robot and of fields along the axes.
//!
//! The column of each parameter is a combination of them in any gravity.

use overact::Code;
use std::collections::BTreeMap;

use nalgebra::{DMatrix, Vector3};
use overact::{Model, StandardParameter as P};

use super::Fields;
use crate::{
    estimation::base::{PayloadUse, RANK_TOLERANCE, payload_names},
    regression::{
        columns::ColumnSet,
        elimination::{Elimination, eliminate},
        states::{SampledStates, random_states},
    },
    settings::Settings,
};
use overact_logs::{Error, Load, Log, Problem};

/// Ratio of the rows of random states to the number of columns, for each combination of payloads.
const STATES: usize = 2;

/// Number of further states.
const FEWEST_STATES: usize = 20;

/// Random states.
#[derive(Debug, Clone, Copy)]
struct RandomRows {
    /// Number of states.
    count: usize,
    seed: u64,
}

/// The different payloads of runs.
fn loads(runs: &[Log]) -> Vec<Load<'_>> {
    let mut loads: Vec<Load<'_>> = Vec::new();
    for load in runs.iter().map(Log::carried) {
        if !loads.contains(&load) {
            loads.push(load);
        }
    }
    loads
}

/// Row and column of each entry, in the order of the matrix.
fn indices(matrix: &DMatrix<f64>) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (rows, columns) = matrix.shape();
    (0..columns).flat_map(move |column| (0..rows).map(move |row| (row, column)))
}

/// Selected columns of one model.
#[derive(Debug)]
pub(super) struct SelectedColumns {
    pub(super) columns: ColumnSet,
    /// Their indices, in ascending order.
    pub(super) picked: Vec<usize>,
}

/// Independent columns B: those of the described robot, then of the fields along x, y and z.
#[derive(Debug)]
pub(super) struct Extended {
    /// Columns of the robot in the described gravity.
    pub(super) own: SelectedColumns,
    /// Columns of the fields.
    pub(super) along: [SelectedColumns; 3],
    /// Names of the parameters with an effect in any gravity.
    pub(super) names: Vec<String>,
    /// B on random states, which carry the payloads of the runs in turn.
    pub(super) random: DMatrix<f64>,
    described: Vector3<f64>,
    /// Columns of all parameters as combinations of B, in the described gravity.
    at_described: DMatrix<f64>,
    /// The same for the fields.
    of_fields: [DMatrix<f64>; 3],
}

impl Extended {
    /// The columns of a robot for these runs.
    ///
    /// # Errors
    /// A model that cannot be evaluated near its home pose.
    pub(super) fn new(
        model: &dyn Model,
        fields: &Fields<'_>,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<Self, Error> {
        let payload = PayloadUse::of(&model.info(), runs)?;
        let loaded = payload != PayloadUse::Absent;
        let split = settings.asymmetric_friction;
        let own = ColumnSet::new(model, loaded, split, settings.seed)?;
        let names = payload_names(runs);
        let own = own.with_payloads(&names);
        let of_field = |field: &dyn Model| {
            let columns = ColumnSet::new(field, loaded, false, settings.seed)?;
            Ok::<_, Error>(columns.with_payloads(&names))
        };
        let along = fields.along.map(of_field);
        let [x, y, z] = along;
        let sets = [own, x?, y?, z?];
        // Set and column of each column of the wide regressor.
        let mut places: Vec<(usize, usize)> = Vec::new();
        for (set, columns) in sets.iter().enumerate() {
            let bears_weight = |column: &usize| {
                let symbol = columns.as_slice().get(*column).map(|one| one.symbol);
                let weighs = [P::M, P::Mx, P::My, P::Mz];
                set == 0 || symbol.is_some_and(|own| weighs.contains(&own))
            };
            let kept = (0..columns.len()).filter(bears_weight);
            places.extend(kept.map(|column| (set, column)));
        }
        let loads = loads(runs);
        let rows = RandomRows {
            count: loads.len() * (STATES * places.len()).div_ceil(model.info().sizes.dof.max(1))
                + FEWEST_STATES,
            seed: settings.seed,
        };
        let random = random_regressor(model, fields, &sets, &places, rows)?;
        let load = |place: &usize| {
            let (set, column) = places[*place];
            let is_load = sets[set].indices(true).contains(&column);
            is_load.then(|| sets[set].as_slice()[column].load.as_ref())
        };
        // Unloaded runs separate the columns of payloads from all others.
        let of = |own: Option<Option<&String>>| -> Vec<usize> {
            let all = 0..places.len();
            all.filter(|place| load(place) == own).collect()
        };
        let mut blocks: Vec<Vec<usize>> = if names.is_empty() {
            vec![of(Some(None))]
        } else {
            names.iter().map(|name| of(Some(Some(name)))).collect()
        };
        if payload == PayloadUse::Regrouped {
            let always = blocks.pop().unwrap_or_default();
            blocks.insert(0, [of(None), always].concat());
        } else {
            blocks.insert(0, of(None));
        }
        let found: Vec<Elimination> = blocks
            .iter()
            .map(|order| eliminate(&random, order, RANK_TOLERANCE))
            .collect();
        let mut kept: Vec<usize> = found.iter().flat_map(|one| one.kept.clone()).collect();
        kept.sort_unstable();
        let mut names: Vec<String> = Vec::new();
        for (set, column) in &places {
            let name = &sets[*set].as_slice()[*column].name;
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        let combinations = combinations(&kept, &found);
        let coefficients = |wanted: usize| {
            let mut all = DMatrix::zeros(kept.len(), names.len());
            for (place, (set, column)) in places.iter().enumerate() {
                let name = &sets[*set].as_slice()[*column].name;
                let index = names.iter().position(|one| one == name);
                if let (true, Some(index)) = (*set == wanted, index) {
                    for (row, value) in combinations.get(&place).into_iter().flatten() {
                        all[(*row, index)] = *value;
                    }
                }
            }
            all
        };
        let (at_described, of_fields) = (coefficients(0), [1, 2, 3].map(coefficients));
        let rows_of_state = model.info().sizes.dof.max(1);
        let carried = |row: usize, place: usize| {
            let (set, column) = places[kept[place]];
            let load = loads[row / rows_of_state % loads.len()];
            sets[set].as_slice()[column].counts(load)
        };
        let mut random = random.select_columns(&kept);
        for ((row, place), value) in indices(&random).zip(random.iter_mut()) {
            if !carried(row, place) {
                *value = 0.0;
            }
        }
        let picked = |set: usize, columns: ColumnSet| SelectedColumns {
            picked: kept
                .iter()
                .filter(|place| places[**place].0 == set)
                .map(|place| places[*place].1)
                .collect(),
            columns,
        };
        let [own, x, y, z] = sets;
        Ok(Self {
            own: picked(0, own.with_friction_signs(model, settings)?),
            along: [picked(1, x), picked(2, y), picked(3, z)],
            random,
            described: Vector3::from(fields.described),
            names,
            at_described,
            of_fields,
        })
    }

    /// Number of columns of B.
    pub(super) fn len(&self) -> usize {
        self.at_described.nrows()
    }

    /// Columns of all parameters in this gravity, as combinations of B.
    pub(super) fn at(&self, gravity: &Vector3<f64>) -> DMatrix<f64> {
        self.at_described.clone() + self.in_field(&(gravity - self.described))
    }

    /// Contribution of a field to the columns of all parameters, as combinations of B.
    pub(super) fn in_field(&self, field: &Vector3<f64>) -> DMatrix<f64> {
        let each = self.of_fields.iter().zip(field.iter());
        let zero = DMatrix::zeros(self.len(), self.names.len());
        each.fold(zero, |sum, (own, size)| sum + own * *size)
    }
}

/// For each non-zero column of the wide regressor, the rows and values of its combination of B.
fn combinations(kept: &[usize], found: &[Elimination]) -> BTreeMap<usize, Vec<(usize, f64)>> {
    let row: BTreeMap<usize, usize> = kept
        .iter()
        .enumerate()
        .map(|(row, one)| (*one, row))
        .collect();
    let mut all: BTreeMap<usize, Vec<(usize, f64)>> = row
        .iter()
        .map(|(one, row)| (*one, vec![(*row, 1.0)]))
        .collect();
    for (column, terms) in found.iter().flat_map(|one| &one.dependent) {
        let terms = terms
            .iter()
            .filter_map(|(on, value)| Some((*row.get(on)?, *value)));
        all.insert(*column, terms.collect());
    }
    all
}

/// All columns on random states; those of the fields at rest.
///
/// The rows of a state are divided by their largest entry, since column relations hold row by row.
fn random_regressor(
    model: &dyn Model,
    fields: &Fields<'_>,
    sets: &[ColumnSet; 4],
    places: &[(usize, usize)],
    rows: RandomRows,
) -> Result<DMatrix<f64>, Error> {
    let r = model.info().sizes.dof.max(1);
    let states = random_states(model, rows.count, rows.seed)?;
    let samples = states.samples;
    let rest = vec![0.0; states.twist.len()];
    let [x, y, z] = fields.along;
    let mut regressor = DMatrix::zeros(samples * r, places.len());
    for (set, model) in [model, x, y, z].into_iter().enumerate() {
        let mine = |place: &&(usize, usize)| place.0 == set;
        let picked: Vec<usize> = places.iter().filter(mine).map(|place| place.1).collect();
        let first = places.iter().position(|place| place.0 == set).unwrap_or(0);
        let states = match set {
            0 => states.sampled(),
            _ => SampledStates {
                twist: &rest,
                acceleration: &rest,
                ..states.sampled()
            },
        };
        let lines = sets[set]
            .evaluate(model, &states, &picked, 0)
            .map_err(|error| Error::from(Problem::new(Code::NO_EFFECT, error.to_string())))?;
        for (line, rows) in lines.iter().enumerate() {
            for (index, value) in rows.iter().enumerate() {
                let (sample, column) = (index / picked.len(), index % picked.len());
                regressor[(sample * r + line, first + column)] = *value;
            }
        }
    }
    for sample in 0..samples {
        let mut rows = regressor.rows_mut(sample * r, r);
        let largest = rows.amax();
        if largest > 0.0 {
            rows /= largest;
        }
    }
    Ok(regressor)
}
