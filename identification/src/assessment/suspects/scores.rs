//! One pass over the beginnings of the runs. What is kept does not grow with the data.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use overact::{Function, Model};
use rayon::prelude::*;

use super::{
    accused::Accused,
    beside::Beside,
    columns::{Layout, Sample, Suspect, moments, rates, suspects},
    nearby::{Misreading, Nearby},
    pairs::{Correlation, correlations},
    scaled::{Scaled, told},
    sections::{Frame, RunScores, Sink, Tempo},
    shapes::{Reach, Shape},
};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    data::{Log, Variant, periods::Return},
    error::Error,
    estimation::returning::Mean,
    filters::{DECIMATION_PADDING, Decimation},
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
        distribution::{least_norm, product},
    },
    regression::{
        chunk::projected,
        columns::{ColumnSet, Reversal},
        fold::{Folds, Phases},
        projection::ModelKind,
    },
    result::Estimate,
    settings::Settings,
};

/// Samples of all runs together that are gone through, at most.
const MOST_SAMPLES: usize = 100_000;

/// The band of the equations is so many times narrower than that of the estimate. Errors of positions come in
/// as accelerations and rates of torques, by a power that grows with the fifth power of the band.
const NARROWER: usize = 2;

/// Equations for each column of the model, at least: below, they are decimated less.
const LEAST_EQUATIONS: usize = 4;

/// What all runs tell.
#[derive(Debug, Clone)]
pub(crate) struct Scores {
    /// The suspects, and the names of the payload's parameters, each of which is a suspect in each run.
    pub(crate) suspects: Vec<Suspect>,
    pub(crate) payload: Vec<String>,
    /// Where their columns stand.
    pub(super) layout: Layout,
    /// Places of the estimate's parameters among the base parameters.
    pub(super) selected: Vec<usize>,
    /// Columns of dry friction that is late, which stand behind the base parameters', as far as the data tell
    /// them.
    pub(super) late: Vec<usize>,
    /// What each run tells.
    pub(super) runs: Vec<RunScores>,
    /// Motions that return, each with the runs that have it.
    pub(super) means: Vec<(Vec<usize>, Mean)>,
    /// What was found beside the estimate's own columns.
    pub(super) own: Found,
}

/// What tests beside the estimate's own columns have in common, and all of them, once one was asked for.
#[derive(Debug, Clone, Default)]
pub(super) struct Found {
    pub(super) beside: OnceLock<Option<Beside>>,
    pub(super) accused: OnceLock<Vec<Option<Accused>>>,
}

/// What a pass needs.
struct Pass<'a> {
    model: &'a dyn Model,
    variants: &'a [Variant<'a>],
    columns: &'a ColumnSet,
    base: &'a [usize],
    /// Places of the columns of dry friction among the base parameters.
    friction: &'a [usize],
    kind: ModelKind,
    frame: Frame<'a>,
    /// One sample in so many is kept.
    decimation: usize,
    settings: &'a Settings,
}

