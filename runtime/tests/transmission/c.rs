//! `runtime/c/overact_transmission.c`, compiled by GCC and compared with Rust number by number.

use super::random::Random;
use overact::float::Float;
use overact::transmission::{Curvature, Error, Interval, Transmission, curvature};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Input of the driver and its expected lines.
#[derive(Default)]
struct Script {
    input: String,
    expected: Vec<(&'static str, i32, Vec<f64>)>,
}

/// Number of an error in C.
fn code(error: Error) -> i32 {
    match error {
        Error::NotFinite { .. } => 1,
        Error::Singular { .. } => 2,
        Error::AnotherMode => 3,
        Error::Ambiguous => 4,
        Error::Setting { .. } => 5,
        Error::Overflow => 6,
        _ => panic!("an error that C does not have: {error}"),
    }
}

/// Numbers of a result, in the order of C.
trait Numbers {
    fn numbers(&self) -> Vec<f64>;
}

impl Numbers for f64 {
    fn numbers(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl Numbers for f32 {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(*self)]
    }
}

impl<T: Float> Numbers for Interval<T> {
    fn numbers(&self) -> Vec<f64> {
        vec![self.least.into(), self.most.into()]
    }
}

impl<X: Numbers, const K: usize> Numbers for [X; K] {
    fn numbers(&self) -> Vec<f64> {
        self.iter().flat_map(Numbers::numbers).collect()
    }
}

impl Script {
    fn give(&mut self, numbers: &impl Numbers) {
        for x in numbers.numbers() {
            let text = if x.is_nan() {
                "nan".to_owned()
            } else {
                format!("{x:e}")
            };
            write!(self.input, " {text}").unwrap();
        }
    }

    fn expect<X: Numbers>(&mut self, name: &'static str, result: Result<X, Error>) {
        self.expected.push(match result {
            Ok(numbers) => (name, 0, numbers.numbers()),
            Err(error) => (name, code(error), Vec::new()),
        });
    }

