//! Estimates, covariances and innovations against dense least squares.

use super::random::Random;
use overact::online::{Error, Filter, SliceFilter};

/// Gauss-Jordan inverse with row pivoting.
fn inverse<const P: usize>(mut matrix: [[f64; P]; P]) -> [[f64; P]; P] {
    let mut result = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for k in 0..P {
        let pivot = (k..P).max_by(|a, b| matrix[*a][k].abs().total_cmp(&matrix[*b][k].abs()));
        matrix.swap(k, pivot.unwrap());
        result.swap(k, pivot.unwrap());
        let scale = 1.0 / matrix[k][k];
        matrix[k] = matrix[k].map(|x| x * scale);
        result[k] = result[k].map(|x: f64| x * scale);
        for row in (0..P).filter(|row| *row != k) {
            let factor = matrix[row][k];
            for column in 0..P {
                matrix[row][column] -= factor * matrix[k][column];
                result[row][column] -= factor * result[k][column];
            }
        }
    }
    result
}

/// Estimate and covariance of weighted least squares by normal equations.
fn batch<const P: usize>(rows: &[([f64; P], f64, f64)]) -> ([f64; P], [[f64; P]; P]) {
    let (mut normal, mut side) = ([[0.0; P]; P], [0.0; P]);
    for (w, y, sigma) in rows {
        for i in 0..P {
            side[i] += w[i] * y / sigma / sigma;
            for j in 0..P {
                normal[i][j] += w[i] * w[j] / sigma / sigma;
            }
        }
    }
    let covariance = inverse(normal);
    let estimate = covariance.map(|row| row.iter().zip(&side).map(|(a, b)| a * b).sum());
    (estimate, covariance)
}

