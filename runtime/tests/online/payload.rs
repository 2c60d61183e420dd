//! Payload estimator: consistency, optimality and bounded work.

use super::random::Random;
use overact::StandardParameter;
use overact::online::{Error, Forgetting, Payload, PayloadEstimator, PayloadSize};
use overact_tier::by_tier;

const SIZE: PayloadSize = PayloadSize {
    mass: 10.0,
    length: 0.3,
};

/// Parameters of a body of points with masses, about the origin.
fn body(points: &[(f64, [f64; 3])]) -> [f64; 10] {
    let mut inertia = [0.0; 10];
    for (m, [x, y, z]) in points {
        let own = [
            y * y + z * z,
            -x * y,
            -x * z,
            x * x + z * z,
            -y * z,
            x * x + y * y,
            *x,
            *y,
            *z,
            1.0,
        ];
        inertia
            .iter_mut()
            .zip(own)
            .for_each(|(sum, one)| *sum += m * one);
    }
    inertia
}

/// Eigenvalues of a symmetric 4 × 4 matrix by Jacobi rotations.
fn eigenvalues(mut a: [[f64; 4]; 4]) -> [f64; 4] {
    for _ in 0..50 {
        for p in 0..4 {
            for q in p + 1..4 {
                if a[p][q].abs() < 1e-300 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                let [above, below] = [a[p], a[q]];
                a[p] = std::array::from_fn(|k| c * above[k] - s * below[k]);
                a[q] = std::array::from_fn(|k| s * above[k] + c * below[k]);
            }
        }
    }
    std::array::from_fn(|k| a[k][k])
}

/// Pseudo-inertia with lengths in units of the payload's size.
fn pseudo_inertia(p: &[f64; 10]) -> [[f64; 4]; 4] {
    let l = SIZE.length;
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = *p;
    let (a, b, c) = (
        (yy + zz - xx) / 2.0,
        (xx + zz - yy) / 2.0,
        (xx + yy - zz) / 2.0,
    );
    let s = l * l;
    [
        [a / s, -xy / s, -xz / s, mx / l],
        [-xy / s, b / s, -yz / s, my / l],
        [-xz / s, -yz / s, c / s, mz / l],
        [mx / l, my / l, mz / l, m],
    ]
}

fn is_consistent(payload: &Payload) -> bool {
    let values = eigenvalues(pseudo_inertia(&payload.parameters));
    let largest = values.iter().fold(0.0_f64, |most, one| most.max(*one));
    // Zero within rounding of the largest is as definite as numbers can be.
    payload.mass > 0.0 && values.iter().all(|one| *one > -1e-12 * largest)
}

/// An estimator after random rows of a body, with noise.
fn estimated(truth: &[f64; 10], rows: usize, sigma: f64, seed: u64) -> PayloadEstimator<10> {
    let mut random = Random(seed);
    let mut estimator = PayloadEstimator::new(StandardParameter::INERTIA, SIZE).unwrap();
    for _ in 0..rows {
        let row: [f64; 10] = random.row();
        let y: f64 = row.iter().zip(truth).map(|(a, b)| a * b).sum();
        let y = y + sigma * random.normal();
        estimator.update(&[row], &[y], &[sigma]).unwrap();
    }
    estimator
}

/// ½‖R χ - z‖² of an estimator, and its gradient with respect to the pseudo-inertia.
fn gradient(estimator: &PayloadEstimator<10>, parameters: &[f64; 10]) -> (f64, [[f64; 4]; 4]) {
    let (factor, side) = estimator.filter().factor();
    let residual: [f64; 10] = std::array::from_fn(|i| {
        factor[i]
            .iter()
            .zip(parameters)
            .map(|(r, x)| r * x)
            .sum::<f64>()
            - side[i]
    });
    let by_parameter: [f64; 10] =
        std::array::from_fn(|j| (0..10).map(|i| factor[i][j] * residual[i]).sum());
    // χ is linear in J: differences are exact.
    let mut gradient = [[0.0; 4]; 4];
    let l = SIZE.length;
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = by_parameter;
    let s = l * l;
    gradient[0][0] = s * (yy + zz);
    gradient[1][1] = s * (xx + zz);
    gradient[2][2] = s * (xx + yy);
    gradient[3][3] = m;
    for (i, j, g) in [
        (0, 1, -s * xy),
        (0, 2, -s * xz),
        (1, 2, -s * yz),
        (0, 3, l * mx),
        (1, 3, l * my),
        (2, 3, l * mz),
    ] {
        gradient[i][j] = 0.5 * g;
        gradient[j][i] = 0.5 * g;
    }
    (0.5 * residual.iter().map(|r| r * r).sum::<f64>(), gradient)
}

#[test]
fn a_consistent_estimate_is_returned_unchanged() {
    let truth = body(&[
        (1.0, [0.1, 0.0, 0.2]),
        (1.0, [-0.05, 0.1, 0.1]),
        (0.5, [0.0, -0.1, 0.15]),
        (0.3, [0.05, 0.05, 0.0]),
    ]);
    let estimator = estimated(&truth, 300, 1e-4, 1);
    let payload = estimator.payload().unwrap();
    assert!(!payload.is_projected);
    assert_eq!(payload.parameters, estimator.filter().estimate().unwrap());
    assert!((payload.mass - 2.8).abs() < 1e-3);
    for (axis, sum) in [0.1 - 0.05 + 0.015, 0.1 - 0.05 + 0.015, 0.2 + 0.1 + 0.075]
        .iter()
        .enumerate()
    {
        assert!((payload.centre[axis] - sum / 2.8).abs() < 1e-3);
    }
    // The inertia about the centre of mass has the triangle inequality.
    let [a, b, c] = [0, 1, 2].map(|k| payload.inertia[k][k]);
    assert!(a > 0.0 && a + b > c && b + c > a && c + a > b);
}

