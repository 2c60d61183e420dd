//! Virtual experiments with random motions and noise.

use crate::{Failure, Subject};
use nalgebra::DMatrix;
use overact::Function;
use overact_identification::Log;
use overact_simulation::{Experiment, Record, Term, Trajectory, simulate};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Samples of a period at which a motion is checked.
const INSTANTS: usize = 120;

/// Largest condition number of the actuators, or kept actuators, relative to that at home.
///
/// Other motions are redrawn, because the identification warns of them anyway.
const LARGEST_CONDITION: f64 = 10.0;

/// Largest number of motions tried for a run.
const CANDIDATES: usize = 500;

/// Factors on the description's noise.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Noise {
    /// Factor on the standard deviation of the torques.
    pub torque: f64,
    /// Factor on the resolution of the encoders.
    pub encoder: f64,
}

impl Noise {
    /// The description's noise.
    pub const PLAIN: Self = Self {
        torque: 1.0,
        encoder: 1.0,
    };
}

/// The subject's experiment with random motions of draw number `draw`.
///
/// # Errors
/// A run for which no motion was found.
pub fn varied(subject: &Subject, draw: u64) -> Result<Experiment, Failure> {
    let mut random = Pcg64::new(u128::from(draw), 0x6d6f_7469_6f6e);
    let mut experiment = subject.experiment.clone();
    for run in &mut experiment.runs {
        let found = (0..CANDIDATES)
            .map(|_| candidate(&run.trajectory, &mut random))
            .find(|candidate| is_harmless(subject, candidate));
        let missing = || {
            format!(
                "{}: no motion found for `{}`",
                subject.info().name,
                run.name
            )
        };
        run.trajectory = found.ok_or_else(missing)?;
    }
    Ok(experiment)
}

/// Terms of a motion with random phases and amplitudes; each coordinate within its original range.
fn candidate(original: &Trajectory, random: &mut Pcg64) -> Trajectory {
    let Trajectory::Periodic {
        fundamental_hz,
        terms,
    } = original
    else {
        return original.clone();
    };
    let mut drawn = terms.clone();
    for term in &mut drawn {
        term.phase_rad = TAU * random.random::<f64>();
        term.amplitude *= 0.5 + random.random::<f64>();
    }
    let reach = |terms: &[Term], coordinate: &str| {
        let at = |instant: usize| -> f64 {
            let angle = TAU * instant as f64 / INSTANTS as f64;
            let own = terms.iter().filter(|term| term.coordinate == coordinate);
            let value = |term: &Term| {
                term.amplitude * (f64::from(term.harmonic) * angle + term.phase_rad).sin()
            };
            own.map(value).sum()
        };
        (0..INSTANTS).map(|i| at(i).abs()).fold(0.0, f64::max)
    };
    let scale = |term: &Term| {
        let (old, new) = (
            reach(terms, &term.coordinate),
            reach(&drawn, &term.coordinate),
        );
        if new > 0.0 { old / new } else { 1.0 }
    };
    let scales: Vec<f64> = drawn.iter().map(scale).collect();
    for (term, scale) in drawn.iter_mut().zip(scales) {
        term.amplitude *= scale;
    }
    Trajectory::Periodic {
        fundamental_hz: *fundamental_hz,
        terms: drawn,
    }
}

/// Whether the robot reaches the whole motion and its actuators stay well conditioned.
fn is_harmless(subject: &Subject, trajectory: &Trajectory) -> bool {
    let info = subject.info();
    let sizes = info.sizes;
    let Trajectory::Periodic { fundamental_hz, .. } = trajectory else {
        return true;
    };
    let mut sets = vec![(0..sizes.actuators).collect::<Vec<usize>>()];
    if sizes.actuators > sizes.dof {
        sets.push(subject.settings.kept_actuators.clone());
    }
    let Some(home) = conditions(subject, info.home_pose, &sets) else {
        return false;
    };
    let mut pose = vec![0.0; sizes.pose];
    let mut step = vec![0.0; sizes.dof];
    let mut rates = [vec![0.0; sizes.dof], vec![0.0; sizes.dof]];
    (0..INSTANTS).all(|instant| {
        let time = instant as f64 / (INSTANTS as f64 * fundamental_hz);
        let [velocity, acceleration] = &mut rates;
        let mut out = overact_simulation::trajectory::Displacement {
            position: &mut step,
            velocity,
            acceleration,
        };
        trajectory.evaluate(info.coordinates, time, &mut out);
        pose.copy_from_slice(info.home_pose);
        subject.model().displace(&mut pose, &step);
        let here = conditions(subject, &pose, &sets);
        here.is_some_and(|here| {
            let mut pairs = here.iter().zip(&home);
            // A determinant that changes its sign indicates a singularity.
            pairs.all(|(here, home)| here.0 <= LARGEST_CONDITION * home.0 && here.1 == home.1)
        })
    })
}

/// For each set of actuators: condition number of its rows of J_p^inv, and whether the determinant
/// is positive.
///
/// `None` if the pose is unreachable.
fn conditions(subject: &Subject, pose: &[f64], sets: &[Vec<usize>]) -> Option<Vec<(f64, bool)>> {
    let sizes = subject.info().sizes;
    let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
    subject
        .model()
        .evaluate(Function::InverseJacobian, &[pose], &mut jacobian)
        .ok()?;
    let whole = DMatrix::from_row_slice(sizes.actuators, sizes.dof, &jacobian);
    let of = |set: &Vec<usize>| {
        let rows = whole.select_rows(set);
        let positive = rows.is_square() && rows.determinant() > 0.0;
        let values = rows.singular_values();
        (values.max() / values.min(), positive)
    };
    Some(sets.iter().map(of).collect())
}

/// Records of an experiment with a factor on the encoder resolution, and exact torques.
///
/// # Errors
/// A run that fails.
pub fn records(
    subject: &Subject,
    experiment: &Experiment,
    encoder: f64,
) -> Result<Vec<Record>, Failure> {
    let mut exact = experiment.clone();
    exact.torque_noise.clear();
    for resolution in &mut exact.encoder_resolution {
        *resolution *= encoder;
    }
    Ok(simulate(subject.model(), &exact, &|_, _| ()).map_err(|error| error.to_string())?)
}

/// Logs of the records with a factor on the torque noise.
///
/// # Errors
/// A record that is not a valid log.
pub fn logs(
    subject: &Subject,
    records: &[Record],
    factor: f64,
    draw: u64,
) -> Result<Vec<Log>, Failure> {
    let deviations = &subject.experiment.torque_noise;
    let mut logs = Vec::new();
    for (number, record) in records.iter().enumerate() {
        let stream = 0x6e6f_6973_6500 + number as u128;
        let mut random = Pcg64::new(u128::from(draw), stream);
        let n = record.actuators.len();
        let mut torques = record.torques.clone();
        for row in torques.chunks_exact_mut(n) {
            for (torque, deviation) in row.iter_mut().zip(deviations) {
                let normal: f64 = StandardNormal.sample(&mut random);
                *torque += factor * deviation * normal;
            }
        }
        logs.push(Log::new(
            record.name.clone(),
            record.sampling_hz,
            n,
            record.positions.clone(),
            torques,
            record.payload,
        )?);
    }
    Ok(logs)
}
