//! Long runs of noise, constants, invalid numbers and steps.

use super::random::Random;
use overact::float::Float;
use overact::online::{Filter, Forgetting};
use overact_tier::{by_tier, is_night};

const P: usize = 3;

/// Rows of a hostile run, by the number of the sample.
fn row(step: usize, random: &mut Random) -> ([f64; P], f64) {
    match (step / 1000) % 9 {
        0 => (random.row(), random.normal()),
        // Constants: no excitation.
        1 => ([1.0, -2.0, 0.5], 3.0),
        2 => ([0.0; P], 0.0),
        // Invalid numbers among valid ones.
        3 if step.is_multiple_of(2) => ([f64::NAN, 1.0, f64::INFINITY], 0.0),
        3 => (random.row(), f64::NAN),
        // A step by eight orders of magnitude, and back.
        4 => (random.row().map(|x| 1e6 * x), 1e8 * random.normal()),
        5 => (random.row().map(|x| 1e-9 * x), 1e-9 * random.normal()),
        // Numbers at and beyond the ends of the range.
        6 if step.is_multiple_of(2) => ([1e300, -1e300, 1e-300], 1e300),
        6 => ([1e-310, 1e-40, 0.0], 1e-320),
        // Nearly parallel rows.
        7 => ([1.0, 1.0, 1.0 + 1e-12 * random.normal()], 1.0),
        _ => ([0.0, 0.0, random.normal()], 1e3),
    }
}

/// Runs a filter and requires finite answers and a regular R.
fn run<T: Float>(forgetting: Forgetting<T>, samples: usize, has_prior: bool) {
    let filter = if has_prior {
        Filter::<P, T>::from_standard_deviations(&[T::ZERO; P], &[T::of(100.0); P]).unwrap()
    } else {
        Filter::without_prior()
    };
    let mut filter = filter.with_forgetting(forgetting).unwrap();
    let mut random = Random(7);
    let (mut was_regular, mut rejected) = (has_prior, 0);
    for step in 0..samples {
        let (row, y) = row(step, &mut random);
        let before = filter;
        match filter.update(&row.map(T::of), T::of(y), T::of(0.1)) {
            Ok(innovation) => {
                let numbers = [
                    innovation.residual,
                    innovation.standard_deviation,
                    innovation.normalised,
                ];
                assert!(numbers.iter().all(|x| x.is_finite()), "{innovation:?}");
            }
            Err(_) => {
                rejected += 1;
                assert_eq!(filter, before);
            }
        }
        if step % 97 == 0 {
            let (factor, side) = filter.factor();
            let mut numbers = factor.as_flattened().iter().chain(side);
            assert!(numbers.all(|x| x.is_finite()), "{filter:?}");
            let is_regular = (0..P).all(|k| factor[k][k] > T::ZERO);
            assert!(is_regular || !was_regular, "{filter:?}");
            let estimate = filter.estimate();
            assert!(estimate.is_ok() || !was_regular, "{filter:?}");
            was_regular |= estimate.is_ok();
            if let Ok(estimate) = estimate {
                assert!(estimate.iter().all(|x| x.is_finite()));
                assert!(
                    filter
                        .standard_deviations()
                        .unwrap()
                        .iter()
                        .all(|s| *s > T::ZERO)
                );
            }
        }
    }
    assert!(was_regular && rejected > samples / 9);
}

#[test]
fn hostile_samples_keep_estimates_finite_and_the_factor_regular() {
    let samples = if is_night() {
        10_000_000
    } else {
        by_tier([18_000, 500_000])
    };
    for has_prior in [true, false] {
        run::<f64>(Forgetting::None, samples, has_prior);
        run::<f64>(Forgetting::Exponential(0.99), samples, has_prior);
        run::<f64>(Forgetting::Directional(0.99), samples, has_prior);
        run::<f32>(Forgetting::None, samples, has_prior);
        run::<f32>(Forgetting::Exponential(0.99), samples, has_prior);
        run::<f32>(Forgetting::Directional(0.99), samples, has_prior);
    }
}

#[test]
fn the_largest_rows_do_not_overflow() {
    fn check<T: Float>(most: f64) {
        for forgetting in [Forgetting::None, Forgetting::Directional(T::of(0.9))] {
            let filter = Filter::<2, T>::from_standard_deviations(&[T::ZERO; 2], &[T::of(1.0); 2]);
            let mut filter = filter.unwrap().with_forgetting(forgetting).unwrap();
            for step in 0..20_000 {
                let sign = if step % 3 == 0 { 1.0 } else { -1.0 };
                let row = [T::of(most), T::of(sign * most)];
                filter.update(&row, T::of(most), T::of(1.0)).unwrap();
            }
            let estimate = filter.estimate().unwrap();
            assert!(estimate.iter().all(|x| x.is_finite()));
        }
    }
    check::<f64>(1e100);
    check::<f32>(1e9);
}

#[test]
fn the_estimate_recovers_after_hostile_samples() {
    let filter = Filter::<P>::from_standard_deviations(&[0.0; P], &[100.0; P]).unwrap();
    let mut filter = filter
        .with_forgetting(Forgetting::Exponential(0.99))
        .unwrap();
    let mut random = Random(8);
    for step in 0..18_000 {
        let (row, y) = row(step, &mut random);
        let _ = filter.update(&row, y, 0.1);
    }
    for _ in 0..6000 {
        let w: [f64; P] = random.row();
        let y = w[0] - 2.0 * w[1] + 3.0 * w[2] + 0.1 * random.normal();
        filter.update(&w, y, 0.1).unwrap();
    }
    for (found, expected) in filter.estimate().unwrap().iter().zip([1.0, -2.0, 3.0]) {
        assert!((found - expected).abs() < 0.1, "{found}");
    }
}
