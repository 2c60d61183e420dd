//! The C files of `runtime/c/`, compiled by GCC and compared with Rust number by number.

use super::random::Random;
use overact::StandardParameter;
use overact::float::Float;
use overact::online::{
    Change, ChangeTest, Error, Filter, Forgetting, Innovation, PayloadEstimator, PayloadSize,
    StateVariableFilter, Whitening,
};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Largest relative difference of two numbers of a result.
const TOLERANCE: f64 = 1e-14;

/// Commands for the driver, and the expected results.
#[derive(Default)]
struct Script {
    commands: String,
    expected: Vec<(i32, Vec<f64>)>,
}

/// Number of an error in C.
fn code(error: Error) -> i32 {
    match error {
        Error::NotFinite { .. } => 1,
        Error::OutOfRange { .. } => 2,
        Error::Setting { .. } => 3,
        Error::NotPositiveDefinite => 4,
        Error::NotDetermined => 5,
        Error::Overflow => 6,
        _ => panic!("an error that C does not have: {error}"),
    }
}

impl Script {
    fn add<T: Float>(&mut self, word: &str, inputs: &[T], result: Result<Vec<T>, Error>) {
        self.commands += word;
        for input in inputs {
            let x: f64 = (*input).into();
            let text = if x.is_nan() {
                "nan".to_owned()
            } else if x.is_infinite() {
                if x > 0.0 { "inf" } else { "-inf" }.to_owned()
            } else {
                format!("{x:e}")
            };
            write!(self.commands, " {text}").unwrap();
        }
        self.commands.push('\n');
        self.expected.push(match result {
            Ok(numbers) => (0, numbers.into_iter().map(Into::into).collect()),
            Err(error) => (code(error), Vec::new()),
        });
    }
}

/// A number of `printf("%a")`.
fn hexadecimal(text: &str) -> f64 {
    let (sign, text) = text
        .strip_prefix('-')
        .map_or((1.0, text), |rest| (-1.0, rest));
    let Some(text) = text.strip_prefix("0x") else {
        return sign * text.parse::<f64>().unwrap();
    };
    let (mantissa, exponent) = text.split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    // Two factors, so that subnormal numbers are exact.
    let half = exponent / 2;
    sign * digits as f64 * 2.0_f64.powi(half) * 2.0_f64.powi(exponent - half)
}

/// The driver, compiled; `None` without GCC.
fn driver(folder: &Path, single: bool) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = folder.join(if single { "single" } else { "double" });
    let mut gcc = Command::new("gcc");
    gcc.args([
        "-std=c99",
        "-O2",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
    ]);
    gcc.args(["-Wconversion", "-Wshadow", "-ffp-contract=off", "-I"]);
    gcc.arg(root.join("c"));
    if single {
        gcc.arg("-DOVERACT_ONLINE_SINGLE");
    }
    for file in [
        "overact_online",
        "overact_online_signals",
        "overact_online_payload",
    ] {
        gcc.arg(root.join("c").join(file).with_extension("c"));
    }
    gcc.arg(root.join("tests/online/c/driver.c"));
    gcc.arg("-o").arg(&program).arg("-lm");
    match gcc.status() {
        Ok(status) => assert!(status.success(), "GCC refuses the code"),
        Err(_) => {
            eprintln!("skipped: there is no GCC");
            return None;
        }
    }
    Some(program)
}

