//! Combines the factors of all runs to systems.

use nalgebra::DMatrix;
use overact::Code;
use overact::Model;

use super::{
    excluded_run::{ExcludedRun, Reason},
    run::RunFactors,
};
use crate::{
    estimation::base::{BaseParameters, PayloadUse, base_parameters, names_of_loads},
    identify::{PreparedSystem, session_numbers},
    regression::{
        columns::{ColumnSet, has_payload},
        projection::Projection,
        system::{RunEquations, RunPart, Stretch, System},
    },
    settings::Settings,
};
use overact_logs::{Error, Load, Problem};

/// Combines the factors of runs.
///
/// If a run lacks a model that others have, this is an error. With `skip_bad`, the run is left out
/// of this model and reported.
pub(super) fn restored(
    model: &dyn Model,
    runs: &[RunFactors],
    settings: &Settings,
    skip_bad: bool,
) -> Result<(PreparedSystem, Vec<ExcludedRun>), Error> {
    let info = model.info();
    let payload = payload_use(runs)?;
    if payload != PayloadUse::Absent && !has_payload(&info) {
        let message = "runs carry a payload, but the description has none";
        return Err(Problem::new(Code::FACTORS, message)
            .help("use the description of the factors")
            .into());
    }
    let columns = ColumnSet::new(
        model,
        payload != PayloadUse::Absent,
        settings.asymmetric_friction,
        settings.seed,
    )?
    .with_payloads(&names(runs));
    Error::check(settings.prior.problems(&columns.named()))?;
    let base = base_parameters(model, &columns, payload, settings.seed)?;
    let columns = columns.with_friction_signs(model, settings)?;
    let places = places(runs, &columns, &base)?;
    let projections = Projection::usual(&info, &settings.kept_actuators);
    let sessions = session_numbers(runs.iter().map(|run| run.summary.session.as_deref()));
    let (mut systems, mut left_out) = (Vec::new(), Vec::new());
    for projection in &projections {
        let system = System::new(projection.clone(), &info, base.columns.len());
        let mut system = Ok(System {
            sessions: sessions.clone(),
            ..system
        });
        for (number, (run, places)) in runs.iter().zip(&places).enumerate() {
            let own = run
                .models
                .iter()
                .find(|own| own.model == projection.model());
            let observed = match own.map(|own| (own, &own.parts)) {
                Some((own, Ok(parts))) => Ok(places.observed(number, parts, own)),
                Some((_, Err(why))) => Err(why.clone()),
                None => Err(format!(
                    "{}: the file has no factors of this model",
                    run.title()
                )),
            };
            match (observed, &mut system) {
                (Ok(observed), Ok(system)) => system.extend(observed),
                (Err(message), _) if skip_bad => left_out.push(ExcludedRun {
                    file: run.summary.name.clone(),
                    run: Some(run.title()),
                    reason: Reason::MissingModel,
                    message: format!("{}: {message}", projection.model().label()),
                }),
                (Err(message), Ok(_)) => system = Err(Problem::new(Code::FACTORS, message).into()),
                (_, Err(_)) => {}
            }
        }
        systems.push(system);
    }
    let mut prepared = PreparedSystem::new(columns, base, payload, projections, systems);
    prepared.runs = runs.iter().map(|run| run.summary.clone()).collect();
    Ok((prepared, left_out))
}

/// Treatment of the payload columns.
fn payload_use(runs: &[RunFactors]) -> Result<PayloadUse, Error> {
    let loaded = || runs.iter().filter(|run| run.summary.payload);
    let unnamed = loaded().find(|run| run.summary.payload_name.is_none());
    if let (Some(unnamed), false) = (unnamed, names(runs).is_empty()) {
        let message = "the run carries a payload without a name, others one with a name: they can't be distinguished";
        let help = "factor the logs again with the name of each payload";
        return Err(Problem::new(Code::FACTORS, message)
            .file(unnamed.title())
            .help(help)
            .into());
    }
    let loads: Vec<Load<'_>> = runs.iter().map(|run| run.summary.carried()).collect();
    PayloadUse::of_loads(&loads)
}

/// Names of the payloads, in the order of the runs.
fn names(runs: &[RunFactors]) -> Vec<String> {
    names_of_loads(runs.iter().map(|run| run.summary.carried()))
}

/// For each base parameter the column of the run; `None` if it is zero.
struct Places {
    columns: Vec<Option<usize>>,
    /// Number of the run's own columns.
    own: usize,
}

/// Columns of all runs.
fn places(
    runs: &[RunFactors],
    columns: &ColumnSet,
    base: &BaseParameters,
) -> Result<Vec<Places>, Error> {
    let all = columns.as_slice();
    let loads = columns.indices(true);
    let (mut places, mut problems) = (Vec::new(), Vec::new());
    for run in runs {
        let mut own = Vec::new();
        for column in &base.columns {
            let Some(wanted) = all.get(*column) else {
                continue;
            };
            let found = run.columns.iter().position(|name| *name == wanted.name);
            let carried = match (&wanted.load, &run.summary.payload_name) {
                (Some(load), Some(label)) => Load::Named(label).contains(load),
                (Some(_), None) => false,
                (None, _) => run.summary.payload,
            };
            own.push(if loads.contains(column) && !carried {
                None
            } else {
                found
            });
            if found.is_none() && (carried || !loads.contains(column)) {
                let message = format!("the factors have no column `{}`", wanted.name);
                let help = "factor the log again with this program";
                problems.push(
                    Problem::new(Code::FACTORS, message)
                        .file(run.title())
                        .help(help),
                );
            }
        }
        places.push(Places {
            columns: own,
            own: run.columns.len(),
        });
    }
    Error::check(problems)?;
    Ok(places)
}

impl Places {
    /// Equations of a run for the common columns.
    fn observed(
        &self,
        number: usize,
        parts: &[RunPart],
        own: &super::run::ModelFactors,
    ) -> RunEquations {
        let same = self.columns.len() == self.own;
        let same = same
            && self
                .columns
                .iter()
                .enumerate()
                .all(|(at, own)| *own == Some(at));
        let pick = DMatrix::from_fn(self.own, self.columns.len(), |row, column| {
            f64::from(u8::from(self.columns[column] == Some(row)))
        });
        let part = |part: &RunPart| RunPart {
            run: number,
            lines: if same {
                part.lines.clone()
            } else {
                part.lines.iter().map(|line| line.combined(&pick)).collect()
            },
        };
        let stretch = |stretch: &Stretch| Stretch {
            run: number,
            lines: stretch.lines.iter().map(|rows| self.rows(rows)).collect(),
            instruments: Vec::new(),
        };
        RunEquations {
            parts: parts.iter().map(part).collect(),
            stretches: own.stretches.iter().map(stretch).collect(),
            partition: own.partition.clone(),
            ..RunEquations::default()
        }
    }

    /// Rows in the common columns.
    fn rows(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(rows.nrows(), self.columns.len() + 1);
        for (to, from) in self.columns.iter().enumerate() {
            if let Some(from) = from {
                all.set_column(to, &rows.column(*from));
            }
        }
        all.set_column(self.columns.len(), &rows.column(self.own));
        all
    }
}
