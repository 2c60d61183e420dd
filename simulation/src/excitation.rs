//! Search of exciting trajectories: periodic motions that determine the parameters well.
//!
//! Random Fourier coefficients inside amplitude limits are kept if the robot reaches the whole motion
//! and every partition of its actuators stays well conditioned (a bound of 30 lets case 2 recover what
//! case 1 does); among these, the one with the largest reciprocal condition number of the base regressor
//! wins. The second half of the candidates are small changes of the best one so far. The search is made
//! once, and its result is written into a robot's description with [`Trajectory::to_toml`].

use nalgebra::DMatrix;
use overact::{Info, Model};
use rand::RngExt;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

use crate::{
    conditioning::{
        Motion, column_scales, gram, independent, reciprocal_condition, worst_partition,
    },
    error::{Error, Problem},
    reference::Reference,
    trajectory::{Term, Trajectory},
};

/// What to search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Search {
    /// Frequency of the first harmonic, Hz.
    pub fundamental_hz: f64,
    /// Number of harmonics, each with an amplitude and a phase per coordinate.
    pub harmonics: u32,
    /// Largest displacement of each of the r platform coordinates from home, m or rad.
    pub amplitude_limits: Vec<f64>,
    /// Names of the parameters that are to be determined; empty: all.
    pub parameters: Vec<String>,
    /// Whether the payload's columns count too.
    pub payload: bool,
    /// Bound of the condition number of every partition's J_a along the motion.
    pub condition_bound: f64,
    /// Number of candidates.
    pub candidates: usize,
    /// Samples of one period at which a candidate is judged.
    pub samples: usize,
    /// Seed of the random coefficients.
    pub seed: u64,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            fundamental_hz: 0.2,
            harmonics: 5,
            amplitude_limits: Vec::new(),
            parameters: Vec::new(),
            payload: false,
            condition_bound: 30.0,
            candidates: 2000,
            samples: 200,
            seed: 0,
        }
    }
}

/// The best trajectory that a search has found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The trajectory, always [`Trajectory::Periodic`]; its numbers have at most five decimals.
    pub trajectory: Trajectory,
    /// Reciprocal condition number of the base regressor with columns of unit norm, 0 to 1.
    pub reciprocal_condition: f64,
    /// Largest condition number of any partition's J_a along the motion.
    pub worst_partition: f64,
    /// Names of the parameters whose columns are the base columns.
    pub base_parameters: Vec<String>,
}

/// Searches an exciting trajectory. The same search gives the same trajectory.
///
/// # Errors
/// Problems of the search's values, or no candidate that is reachable and well conditioned.
pub fn search(model: &dyn Model, search: &Search, progress: &dyn Fn(f64)) -> Result<Found, Error> {
    let info = model.info();
    let wanted = wanted_columns(search, &info)?;
    let scales = column_scales(model).map_err(|e| Error::Home(e.error))?;
    let mut random = Pcg64::new(u128::from(search.seed), 0);
    let mut best: Option<Candidate> = None;
    let mut columns: Option<Vec<usize>> = None;
    let mut reachable = 0;
    for candidate in 0..search.candidates {
        progress(candidate as f64 / search.candidates as f64);
        let coefficients = match &best {
            Some(best) if 2 * candidate >= search.candidates => {
                vary(&best.coefficients, &mut random)
            }
            _ => draw(search, info.sizes.dof, &mut random),
        };
        let trajectory = trajectory(search, &info, &coefficients);
        let Ok(motion) = sample(model, &trajectory, search) else {
            continue;
        };
        let Ok(gram) = gram(model, &motion, search.payload) else {
            continue;
        };
        let Ok(partition) = worst_partition(model, &motion.pose, &scales) else {
            continue;
        };
        reachable += 1;
        if partition > search.condition_bound {
            continue;
        }
        // The base columns are a property of the robot: any motion that excites them all shows them.
        let base = columns.get_or_insert_with(|| independent(&gram, &wanted));
        let score = reciprocal_condition(&gram, base);
        if best.as_ref().is_none_or(|best| score > best.score) {
            best = Some(Candidate {
                coefficients,
                trajectory,
                score,
                partition,
            });
        }
    }
    progress(1.0);
    let best = best.ok_or(Error::NoTrajectory {
        candidates: search.candidates,
        reachable,
    })?;
    let names = info
        .parameters
        .iter()
        .chain(info.payload_parameters)
        .map(|p| p.name);
    let names: Vec<&str> = names.collect();
    Ok(Found {
        trajectory: best.trajectory,
        reciprocal_condition: best.score,
        worst_partition: best.partition,
        base_parameters: columns
            .unwrap_or_default()
            .into_iter()
            .map(|column| names[column].to_string())
            .collect(),
    })
}

/// A motion that is reachable and well conditioned.
struct Candidate {
    coefficients: DMatrix<f64>,
    trajectory: Trajectory,
    score: f64,
    partition: f64,
}

