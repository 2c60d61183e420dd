//! One pass over the runs: decimated equations in the independent columns, for each projection.

use rayon::prelude::*;

use nalgebra::DMatrix;
use overact::Model;

use super::{Fields, columns::Extended};
use crate::{
    blocks::BLOCK,
    kinematics::{self, Motion},
    regression::{
        Chunk, observer,
        pass::{BlockRows, Pass, in_projections},
        projection::Projection,
        sink::LARGEST_STRETCHES,
        states::SampledStates,
        system::System,
    },
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Options of the observation, the same for all runs.
pub(super) struct Observer<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) fields: &'a Fields<'a>,
    pub(super) extended: &'a Extended,
    pub(super) settings: &'a Settings,
}

/// Rows of the field columns: for each projection and line, samples × columns.
type FieldRows = Vec<Vec<Vec<f64>>>;

impl Observer<'_> {
    /// Equations of all runs for each projection, or the reason why it has none.
    ///
    /// # Errors
    /// The problems of all runs together.
    pub(super) fn systems(
        &self,
        runs: &[Log],
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<Vec<Result<System, Error>>, Error> {
        let checked = runs
            .iter()
            .filter_map(|log| kinematics::check(self.model, log, self.settings).err());
        Error::check(checked.flat_map(|error| error.problems).collect())?;
        let info = self.model.info();
        let projections = Projection::usual(&info, &self.settings.kept_actuators);
        let observer = observer::Observer {
            model: self.model,
            columns: &self.extended.own.columns,
            base: &self.extended.own.picked,
            projections: &projections,
            settings: self.settings,
        };
        let new = |one: &Projection| Ok(System::new(one.clone(), &info, self.extended.len()));
        let mut systems: Vec<Result<System, Error>> = projections.iter().map(new).collect();
        let mut problems = Vec::new();
        for number in 0..runs.len() {
            if let Err(error) = self.run(&observer, runs, number, &mut systems, progress) {
                problems.extend(error.problems);
            }
        }
        Error::check(problems)?;
        Ok(systems)
    }

    /// Adds the equations of a run.
    fn run(
        &self,
        observer: &observer::Observer<'_>,
        runs: &[Log],
        number: usize,
        systems: &mut [Result<System, Error>],
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<(), Error> {
        let pass = Pass {
            model: self.model,
            settings: self.settings,
            log: &runs[number],
            number,
            columns: self.extended.len(),
            projections: systems.len(),
            budget: LARGEST_STRETCHES / runs.len(),
        };
        let mut failed: Vec<Option<Error>> = systems.iter().map(|_| None).collect();
        let rows = |motion: &Motion| {
            let blocks = motion.samples.div_ceil(BLOCK);
            let chunks = observer.chunks(motion, 0..blocks, &mut failed)?;
            let failed = &failed;
            let block = |(place, chunk): (usize, &Chunk)| {
                let fields = self.field_rows(observer, motion, place * BLOCK)?;
                let of_projection = |(projection, fields): (usize, Vec<Vec<f64>>)| {
                    if failed[projection].is_some() {
                        return Vec::new();
                    }
                    let lines = chunk.lines[projection].iter().zip(&fields);
                    lines
                        .map(|(rows, fields)| joined(rows, fields, chunk.samples()))
                        .collect()
                };
                Ok(fields.into_iter().enumerate().map(of_projection).collect())
            };
            let blocks = chunks.par_iter().enumerate().map(block);
            blocks.collect::<Result<Vec<BlockRows>, Error>>()
        };
        let (equations, _) = pass.equations(rows, progress)?;
        for ((system, own), failure) in systems.iter_mut().zip(equations).zip(failed) {
            match (system.as_mut(), failure) {
                (Ok(_), Some(failure)) => *system = Err(failure),
                (Ok(system), None) => system.extend(own),
                (Err(_), _) => {}
            }
        }
        Ok(())
    }

    /// Field columns of up to [`BLOCK`] samples from number `first` of the motion on.
    fn field_rows(
        &self,
        observer: &observer::Observer<'_>,
        motion: &Motion,
        first: usize,
    ) -> Result<FieldRows, Error> {
        let r = self.model.info().sizes.dof;
        let count = BLOCK.min(motion.samples - first);
        let outside =
            |error: overact::SampleError| motion.outside(first + error.sample, error.error);
        let rest = vec![0.0; count * r];
        let mut lines: Vec<Vec<f64>> = vec![Vec::new(); r];
        let mut parts: Vec<(usize, Vec<Vec<f64>>)> = Vec::new();
        for (field, own) in self.fields.along.iter().zip(&self.extended.along) {
            let states = SampledStates {
                twist: &rest,
                acceleration: &rest,
                ..SampledStates::of_motion(motion, first, count)
            };
            let rows = own
                .columns
                .evaluate(*field, &states, &own.picked, 0)
                .map_err(outside)?;
            parts.push((own.picked.len(), rows));
        }
        for (line, all) in lines.iter_mut().enumerate() {
            for sample in 0..count {
                for (width, rows) in &parts {
                    all.extend_from_slice(&rows[line][sample * width..(sample + 1) * width]);
                }
            }
        }
        let jacobians = motion.inverse_jacobians(self.model, first, count)?;
        Ok(in_projections(
            self.model,
            observer.projections,
            &lines,
            &jacobians,
        ))
    }
}

/// Rows of a line, with the field columns before Y.
fn joined(rows: &[f64], fields: &[f64], samples: usize) -> Vec<f64> {
    let (width, more) = (rows.len() / samples, fields.len() / samples);
    let mut all = Vec::with_capacity(rows.len() + fields.len());
    for sample in 0..samples {
        let (y, own) = rows[sample * width..(sample + 1) * width]
            .split_last()
            .unwrap_or((&0.0, &[]));
        all.extend_from_slice(own);
        all.extend_from_slice(&fields[sample * more..(sample + 1) * more]);
        all.push(*y);
    }
    all
}

/// A system in combinations of its columns.
pub(super) fn combined(system: &System, coefficients: &DMatrix<f64>) -> System {
    System {
        lines: system
            .lines
            .iter()
            .map(|line| line.combined(coefficients))
            .collect(),
        parts: Vec::new(),
        stretches: Vec::new(),
        phase_sums: Vec::new(),
        instruments: Vec::new(),
        ..system.clone()
    }
}
