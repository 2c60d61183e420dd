//! Times the computation of R factors from measured poses and torques.
//!
//! `overact-throughput DESCRIPTION LOG SETTINGS ROUNDS [RESULT]`. LOG has rows of a pose and
//! torques as little-endian doubles. SETTINGS are, separated by commas: sampling frequency (Hz),
//! filter order, filter cutoff (Hz), decimation, and the names of the columns. Prints the shortest
//! processor time of all rounds in nanoseconds per sample, and writes the R factors, row-major, to
//! RESULT.

use nalgebra::DMatrix;
use overact::{Function, Model};
use overact_codegen::{Source, compile};
use overact_identification::Factor;
use overact_identification::filters::{Decimator, ZeroPhase, butterworth};
use overact_identification::{ColumnSet, Error, Load, SampledStates};
use overact_robot::InterpretedRobot;
use std::{env, fs, process::ExitCode};

/// Samples per block, as in an identification.
const BLOCK: usize = 512;

type Failure = Box<dyn std::error::Error>;

/// A log with its processing settings.
struct Work<'a> {
    model: &'a dyn Model,
    columns: ColumnSet,
    picked: Vec<usize>,
    frequency: f64,
    order: usize,
    cutoff: f64,
    decimation: usize,
    pose: Vec<f64>,
    torques: Vec<f64>,
}

/// Poses, twists and accelerations, row by row.
struct Motion {
    pose: Vec<f64>,
    twist: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Work<'_> {
    fn samples(&self) -> usize {
        self.pose.len() / self.model.info().sizes.pose
    }

    /// Zero-phase low-pass and central differences.
    fn motion(&self) -> Result<Motion, Error> {
        let width = self.model.info().sizes.pose;
        let filter = butterworth(self.order, 2.0 * self.cutoff / self.frequency)?;
        let mut stream = ZeroPhase::new(&filter, width, self.samples())?;
        let mut pose = Vec::with_capacity(self.pose.len());
        stream.push(&self.pose, &mut pose);
        let twist = differences(&pose, width, self.frequency);
        let acceleration = differences(&twist, width, self.frequency);
        Ok(Motion {
            pose,
            twist,
            acceleration,
        })
    }

    /// R factor of the decimated equations for each row of the model, computed block by block.
    fn factors(&self) -> Result<Vec<Factor>, Failure> {
        let motion = self.motion()?;
        let sizes = self.model.info().sizes;
        let (width, samples) = (self.picked.len() + 1, self.samples());
        let decimator = Decimator::new(self.decimation)?;
        let one = |_| decimator.stream(width, samples);
        let mut streams = (0..sizes.dof).map(one).collect::<Result<Vec<_>, _>>()?;
        let mut kept = vec![Vec::new(); sizes.dof];
        for first in (0..samples).step_by(BLOCK) {
            let rows = self.rows(&motion, first, BLOCK.min(samples - first))?;
            for ((rows, stream), kept) in rows.iter().zip(&mut streams).zip(&mut kept) {
                stream.push(rows, kept);
            }
        }
        let factor = |rows: &Vec<f64>| {
            let mut factor = Factor::new(width - 1);
            factor.push(&DMatrix::from_row_slice(rows.len() / width, width, rows));
            factor
        };
        Ok(kept.iter().map(factor).collect())
    }

