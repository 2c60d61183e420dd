//! Fixed settings of a run, and its motion as a Fourier series.

use overact_codegen::description::{Description, JointKind, independent_joints};
use overact_identification::Load;
use overact_simulation::{Term, Trajectory};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Default for the highest harmonic, as a fraction of the controller's bandwidth.
const BANDWIDTH_SHARE: f64 = 0.1;

/// Default bandwidth (Hz) and duration (s).
const USUAL: [f64; 2] = [70.0, 10.0];

/// Default number of harmonics.
const HARMONICS: usize = 5;

/// Fixed settings of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FourierRun {
    pub(super) name: String,
    /// Frequency of the first harmonic, Hz.
    pub(super) fundamental: f64,
    pub(super) harmonics: usize,
    /// Whether the platform carries the payload.
    pub(super) payload: bool,
    /// Name of the payload, if there are several.
    pub(super) payload_name: Option<String>,
    /// Duration specified for this run, s.
    pub(super) own_duration: Option<f64>,
    /// Duration, s.
    pub(super) duration: f64,
}

impl FourierRun {
    /// Payload of the run.
    pub(super) fn carried(&self) -> Load<'_> {
        Load::new(self.payload, self.payload_name.as_deref())
    }
}

/// Training runs of a description.
pub(super) fn described(
    description: &Description,
    coordinates: &[&str],
) -> Vec<(FourierRun, Trajectory)> {
    let Some(experiment) = &description.experiment else {
        return Vec::new();
    };
    let runs = experiment.runs.iter().filter(|run| !run.validation);
    let own = runs.map(|run| {
        let terms = run.terms.iter().map(|term| Term {
            coordinate: coordinates
                .get(term.index)
                .map_or_else(String::new, |name| (*name).to_owned()),
            harmonic: term.harmonic,
            amplitude: term.amplitude,
            phase_rad: term.phase,
        });
        let harmonics = run.terms.iter().map(|term| term.harmonic as usize).max();
        let frame = FourierRun {
            name: run.name.value.clone(),
            fundamental: run.fundamental,
            harmonics: harmonics.unwrap_or(1),
            payload: run.payload,
            payload_name: run.payload_name.clone(),
            own_duration: run.duration,
            duration: run.duration.unwrap_or(experiment.duration),
        };
        let trajectory = Trajectory::Periodic {
            fundamental_hz: run.fundamental,
            terms: terms.collect(),
        };
        (frame, trajectory)
    });
    own.collect()
}

/// Runs to search: the requested number, else that of the table or description.
pub(super) fn wanted(
    description: &Description,
    described: &[(FourierRun, Trajectory)],
    runs: Option<usize>,
) -> Vec<FourierRun> {
    let table = description.excitation.as_ref();
    let experiment = description.experiment.as_ref();
    let loads = loads(description, described);
    let usual = match described.len() {
        0 => loads.len(),
        count => count,
    };
    let count = runs.or(table.and_then(|t| t.runs)).unwrap_or(usual);
    let highest = described.iter().map(|(frame, _)| frame.harmonics).max();
    let harmonics = table
        .and_then(|t| t.harmonics)
        .or(highest)
        .unwrap_or(HARMONICS);
    let [bandwidth, duration] = experiment.map_or(USUAL, |e| [e.bandwidth, e.duration]);
    let held_out = experiment
        .iter()
        .flat_map(|e| &e.runs)
        .filter(|run| run.validation);
    let taken: BTreeSet<&str> = held_out.map(|run| run.name.value.as_str()).collect();
    let numbers = (1..).map(|number| format!("excitation {number}"));
    let names = numbers.filter(|name| !taken.contains(name.as_str()));
    let frame = |(index, name): (usize, String)| {
        let like = described
            .get(index % described.len().max(1))
            .map(|(frame, _)| frame);
        let own = match like.filter(|_| count == described.len()) {
            Some(frame) => frame.carried(),
            None => loads[index % loads.len()],
        };
        FourierRun {
            name,
            fundamental: table
                .and_then(|t| t.fundamental)
                .or(like.map(|frame| frame.fundamental))
                .unwrap_or(BANDWIDTH_SHARE * bandwidth / harmonics as f64),
            harmonics,
            payload: own.is_some(),
            payload_name: own.name().map(str::to_owned),
            own_duration: like.and_then(|frame| frame.own_duration),
            duration: like.map_or(duration, |frame| frame.duration),
        }
    };
    let frames: Vec<FourierRun> = names.take(count).enumerate().map(frame).collect();
    frames
}

/// Payloads that runs carry in turn: those of the described runs, else none and each one alone.
fn loads<'a>(
    description: &'a Description,
    described: &'a [(FourierRun, Trajectory)],
) -> Vec<Load<'a>> {
    let mut loads: Vec<Load<'_>> = Vec::new();
    for (frame, _) in described {
        if !loads.contains(&frame.carried()) {
            loads.push(frame.carried());
        }
    }
    if !loads.is_empty() {
        return loads;
    }
    let mut platform = description.platform.iter();
    let named = description.payloads.iter();
    loads.push(Load::Nothing);
    loads.extend(named.map(|name| Load::Named(&name.value)));
    if loads.len() == 1 && platform.any(|platform| platform.payload.is_some()) {
        loads.push(Load::Any);
    }
    loads
}