/// Runs a script and compares.
fn check(script: &Script, single: bool) {
    let folder =
        std::env::temp_dir().join(format!("overact-online-{}-{single}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let Some(program) = driver(&folder, single) else {
        return;
    };
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    let commands = script.commands.clone();
    let writer = std::thread::spawn(move || input.write_all(commands.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let output = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(lines.len(), script.expected.len());
    let commands = script.commands.lines();
    let (mut numbers, mut different, mut largest) = (0, 0, 0.0_f64);
    let tolerance = if single { 1e-6 } else { TOLERANCE };
    for ((line, (error, expected)), command) in lines.iter().zip(&script.expected).zip(commands) {
        let mut words = line.split(' ').skip(1);
        let found: i32 = words.next().unwrap().parse().unwrap();
        assert_eq!(found, *error, "{command}");
        let found: Vec<f64> = words.map(hexadecimal).collect();
        let size = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert_eq!(found.len(), expected.len(), "{command}: {line}");
        for (found, expected) in found.iter().zip(expected) {
            numbers += 1;
            different += u32::from(found.to_bits() != expected.to_bits());
            let difference = (found - expected).abs() / size.max(1e-300);
            largest = largest.max(difference);
            assert!(
                difference <= tolerance,
                "{command}: {line} instead of {expected:e}"
            );
        }
    }
    println!(
        "single {single}: {numbers} numbers, {different} differ in a bit, at most {largest:e}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Commands of filters with every rule, and their results.
fn filters<T: Float>(script: &mut Script) {
    const P: usize = 6;
    let mut random = Random(21);
    for rule in 0..3 {
        for has_prior in [false, true] {
            let factor = T::of(0.97);
            let forgetting = match rule {
                0 => Forgetting::None,
                1 => Forgetting::Exponential(factor),
                _ => Forgetting::Directional(factor),
            };
            script.add("init", &[T::of(P as f64)], Ok(vec![]));
            let filter = if has_prior {
                let prior: [T; P] = random.row().map(T::of);
                let root: [[T; P]; P] = std::array::from_fn(|_| random.row().map(T::of));
                let inputs: Vec<T> = prior.iter().chain(root.as_flattened()).copied().collect();
                script.add("prior", &inputs, Ok(vec![]));
                Filter::new(prior, root).unwrap()
            } else {
                Filter::without_prior()
            };
            let mut filter = filter.with_forgetting(forgetting).unwrap();
            script.add("forget", &[T::of(f64::from(rule)), factor], Ok(vec![]));
            for step in 0..300 {
                let rows: [[T; P]; 2] = std::array::from_fn(|_| match step % 50 {
                    // No excitation of the last parameters, tiny rows, and invalid ones.
                    20..35 => {
                        std::array::from_fn(|k| T::of(if k < 3 { random.normal() } else { 0.0 }))
                    }
                    40 => [T::of(1e-30); P],
                    41 => [T::NAN; P],
                    42 => [T::of(1e30); P],
                    _ => random.row().map(T::of),
                });
                let y = [T::of(random.normal()), T::of(random.normal())];
                let sigma = [T::of(0.5), T::of(if step % 50 == 43 { 0.0 } else { 0.25 })];
                let result = filter.update_block(&rows, &y, &sigma);
                let inputs = rows.iter().zip(y).zip(sigma);
                let inputs = inputs.flat_map(|((row, y), s)| row.iter().copied().chain([y, s]));
                let inputs: Vec<T> = [T::of(2.0)].into_iter().chain(inputs).collect();
                let numbers =
                    |one: &Innovation<T>| [one.residual, one.standard_deviation, one.normalised];
                let result = result.map(|all| all.iter().flat_map(numbers).collect());
                script.add("block", &inputs, result);
                if step % 10 == 5 {
                    script.add("estimate", &[], filter.estimate().map(Vec::from));
                    script.add(
                        "deviations",
                        &[],
                        filter.standard_deviations().map(Vec::from),
                    );
                    let covariance = filter.covariance().map(|all| all.as_flattened().to_vec());
                    script.add("covariance", &[], covariance);
                }
            }
            let half = T::of(0.5);
            script.add("discount", &[half], filter.discount(half).map(|()| vec![]));
            let two = T::of(2.0);
            script.add("discount", &[two], filter.discount(two).map(|()| vec![]));
            script.add("estimate", &[], filter.estimate().map(Vec::from));
        }
    }
    let root = [[T::of(1.0); 2]; 2];
    let singular = Filter::new([T::ZERO; 2], root).map(|_| vec![]);
    script.add("init", &[T::of(2.0)], Ok(vec![]));
    script.add(
        "prior",
        &[
            T::ZERO,
            T::ZERO,
            T::of(1.0),
            T::of(1.0),
            T::of(1.0),
            T::of(1.0),
        ],
        singular,
    );
}

/// Commands of change tests and state-variable filters.
fn signals<T: Float>(script: &mut Script) {
    let mut random = Random(22);
    let (shift, samples) = (T::of(1.5), T::of(100.0));
    let mut test = ChangeTest::new(shift, samples).unwrap();
    let mut whitening = Whitening::new();
    script.add("test", &[shift, samples], Ok(vec![test.threshold()]));
    let mut state = 0.0;
    for step in 0..2000 {
        state = 0.8 * state + random.normal() + if step > 1000 { 0.5 } else { 0.0 };
        let number = if step % 97 == 0 { T::NAN } else { T::of(state) };
        let white = whitening.update(number);
        let change = match test.update(white) {
            Some(Change::Increase) => 1.0,
            Some(Change::Decrease) => -1.0,
            None => 0.0,
        };
        script.add("innovation", &[number], Ok(vec![white, T::of(change)]));
    }
    let (cutoff, sampling) = (T::of(30.0), T::of(1000.0));
    let mut third = StateVariableFilter::<3, T>::new(cutoff, sampling).unwrap();
    let mut fifth = StateVariableFilter::<5, T>::new(cutoff, sampling).unwrap();
    for order in [3, 5] {
        let delay = if order == 3 {
            third.delay()
        } else {
            fifth.delay()
        };
        let inputs = [T::of(f64::from(order)), cutoff, sampling];
        script.add("signal", &inputs, Ok(vec![delay]));
        for step in 0..500 {
            let sample = T::of((0.03 * f64::from(step)).sin() + 0.01 * random.normal());
            let sample = if step == 77 { T::INFINITY } else { sample };
            let result = if order == 3 {
                third.update(sample)
            } else {
                fifth.update(sample)
            };
            let result = result.map(|one| vec![one.value, one.velocity, one.acceleration]);
            script.add("sample", &[sample], result);
        }
    }
}

/// Commands of payloads, consistent and inconsistent.
fn payloads<T: Float>(script: &mut Script, columns: usize) {
    let mut random = Random(23);
    let size = PayloadSize {
        mass: T::of(10.0),
        length: T::of(0.3),
    };
    // A point mass of 2 kg is at the boundary of consistency.
    let truth = [0.085, 0.01, -0.04, 0.1, 0.02, 0.025, 0.2, -0.1, 0.4, 2.0];
    for _ in 0..10 {
        let places: Vec<T> = (10 - columns..10).map(|k| T::of(k as f64)).collect();
        let inputs = [
            &[T::of(columns as f64)][..],
            &places,
            &[size.mass, size.length],
        ]
        .concat();
        script.add("payload", &inputs, Ok(vec![]));
        let mut ten = PayloadEstimator::<10, T>::new(StandardParameter::INERTIA, size).unwrap();
        let last: [StandardParameter; 4] = *StandardParameter::INERTIA.last_chunk().unwrap();
        let mut four = PayloadEstimator::<4, T>::new(last, size).unwrap();
        for _ in 0..40 {
            let row: [f64; 10] = random.row();
            let used = &row[10 - columns..];
            let y = used.iter().zip(&truth[10 - columns..]).map(|(a, b)| a * b);
            let y = T::of(y.sum::<f64>() + 0.02 * random.normal());
            let sigma = T::of(0.02);
            let row: Vec<T> = used.iter().map(|x| T::of(*x)).collect();
            let innovation = if columns == 10 {
                ten.update(&[row.clone().try_into().unwrap()], &[y], &[sigma])
            } else {
                four.update(&[row.clone().try_into().unwrap()], &[y], &[sigma])
            };
            let [one] = innovation.unwrap();
            let inputs = [&[T::of(1.0)][..], &row, &[y, sigma]].concat();
            let numbers = vec![one.residual, one.standard_deviation, one.normalised];
            script.add("block", &inputs, Ok(numbers));
        }
        let body = if columns == 10 {
            ten.payload()
        } else {
            four.payload()
        };
        let body = body.map(|one| {
            let projected = T::of(f64::from(u8::from(one.is_projected)));
            let numbers = one.parameters.iter().chain(one.inertia.as_flattened());
            numbers.copied().chain([projected]).collect()
        });
        script.add("body", &[], body);
    }
}

fn all<T: Float>() -> Script {
    let mut script = Script::default();
    filters::<T>(&mut script);
    signals::<T>(&mut script);
    payloads::<T>(&mut script, 10);
    payloads::<T>(&mut script, 4);
    script
}

#[test]
fn double_precision_agrees_with_rust() {
    check(&all::<f64>(), false);
}

#[test]
fn single_precision_agrees_with_rust() {
    check(&all::<f32>(), true);
}
