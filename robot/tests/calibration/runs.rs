//! Runs of robots as their encoders measure them, without dynamics.

use overact::{Function, Model};
use overact_identification::{CalibratedParameter, Calibration, CalibrationScope, Log};
use overact_robot::Robot;
use std::{
    collections::VecDeque,
    f64::consts::{PI, TAU},
    path::Path,
};

/// Text of a description in `robots/`.
pub(crate) fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path.join("../robots").join(name)).expect("a description")
}

/// Robot of a description.
pub(crate) fn robot(text: &str) -> Robot {
    Robot::from_text("robot.toml", text).expect("a robot")
}

/// Encoder errors.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Encoder {
    /// Quantisation, rad or m.
    Resolution(f64),
    /// Gaussian noise with a standard deviation (rad, m).
    Noise { deviation: f64, colour: Colour },
}

/// Colour of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Colour {
    /// White noise.
    White,
    /// Autoregressive noise with a coefficient.
    Remembered(f64),
    /// White noise through a linear-phase low-pass filter; cutoff relative to half the sampling
    /// frequency.
    BandLimited(f64),
}

/// Motion and measurement of a run.
#[derive(Debug, Clone)]
pub(crate) struct Reading {
    pub(crate) samples: usize,
    /// Amplitude of each coordinate: m, rad.
    pub(crate) size: [f64; 2],
    pub(crate) encoder: Encoder,
    /// Offset of each encoder (rad, m); missing ones are zero.
    pub(crate) offsets: Vec<f64>,
    pub(crate) seed: u64,
}

impl Default for Reading {
    fn default() -> Self {
        Self {
            samples: 500,
            size: [0.05, 0.3],
            encoder: Encoder::Resolution(1e-5),
            offsets: Vec::new(),
            seed: 1,
        }
    }
}

/// Run in which every coordinate moves about home.
pub(crate) fn run(robot: &Robot, of: &Reading) -> Log {
    let model = robot.model();
    let info = model.info();
    let n = info.sizes.actuators;
    let mut positions = vec![0.0; of.samples * n];
    let mut noise = Noise::new(of.seed, n, of.encoder);
    for (sample, row) in positions.chunks_exact_mut(n).enumerate() {
        let time = sample as f64 / of.samples as f64;
        let coordinates = info.coordinates.iter().enumerate();
        let step: Vec<f64> = coordinates
            .map(|(k, name)| {
                let angular = *name == "phi" || name.starts_with('r');
                let wave = |harmonic: usize| {
                    let turns = (harmonic * (k + 1)) as f64 * time + 0.3 * (k + 1) as f64;
                    (TAU * turns).sin() / harmonic as f64
                };
                0.5 * of.size[usize::from(angular)] * (wave(1) + wave(2))
            })
            .collect();
        let mut pose = info.home_pose.to_vec();
        model.displace(&mut pose, &step);
        model
            .evaluate(Function::ActuatorPositions, &[&pose], row)
            .expect("a pose that the robot reaches");
        for (position, offset) in row.iter_mut().zip(&of.offsets) {
            *position += offset;
        }
        noise.add(of.encoder, row);
    }
    let torques = vec![0.0; positions.len()];
    Log::new("run", 100.0, n, positions, torques, false).expect("a log")
}

/// Encoder noise.
struct Noise {
    state: u64,
    /// Filter coefficients, and the last white values of each sensor.
    factors: Vec<f64>,
    white: Vec<VecDeque<f64>>,
}

/// Length of the filter.
const FILTER_LENGTH: usize = 121;

impl Noise {
    fn new(seed: u64, sensors: usize, encoder: Encoder) -> Self {
        let factors = match encoder {
            Encoder::Resolution(_) => Vec::new(),
            Encoder::Noise { colour, .. } => factors(colour),
        };
        let mut noise = Self {
            // Not a multiple of the step of the sequence, so that no two seeds give shifted
            // sequences.
            state: seed.wrapping_mul(0xd134_2543_de82_ef95),
            white: vec![VecDeque::new(); sensors],
            factors,
        };
        for sensor in 0..sensors {
            for _ in 0..noise.factors.len() {
                let value = noise.normal();
                noise.white[sensor].push_back(value);
            }
        }
        noise
    }

    /// Uniform number between 0 and 1.
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    fn add(&mut self, encoder: Encoder, row: &mut [f64]) {
        for (sensor, position) in row.iter_mut().enumerate() {
            match encoder {
                Encoder::Resolution(step) => *position = (*position / step).round() * step,
                Encoder::Noise { deviation, .. } => {
                    let value = self.normal();
                    let white = &mut self.white[sensor];
                    white.pop_back();
                    white.push_front(value);
                    let terms = self.factors.iter().zip(white.iter());
                    *position += deviation * terms.map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
    }
}

/// Filter coefficients for noise of a colour with unit variance.
fn factors(colour: Colour) -> Vec<f64> {
    let factors: Vec<f64> = match colour {
        Colour::White => vec![1.0],
        Colour::Remembered(part) => (0..FILTER_LENGTH as i32)
            .map(|lag| part.powi(lag))
            .collect(),
        Colour::BandLimited(part) => (0..FILTER_LENGTH)
            .map(|lag| {
                let middle = 0.5 * (FILTER_LENGTH - 1) as f64;
                let from = PI * part * (lag as f64 - middle);
                let ideal = if from == 0.0 { 1.0 } else { from.sin() / from };
                let window = (PI * (lag as f64 + 0.5) / FILTER_LENGTH as f64)
                    .sin()
                    .powi(2);
                ideal * window
            })
            .collect(),
    };
    let size = factors.iter().map(|one| one * one).sum::<f64>().sqrt();
    factors.into_iter().map(|one| one / size).collect()
}

/// Parameters that calibration knows of a robot, with their indices.
pub(crate) fn parameters(robot: &Robot) -> Vec<(String, usize)> {
    let reading = Reading {
        samples: 20,
        size: [1e-3, 1e-3],
        ..Reading::default()
    };
    let clean = robot.calibrate(&[run(robot, &reading)], CalibrationScope::Offsets);
    let clean = clean.expect("a calibration");
    let n = clean.sensors;
    let lengths = clean
        .held
        .into_iter()
        .filter(|one| !one.name.starts_with("offset_"));
    let names = lengths.enumerate().map(|(index, one)| (one.name, index));
    assert_eq!(n, robot.model().info().sizes.actuators);
    names.collect()
}

/// Robot with changed lengths (m).
pub(crate) fn faulty(robot: &Robot, changes: &[(&str, f64)]) -> Robot {
    let reading = Reading {
        samples: 20,
        size: [1e-3, 1e-3],
        ..Reading::default()
    };
    let clean = robot.calibrate(&[run(robot, &reading)], CalibrationScope::Smallest);
    let clean = clean.expect("a calibration");
    let known = parameters(robot);
    let estimated = changes.iter().map(|(name, change)| {
        let index = known
            .iter()
            .find(|(own, _)| own == name)
            .expect("a parameter")
            .1;
        let held = clean
            .held
            .iter()
            .find(|own| own.name == *name)
            .expect("a parameter");
        CalibratedParameter {
            name: (*name).to_owned(),
            unit: held.unit,
            kind: held.kind,
            described: held.described,
            change: *change,
            standard_deviation: 1e-9,
            interval_95: [*change; 2],
            alternatives: Vec::new(),
            index,
        }
    });
    let fault = Calibration {
        estimated: estimated.collect(),
        converged: true,
        ..clean
    };
    robot.calibrated(&fault).expect("a robot")
}