#[test]
fn estimates_equal_batch_least_squares_with_every_prior() {
    const P: usize = 5;
    let mut random = Random(1);
    let truth: [f64; P] = random.row();
    let rows: Vec<([f64; P], f64, f64)> = (0..400)
        .map(|_| {
            let (w, sigma) = (random.row(), 0.1 + random.uniform());
            let y: f64 = w.iter().zip(&truth).map(|(a, b)| a * b).sum();
            (w, y + sigma * random.normal(), sigma)
        })
        .collect();
    let prior: [f64; P] = random.row();
    let square_root: [[f64; P]; P] = std::array::from_fn(|_| random.row());
    let information: [[f64; P]; P] = std::array::from_fn(|i| {
        std::array::from_fn(|j| square_root.iter().map(|row| row[i] * row[j]).sum())
    });
    // The prior as rows of its square root.
    let prior_rows = square_root.map(|row| {
        let y = row.iter().zip(&prior).map(|(a, b)| a * b).sum();
        (row, y, 1.0)
    });
    let with_prior: Vec<_> = prior_rows.iter().chain(&rows).copied().collect();
    let filters = [
        (Filter::without_prior(), batch(&rows)),
        (Filter::new(prior, square_root).unwrap(), batch(&with_prior)),
        (
            Filter::from_covariance(prior, inverse(information)).unwrap(),
            batch(&with_prior),
        ),
    ];
    for (mut filter, (estimate, covariance)) in filters {
        for pair in rows.chunks_exact(2) {
            let [(a, y, s), (b, z, t)] = [pair[0], pair[1]];
            filter.update_block(&[a, b], &[y, z], &[s, t]).unwrap();
        }
        for (found, expected) in filter.estimate().unwrap().iter().zip(estimate) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        let found = filter.covariance().unwrap();
        let deviations = filter.standard_deviations().unwrap();
        for i in 0..P {
            assert!((deviations[i].powi(2) / covariance[i][i] - 1.0).abs() < 1e-10);
            for j in 0..P {
                assert!((found[i][j] - covariance[i][j]).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn innovation_is_the_difference_from_the_prediction() {
    const P: usize = 3;
    let mut random = Random(2);
    let mut filter = Filter::<P>::from_standard_deviations(&[1.0; P], &[2.0; P]).unwrap();
    for _ in 0..50 {
        let (w, y, sigma) = (random.row::<P>(), random.normal(), 0.3);
        let (estimate, covariance) = (filter.estimate().unwrap(), filter.covariance().unwrap());
        let predicted: f64 = w.iter().zip(estimate).map(|(a, b)| a * b).sum();
        let mut variance = sigma * sigma;
        for i in 0..P {
            for j in 0..P {
                variance += w[i] * covariance[i][j] * w[j];
            }
        }
        let innovation = filter.update(&w, y, sigma).unwrap();
        assert!((innovation.residual - (y - predicted)).abs() < 1e-12);
        assert!((innovation.standard_deviation - variance.sqrt()).abs() < 1e-12);
        let normalised = (y - predicted) / variance.sqrt();
        assert!((innovation.normalised - normalised).abs() < 1e-12);
    }
}

#[test]
fn residual_deviation_equals_batch_least_squares() {
    let mut random = Random(3);
    let mut filter = Filter::<2>::without_prior();
    let rows: Vec<_> = (0..30)
        .map(|_| (random.row::<2>(), random.normal(), 0.5))
        .collect();
    for (w, y, sigma) in &rows {
        filter.update(w, *y, *sigma).unwrap();
    }
    let (estimate, _) = batch(&rows);
    let squares: f64 = rows
        .iter()
        .map(|(w, y, s)| ((y - w[0] * estimate[0] - w[1] * estimate[1]) / s).powi(2))
        .sum();
    let expected = (squares / 28.0).sqrt();
    assert!((filter.residual_deviation().unwrap() / expected - 1.0).abs() < 1e-12);
    assert_eq!(
        Filter::<2>::without_prior().residual_deviation(),
        None::<f64>
    );
}

#[test]
fn estimates_require_full_rank() {
    let mut filter = Filter::<3>::without_prior();
    let mut random = Random(4);
    // All rows are in a plane.
    for step in 0..1000 {
        let (a, b) = (random.normal(), random.normal());
        let innovation = filter.update(&[a, b, a + b], 1.0, 0.1).unwrap();
        assert!(!innovation.is_determined || step >= 2);
    }
    assert_eq!(filter.estimate(), Err(Error::NotDetermined));
    assert_eq!(filter.covariance(), Err(Error::NotDetermined));
    assert_eq!(filter.standard_deviations(), Err(Error::NotDetermined));
    let innovation = filter.update(&[0.0, 0.0, 1.0], 2.0, 0.1).unwrap();
    // Rounding may leave a trace of the third direction, with a huge standard deviation.
    assert!(!innovation.is_determined || innovation.standard_deviation > 1e9);
    assert!(filter.estimate().is_ok());
}

#[test]
fn rejected_rows_leave_every_bit_unchanged() {
    let mut filter = Filter::<2>::from_standard_deviations(&[1.0, 2.0], &[1.0, 1.0]).unwrap();
    filter.update(&[1.0, 1.0], 3.5, 0.1).unwrap();
    let before = filter;
    let setting = Error::Setting {
        setting: "sigma",
        condition: "positive and finite",
    };
    let not_finite = |input| Error::NotFinite { input };
    let large = |input| Error::OutOfRange { input };
    for (row, y, sigma, error) in [
        ([f64::NAN, 1.0], 0.0, 1.0, not_finite("row")),
        ([1.0, f64::NEG_INFINITY], 0.0, 1.0, not_finite("row")),
        ([1.0, 1.0], f64::NAN, 1.0, not_finite("y")),
        ([1.0, 1e200], 0.0, 1.0, large("row")),
        ([1.0, 1.0], 1e99, 0.01, large("y")),
        ([1.0, 1.0], 0.0, 0.0, setting),
        ([1.0, 1.0], 0.0, -1.0, setting),
        ([1.0, 1.0], 0.0, f64::NAN, setting),
        ([1.0, 1.0], 0.0, f64::INFINITY, setting),
        ([1.0, 1.0], 0.0, 1e-320, setting),
    ] {
        assert_eq!(filter.update(&row, y, sigma), Err(error));
        // The good row before the bad one is not added either.
        let block = filter.update_block(&[[1.0, 0.0], row], &[1.0, y], &[1.0, sigma]);
        assert_eq!(block, Err(error));
        assert_eq!(filter, before);
    }
}

#[test]
fn priors_that_are_not_positive_definite_are_errors() {
    let singular = Err(Error::NotPositiveDefinite);
    assert_eq!(Filter::new([0.0; 2], [[1.0, 2.0], [2.0, 4.0]]), singular);
    assert_eq!(Filter::new([0.0; 2], [[0.0; 2]; 2]), singular);
    assert_eq!(
        Filter::from_covariance([0.0; 2], [[-1.0, 0.0], [0.0, 1.0]]),
        singular
    );
    assert_eq!(
        Filter::from_covariance([0.0; 2], [[f64::NAN; 2]; 2]),
        singular
    );
    assert_eq!(Filter::from_covariance([0.0; 2], [[1.0; 2]; 2]), singular);
    for deviation in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let filter = Filter::from_standard_deviations(&[0.0], &[deviation]);
        assert_eq!(filter, Err(Error::NotPositiveDefinite));
    }
    let filter = Filter::new([f64::NAN], [[1.0]]);
    assert_eq!(filter, Err(Error::NotFinite { input: "prior" }));
    let filter = Filter::new([1.0], [[f64::NAN]]);
    let input = "square_root_information";
    assert_eq!(filter, Err(Error::NotFinite { input }));
}

#[test]
fn slice_and_array_filters_compute_the_same_bits() {
    let mut random = Random(5);
    let (mut factor, mut vectors) = ([7.0; 16], [7.0; 16]);
    let mut slices = SliceFilter::without_prior(&mut factor, &mut vectors).unwrap();
    let mut filter = Filter::<4>::without_prior();
    for _ in 0..20 {
        let (row, y) = (random.row::<4>(), random.normal());
        let expected = filter.update(&row, y, 0.2);
        assert_eq!(slices.update(&row, y, 0.2), expected);
    }
    let mut numbers = [0.0; 4];
    slices.estimate(&mut numbers).unwrap();
    assert_eq!(numbers, filter.estimate().unwrap());
    slices.standard_deviations(&mut numbers).unwrap();
    assert_eq!(numbers, filter.standard_deviations().unwrap());
    assert_eq!(slices.residual_deviation(), filter.residual_deviation());
    let length = Err(Error::Length {
        expected: 4,
        found: 3,
    });
    assert_eq!(slices.estimate(&mut [0.0; 3]), length);
    assert!(slices.update(&[0.0; 5], 0.0, 1.0).is_err());
    assert!(SliceFilter::without_prior(&mut [0.0; 4], &mut [0.0; 7]).is_err());
    assert!(SliceFilter::without_prior(&mut [0.0; 5], &mut [0.0; 8]).is_err());
}

#[test]
fn undetermined_columns_do_not_hide_the_others() {
    let mut random = Random(9);
    let (mut factor, mut vectors) = ([0.0; 9], [0.0; 12]);
    let mut slices = SliceFilter::without_prior(&mut factor, &mut vectors).unwrap();
    let mut early = Filter::<2>::without_prior();
    for _ in 0..50 {
        let ([a, b], y) = (random.row::<2>(), random.normal());
        slices.update(&[a, b, 0.0], y, 0.5).unwrap();
        early.update(&[a, b], y, 0.5).unwrap();
    }
    let (mut values, mut deviations) = ([0.0; 3], [0.0; 3]);
    slices.determined(&mut values, &mut deviations).unwrap();
    assert_eq!(values[..2], early.estimate().unwrap());
    assert_eq!(deviations[..2], early.standard_deviations().unwrap());
    assert!(values[2].is_nan() && deviations[2].is_nan());
    assert_eq!(slices.estimate(&mut values), Err(Error::NotDetermined));
    // A row of the last column alone shares its right side with the others.
    slices.update(&[1.0, 0.0, 1.0], 2.0, 0.5).unwrap();
    slices.determined(&mut values, &mut deviations).unwrap();
    assert!(values.iter().chain(&deviations).all(|x| x.is_finite()));
}

#[test]
fn single_precision_agrees_within_rounding() {
    let mut random = Random(6);
    let mut double = Filter::<4>::without_prior();
    let mut single = Filter::<4, f32>::without_prior();
    for _ in 0..5000 {
        let row = random.row::<4>().map(|x| f64::from(x as f32));
        let y = f64::from((row.iter().sum::<f64>() + 0.1 * random.normal()) as f32);
        double.update(&row, y, 0.125).unwrap();
        single
            .update(&row.map(|x| x as f32), y as f32, 0.125)
            .unwrap();
    }
    let found = single.estimate().unwrap();
    for (found, expected) in found.iter().zip(double.estimate().unwrap()) {
        assert!(
            (f64::from(*found) - expected).abs() < 1e-4,
            "{found} {expected}"
        );
    }
}