/// Goes through the runs with an estimate of all base parameters; `reaches` are those of the actuators.
///
/// # Errors
/// As [`Motions::next`]; the runs have been gone through before.
pub(crate) fn scores(
    model: &dyn Model,
    (runs, variants): (&[Log], &[Variant<'_>]),
    (columns, base): (&ColumnSet, &[usize]),
    (estimate, reaches): (&Estimate, &[Reach]),
    (settings, returns): (&Settings, &[Option<Return>]),
) -> Result<Scores, Error> {
    let suspects = suspects(model, variants.len(), estimate.model);
    let payload = model.info().payload_parameters;
    let friction = coulomb(columns, base);
    let layout = Layout::new(base.len() + friction.len(), &suspects, payload.len());
    let mut values = vec![0.0; layout.base];
    for parameter in &estimate.parameters {
        values[parameter.column] = parameter.value;
    }
    let most = (MOST_SAMPLES / runs.len().max(1)).max(settings.samples_needed());
    let beginning = |log: &Log| log.beginning(most.min(log.samples()));
    let runs: Vec<Log> = runs.iter().map(beginning).collect::<Result<_, _>>()?;
    let narrower = narrower(&runs, settings, (layout.base, model.info().sizes.dof));
    let pass = Pass {
        model,
        variants,
        columns,
        base,
        friction: &friction,
        kind: estimate.model,
        frame: Frame {
            suspects: &suspects,
            layout: &layout,
            reaches,
            weights: &estimate.weights,
            values: &values,
        },
        decimation: settings.decimation * narrower,
        settings,
    };
    let phases = |number: usize| {
        let motion = returns.get(number).copied().flatten();
        motion.and_then(|motion| Phases::new(motion, pass.decimation))
    };
    let scores = runs
        .par_iter()
        .enumerate()
        .map(|(number, log)| pass.run(log, phases(number)))
        .collect::<Result<Vec<_>, Error>>()?;
    let selected = estimate.columns();
    Ok(Scores {
        late: late(&layout, &scores, (&selected, base.len())),
        payload: payload.iter().map(|one| one.name.to_owned()).collect(),
        layout,
        selected,
        means: means(&scores),
        runs: scores,
        suspects,
        own: Found::default(),
    })
}

/// The motions that return.
fn means(runs: &[RunScores]) -> Vec<(Vec<usize>, Mean)> {
    let mut all: Vec<(Vec<usize>, Folds)> = Vec::new();
    for (number, run) in runs.iter().enumerate() {
        let motion = |folds: &Folds| folds.first().map(|fold| fold.phases.motion);
        if run.folds.is_empty() {
            continue;
        }
        let same = |one: &&mut (Vec<usize>, Folds)| motion(&one.1) == motion(&run.folds);
        match all.iter_mut().find(same) {
            Some((runs, folds)) => {
                runs.push(number);
                let both = folds.iter_mut().zip(&run.folds);
                both.for_each(|(all, own)| all.merge(own));
            }
            None => all.push((vec![number], run.folds.clone())),
        }
    }
    let split = |_, rows: DMatrix<f64>| {
        let last = rows.ncols() - 1;
        (
            rows.columns(0, last).clone_owned(),
            rows.column(last).clone_owned(),
        )
    };
    let mean = |(runs, folds): (Vec<usize>, Folds)| Some((runs, Mean::new(&folds, split)?));
    all.into_iter().filter_map(mean).collect()
}

/// By how many times narrower the band of the equations is than that of the estimate, for a model of so
/// many columns and lines.
fn narrower(runs: &[Log], settings: &Settings, (columns, lines): (usize, usize)) -> usize {
    let kept = |log: &Log| log.samples() - settings.skip_start - settings.skip_end;
    if runs.iter().any(|log| kept(log) <= DECIMATION_PADDING) {
        return 1;
    }
    let samples: usize = runs.iter().map(kept).sum();
    let equations = samples * lines / settings.decimation;
    (equations / (LEAST_EQUATIONS * columns).max(1)).clamp(1, NARROWER)
}

/// Places of the columns of dry friction among the base parameters.
fn coulomb(columns: &ColumnSet, base: &[usize]) -> Vec<usize> {
    let is_coulomb = |column: usize| {
        let column = columns.as_slice().get(column);
        column.is_some_and(|column| column.symbol.has_sign())
    };
    let places = base.iter().enumerate();
    let places = places.filter(|(_, column)| is_coulomb(**column));
    places.map(|(place, _)| place).collect()
}

/// The columns behind the `base` ones that the runs tell from those `selected`, and from each other.
fn late(layout: &Layout, runs: &[RunScores], (selected, base): (&[usize], usize)) -> Vec<usize> {
    let late: Vec<usize> = (base..layout.base).collect();
    let sum = |rows: &[usize], columns: &[usize]| {
        let start = DMatrix::zeros(rows.len(), columns.len());
        runs.iter().fold(start, |sum, run| {
            sum + run
                .cross(layout, 0)
                .select_rows(rows)
                .select_columns(columns)
        })
    };
    let Some(gram) = Scaled::new(&sum(selected, selected)) else {
        return Vec::new();
    };
    let (cross, square) = (sum(selected, &late), sum(&late, &late));
    let outside = &square - cross.tr_mul(&gram.solve(&cross));
    let places = told(&outside, &square).into_iter();
    places.map(|place| late[place]).collect()
}

impl Scores {
    /// How the residuals of all pairs of actuators hang together, as far as the motion tells.
    pub(crate) fn correlations(&self) -> Vec<Correlation> {
        // Where all actuators are kept and needed the lines are theirs.
        let lines = self.runs.first().map_or(0, |run| run.lines);
        let equations: usize = self.runs.iter().map(|run| run.equations).sum();
        let instants = equations as f64 / lines.max(1) as f64;
        let returning = |(first, second): (usize, usize)| {
            let means = self.means.iter().map(|(_, mean)| mean);
            let sums = means.map(|mean| mean.product(first, second));
            let [sum, scatter] = sums.fold([0.0; 2], |all, own| [all[0] + own[0], all[1] + own[1]]);
            [sum / instants.powi(2), scatter / instants.powi(4)]
        };
        let runs = self.runs.iter().map(|run| (&run.pairs, run.cosines));
        correlations(runs, &returning)
    }

    /// The mean of λ² e² over all equations, of errors e that come from white noise of the torques, given its
    /// variance for each run and actuator at the full rate, of which decimation leaves the part `passed`.
    pub(crate) fn noise(&self, variances: &[Vec<f64>], passed: f64) -> f64 {
        let offset = |actuator: usize| {
            let wanted = Suspect::Torque(actuator, Shape::Constant);
            self.suspects.iter().position(|one| *one == wanted)
        };
        let (mut noise, mut equations) = (0.0, 0);
        for (run, variances) in self.runs.iter().zip(variances) {
            equations += run.equations;
            for (actuator, variance) in variances.iter().enumerate() {
                // Σ λ² J² over all equations.
                let shares = offset(actuator).map(|k| run.own(&self.layout, k, 0)[(0, 0)]);
                noise += shares.unwrap_or(0.0) * variance * passed;
            }
        }
        noise / equations.max(1) as f64
    }
}

impl Pass<'_> {
    /// Columns of a row: the base parameters', Y, the suspects' of one column each, the payload's.
    fn width(&self) -> usize {
        self.frame.layout.decimated + 1
    }

    fn run(&self, log: &Log, phases: Option<Phases>) -> Result<RunScores, Error> {
        let lines = self.model.info().sizes.dof;
        let mut motions = Motions::new(self.model, log, self.settings)?.unwatched();
        let decimator = self
            .settings
            .decimator(self.decimation, log.sampling_frequency())?;
        let samples = motions.samples();
        let mut streams: Vec<Decimation> = (0..lines)
            .map(|_| decimator.stream(self.width(), samples))
            .collect::<Result<_, _>>()?;
        let actuators = self.model.info().sizes.actuators;
        let mut places = decimator.stream(actuators, samples)?;
        let mut sink = Sink::new(self.frame, decimator.kept(samples), phases);
        let frequency = log.sampling_frequency();
        let mut tempo = Tempo {
            start: self.settings.skip_start as f64 / frequency,
            interval: self.decimation as f64 / frequency,
            velocities: vec![0.0; actuators],
            accelerations: vec![0.0; actuators],
        };
        let mut rows = vec![Vec::new(); lines];
        while let Some(motion) = motions.next()? {
            let jacobians = self.jacobians(&motion)?;
            let positions = self.rows(&motion, &jacobians, &mut tempo, &mut rows)?;
            let projected = self.projected(&rows, &jacobians);
            let rows = projected.as_ref().unwrap_or(&rows);
            let mut kept: Vec<Vec<f64>> = vec![Vec::new(); lines];
            let all = streams.par_iter_mut().zip(&mut kept).zip(rows);
            all.for_each(|((stream, kept), rows)| stream.push(rows, kept));
            let mut at = Vec::new();
            places.push(&positions, &mut at);
            sink.take(&kept, &at);
        }
        Ok(sink.told(tempo))
    }

    /// J_p^inv at all samples of a motion, n x r each.
    fn jacobians(&self, motion: &Motion) -> Result<Vec<f64>, Error> {
        let inputs: [&[f64]; 1] = [&motion.pose];
        evaluate(
            self.model,
            Function::InverseJacobian,
            &inputs,
            motion.samples,
        )
        .map_err(|error| motion.outside(error.sample, error.error).into())
    }

    /// The rows of all samples of a motion, line by line of Γ¹, in the place of those of another one; gives the
    /// positions of the actuators, whose motion is noted.
    fn rows(
        &self,
        motion: &Motion,
        jacobians: &[f64],
        tempo: &mut Tempo,
        lines: &mut [Vec<f64>],
    ) -> Result<Vec<f64>, Error> {
        let info = self.model.info();
        let (n, r) = (info.sizes.actuators, info.sizes.dof);
        let at =
            |error: overact::SampleError| Error::from(motion.outside(error.sample, error.error));
        let ask = |function: Function, inputs: &[&[f64]]| {
            evaluate(self.model, function, inputs, motion.samples).map_err(at)
        };
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let positions = ask(Function::ActuatorPositions, &states[..1])?;
        let payload = match info.sizes.payload_parameters {
            0 => Vec::new(),
            _ => ask(Function::IdmRedPayload, &states)?,
        };
        let (layout, p) = (self.frame.layout, self.base.len());
        let more = self.width() - p;
        for rows in &mut *lines {
            rows.clear();
            rows.reserve_exact(motion.samples * self.width());
        }
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let states = [
                slice(&motion.pose, info.sizes.pose, first, count),
                slice(&motion.twist, r, first, count),
                slice(&motion.acceleration, r, first, count),
            ];
            let interval = 1.0 / motion.sampling_frequency;
            let rows = self
                .columns
                .evaluate(
                    self.model,
                    &states,
                    (count, interval),
                    motion.carried(),
                    (self.base, more),
                )
                .map_err(at)?;
            lines
                .iter_mut()
                .zip(rows)
                .for_each(|(all, rows)| all.extend(rows));
        }
        for (to, from) in self.friction.iter().enumerate() {
            for rows in &mut *lines {
                let column = rows.iter().skip(*from).step_by(self.width());
                let column: Vec<f64> = column.copied().collect();
                let late = rates(&column, 1, motion.sampling_frequency);
                let places = rows.iter_mut().skip(p + to).step_by(self.width());
                places.zip(late).for_each(|(place, rate)| *place = -rate);
            }
        }
        let [torques, smooth] = self.inputs(motion, jacobians, lines);
        let torque_rates = rates(&torques, n, motion.sampling_frequency);
        let slopes = rates(&smooth, n, motion.sampling_frequency);
        let torque_bends = rates(&slopes, n, motion.sampling_frequency);
        let nearby = Nearby {
            model: self.model,
            columns: self.columns,
            base: self.base,
            values: self.frame.values,
        };
        let [velocities, accelerations] = nearby.actuators(motion, jacobians)?;
        tempo.take([&velocities, &accelerations]);
        let signals: [&[f64]; 4] = [&positions, &velocities, &accelerations, &torques];
        let actuators = moments((motion, Reversal::new(self.settings)), signals);
        let clock = nearby.clock(motion)?;
        let moved = self
            .frame
            .suspects
            .iter()
            .any(|one| matches!(one, Suspect::Offset(_)));
        let misread = match moved {
            true => nearby.misread(motion, (&torques, jacobians), &actuators, &Misreading::ALL)?,
            false => Vec::new(),
        };
        let width = self.width();
        let lengths = nearby.lengths(motion, self.variants)?;
        let own = layout.base + 1;
        for sample in 0..motion.samples {
            let here = Sample {
                jacobian: slice(jacobians, n * r, sample, 1),
                torques: slice(&torques, n, sample, 1),
                torque_rates: slice(&torque_rates, n, sample, 1),
                torque_bends: slice(&torque_bends, n, sample, 1),
                actuators: &actuators[sample * n..(sample + 1) * n],
                reaches: self.frame.reaches,
                pose: slice(&motion.pose, info.sizes.pose, sample, 1),
                clock: slice(&clock, r, sample, 1),
                misread: slice(&misread, Misreading::ALL.len() * n * r, sample, 1),
                lengths: slice(&lengths, self.variants.len() * r, sample, 1),
            };
            // Waves, which come last, are made of decimated positions.
            let narrow = self
                .frame
                .suspects
                .iter()
                .take(layout.decimated - layout.base);
            let factors: Vec<f64> = narrow.map(|suspect| here.factor(*suspect)).collect();
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let narrow = row.len() - own - self.model.info().sizes.payload_parameters;
                let (suspects, load) = row[own..].split_at_mut(narrow);
                let all = self.frame.suspects.iter().zip(&factors);
                for (to, (suspect, factor)) in suspects.iter_mut().zip(all) {
                    *to = here.entry(*suspect, *factor, line);
                }
                load.copy_from_slice(slice(&payload, load.len(), sample * r + line, 1));
            }
        }
        Ok(positions)
    }

    /// Puts the measured inputs into the rows, and gives the torques freed of the residual, and freed of dry friction
    /// beside it.
    fn inputs(&self, motion: &Motion, jacobians: &[f64], lines: &mut [Vec<f64>]) -> [Vec<f64>; 2] {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let (width, p, y) = (self.width(), self.base.len(), self.frame.layout.base);
        let mut both = [motion.torques.clone(), motion.torques.clone()];
        for sample in 0..motion.samples {
            let jacobian = slice(jacobians, n * r, sample, 1);
            let torques = slice(&motion.torques, n, sample, 1);
            let mut taken = [vec![0.0; r], vec![0.0; r]];
            for (line, rows) in lines.iter_mut().enumerate() {
                let row = &mut rows[sample * width..(sample + 1) * width];
                let measured = torques.iter().enumerate();
                let input: f64 = measured
                    .map(|(i, torque)| jacobian[i * r + line] * torque)
                    .sum();
                let part = |place: usize| row[place] * self.frame.values[place];
                let explained: f64 = (0..p).map(part).sum();
                let dry: f64 = self.friction.iter().map(|place| part(*place)).sum();
                row[y] = input;
                taken[0][line] = input - explained;
                taken[1][line] = input - explained + dry;
            }
            let Some(distribution) = least_norm(jacobian, r) else {
                continue;
            };
            for (all, taken) in both.iter_mut().zip(&taken) {
                let mut own = vec![0.0; n];
                product(&distribution, taken, &mut own);
                let torques = &mut all[sample * n..(sample + 1) * n];
                torques
                    .iter_mut()
                    .zip(&own)
                    .for_each(|(torque, own)| *torque -= own);
            }
        }
        both
    }

    /// Rows of Γ¹ as the estimate's model takes them, where it takes others.
    fn projected(&self, lines: &[Vec<f64>], jacobians: &[f64]) -> Option<Vec<Vec<f64>>> {
        let sizes = self.model.info().sizes;
        let kept = match self.kind {
            ModelKind::Platform => return None,
            ModelKind::Joints => (0..sizes.actuators).collect(),
            ModelKind::Actuators => self.settings.kept_actuators.clone(),
        };
        let choice = KeptActuators::new(kept, &home_scales(self.model));
        Some(projected(lines, &choice, jacobians, sizes.actuators * sizes.dof).0)
    }
}
