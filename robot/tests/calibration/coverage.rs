//! Intervals of calibrated parameters contain the truth as often as they say.
//!
//! `OVERACT_RANDOM_COUNT=100` draws more noise.

use super::runs::{Colour, Encoder, Reading, faulty, robot, run, text};
use overact_identification::CalibrationScope;
use overact_tier::{by_tier, drawn, is_full};

/// What is wrong with the robot.
const LINK: (&str, f64) = ("d_2_leg2", 2.8e-3);
const OFFSET: (&str, f64) = ("offset_leg3", 3.490_658_503_988_659e-3);

/// Under white noise the parameters that were changed are the right ones, and the 95 % intervals cover them;
/// those of all parameters together cover, too.
#[test]
fn intervals_cover_under_white_noise() {
    cover(Colour::White, by_tier([3.0, 1.25]));
}

/// Noise that is correlated over some ten of three hundred samples. So few that are independent make errors in
/// units of the deviations as large as Student's distribution of few degrees of freedom has them.
#[test]
fn intervals_cover_under_correlated_noise() {
    if is_full() {
        cover(Colour::Remembered(0.9), 1.4);
    }
}

/// Noise of low frequencies alone.
#[test]
fn intervals_cover_under_band_limited_noise() {
    if is_full() {
        cover(Colour::BandLimited(0.2), 1.25);
    }
}

/// What the intervals say, and by how many deviations of the number of those that cover it may be missed: 88 % of a
/// hundred draws.
const NOMINAL: f64 = 0.95;
const DEVIATIONS: f64 = 3.2;

/// Draws of noise of a colour; the intervals cover as often as so many draws tell, and errors in units of the deviations
/// have at most so large a root mean square.
fn cover(colour: Colour, largest: f64) {
    let draws = drawn([2, 40]);
    let deviation = (NOMINAL * (1.0 - NOMINAL) / draws as f64).sqrt();
    let least = by_tier([0.5, NOMINAL - DEVIATIONS * deviation]);
    let described = robot(&text("dualv.toml"));
    let real = faulty(&described, &[LINK]);
    for scope in [CalibrationScope::Smallest, CalibrationScope::All] {
        let (mut covered, mut squares, mut right) = ([0; 2], [0.0; 2], 0);
        for draw in 0..draws {
            let reading = Reading {
                samples: 300,
                encoder: Encoder::Noise {
                    deviation: 3e-6,
                    colour,
                },
                offsets: vec![0.0, 0.0, OFFSET.1],
                seed: 1 + draw,
                ..Reading::default()
            };
            let found = described.calibrate(&[run(&real, &reading)], scope);
            let found = found.expect("a calibration");
            right += usize::from(found.estimated.len() == 2);
            for (which, (name, truth)) in [OFFSET, LINK].into_iter().enumerate() {
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
