//! Pools of records give the same estimate in any order and place.

use nalgebra::DMatrix;
use rand::RngExt;
use rand_pcg::Pcg64;

use super::{Pool, PoolError, Pooled, Record, compare};
use crate::{
    estimation::intervals::distributions::student_quantile,
    regression::{factor::Factor, projection::ModelKind},
};

const TRUE: [f64; 3] = [2.0, -0.5, 0.1];

/// Records of runs with two lines and five parts each.
///
/// The second line has ten times the noise. A slow part of the noise is common to successive
/// equations of both lines.
fn records(seed: u64, runs: usize) -> Vec<Record> {
    let mut random = Pcg64::new(seed.into(), 7);
    // A sum of twelve uniform variables is nearly normal.
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    let mut all = Vec::new();
    for run in 0..runs {
        let mut slow = 0.0;
        for part in 0..5 {
            let mut lines = [Vec::new(), Vec::new()];
            for _ in 0..40 {
                slow = 0.8 * slow + 0.6 * normal();
                for (rows, size) in lines.iter_mut().zip([0.1, 1.0]) {
                    let w = [normal(), normal(), normal()];
                    let explained: f64 = w.iter().zip(TRUE).map(|(w, value)| w * value).sum();
                    rows.extend(w);
                    rows.push(explained + size * (slow + 0.3 * normal()));
                }
            }
            for (line, rows) in lines.into_iter().enumerate() {
                let mut factor = Factor::new(3);
                factor.push_rows(&rows);
                all.push(Record {
                    settings_hash: 1,
                    content: u128::from(seed) << 80 | (run as u128) << 64 | 5,
                    model: ModelKind::Joints,
                    load: None,
                    part,
                    line: line as u16,
                    line_name: format!("line {line}"),
                    columns: "a,b,c".to_owned(),
                    factor,
                });
            }
        }
    }
    all
}

fn pooled<'a>(records: impl IntoIterator<Item = &'a Record>, limit: usize) -> Pool {
    let mut pool = Pool::new(limit);
    for record in records {
        pool.push(&record.to_bytes());
    }
    pool
}

fn same(a: &Pooled, b: &Pooled) {
    assert_eq!(
        (a.runs, a.equations, a.groups),
        (b.runs, b.equations, b.groups)
    );
    assert_eq!(a.parameters.len(), 3, "{}", a.problem);
    for (a, b) in a.parameters.iter().zip(&b.parameters) {
        let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} and {b}");
        near(a.value, b.value);
        near(a.white_deviation, b.white_deviation);
        near(a.deviation, b.deviation);
        near(a.freedom, b.freedom);
    }
}

#[test]
fn merging_order_does_not_change_estimates() {
    let all = records(1, 12);
    for limit in [16, 1000] {
        let whole = pooled(&all, limit).estimate();
        assert_eq!(whole.runs, 12);
        assert!(whole.groups <= limit as u64 && whole.groups > limit.min(60) as u64 / 3);
        same(&whole, &pooled(all.iter().rev(), limit).estimate());
        let mut places = [0, 1, 2].map(|place| pooled(all.iter().skip(place).step_by(3), limit));
        let [first, others @ ..] = &mut places;
        for other in others {
            // As between two processes.
            let moved = Pool::from_bytes(&other.to_bytes()).expect("a pool");
            assert_eq!(&moved, other);
            first.merge(moved).expect("other runs");
        }
        same(&whole, &first.estimate());
    }
}

#[test]
fn an_empty_pool_only_contributes_its_group_limit() {
    let all = records(6, 40);
    let (first, second) = all.split_at(200);
    let groups = |pool: &Pool| pool.estimate().groups;
    let wanted = pooled(&all, 64);
    assert!(groups(&wanted) > 16);

    // An empty pool without a limit, on either side.
    let mut left = Pool::default();
    left.merge(wanted.clone()).expect("other runs");
    let mut right = wanted.clone();
    right
        .merge(Pool::from_bytes(&Pool::default().to_bytes()).expect("a pool"))
        .expect("other runs");
    for own in [&left, &right] {
        same(&wanted.estimate(), &own.estimate());
    }
    // Later records have the same limit as without the empty pool.
    let mut later = pooled(first, 64);
    later.merge(Pool::default()).expect("other runs");
    later.merge(pooled(second, 64)).expect("other runs");
    same(&wanted.estimate(), &later.estimate());
}

#[test]
fn the_smallest_group_limit_applies_in_every_merge_order() {
    let all = records(7, 40);
    let few = pooled(&all, 8).estimate();
    assert!(few.groups <= 8);
    // An empty pool with limit 8, merged with one of limit 64.
    let mut output = Pool::new(8);
    output.merge(pooled(&all, 64)).expect("other runs");
    same(&few, &output.estimate());
    let mut output = Pool::default();
    output.limit(8);
    output.merge(pooled(&all, 64)).expect("other runs");
    same(&few, &output.estimate());
    // The reverse, or limit 8 set afterwards.
    let mut late = pooled(&all, 64);
    late.merge(Pool::new(8)).expect("other runs");
    same(&few, &late.estimate());
    let mut late = pooled(&all, 64);
    late.limit(8);
    late.limit(64);
    same(&few, &late.estimate());
    // Kinds do not share groups, and all follow the limit.
    let mut other = records(8, 40);
    other.iter_mut().for_each(|record| record.settings_hash = 2);
    let mut both = pooled(&all, 64);
    both.merge(pooled(&other[..100], 8)).expect("other runs");
    same(&few, &both.estimate());
    let mut both = pooled(&other[..100], 8);
    both.merge(pooled(&all, 64)).expect("other runs");
    same(&few, &both.estimate());
}