/// Columns of the wanted parameters, after a check of all values.
fn wanted_columns(search: &Search, info: &Info<'_>) -> Result<Vec<usize>, Error> {
    let mut problems = Vec::new();
    let mut add = |field: &str, message: String| {
        problems.push(Problem {
            field: field.into(),
            message,
        });
    };
    if !(search.fundamental_hz.is_finite() && search.fundamental_hz > 0.0) {
        add(
            "fundamental_hz",
            format!(
                "is {}; give a positive number of hertz",
                search.fundamental_hz
            ),
        );
    }
    if search.harmonics == 0 || search.samples <= 2 * search.harmonics as usize {
        add(
            "samples",
            "are too few; give one harmonic at least and more than two samples for each".into(),
        );
    }
    let dof = info.sizes.dof;
    if search.amplitude_limits.len() != dof
        || search
            .amplitude_limits
            .iter()
            .any(|limit| !(limit.is_finite() && *limit >= 0.0))
    {
        add(
            "amplitude_limits",
            format!("give {dof} numbers of at least 0, one for each platform coordinate"),
        );
    }
    if search.condition_bound.is_nan() || search.condition_bound < 1.0 {
        add(
            "condition_bound",
            format!("is {}; give a number of at least 1", search.condition_bound),
        );
    }
    let payload: &[_] = if search.payload {
        info.payload_parameters
    } else {
        &[]
    };
    let names: Vec<&str> = info
        .parameters
        .iter()
        .chain(payload)
        .map(|p| p.name)
        .collect();
    let mut wanted = Vec::new();
    for parameter in &search.parameters {
        match names.iter().position(|name| name == parameter) {
            Some(column) => wanted.push(column),
            None => add(
                "parameters",
                format!("`{parameter}` is none of {}", names.join(", ")),
            ),
        }
    }
    if search.parameters.is_empty() {
        wanted = (0..names.len()).collect();
    }
    if problems.is_empty() {
        Ok(wanted)
    } else {
        Err(Error::Experiment(problems))
    }
}

/// Random coefficients, r rows of (cosine, sine) pairs that decay with the harmonic, so that no
/// harmonic dominates the accelerations; the last column is the part of the amplitude limit to use.
fn draw(search: &Search, dof: usize, random: &mut Pcg64) -> DMatrix<f64> {
    let pairs = 2 * search.harmonics as usize;
    DMatrix::from_fn(dof, pairs + 1, |_, k| {
        let uniform: f64 = random.random();
        if k == pairs {
            0.3 + 0.7 * uniform
        } else {
            (2.0 * uniform - 1.0) / (1 + k / 2) as f64
        }
    })
}

/// The best coefficients, changed a little.
fn vary(best: &DMatrix<f64>, random: &mut Pcg64) -> DMatrix<f64> {
    let last = best.ncols() - 1;
    DMatrix::from_fn(best.nrows(), best.ncols(), |i, k| {
        let change = 0.2 * (2.0 * random.random::<f64>() - 1.0);
        if k == last {
            (best[(i, k)] + change).clamp(0.1, 1.0)
        } else {
            best[(i, k)] + change / (1 + k / 2) as f64
        }
    })
}

/// The trajectory of coefficients, each coordinate scaled so that its largest displacement is the given
/// part of its limit, and rounded to the digits that will be printed.
fn trajectory(search: &Search, info: &Info<'_>, coefficients: &DMatrix<f64>) -> Trajectory {
    let last = coefficients.ncols() - 1;
    let mut terms = Vec::new();
    for (c, coordinate) in info.coordinates.iter().enumerate() {
        let pair = |h: usize| (coefficients[(c, 2 * h)], coefficients[(c, 2 * h + 1)]);
        let value = |angle: f64| -> f64 {
            (0..last / 2)
                .map(|h| {
                    let (sin, cos) = ((h + 1) as f64 * angle).sin_cos();
                    pair(h).0 * cos + pair(h).1 * sin
                })
                .sum()
        };
        let peak = (0..search.samples)
            .map(|k| value(TAU * k as f64 / search.samples as f64).abs())
            .fold(f64::MIN_POSITIVE, f64::max);
        let scale = search.amplitude_limits[c] * coefficients[(c, last)] / peak;
        for h in 0..last / 2 {
            let (cosine, sine) = pair(h);
            let amplitude = round(scale * cosine.hypot(sine));
            if amplitude > 0.0 {
                terms.push(Term {
                    coordinate: (*coordinate).into(),
                    harmonic: h as u32 + 1,
                    amplitude,
                    phase_rad: round(cosine.atan2(sine)),
                });
            }
        }
    }
    Trajectory::Periodic {
        fundamental_hz: search.fundamental_hz,
        terms,
    }
}

/// Five decimals: 10 µm, 10 µrad.
fn round(value: f64) -> f64 {
    (value * 1e5).round() / 1e5
}

/// One period of a trajectory.
fn sample(
    model: &dyn Model,
    trajectory: &Trajectory,
    search: &Search,
) -> Result<Motion, overact::Error> {
    let sampling_hz = search.fundamental_hz * search.samples as f64;
    let mut reference = Reference::new(model, trajectory, sampling_hz, None);
    reference
        .fill(0, search.samples)
        .map_err(|(_, error)| error)?;
    let Reference {
        pose,
        twist,
        acceleration,
        ..
    } = reference;
    Ok(Motion {
        pose,
        twist,
        acceleration,
    })
}
