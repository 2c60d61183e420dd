//! Serial models: the file, imported again, has the reported errors at the reported states.

use overact::{Columns, Function, Model};
use overact_codegen::diagnostic::Source;
use overact_interchange::{Format, Options};
use overact_robot::{
    CompiledFile, Error, RelativeError, Robot, SerialModel, SerialSettings, import,
};
use overact_tier::by_tier;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Inertia matrix, torques of gravity and velocity torques.
type Quantities = [Vec<f64>; 3];

/// Difference of reported and recomputed errors, relative to the root mean square of the quantity.
const TOLERANCE: f64 = 1e-9;

fn robots(stem: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("../robots/{stem}.toml"))
}

fn robot(stem: &str) -> Result<Robot, Error> {
    CompiledFile::read(&robots(stem), &Robot::serial_request()).map(Robot::new)
}

/// Inertia matrix, gravity and velocity torques at a state, of inertias alone.
struct Dynamics<'a> {
    robot: &'a Robot,
    parameters: Vec<f64>,
    /// Index of each coordinate of the original robot among those of this one.
    order: Vec<usize>,
}

impl<'a> Dynamics<'a> {
    fn new(robot: &'a Robot, values: &BTreeMap<String, f64>, coordinates: &[String]) -> Self {
        let info = robot.model().info();
        let all = info.parameters.iter();
        let mut parameters: Vec<f64> = all
            .map(|one| {
                let is_inertial = one.symbol.is_inertial() || one.symbol.name() == "ia";
                if is_inertial {
                    values.get(one.name).copied().unwrap_or(0.0)
                } else {
                    0.0
                }
            })
            .collect();
        parameters.resize(parameters.len() + info.payload_parameters.len(), 0.0);
        // Joints without names in the description have other names in the import, in order.
        let place = |(at, name): (usize, &String)| {
            let mut own = info.coordinates.iter();
            own.position(|own| own == name).unwrap_or(at)
        };
        Self {
            robot,
            parameters,
            order: coordinates.iter().enumerate().map(place).collect(),
        }
    }

    /// Numbers of the original order in this one.
    fn ordered(&self, numbers: &[f64]) -> Vec<f64> {
        let mut own = vec![0.0; numbers.len()];
        for (number, &at) in numbers.iter().zip(&self.order) {
            own[at] = *number;
        }
        own
    }

    fn at(&self, pose: &[f64], twist: &[f64]) -> Quantities {
        let r = pose.len();
        let (pose, twist) = (self.ordered(pose), self.ordered(twist));
        let call = |function, inputs: &[&[f64]], size: usize| {
            let mut output = vec![0.0; size];
            let done = self.robot.model().evaluate(function, inputs, &mut output);
            done.expect("a state in the workspace");
            output
        };
        let inputs: [&[f64]; 2] = [&pose, &self.parameters];
        let mass = call(Function::MassMatrix(Columns::Standard), &inputs, r * r);
        let bias = |twist: &[f64]| {
            let nothing = vec![0.0; self.parameters.len()];
            let of = |parameters: &[f64]| {
                let inputs: [&[f64]; 3] = [&pose, twist, parameters];
                call(Function::Bias(Columns::Standard), &inputs, r)
            };
            let pairs = of(&self.parameters).into_iter().zip(of(&nothing));
            pairs
                .map(|(whole, known)| whole - known)
                .collect::<Vec<f64>>()
        };
        let gravity = bias(&vec![0.0; r]);
        let both = bias(&twist);
        let pairs = both.iter().zip(&gravity);
        let velocity: Vec<f64> = pairs.map(|(both, gravity)| both - gravity).collect();
        let entries = (0..r).flat_map(|i| (0..r).map(move |j| (i, j)));
        let mass = entries.map(|(i, j)| mass[self.order[i] * r + self.order[j]]);
        let vector = |of: &[f64]| self.order.iter().map(|&at| of[at]).collect();
        [mass.collect(), vector(&gravity), vector(&velocity)]
    }
}