#[test]
fn the_pool_gives_the_weighted_least_squares_estimate() {
    let all = records(2, 3);
    let output = pooled(&all, 100).estimate();
    // Weights from each line alone; then the normal equations of both.
    let line = |number: u16| {
        let mut sum = DMatrix::zeros(4, 4);
        let mut equations = 0;
        for record in all.iter().filter(|record| record.line == number) {
            sum += record.factor.matrix().tr_mul(record.factor.matrix());
            equations += record.factor.equations();
        }
        let solve = |sum: &DMatrix<f64>| {
            let w = sum.view((0, 0), (3, 3)).clone_owned();
            w.lu()
                .solve(&sum.view((0, 3), (3, 1)).clone_owned())
                .expect("regular")
        };
        let own = solve(&sum);
        let rest = sum[(3, 3)] - own.dot(&sum.view((0, 3), (3, 1)));
        (sum, rest / (equations - 3) as f64)
    };
    let ((a, of_a), (b, of_b)) = (line(0), line(1));
    let both = a / of_a + b / of_b;
    let w = both.view((0, 0), (3, 3)).clone_owned();
    let values = w
        .lu()
        .solve(&both.view((0, 3), (3, 1)).clone_owned())
        .expect("regular");
    for (own, value) in output.parameters.iter().zip(values.iter()) {
        assert!(
            (own.value - value).abs() < 1e-12 * value.abs(),
            "{} and {value}",
            own.value
        );
    }
}

#[test]
fn duplicate_and_damaged_records_are_not_counted() {
    let all = records(3, 4);
    let good = pooled(&all, 16);
    let mut twice = pooled(all.iter().chain(&all[..10]), 16);
    assert_eq!(twice.estimate().twice, 10);
    same(&good.estimate(), &twice.estimate());
    let other = pooled(&all[..1], 16);
    assert_eq!(twice.merge(other), Err(PoolError::Twice));

    let mut corrupted = pooled(&all, 16);
    let bytes = all[0].to_bytes();
    for at in [0, 5, 9, 20, bytes.len() - 1] {
        let mut wrong = bytes.clone();
        wrong[at] ^= 1;
        corrupted.push(&wrong);
    }
    corrupted.push(&bytes[..bytes.len() - 3]);
    assert_eq!(corrupted.estimate().damaged, 6);
    same(&good.estimate(), &corrupted.estimate());
    let mut infinite = all[0].clone();
    infinite.content += 1 << 70;
    infinite.factor = Factor::of(DMatrix::identity(4, 4) * f64::INFINITY, 9, vec![0.0; 4]);
    corrupted.push(&infinite.to_bytes());
    assert_eq!(corrupted.estimate().damaged, 7);
    let pool = good.to_bytes();
    assert_eq!(
        Pool::from_bytes(&pool[..pool.len() - 1]),
        Err(PoolError::Damaged)
    );
    assert_eq!(Pool::from_bytes(&[]), Err(PoolError::Damaged));
}

#[test]
fn records_of_other_settings_or_payloads_are_not_pooled() {
    let mut all = records(4, 3);
    for record in &mut all[..10] {
        record.settings_hash = 2;
    }
    let output = pooled(&all, 16).estimate();
    assert_eq!(
        (output.runs, output.unlike, output.problem.as_str()),
        (2, 1, "")
    );
    all[10..20]
        .iter_mut()
        .for_each(|record| record.load = Some(String::new()));
    let mixed = pooled(&all[10..], 16).estimate();
    assert!(mixed.problem.contains("payload") && mixed.parameters.is_empty());
    let mut singular = records(5, 1);
    for record in &mut singular {
        let mut r = record.factor.matrix().clone_owned();
        r.column_mut(1).fill(0.0);
        record.factor = Factor::of(r, record.factor.equations(), vec![0.0; 4]);
    }
    let output = pooled(&singular, 16).estimate();
    assert_eq!(output.not_determined, ["b"]);
    assert_eq!(output.parameters.len(), 2);
    assert_eq!(pooled(&[], 16).estimate().problem, "no run is left");
}

#[test]
fn pooled_intervals_and_tests_have_their_nominal_rates() {
    let draws = overact_tier::by_tier([200, 2000]);
    let (mut covered, mut white, mut rejected) = (0, 0, 0);
    let mut last = None;
    for seed in 0..draws {
        let output = pooled(&records(100 + seed, 3), 16).estimate();
        for (own, truth) in output.parameters.iter().zip(TRUE) {
            let off = (own.value - truth).abs();
            covered += u64::from(off < student_quantile(0.05, own.freedom) * own.deviation);
            white += u64::from(off < 1.96 * own.white_deviation);
        }
        if let Some(last) = last.replace(output.clone()) {
            let compared = compare(&last, &output, &["a", "c"]).expect("both have them");
            rejected += u64::from(compared.probability < 0.05);
        }
        assert!(compare(&output, &output, &["d"]).is_none());
    }
    let part = covered as f64 / (3 * draws) as f64;
    assert!((0.92..0.98).contains(&part), "{part}; white {white}");
    let part = rejected as f64 / draws as f64;
    assert!((0.01..0.10).contains(&part), "{part}");
}
