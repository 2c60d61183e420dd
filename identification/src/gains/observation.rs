//! One pass over the runs: decimated equations [W V K | w] of all lines, and moments for the noise.
//!
//! K has the columns of the known parameters if there are several, to test whether they agree. Line
//! i of a sample is Σ_j (J_p^inv)ᵀ_ij τ_j g_j = W_i χ + w_i. The columns of V are filtered and
//! decimated like torques. As Γ¹ = (J_p^inv)ᵀ τ, noise of τ_j with variance σ_j² has the covariance
//! σ_j² J_ji J_jl in lines i and l. The `moments` are the means of J_ji J_jl over all samples.

use nalgebra::DMatrix;
use overact::Model;
use rayon::prelude::*;

use super::known::Split;
use crate::{
    blocks::{BLOCK, slice},
    kinematics::{self, Motion},
    regression::{
        factor::Factor, pass::Pass, projection::Projection, sink::LARGEST_STRETCHES,
        states::SampledStates, system::System,
    },
    settings::Settings,
};
use overact_logs::{Error, Log, Problem};

/// Equations of all runs.
#[derive(Debug)]
pub(super) struct Equations {
    /// Columns of unknown base parameters, one for each actuator, those of known parameters if there
    /// are several; w on the right.
    pub(super) system: System,
    /// Number of columns of known parameters.
    pub(super) known: usize,
    /// For each actuator j, the means of J_ji J_jl, r × r.
    pub(super) moments: Vec<DMatrix<f64>>,
}

impl Equations {
    /// Number of equations of all lines.
    pub(super) fn count(&self) -> usize {
        self.system.lines.iter().map(Factor::equations).sum()
    }
}

/// Options of the observation, the same for all runs.
pub(super) struct Observer<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) split: &'a Split,
    pub(super) settings: &'a Settings,
}

/// Some successive samples: rows line by line, and sums of J_ji J_jl.
struct Chunk {
    lines: Vec<Vec<f64>>,
    moments: Vec<DMatrix<f64>>,
}

impl Observer<'_> {
    /// Equations of all runs.
    ///
    /// `progress` gets the run, and its numbers of finished and of all samples.
    ///
    /// # Errors
    /// The problems of all runs together.
    pub(super) fn equations(
        &self,
        runs: &[Log],
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<Equations, Error> {
        let checked = runs.iter().filter_map(|log| {
            let checked = kinematics::check(self.model, log, self.settings);
            checked.err()
        });
        Error::check(checked.flat_map(|error| error.problems).collect())?;
        let info = self.model.info();
        let (r, n) = (info.sizes.dof, info.sizes.actuators);
        let mut equations = Equations {
            system: System::new(Projection::Platform, &info, self.columns()),
            known: self.known(),
            moments: vec![DMatrix::zeros(r, r); n],
        };
        let (mut samples, mut problems) = (0, Vec::new());
        for number in 0..runs.len() {
            match self.run(runs, number, &mut equations, progress) {
                Ok(count) => samples += count,
                Err(error) => problems.extend(error.problems),
            }
        }
        Error::check(problems)?;
        let scale = 1.0 / samples.max(1) as f64;
        equations.moments.iter_mut().for_each(|own| *own *= scale);
        Ok(equations)
    }

    /// Number of columns: base parameters, gains and known parameters.
    fn columns(&self) -> usize {
        self.split.base.columns.len() + self.model.info().sizes.actuators + self.known()
    }

    /// Number of columns of known parameters: none if a single one cannot be tested.
    fn known(&self) -> usize {
        match self.split.known.len() {
            0 | 1 => 0,
            several => several,
        }
    }

    /// Adds the equations of a run, and returns the number of its samples.
    fn run(
        &self,
        runs: &[Log],
        number: usize,
        equations: &mut Equations,
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<usize, Error> {
        let pass = Pass {
            model: self.model,
            settings: self.settings,
            log: &runs[number],
            number,
            columns: self.columns(),
            projections: 1,
            budget: LARGEST_STRETCHES / runs.len(),
        };
        let mut moments = Vec::new();
        let rows = |motion: &Motion| {
            let chunks: Vec<Chunk> = (0..motion.samples.div_ceil(BLOCK))
                .into_par_iter()
                .map(|index| self.chunk(motion, index * BLOCK))
                .collect::<Result<_, Error>>()?;
            let own = chunks.into_iter().map(|chunk| {
                moments.push(chunk.moments);
                vec![chunk.lines]
            });
            Ok(own.collect())
        };
        let (systems, samples) = pass.equations(rows, progress)?;
        systems
            .into_iter()
            .for_each(|own| equations.system.extend(own));
        for chunk in moments {
            let own = equations.moments.iter_mut().zip(chunk);
            own.for_each(|(all, more)| *all += more);
        }
        Ok(samples)
    }

    /// Evaluates up to [`BLOCK`] samples from number `first` of the motion on.
    fn chunk(&self, motion: &Motion, first: usize) -> Result<Chunk, Error> {
        let sizes = self.model.info().sizes;
        let (r, n) = (sizes.dof, sizes.actuators);
        let count = BLOCK.min(motion.samples - first);
        let at = |error: overact::SampleError| -> Problem {
            motion.outside(first + error.sample, error.error)
        };
        let states = SampledStates::of_motion(motion, first, count);
        let torques = slice(&motion.torques, n, first, count);
        let jacobians = motion.inverse_jacobians(self.model, first, count)?;
        let known = self.split.known.iter().map(|own| own.column);
        let base = self.split.base.columns.iter().copied();
        let picked: Vec<usize> = base.chain(known).collect();
        let evaluated = self
            .split
            .columns
            .evaluate(self.model, &states, &picked, 0)
            .map_err(at)?;
        let line = |(line, rows): (usize, Vec<f64>)| {
            let drives = jacobians
                .chunks_exact(n * r)
                .zip(torques.chunks_exact(n))
                .map(move |(jacobian, torques)| (jacobian.iter().skip(line).step_by(r), torques));
            self.joined(&rows, picked.len(), drives)
        };
        let mut moments = vec![DMatrix::zeros(r, r); n];
        for jacobian in jacobians.chunks_exact(n * r) {
            for (row, own) in jacobian.chunks_exact(r).zip(&mut moments) {
                for (i, l) in (0..r).flat_map(|i| (0..r).map(move |l| (i, l))) {
                    own[(i, l)] += row[i] * row[l];
                }
            }
        }
        Ok(Chunk {
            lines: evaluated.into_iter().enumerate().map(line).collect(),
            moments,
        })
    }

    /// Rows of a line: columns of unknown parameters, contributions of the drives, columns of known
    /// parameters, and w.
    ///
    /// `rows` have `width` columns of unknown and known parameters.
    fn joined<'v>(
        &self,
        rows: &[f64],
        width: usize,
        drives: impl Iterator<Item = (impl Iterator<Item = &'v f64>, &'v [f64])>,
    ) -> Vec<f64> {
        let unknown = self.split.base.columns.len();
        let mut all = Vec::new();
        for (row, (factors, torques)) in rows.chunks_exact(width).zip(drives) {
            let (own, known) = row.split_at(unknown);
            all.extend_from_slice(own);
            all.extend(factors.zip(torques).map(|(factor, torque)| factor * torque));
            all.extend_from_slice(&known[..self.known()]);
            let values = self.split.known.iter().map(|own| own.value);
            all.push(known.iter().zip(values).map(|(a, b)| a * b).sum());
        }
        all
    }
}
