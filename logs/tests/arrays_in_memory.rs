//! Runs of arrays in memory are read like those of files: names, units, resampling.

use overact_logs::{Array, read_arrays};
use overact_logs::{Gain, Mapping, Time};

fn mapping() -> Mapping {
    Mapping {
        time: Time::Column("t".to_owned()),
        positions: vec!["q(:,1)".to_owned(), "q(:,2)".to_owned()],
        torques: vec!["i1".to_owned(), "'motor 2' * 2".to_owned()],
        velocities: Vec::new(),
        position_scale: vec![1.0, 0.5],
        position_offset: Vec::new(),
        torque_gain: vec![Gain::Variable("gain".to_owned()), Gain::Value(1.0)],
        resample: None,
        transmission: Vec::new(),
        rotating: Vec::new(),
    }
}

const COUNT: usize = 40;

fn series(of: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..COUNT).map(|at| of(at as f64 * 0.01)).collect()
}

fn array<'a>(name: &'a str, columns: usize, values: &'a [f64]) -> Array<'a> {
    Array {
        name,
        shape: (values.len() / columns, columns),
        values,
    }
}

#[test]
fn arrays_support_matrix_columns_expressions_and_gains() {
    let time = series(|t| t);
    let positions = [series(f64::sin), series(f64::cos)].concat();
    let (first, second) = (series(|t| t * t), series(|t| -t));
    let arrays = [
        array("t", 1, &time),
        array("q", 2, &positions),
        array("i1", 1, &first),
        array("motor 2", 1, &second),
        array("gain", 1, &[3.0]),
    ];
    let log = read_arrays("mine", &arrays, &mapping(), true).expect("a run");
    assert_eq!((log.name(), log.payload()), ("mine", true));
    assert!((log.sampling_frequency() - 100.0).abs() < 1e-9);
    let (positions, torques) = log.load().expect("samples");
    assert_eq!(positions.len(), 2 * COUNT);
    for at in 0..COUNT {
        let t = at as f64 * 0.01;
        assert_eq!(positions[2 * at..2 * at + 2], [t.sin(), 0.5 * t.cos()]);
        assert_eq!(torques[2 * at..2 * at + 2], [3.0 * (t * t), -2.0 * t]);
    }
}

#[test]
fn missing_and_non_finite_arrays_are_reported_by_name() {
    let time = series(|t| t);
    let mut positions = [series(f64::sin), series(f64::cos)].concat();
    positions[7] = f64::NAN;
    let arrays = [array("t", 1, &time), array("q", 2, &positions)];
    let output = |arrays: &[Array<'_>]| {
        let error = read_arrays("mine", arrays, &mapping(), false).expect_err("no run");
        error.to_string()
    };
    let missing = output(&arrays);
    assert!(
        missing.contains("gain") && missing.contains("mine"),
        "{missing}"
    );
    let torque = series(|t| t);
    let all = [
        arrays[0],
        arrays[1],
        array("i1", 1, &torque),
        array("motor 2", 1, &torque),
        array("gain", 1, &[1.0]),
    ];
    let broken = output(&all);
    assert!(
        broken.contains("sample 7 is not a finite number"),
        "{broken}"
    );
}
