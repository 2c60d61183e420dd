//! Coverage of the intervals of calibrated parameters.
//!
//! `OVERACT_RANDOM_COUNT=100` draws more noise.

use super::runs::{Colour, Encoder, Reading, faulty, robot, run, text};
use overact_identification::CalibrationScope;
use overact_tier::{by_tier, drawn, is_full};

/// Faults of the robot.
const LINK_FAULT: (&str, f64) = ("d_2_leg2", 2.8e-3);
const OFFSET_FAULT: (&str, f64) = ("offset_leg3", 3.490_658_503_988_659e-3);

/// White noise: the right parameters are changed, and their 95 % intervals cover; so do those of
/// all parameters together.
#[test]
fn intervals_cover_under_white_noise() {
    cover(Colour::White, 1.0);
}

/// Noise correlated over about ten of three hundred samples.
///
/// With so few independent samples, errors in standard deviations follow Student's t distribution
/// with few degrees of freedom.
#[test]
fn intervals_cover_under_correlated_noise() {
    if is_full() {
        cover(Colour::Remembered(0.9), 1.15);
    }
}

/// Low-frequency noise only.
#[test]
fn intervals_cover_under_band_limited_noise() {
    if is_full() {
        cover(Colour::BandLimited(0.2), 1.0);
    }
}

/// Nominal coverage, and tolerance in standard deviations of the counted or averaged value.
///
/// A hundred draws have to cover 88 %, with errors of at most 1.23 times the expected size.
const NOMINAL: f64 = 0.95;
const DEVIATIONS: f64 = 3.2;

/// Checks coverage and the root mean square error in standard deviations, for noise of a colour.
///
/// The root mean square of n normal errors varies by 1/√(2 n) of the `expected` value.
fn cover(colour: Colour, expected: f64) {
    let draws = drawn([2, 20, 40]);
    let deviation = (NOMINAL * (1.0 - NOMINAL) / draws as f64).sqrt();
    let least = by_tier([0.5, NOMINAL - DEVIATIONS * deviation]);
    let largest = expected * (1.0 + DEVIATIONS / (2.0 * draws as f64).sqrt());
    let described = robot(&text("dualv.toml"));
    let real = faulty(&described, &[LINK_FAULT]);
    for scope in [CalibrationScope::Smallest, CalibrationScope::All] {
        let (mut covered, mut squares, mut right) = ([0; 2], [0.0; 2], 0);
        for draw in 0..draws {
            let reading = Reading {
                samples: 300,
                encoder: Encoder::Noise {
                    deviation: 3e-6,
                    colour,
                },
                offsets: vec![0.0, 0.0, OFFSET_FAULT.1],
                seed: 1 + draw,
                ..Reading::default()
            };
            let found = described.calibrate(&[run(&real, &reading)], scope);
            let found = found.expect("a calibration");
            right += usize::from(found.estimated.len() == 2);
            for (which, (name, truth)) in [OFFSET_FAULT, LINK_FAULT].into_iter().enumerate() {
                let one = found.estimated.iter().find(|one| one.name == name);
                let Some(one) = one else { continue };
                let [low, high] = one.interval_95;
                covered[which] += usize::from((low..=high).contains(&truth));
                squares[which] += ((one.change - truth) / one.standard_deviation).powi(2);
            }
        }
        let part = |count: usize| count as f64 / draws as f64;
        let sizes = squares.map(|sum| (sum / draws as f64).sqrt());
        println!(
            "{colour:?}, {scope:?}: coverage {:?}, errors in deviations {sizes:?}, exactly the two {}",
            covered.map(part),
            part(right)
        );
        for (covered, size) in covered.map(part).into_iter().zip(sizes) {
            assert!(covered >= least, "{covered}");
            assert!(size < largest, "{size}");
        }
        if scope == CalibrationScope::Smallest && colour == Colour::White {
            assert!(part(right) >= by_tier([0.5, 0.95]), "{right} of {draws}");
        }
    }
}