/// Errors of one robot's quantities relative to the root mean square of the other's.
fn errors(model: &SerialModel, original: &Dynamics<'_>, serial: &Dynamics<'_>) -> [[f64; 2]; 3] {
    let r = model.home.len();
    let all = model.states.iter();
    let all: Vec<(Quantities, Quantities)> = all
        .map(|(pose, twist)| (original.at(pose, twist), serial.at(pose, twist)))
        .collect();
    let count = all.len() as f64;
    let mean = |at: usize| all.iter().map(|(own, _)| own[0][at * r + at]).sum::<f64>() / count;
    let scales: Vec<f64> = (0..r).map(|at| mean(at).sqrt()).collect();
    let norm = |quantity: usize, numbers: &[f64]| {
        let weight = |at: usize| match quantity {
            0 => scales[at / r] * scales[at % r],
            _ => scales[at],
        };
        let squares = numbers.iter().enumerate();
        squares
            .map(|(at, x)| (x / weight(at)).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    std::array::from_fn(|quantity| {
        let squares = all
            .iter()
            .map(|(own, _)| norm(quantity, &own[quantity]).powi(2));
        let size = (squares.sum::<f64>() / count).sqrt();
        let error = |(own, other): &(Quantities, Quantities)| {
            let pairs = own[quantity].iter().zip(&other[quantity]);
            let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
            norm(quantity, &difference) / size
        };
        let each: Vec<f64> = all.iter().map(error).collect();
        let squares: f64 = each.iter().map(|x| x * x).sum();
        [
            (squares / count).sqrt(),
            each.iter().copied().fold(0.0, f64::max),
        ]
    })
}

/// Exports a robot, imports the file, and compares reported with recomputed errors.
fn check(stem: &str, robot: &Robot, format: Format) -> Result<[Option<RelativeError>; 3], Error> {
    let model = robot.serial(&SerialSettings::new(format))?;
    let extension = if format == Format::Urdf {
        "urdf"
    } else {
        "xml"
    };
    let name = format!("overact-serial-{stem}-{}.{extension}", std::process::id());
    let file = std::env::temp_dir().join(name);
    std::fs::write(&file, &model.text).expect("a temporary file");
    let imported = import(&file, &Options::default())?;
    std::fs::remove_file(&file).expect("a temporary file");
    let source = Source::new("imported.toml", imported.text.as_str());
    let again = Robot::new(CompiledFile::new(source, &Robot::serial_request())?);
    assert!(again.model().model().is_tree(), "{stem}: a serial robot");
    let values = |robot: &Robot| robot.true_values().expect("values");
    let original = Dynamics::new(robot, &values(robot), &model.coordinates);
    let serial = Dynamics::new(&again, &values(&again), &model.coordinates);
    assert_eq!(model.states.len(), 1000);
    let found = errors(&model, &original, &serial);
    let reported = [
        Some(model.inertia_matrix),
        model.gravity,
        model.velocity_torques,
    ];
    for (found, reported) in found.iter().zip(reported) {
        let Some(reported) = reported else { continue };
        println!(
            "{stem}: rms {:.3e}, largest {:.3e}",
            reported.rms, reported.largest
        );
        for (found, reported) in found.iter().zip([reported.rms, reported.largest]) {
            assert!(
                (found - reported).abs() < TOLERANCE,
                "{stem}: {found} {reported}"
            );
        }
    }
    Ok(reported)
}

#[test]
fn the_reported_errors_are_those_of_the_file() -> Result<(), Error> {
    for stem in by_tier([
        &["ankle"][..],
        &[
            "ankle",
            "excavator",
            "humanoid_leg",
            "palletiser",
            "tricept",
        ],
    ]) {
        let robot = robot(stem)?;
        let mjcf = check(stem, &robot, Format::Mjcf)?;
        let urdf = check(stem, &robot, Format::Urdf)?;
        // The fit is of inertia matrix and gravity. Velocity torques of reflected rotors, whose
        // inertia depends on the pose, have no counterpart in a serial robot.
        let [mjcf, urdf] = [mjcf, urdf].map(|errors| [errors[0], errors[1]]);
        for error in mjcf.iter().chain(&urdf).flatten() {
            assert!(
                error.rms <= error.largest && error.rms < 0.5,
                "{stem}: {error:?}"
            );
        }
        for error in mjcf.iter().flatten() {
            assert!(error.rms < 0.15, "{stem}: {error:?}");
        }
    }
    Ok(())
}

/// An arm on a wall, with a slide and a body fixed on another.
const ARM: &str = r#"
name = "Arm"
gravity = ["9.81 m/s^2", 0, 0]

[[leg.arm.joint]]
name = "turn"
type = "revolute"
alpha = "30 deg"
actuated = true

[[leg.arm.joint]]
name = "lift"
type = "prismatic"
gamma = "20 deg"
alpha = "-90 deg"
d = "0.1 m"
r = "q + 0.2 m"
actuated = true

[[leg.arm.joint]]
name = "box"
type = "fixed"
d = "0.1 m"
alpha = "40 deg"

[[leg.arm.joint]]
name = "swing"
type = "revolute"
antecedent = "box"
alpha = "90 deg"
d = "0.2 m"
theta = "q + 15 deg"
actuated = true

[[place]]
name = "arm"
shape = "arm"

[experiment]
[experiment.parameters]
xx_turn = 0.03
yy_turn = 0.04
zz_turn = 0.05
mx_turn = 0.1
m_turn = 2.0
ia_turn = 0.02
xx_lift = 0.02
yy_lift = 0.02
zz_lift = 0.01
m_lift = 1.0
ia_lift = 3.0
xx_box = 0.004
yy_box = 0.005
zz_box = 0.006
mz_box = 0.02
m_box = 0.5
xx_swing = 0.002
yy_swing = 0.02
zz_swing = 0.02
mx_swing = 0.09
m_swing = 0.6

[[experiment.run]]
name = "run"
fundamental = "0.5 Hz"
terms = [
    { coordinate = "turn", harmonic = 1, amplitude = "60 deg" },
    { coordinate = "lift", harmonic = 2, amplitude = "0.1 m", phase = "30 deg" },
    { coordinate = "swing", harmonic = 3, amplitude = "50 deg" },
]
"#;

#[test]
fn a_consistent_serial_robot_has_no_error() -> Result<(), Error> {
    let source = Source::new("arm.toml", ARM);
    let robot = Robot::new(CompiledFile::new(source, &Robot::serial_request())?);
    let errors = check("arm", &robot, Format::Mjcf)?;
    println!("{errors:?}");
    assert!(errors.iter().flatten().all(|error| error.largest < 1e-7));
    // URDF has no rotor inertia: that of the slide cannot be in the bodies without their weight.
    let [inertia, ..] = check("arm", &robot, Format::Urdf)?;
    assert!(inertia.is_some_and(|error| error.rms > 0.01));
    Ok(())
}

#[test]
fn a_platform_on_legs_is_refused() -> Result<(), Error> {
    let robot = robot("five_bar")?;
    let error = robot
        .serial(&SerialSettings::new(Format::Mjcf))
        .unwrap_err();
    let problems = error.problems();
    assert!(problems[0].message.contains("platform on legs"), "{error}");
    assert!(problems[0].help.is_some());
    Ok(())
}

#[test]
fn a_robot_without_values_is_refused() -> Result<(), Error> {
    let text = std::fs::read_to_string(robots("ankle")).expect("a description");
    let text = text
        .split("[experiment]")
        .next()
        .unwrap_or_default()
        .to_owned();
    let source = Source::new("ankle.toml", text);
    let robot = Robot::new(CompiledFile::new(source, &Robot::serial_request())?);
    let mut settings = SerialSettings::new(Format::Mjcf);
    let error = robot.serial(&settings).unwrap_err();
    assert!(error.to_string().contains("no values"), "{error}");
    // With values, the ranges are assumed.
    let values = [
        ("xx_roll_foot", 3e-3),
        ("yy_roll_foot", 5e-3),
        ("zz_roll_foot", 4e-3),
        ("m_roll_foot", 0.8),
    ];
    settings.parameters = Some(values.map(|(name, value)| (name.to_owned(), value)).into());
    let model = robot.serial(&settings)?;
    assert_eq!(model.origin, overact_robot::RangeOrigin::Assumed);
    // Without inertia in the loops, the foot alone is the serial robot.
    assert!(
        model.inertia_matrix.largest < 1e-6,
        "{:?}",
        model.inertia_matrix
    );
    Ok(())
}