#[test]
fn the_projection_is_optimal_and_consistent() {
    for seed in 1..=by_tier([20, 400]) {
        // A point mass is at the boundary: noise makes the estimate inconsistent.
        let truth = body(&[(2.0, [0.1, -0.05, 0.2])]);
        let estimator = estimated(&truth, 30, 0.02, seed);
        let payload = estimator.payload().unwrap();
        assert!(payload.is_projected);
        assert!(is_consistent(&payload), "{payload:?}");
        // Karush, Kuhn and Tucker: G is positive semidefinite, and tr(G J) = 0.
        let (cost, gradient) = gradient(&estimator, &payload.parameters);
        let pseudo = pseudo_inertia(&payload.parameters);
        let values = eigenvalues(gradient);
        let largest = values.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
        let least = values
            .iter()
            .fold(f64::INFINITY, |least, one| least.min(*one));
        let slackness: f64 = (0..4)
            .flat_map(|i| (0..4).map(move |j| (i, j)))
            .map(|(i, j)| gradient[i][j] * pseudo[i][j])
            .sum();
        // The mass of 10 kg times the negative part bounds the possible decrease of the cost.
        let gap = slackness + SIZE.mass * (-least).max(0.0);
        assert!(
            gap < 0.02,
            "seed {seed}: cost {cost}, gap {gap}, {values:?} {largest}"
        );
    }
}

#[test]
fn negative_masses_and_hostile_rows_give_a_body_or_an_error() {
    let mut random = Random(3);
    for case in 0..by_tier([100, 5000]) {
        let mut estimator = PayloadEstimator::new(StandardParameter::INERTIA, SIZE).unwrap();
        for step in 0..case % 40 {
            let scale = 10.0_f64.powf(4.0 * random.normal());
            let row = random.row::<10>().map(|x| scale * x);
            let y = -100.0 * scale * random.normal().abs();
            let y = if step % 7 == 3 { f64::NAN } else { y };
            let _ = estimator.update(&[row], &[y], &[0.1]);
        }
        match estimator.payload() {
            Ok(payload) => assert!(is_consistent(&payload), "{payload:?}"),
            Err(error) => assert_eq!(error, Error::Overflow),
        }
    }
}

#[test]
fn planar_robots_need_four_columns() {
    use StandardParameter::{M, Mx, My, Zz};
    let truth = [0.05, 0.2, -0.1, 2.0];
    let mut random = Random(4);
    let mut estimator = PayloadEstimator::<4>::new([Zz, Mx, My, M], SIZE).unwrap();
    for _ in 0..200 {
        let rows = [random.row::<4>(), random.row::<4>()];
        let y = rows.map(|row| row.iter().zip(truth).map(|(a, b)| a * b).sum());
        estimator.update(&rows, &y, &[0.01, 0.01]).unwrap();
    }
    let payload = estimator.payload().unwrap();
    assert!(is_consistent(&payload));
    assert!(!payload.is_projected, "{payload:?}");
    assert!((payload.mass - 2.0).abs() < 1e-3);
    assert!((payload.centre[0] - 0.1).abs() < 1e-3);
    assert!((payload.parameters[5] - 0.05).abs() < 1e-3);
}

#[test]
fn single_precision_gives_a_consistent_body() {
    let size = PayloadSize::<f32> {
        mass: 10.0,
        length: 0.3,
    };
    let mut random = Random(5);
    let mut estimator = PayloadEstimator::<10, f32>::new(StandardParameter::INERTIA, size)
        .unwrap()
        .with_forgetting(Forgetting::Directional(0.999))
        .unwrap();
    let truth = body(&[(2.0, [0.1, -0.05, 0.2])]);
    for _ in 0..2000 {
        let row: [f64; 10] = random.row();
        let y: f64 = row.iter().zip(truth).map(|(a, b)| a * b).sum();
        let y = y + 0.02 * random.normal();
        estimator
            .update(&[row.map(|x| x as f32)], &[y as f32], &[0.02])
            .unwrap();
    }
    let payload = estimator.payload().unwrap();
    assert!((payload.mass - 2.0).abs() < 0.01, "{payload:?}");
    for (found, expected) in payload.centre.iter().zip([0.1, -0.05, 0.2]) {
        assert!((found - expected).abs() < 0.01, "{payload:?}");
    }
}

#[test]
fn invalid_columns_and_sizes_are_rejected() {
    use StandardParameter::{Fv, M, Mx};
    assert!(PayloadEstimator::<2>::new([M, M], SIZE).is_err());
    assert!(PayloadEstimator::<2>::new([Mx, Fv], SIZE).is_err());
    for (mass, length) in [
        (0.0, 1.0),
        (1.0, -1.0),
        (f64::NAN, 1.0),
        (1.0, f64::INFINITY),
    ] {
        assert!(PayloadEstimator::<1>::new([M], PayloadSize { mass, length }).is_err());
    }
}
