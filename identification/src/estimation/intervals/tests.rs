//! Coverage of the intervals in synthetic experiments.

use super::Intervals;
use crate::{
    estimation::{correlation::tests::settings, estimate::estimate},
    regression::{
        factor::Factor,
        projection::Projection,
        system::{RunPart, Stretch, System},
    },
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const TRUTH: [f64; 3] = [2.0, -1.0, 0.5];

/// Options of a draw.
#[derive(Clone, Copy)]
struct DrawOptions {
    /// Correlation of the residual between successive instants.
    memory: f64,
    /// Growth of the residual with the first column.
    growth: f64,
    /// Size of a residual that repeats with the motion.
    repeated: f64,
}

/// Two lines with periodic columns and a constant one.
///
/// Their residuals are partly common to both lines.
fn system(kind: DrawOptions, samples: usize, seed: u64) -> System {
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut white = || {
        (0..12)
            .map(|_| generator.random_range(-0.5..0.5))
            .sum::<f64>()
    };
    let harmonics: Vec<[f64; 2]> = (0..40).map(|_| [white(), white()]).collect();
    let mut state = [0.0; 2];
    let mut lines = vec![DMatrix::zeros(samples, 4); 2];
    for k in 0..samples {
        let common = white();
        let angle = std::f64::consts::TAU * k as f64 / 100.0;
        for (line, rows) in lines.iter_mut().enumerate() {
            state[line] = kind.memory * state[line] + 0.6 * common + 0.8 * white();
            let wave = |harmonic: usize, phase: f64| {
                let phase = phase * (harmonic * harmonic) as f64 + line as f64;
                (harmonic as f64 * angle + phase).sin() / (harmonic as f64).sqrt()
            };
            let slow: f64 = (1..10).map(|harmonic| wave(harmonic, 0.7)).sum();
            let fast: f64 = (4..16).map(|harmonic| wave(harmonic, 1.9)).sum();
            let row = [slow, 1.0, fast];
            let waves = harmonics.iter().enumerate().map(|(h, [a, b])| {
                let (sin, cos) = ((h + 1) as f64 * angle + line as f64).sin_cos();
                a * sin + b * cos
            });
            let repeated = kind.repeated * waves.sum::<f64>();
            let y: f64 = row.iter().zip(TRUTH).map(|(w, x)| w * x).sum();
            let noise = state[line] * (1.0 + kind.growth * row[0] * row[0]);
            for (column, value) in row.into_iter().enumerate() {
                rows[(k, column)] = value;
            }
            rows[(k, 3)] = y + (1 + line) as f64 * (noise + repeated);
        }
    }
    let factor = |rows: &DMatrix<f64>| {
        let mut factor = Factor::new(3);
        factor.push(rows);
        factor
    };
    System {
        projection: Projection::Platform,
        line_names: vec![String::from("x"), String::from("y")],
        sessions: Vec::new(),
        line_units: vec!["N"; 2],
        lines: lines.iter().map(factor).collect(),
        parts: Vec::new(),
        phase_sums: Vec::new(),
        totals: Vec::new(),
        stretches: vec![Stretch {
            run: 0,
            lines,
            instruments: Vec::new(),
        }],
        partition: None,
        instruments: Vec::new(),
    }
}

/// Intervals of one draw.
fn intervals(kind: DrawOptions, samples: usize, seed: u64) -> Vec<[f64; 2]> {
    let system = system(kind, samples, seed);
    let selected = [0, 1, 2];
    let found = estimate(&system, &selected, &settings()).expect("an estimate");
    let intervals = Intervals::new(&system, &selected, &found);
    let each = selected
        .iter()
        .map(|column| intervals.of(*column, selected.len()));
    each.collect::<Option<_>>().expect("estimated columns")
}

#[test]
fn intervals_have_their_nominal_coverage() {
    const DRAWS: u64 = 100;
    for (memory, growth, repeated) in [
        (0.0, 0.0, 0.0),
        (0.7, 0.0, 0.0),
        (0.0, 1.0, 0.0),
        (0.0, 0.0, 0.3),
    ] {
        let kind = DrawOptions {
            memory,
            growth,
            repeated,
        };
        let mut covering = [0; 3];
        for seed in 0..DRAWS {
            for (i, [low, high]) in intervals(kind, 600, seed).into_iter().enumerate() {
                covering[i] += usize::from((low..=high).contains(&TRUTH[i]));
            }
        }
        let rates = covering.map(|count| f64::from(count as u32) / DRAWS as f64);
        println!("memory {memory}, growth {growth}, repeated {repeated}: {rates:.3?}");
        let mean = rates.iter().sum::<f64>() / 3.0;
        // The variance of a residual of a few sharp frequencies is badly determined.
        let least = if repeated > 0.0 { 0.88 } else { 0.925 };
        assert!((least..0.99).contains(&mean), "{mean}");
    }
}

#[test]
fn more_periods_do_not_narrow_intervals_of_periodic_residuals() {
    let kind = DrawOptions {
        memory: 0.0,
        growth: 0.0,
        repeated: 1.0,
    };
    let width = |samples| -> f64 {
        let draws = (0..20).map(|seed| intervals(kind, samples, seed));
        let first = draws.map(|intervals| intervals[0][1] - intervals[0][0]);
        first.sum()
    };
    let (few, many) = (width(600), width(2400));
    println!("widths of 6 and 24 periods: {few:.2}, {many:.2}");
    // For white residuals it would be one half.
    assert!(many > 0.75 * few);
}

/// Runs of several sessions whose parameters scatter by `scatter` around the truth.
fn of_sessions(sessions: usize, scatter: f64, seed: u64) -> System {
    let mut generator = Pcg64::seed_from_u64(1000 + seed);
    let mut normal = || {
        (0..12)
            .map(|_| generator.random_range(-0.5..0.5))
            .sum::<f64>()
    };
    let white = DrawOptions {
        memory: 0.0,
        growth: 0.0,
        repeated: 0.0,
    };
    let mut all = system(white, 0, 0);
    all.stretches.clear();
    for session in 0..sessions {
        let shift = [0; 3].map(|_| scatter * normal());
        let mut own = system(white, 200, seed * 100 + session as u64);
        let mut stretch = own.stretches.remove(0);
        for rows in &mut stretch.lines {
            for mut row in rows.row_iter_mut() {
                let moved: f64 = (0..3).map(|i| row[i] * shift[i]).sum();
                row[3] += moved;
            }
        }
        let lines: Vec<Factor> = { &stretch.lines }
            .iter()
            .map(|rows| {
                let mut factor = Factor::new(3);
                factor.push(rows);
                factor
            })
            .collect();
        for (sum, one) in all.lines.iter_mut().zip(&lines) {
            sum.add(one);
        }
        stretch.run = session;
        all.stretches.push(stretch);
        all.parts.push(RunPart {
            run: session,
            lines,
        });
        all.sessions.push(session);
    }
    all
}

/// Fraction of covering intervals, and their mean width, over many draws of sessions.
fn coverage_of_sessions(sessions: usize, scatter: f64, are_known: bool) -> (f64, f64) {
    const DRAWS: u64 = 60;
    let (mut covering, mut width) = (0.0, 0.0);
    for seed in 0..DRAWS {
        let mut system = of_sessions(sessions, scatter, seed);
        if !are_known {
            system.sessions.clear();
        }
        let selected = [0, 1, 2];
        let found = estimate(&system, &selected, &settings()).expect("an estimate");
        let intervals = Intervals::new(&system, &selected, &found);
        for column in selected {
            let [low, high] = intervals.of(column, 3).expect("an estimated column");
            covering += f64::from(u8::from((low..=high).contains(&TRUTH[column])));
            width += high - low;
        }
    }
    let count = (3 * DRAWS) as f64;
    (covering / count, width / count)
}

#[test]
fn session_intervals_cover_changes_between_sessions() {
    let (without, narrow) = coverage_of_sessions(6, 0.5, false);
    let (with, wide) = coverage_of_sessions(6, 0.5, true);
    println!("changes, not labelled: {without:.3}, labelled: {with:.3}");
    assert!(without < 0.7, "{without}");
    assert!((0.91..0.99).contains(&with), "{with}");
    assert!(wide > narrow);
}

#[test]
fn intervals_of_equal_sessions_hardly_grow() {
    let (_, narrow) = coverage_of_sessions(6, 0.0, false);
    let (with, wide) = coverage_of_sessions(6, 0.0, true);
    println!("no changes: {with:.3}, width {}", wide / narrow);
    assert!((0.92..0.995).contains(&with), "{with}");
    assert!(wide < 1.4 * narrow, "{wide} {narrow}");
}