/// Names of the coordinates in the description, and whether each is a length.
pub(super) fn coordinates(description: &Description) -> Vec<(String, bool)> {
    if let Some(platform) = &description.platform {
        let names = platform.motion.value.coordinates().into_iter();
        return names
            .map(|name| (name.to_owned(), matches!(name, "x" | "y" | "z")))
            .collect();
    }
    let own = independent_joints(&description.legs).into_iter();
    own.map(|(name, joint)| (name, joint.kind.value == JointKind::Prismatic))
        .collect()
}

/// Maps dimensionless numbers to the Fourier series of a run within its position limits.
///
/// Each harmonic of each coordinate has two numbers, for sine and cosine, in units of limit /
/// harmonic.
#[derive(Debug)]
pub(super) struct Series<'a> {
    pub(super) frame: &'a FourierRun,
    /// Model name, largest displacement (m or rad) and whether it is a length, for each coordinate.
    pub(super) coordinates: Vec<(&'a str, f64, bool)>,
    pub(super) samples: usize,
}

impl Series<'_> {
    /// Number of values of a series.
    pub(super) fn len(&self) -> usize {
        2 * self.frame.harmonics * self.coordinates.len()
    }

    /// Series scaled down to the position limits, and the relative excess before scaling.
    pub(super) fn bounded(&self, numbers: &[f64]) -> (Trajectory, f64) {
        let mut terms = Vec::new();
        let mut excess = 0.0;
        let width = 2 * self.frame.harmonics;
        for ((name, limit, _), own) in self.coordinates.iter().zip(numbers.chunks(width)) {
            let pairs: Vec<(f64, f64)> = own
                .chunks(2)
                .zip(1..)
                .map(|(pair, harmonic)| {
                    let scale = limit / f64::from(harmonic);
                    (scale * pair[0], scale * pair[1])
                })
                .collect();
            let peak = self.peak(&pairs);
            let scale = if peak > *limit { limit / peak } else { 1.0 };
            excess += (peak / limit - 1.0).max(0.0);
            terms.extend(
                pairs
                    .iter()
                    .zip(1..)
                    .map(|((sine, cosine), harmonic)| Term {
                        coordinate: (*name).to_owned(),
                        harmonic,
                        amplitude: scale * sine.hypot(*cosine),
                        phase_rad: cosine.atan2(*sine),
                    }),
            );
        }
        (self.trajectory(terms), excess)
    }

    /// Largest displacement at the samples.
    fn peak(&self, pairs: &[(f64, f64)]) -> f64 {
        let value = |sample: usize| {
            let (sin, cos) = (TAU * sample as f64 / self.samples as f64).sin_cos();
            // Angle addition gives sine and cosine of the next harmonic.
            let (mut s, mut c, mut sum) = (sin, cos, 0.0);
            for (sine, cosine) in pairs {
                sum += sine * s + cosine * c;
                (s, c) = (s * cos + c * sin, c * cos - s * sin);
            }
            sum.abs()
        };
        (0..self.samples).map(value).fold(0.0, f64::max)
    }

    /// Numbers of a series, the inverse of [`Series::bounded`].
    pub(super) fn numbers(&self, trajectory: &Trajectory) -> Vec<f64> {
        let mut numbers = vec![0.0; self.len()];
        let Trajectory::Periodic { terms, .. } = trajectory else {
            return numbers;
        };
        for term in terms {
            let at = self
                .coordinates
                .iter()
                .position(|(name, ..)| *name == term.coordinate);
            let Some(at) = at else { continue };
            let (sin, cos) = term.phase_rad.sin_cos();
            let size = term.amplitude * f64::from(term.harmonic) / self.coordinates[at].1;
            let place = 2 * (at * self.frame.harmonics + term.harmonic as usize - 1);
            if let Some([sine, cosine]) = numbers.get_mut(place..place + 2) {
                (*sine, *cosine) = (size * cos, size * sin);
            }
        }
        numbers
    }

    /// Series times a factor.
    pub(super) fn scaled(&self, trajectory: &Trajectory, factor: f64) -> Trajectory {
        let Trajectory::Periodic { terms, .. } = trajectory else {
            return trajectory.clone();
        };
        let scaled = |term: &Term| Term {
            amplitude: factor * term.amplitude,
            ..term.clone()
        };
        self.trajectory(terms.iter().map(scaled).collect())
    }

    /// Series rounded to the written precision: micrometres, 10⁻⁴ degrees, and 10⁻² degrees of
    /// phase.
    pub(super) fn rounded(&self, trajectory: &Trajectory) -> Trajectory {
        let Trajectory::Periodic { terms, .. } = trajectory else {
            return trajectory.clone();
        };
        let is_length = |name: &str| {
            self.coordinates
                .iter()
                .any(|(own, _, length)| *own == name && *length)
        };
        let round = |term: &Term| {
            let amplitude = term.amplitude;
            Term {
                amplitude: if is_length(&term.coordinate) {
                    (amplitude * 1e6).round() / 1e6
                } else {
                    ((amplitude.to_degrees() * 1e4).round() / 1e4).to_radians()
                },
                phase_rad: ((term.phase_rad.to_degrees() * 1e2).round() / 1e2).to_radians(),
                ..term.clone()
            }
        };
        let terms = terms.iter().map(round).filter(|term| term.amplitude > 0.0);
        self.trajectory(terms.collect())
    }

    fn trajectory(&self, terms: Vec<Term>) -> Trajectory {
        Trajectory::Periodic {
            fundamental_hz: self.frame.fundamental,
            terms,
        }
    }
}