    /// All functions at a random transmission; `defect` is one of its inputs.
    fn transmission<const N: usize, const R: usize, T: Float + Numbers>(
        &mut self,
        random: &mut Random,
        defect: usize,
    ) {
        let mut draw = |scale: f64| T::of(scale * random.normal());
        let mut jacobian: [[T; R]; N] = std::array::from_fn(|_| std::array::from_fn(|_| draw(1.0)));
        let joints: [T; R] = std::array::from_fn(|_| draw(1.0));
        let mut motors: [T; N] = std::array::from_fn(|_| draw(10.0));
        let gains: [[T; R]; R] = std::array::from_fn(|_| std::array::from_fn(|_| draw(100.0)));
        let mut second: Curvature<N, R, T> =
            std::array::from_fn(|_| std::array::from_fn(|_| std::array::from_fn(|_| draw(1.0))));
        for matrix in &mut second {
            let whole = *matrix;
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate().take(i) {
                    *entry = whole[j][i];
                }
            }
        }
        let mut limits: [Interval<T>; N] = std::array::from_fn(|_| Interval {
            least: -draw(1.0).abs(),
            most: draw(1.0).abs(),
        });
        match defect {
            1 => jacobian[0][0] = T::NAN,
            2 => jacobian = jacobian.map(|row| [row[0]; R]),
            3 => motors[0] = T::NAN,
            4 => limits[0].least = T::of(0.5),
            5 => jacobian[0] = jacobian[N - 1],
            _ => {}
        }
        write!(self.input, "{N} {R}").unwrap();
        self.give(&jacobian);
        self.give(&joints);
        self.give(&motors);
        self.give(&gains);
        self.give(&second);
        self.give(&limits);
        self.input.push('\n');
        let own = match Transmission::new(&jacobian) {
            Ok(own) => own,
            Err(error) => return self.expect::<[T; 1]>("inverse", Err(error)),
        };
        self.expect("inverse", Ok(*own.inverse()));
        self.expect("condition", Ok([own.condition()]));
        let mirrored = jacobian.map(|mut row| {
            row[0] = -row[0];
            row
        });
        let home = Transmission::new(&mirrored).unwrap();
        self.expect::<[T; 0]>("mode", own.in_mode_of(&home).map(|()| []));
        self.expect("motor_velocities", own.motor_velocities(&joints));
        self.expect("joint_velocities", own.joint_velocities(&motors));
        self.expect(
            "motor_accelerations",
            own.motor_accelerations(&joints, &motors),
        );
        let flat: Vec<T> = limits
            .iter()
            .flat_map(|limit| [limit.least, limit.most])
            .collect();
        let bias = std::array::from_fn(|a| flat[a]);
        self.expect(
            "joint_accelerations",
            own.joint_accelerations(&motors, &bias),
        );
        self.expect("joint_torques", own.joint_torques(&motors));
        self.expect("motor_torques", own.motor_torques(&joints));
        self.expect("reflected_inertia", own.reflected_inertia(&motors));
        self.expect(
            "joint_stiffness",
            own.joint_stiffness(&motors, &motors, &second),
        );
        self.expect("motor_gains", own.motor_gains(&gains));
        self.expect(
            "motor_stiffness",
            own.motor_stiffness(&gains, &motors, &second),
        );
        self.expect("diagonal_motor_gains", own.diagonal_motor_gains(&gains));
        self.expect("speed_intervals", own.speed_intervals(&limits));
        self.expect("torque_intervals", own.torque_intervals(&limits));
        self.expect(
            "speed_factor",
            own.speed_factor(&joints, &limits).map(|x| [x]),
        );
        self.expect(
            "torque_factor",
            own.torque_factor(&joints, &limits).map(|x| [x]),
        );
        let found: Result<Curvature<N, R, T>, Error> = curvature(|twist: &[T; R]| {
            Ok(std::array::from_fn(|a| {
                let mut sum = T::ZERO;
                for i in 0..R {
                    for j in 0..R {
                        sum += twist[i] * second[a][i][j] * twist[j];
                    }
                }
                sum
            }))
        });
        self.expect("curvature", found);
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
    let half = exponent / 2;
    sign * digits as f64 * 2.0_f64.powi(half) * 2.0_f64.powi(exponent - half)
}

/// The compiled driver; `None` without GCC.
fn driver(folder: &Path, is_single: bool) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = folder.join("driver");
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
    if is_single {
        gcc.arg("-DOVERACT_TRANSMISSION_SINGLE");
    }
    gcc.arg(root.join("c/overact_transmission.c"));
    gcc.arg(root.join("tests/transmission/driver.c"));
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

fn check<T: Float + Numbers>(tolerance: f64) {
    let is_single = size_of::<T>() == 4;
    let mut script = Script::default();
    let mut random = Random(31);
    for defect in (0_usize..12).map(|at| at.saturating_sub(6)) {
        script.transmission::<1, 1, T>(&mut random, defect);
        script.transmission::<2, 2, T>(&mut random, defect);
        script.transmission::<4, 3, T>(&mut random, defect);
        script.transmission::<6, 6, T>(&mut random, defect);
        script.transmission::<8, 6, T>(&mut random, defect);
    }
    let folder = std::env::temp_dir().join(format!(
        "overact-transmission-{}-{is_single}",
        std::process::id()
    ));
    std::fs::create_dir_all(&folder).unwrap();
    let Some(program) = driver(&folder, is_single) else {
        return;
    };
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdin.take().unwrap();
    let input = script.input.clone();
    let writer = std::thread::spawn(move || pipe.write_all(input.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let output = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.lines().count(), script.expected.len());
    let (mut compared, mut different) = (0, 0);
    for (line, (name, error, expected)) in output.lines().zip(&script.expected) {
        let mut words = line.split(' ');
        assert_eq!(words.next(), Some(*name), "{line}");
        assert_eq!(words.next(), Some(error.to_string().as_str()), "{line}");
        let found: Vec<f64> = words.map(hexadecimal).collect();
        assert_eq!(found.len(), expected.len(), "{line}");
        let scale = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        for (found, expected) in found.iter().zip(expected) {
            compared += 1;
            different += usize::from(found != expected);
            assert!(
                (found - expected).abs() <= tolerance * scale,
                "{line}\n{expected}"
            );
        }
    }
    println!("{compared} numbers compared, {different} different");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn double_precision_agrees_with_rust() {
    check::<f64>(1e-13);
}

#[test]
fn single_precision_agrees_with_rust() {
    check::<f32>(1e-5);
}
