//! Forgetting against its definition, and floors of the information.

use super::random::Random;
use overact::online::{Error, Filter, Forgetting};

const P: usize = 4;
const LAMBDA: f64 = 0.9;

/// RᵀR of a filter.
fn information(filter: &Filter<P>) -> [[f64; P]; P] {
    let (factor, _) = filter.factor();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..=i.min(j)).map(|k| factor[k][i] * factor[k][j]).sum())
    })
}

/// A filter after twenty random rows, with a weak prior.
fn started(random: &mut Random) -> Filter<P> {
    let mut filter = Filter::from_standard_deviations(&[0.0; P], &[1e3; P]).unwrap();
    for _ in 0..20 {
        filter.update(&random.row(), random.normal(), 0.5).unwrap();
    }
    filter
}

#[test]
fn exponential_forgetting_scales_the_information_once_per_block() {
    let mut random = Random(1);
    let before = started(&mut random);
    let rows: [[f64; P]; 2] = [random.row(), random.row()];
    let mut filter = before
        .with_forgetting(Forgetting::Exponential(LAMBDA))
        .unwrap();
    filter
        .update_block(&rows, &[1.0, 2.0], &[0.5, 0.5])
        .unwrap();
    let (old, new) = (information(&before), information(&filter));
    for i in 0..P {
        for j in 0..P {
            let added: f64 = rows.iter().map(|w| w[i] * w[j] / 0.25).sum();
            assert!((new[i][j] - LAMBDA * old[i][j] - added).abs() < 1e-11);
        }
    }
}

#[test]
fn directional_forgetting_matches_cao_and_schwartz() {
    let mut random = Random(2);
    let before = started(&mut random);
    for w in [random.row(), [0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, -2.0]] {
        let mut filter = before
            .with_forgetting(Forgetting::Directional(LAMBDA))
            .unwrap();
        // The row is predicted exactly: only the information changes.
        let estimate = before.estimate().unwrap();
        let y = w.iter().zip(estimate).map(|(a, b)| a * b).sum();
        let innovation = filter.update(&w, y, 0.5).unwrap();
        assert!(innovation.residual.abs() < 1e-12);
        let (old, new) = (information(&before), information(&filter));
        let image: [f64; P] = old.map(|row| row.iter().zip(w).map(|(a, b)| a * b).sum());
        let along: f64 = image.iter().zip(w).map(|(a, b)| a * b).sum();
        for i in 0..P {
            for j in 0..P {
                let lost = (1.0 - LAMBDA) * image[i] * image[j] / along;
                let expected = old[i][j] - lost + w[i] * w[j] / 0.25;
                assert!((new[i][j] - expected).abs() < 1e-10);
            }
        }
        for (found, expected) in filter.estimate().unwrap().iter().zip(estimate) {
            assert!((found - expected).abs() < 1e-12);
        }
        let (factor, _) = filter.factor();
        for (row, entries) in factor.iter().enumerate() {
            assert!(entries[row] > 0.0);
            assert!(entries[..row].iter().all(|entry| *entry == 0.0));
        }
    }
}

#[test]
fn forgetting_tracks_a_changing_parameter() {
    for forgetting in [Forgetting::Exponential(0.98), Forgetting::Directional(0.98)] {
        let mut random = Random(3);
        let filter = Filter::<2>::from_standard_deviations(&[0.0; 2], &[100.0; 2]).unwrap();
        let mut filter = filter.with_forgetting(forgetting).unwrap();
        for step in 0..2000 {
            let w: [f64; 2] = random.row();
            let truth = if step < 1000 { 1.0 } else { 3.0 };
            let y = truth * w[0] + 0.5 * w[1] + 0.01 * random.normal();
            filter.update(&w, y, 0.01).unwrap();
        }
        let [a, b] = filter.estimate().unwrap();
        assert!((a - 3.0).abs() < 0.02 && (b - 0.5).abs() < 0.02);
    }
}

#[test]
fn forgetting_keeps_a_minimum_of_information_and_the_estimate() {
    for forgetting in [Forgetting::Exponential(0.5), Forgetting::Directional(0.5)] {
        let mut random = Random(4);
        let mut filter = started(&mut random).with_forgetting(forgetting).unwrap();
        let estimate = filter.estimate().unwrap();
        for _ in 0..5000 {
            filter.update(&[0.0, 1e-9, 0.0, 1e-9], 0.0, 1.0).unwrap();
        }
        let (factor, _) = filter.factor();
        for (place, row) in factor.iter().enumerate() {
            assert!(row[place] >= 1e-3 * (1.0 - 1e-9), "{}", row[place]);
        }
        let deviations = filter.standard_deviations().unwrap();
        assert!(deviations.iter().all(|s| *s < 2e3), "{deviations:?}");
        for (found, expected) in filter.estimate().unwrap().iter().zip(estimate) {
            assert!((found - expected).abs() < 1e-3, "{found} {expected}");
        }
    }
}

#[test]
fn factors_outside_their_range_are_errors() {
    let filter = Filter::<1>::without_prior();
    for factor in [0.0, -0.5, 1.0 + 1e-12, f64::NAN, f64::INFINITY] {
        for forgetting in [
            Forgetting::Exponential(factor),
            Forgetting::Directional(factor),
        ] {
            let error = filter.with_forgetting(forgetting).unwrap_err();
            assert!(matches!(error, Error::Setting { .. }));
        }
        assert!(filter.clone().discount(factor).is_err());
    }
    assert_eq!(Forgetting::<f64>::factor_of_memory(100.0), 0.99);
}

#[test]
fn decaying_information_becomes_zero_and_never_subnormal() {
    let filter = Filter::<2>::without_prior();
    let mut filter = filter
        .with_forgetting(Forgetting::Exponential(0.5))
        .unwrap();
    // One row does not determine two parameters, so nothing keeps its information.
    filter.update(&[1.0, 2.0], 3.0, 1.0).unwrap();
    for _ in 0..2000 {
        filter.update(&[0.0, 0.0], 0.0, 1.0).unwrap();
        let (factor, side) = filter.factor();
        let mut numbers = factor.as_flattened().iter().chain(side);
        assert!(numbers.all(|number| !number.is_subnormal()));
    }
    assert_eq!(filter.factor().0, &[[0.0; 2]; 2]);
}