    /// Rows of the model for `count` samples from number `first`, x (columns + 1), Y last.
    fn rows(&self, motion: &Motion, first: usize, count: usize) -> Result<Vec<Vec<f64>>, Failure> {
        let sizes = self.model.info().sizes;
        let part =
            |values: &'_ [f64], width: usize| values[first * width..][..count * width].to_vec();
        let pose = part(&motion.pose, sizes.pose);
        let twist = part(&motion.twist, sizes.dof);
        let acceleration = part(&motion.acceleration, sizes.dof);
        let torques = part(&self.torques, sizes.actuators);
        let states = SampledStates {
            samples: count,
            interval: 1.0 / self.frequency,
            pose: &pose,
            twist: &twist,
            acceleration: &acceleration,
            carried: Load::Nothing,
        };
        let mut lines = self
            .columns
            .evaluate(self.model, &states, &self.picked, 1)?;
        let mut measured = vec![0.0; count * sizes.dof];
        self.model
            .evaluate(Function::ProjectPlatform, &[&pose, &torques], &mut measured)?;
        let width = self.picked.len() + 1;
        for (line, rows) in lines.iter_mut().enumerate() {
            let places = rows[width - 1..].iter_mut().step_by(width);
            let values = measured[line..].iter().step_by(sizes.dof);
            places.zip(values).for_each(|(place, y)| *place = *y);
        }
        Ok(lines)
    }
}

/// Processor time of this process so far, s, which excludes other work on the machine.
fn processor_time() -> Result<f64, Failure> {
    let text = fs::read_to_string("/proc/self/schedstat")?;
    let nanoseconds = text.split_whitespace().next().ok_or("no time")?;
    Ok(1e-9 * nanoseconds.parse::<f64>()?)
}

/// Central differences of rows, one-sided at both ends.
fn differences(rows: &[f64], width: usize, frequency: f64) -> Vec<f64> {
    let last = rows.len() / width - 1;
    let row = |sample: usize| &rows[sample * width..(sample + 1) * width];
    let of = |sample: usize| {
        let (before, after) = (sample.saturating_sub(1), (sample + 1).min(last));
        let factor = frequency / (after - before) as f64;
        let pairs = row(after).iter().zip(row(before));
        pairs.map(move |(b, a)| (b - a) * factor)
    };
    (0..=last).flat_map(of).collect()
}

fn doubles(path: &str) -> Result<Vec<f64>, Failure> {
    let bytes = fs::read(path)?;
    let (numbers, _) = bytes.as_chunks();
    Ok(numbers.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

fn run() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [description, log, settings, rounds, rest @ ..] = &arguments[..] else {
        return Err("DESCRIPTION LOG SETTINGS ROUNDS [RESULT] are needed".into());
    };
    let text = fs::read_to_string(description)?;
    let compiled = compile(&Source::new(description, &text)).map_err(|e| format!("{e:?}"))?;
    let robot = InterpretedRobot::new(compiled.model);
    let sizes = robot.info().sizes;
    let settings: Vec<&str> = settings.split(',').collect();
    let [frequency, order, cutoff, decimation, names @ ..] = &settings[..] else {
        return Err("the settings are incomplete".into());
    };
    let columns = ColumnSet::new(&robot, false, false, 1)?;
    let place = |name: &&str| columns.as_slice().iter().position(|c| c.name == **name);
    let picked: Option<Vec<usize>> = names.iter().map(place).collect();
    let rows = doubles(log)?;
    let rows = rows.chunks_exact(sizes.pose + sizes.actuators);
    let work = Work {
        model: &robot,
        picked: picked.ok_or("a column is unknown")?,
        columns,
        frequency: frequency.parse()?,
        order: order.parse()?,
        cutoff: cutoff.parse()?,
        decimation: decimation.parse()?,
        pose: rows
            .clone()
            .flat_map(|row| &row[..sizes.pose])
            .copied()
            .collect(),
        torques: rows.flat_map(|row| &row[sizes.pose..]).copied().collect(),
    };
    let mut best = f64::INFINITY;
    let mut factors = Vec::new();
    for _ in 0..rounds.parse()? {
        let start = processor_time()?;
        factors = work.factors()?;
        best = best.min(processor_time()? - start);
    }
    println!("{:.1}", 1e9 * best / work.samples() as f64);
    if let Some(path) = rest.first() {
        let numbers = factors
            .iter()
            .flat_map(|f| f.matrix().transpose().as_slice().to_vec());
        fs::write(
            path,
            numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>(),
        )?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
