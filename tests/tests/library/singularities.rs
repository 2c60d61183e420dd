//! Near singular configurations, compiled and evaluated robots report the leg or actuators, and the
//! condition.
//!
//! Legs are moved to their singularity by their joints: a stretched arm, or a rod along the first
//! axis of its universal joint. Partitions are moved there by the pose: along a path, the
//! determinant of the kept actuators' rows of J_p^inv changes its sign, and bisection finds the
//! place. There the actuator projection has no value; the platform projection, which needs no
//! partition, has one.

use nalgebra::DMatrix;
use overact::Error;
use overact_codegen::derivation::function_name;
use overact_codegen::interpreter::Rows;
use overact_codegen::lowering::Condition;
use overact_codegen::{Effort, Request, RobotModel, Source, compile_with};
use overact_compiled::partitions;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::workspace;
use overact_tests::support::sample::samples;
use overact_tests::support::served::project;
use overact_tests::support::{Backend, Failure, Sample, conversion, description};

/// Functions that are called; others are not generated.
const FUNCTIONS: [&str; 6] = [
    "inverse_jacobian",
    "inverse_jacobian_from_joints",
    "idm_red_platform",
    "idm_red_platform_from_joints",
    "idm_red_actuators",
    "inverse_dynamics",
];

macro_rules! backends {
    ($($name:ident: $robot:path,)*) => {
        $(overact_tests::compiled_backend!($name, "compiled", $robot,
            inverse_jacobian(pose);
            inverse_jacobian_from_joints(pose, joints);
            idm_red_platform(pose, twist, acceleration);
            idm_red_platform_from_joints(pose, joints, twist, acceleration);
            idm_red_actuators(pose, twist, acceleration);
            inverse_dynamics(pose, twist, acceleration, parameters););)*
    };
}

backends! {
    FiveBar: overact_compiled::FiveBar,
    Planar3Rrr: overact_compiled::Planar3Rrr,
    Hexapod: overact_compiled::Hexapod,
    Octopod: overact_compiled::Octopod,
    Kept123: partitions::kept_123::DualV,
    Kept124: partitions::kept_124::DualV,
    Kept134: partitions::kept_134::DualV,
    Kept234: partitions::kept_234::DualV,
}

/// Error of a function without a value.
#[derive(Clone, Debug, PartialEq)]
struct Refusal {
    /// Leg, or actuators.
    what: String,
    /// Ratio of the determinant at home to that here; 0 if a leg does not reach.
    condition: f64,
}

/// A robot in both forms, and a sample to be moved.
struct Robot<'a> {
    compiled: &'a dyn Backend,
    model: RobotModel,
    sample: Sample,
}

impl<'a> Robot<'a> {
    fn new(stem: &str, compiled: &'a dyn Backend) -> Result<Self, Failure> {
        Self::described(&description(stem)?, compiled)
    }

    fn described(source: &Source, compiled: &'a dyn Backend) -> Result<Self, Failure> {
        let request = Request {
            wanted: &|_, function, from| {
                FUNCTIONS.contains(&function_name(function, from, false).as_str())
            },
            ..Request::with_effort(Effort::None)
        };
        let described = compile_with(source, &request).map_err(|e| e.render_plain(source))?;
        let model = described.model;
        let mechanism = conversion::reference(&model.mechanism, workspace(&model));
        let expected = Expected::by_position(&model, mechanism);
        let mut all = samples(&expected.mechanism, &expected.parameters(), 1, 5, false)?;
        let sample = all.pop().ok_or("no sample")?;
        Ok(Self {
            compiled,
            model,
            sample,
        })
    }

    /// The sample at home with one joint elsewhere.
    fn with_joint(&self, joint: usize, position: f64) -> Sample {
        let mut sample = self.sample.clone();
        let home = &self.model.mechanism.home;
        sample.state.pose.clone_from(&home.pose);
        sample.state.q.copy_from_slice(&home.joints);
        sample.state.q[joint] = position;
        sample
    }

    fn at(&self, pose: &[f64]) -> Sample {
        let mut sample = self.sample.clone();
        sample.state.pose = pose.to_vec();
        sample
    }

    /// Values of compiled code and evaluation.
    fn call(
        &self,
        function: &str,
        sample: &Sample,
    ) -> Result<[Result<DMatrix<f64>, Refusal>; 2], Failure> {
        let compiled = match self.compiled.call(function, sample) {
            Ok(output) => Ok(output),
            Err(failure) => Err(compiled_refusal(failure)?),
        };
        Ok([compiled, self.evaluate(function, sample)?])
    }

    fn evaluate(
        &self,
        function: &str,
        sample: &Sample,
    ) -> Result<Result<DMatrix<f64>, Refusal>, Failure> {
        let found = self.model.functions.iter().find(|f| f.name == function);
        let program = &found.ok_or("no such function")?.program;
        let inputs = program.inputs.iter().map(|array| {
            let values = sample.input(&array.name)?;
            Ok(Rows {
                values,
                shared: false,
            })
        });
        let inputs = inputs.collect::<Result<Vec<_>, Failure>>()?;
        let mut output = vec![0.0; program.output.len()];
        let failed = program.evaluate(1, &inputs, &mut output);
        Ok(match failed {
            Ok(()) => Ok(overact_tests::support::backend::matrix(program, &output)),
            Err(failed) => Err(match &program.guards[failed.guard].condition {
                Condition::Reach { leg, .. } => Refusal {
                    what: leg.clone(),
                    condition: 0.0,
                },
                Condition::Size { .. } => Refusal {
                    what: "a value that is too large".to_owned(),
                    condition: 0.0,
                },
                Condition::Leg { leg, home } => Refusal {
                    what: leg.clone(),
                    condition: home / failed.value.abs(),
                },
                Condition::Mass => Refusal {
                    what: "mass matrix".to_owned(),
                    condition: 0.0,
                },
                Condition::Closed { leg, .. } => Refusal {
                    what: leg.clone(),
                    condition: failed.value.abs(),
                },
                Condition::Coordinates { home } => Refusal {
                    what: "independent coordinates".to_owned(),
                    condition: home / failed.value.abs(),
                },
                Condition::Platform { actuators, home } => Refusal {
                    what: actuators.to_string(),
                    condition: home / failed.value.abs(),
                },
            }),
        })
    }

    /// Asserts that both forms fail for the same reason with at least this condition.
    fn assert_refused(
        &self,
        function: &str,
        sample: &Sample,
        what: &str,
        least: f64,
    ) -> Result<[f64; 2], Failure> {
        let refused = |found: Result<DMatrix<f64>, Refusal>| {
            let refusal = found.err().ok_or(format!("{function} has a value"))?;
            println!("{function}: {refusal:?}");
            assert_eq!(refusal.what, what, "{function}");
            assert!(refusal.condition >= least, "{function}: {refusal:?}");
            Ok::<f64, Failure>(refusal.condition)
        };
        let [compiled, evaluated] = self.call(function, sample)?;
        Ok([refused(compiled)?, refused(evaluated)?])
    }

    /// Both forms have a finite value.
    fn assert_regular(&self, function: &str, sample: &Sample) -> Result<(), Failure> {
        for found in self.call(function, sample)? {
            let output = found.map_err(|refusal| format!("{function}: {refusal:?}"))?;
            assert!(output.iter().all(|x| x.is_finite()), "{function}");
        }
        Ok(())
    }

    /// Determinant of the rows of J_p^inv of chosen actuators.
    fn determinant(&self, kept: &[usize], pose: &[f64]) -> Result<f64, Failure> {
        let jacobian = self.compiled.call("inverse_jacobian", &self.at(pose))?;
        Ok(jacobian.select_rows(kept).determinant())
    }

    /// A pose on the path where chosen actuators become singular.
    fn singular_pose(
        &self,
        kept: &[usize],
        path: impl Fn(f64) -> Vec<f64>,
        [mut low, mut high]: [f64; 2],
    ) -> Result<f64, Failure> {
        let at = |t: f64| self.determinant(kept, &path(t));
        let start = at(low)?;
        assert!(start * at(high)? < 0.0, "the singularity is bracketed");
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return Ok(low);
            }
            if start * at(middle)? > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
}

fn compiled_refusal(failure: Failure) -> Result<Refusal, Failure> {
    let error = *failure.downcast::<Error>()?;
    let (what, condition) = match error {
        Error::OutOfReach { leg } => (leg.to_owned(), 0.0),
        Error::SingularLeg { leg, condition } => (leg.to_owned(), condition),
        Error::SingularPlatform {
            actuators,
            condition,
        } => (actuators.to_string(), condition),
        other => return Err(other.into()),
    };
    Ok(Refusal { what, condition })
}

/// Moves a leg's joint to the leg's singularity.
///
/// Within 1e-10 rad the error names the leg; at 1e-4 rad there is a value. The leg's determinant is
/// proportional to the sine of the distance, which determines the condition number.
fn check_leg(
    robot: &Robot<'_>,
    functions: &[&str],
    joint: usize,
    singular: f64,
    leg: &str,
) -> Result<(), Failure> {
    const NEAR: f64 = 1e-10;
    let home = robot.model.mechanism.home.joints[joint];
    let expected = (home - singular).sin().abs() / NEAR;
    for function in functions {
        let sample = robot.with_joint(joint, singular);
        robot.assert_refused(function, &sample, leg, 1e14)?;
        for near in [NEAR, -NEAR] {
            let sample = robot.with_joint(joint, singular + near);
            for condition in robot.assert_refused(function, &sample, leg, 1e9)? {
                // Generated code states four digits of the magnitude at home.
                let relative = (condition / expected - 1.0).abs();
                assert!(relative < 1e-3, "{condition:e} against {expected:e}");
            }
        }
        robot.assert_regular(function, &robot.with_joint(joint, singular + 1e-4))?;
    }
    Ok(())
}

const REGRESSORS: [&str; 2] = [
    "inverse_jacobian_from_joints",
    "idm_red_platform_from_joints",
];

#[test]
fn a_stretched_arm_of_the_five_bar_is_reported() -> Result<(), Failure> {
    let robot = Robot::new("five_bar", &FiveBar)?;
    check_leg(&robot, &REGRESSORS, 1, 0.0, "left")?;
    check_leg(&robot, &REGRESSORS, 3, 0.0, "right")?;
    // From the pose, positions beyond the stretched arm are out of reach: 0.45 m from the motor.
    for (x, leg) in [(-0.1 + 0.451, "left"), (0.1 - 0.451, "right")] {
        let sample = robot.at(&[x, 0.0]);
        robot.assert_refused("idm_red_platform", &sample, leg, 0.0)?;
    }
    Ok(())
}

#[test]
fn a_stretched_leg_of_the_3rrr_is_reported() -> Result<(), Failure> {
    let robot = Robot::new("planar_3rrr", &Planar3Rrr)?;
    for (leg, name) in ["leg1", "leg2", "leg3"].into_iter().enumerate() {
        check_leg(&robot, &REGRESSORS, 3 * leg + 1, 0.0, name)?;
    }
    Ok(())
}

/// The drive's rate is the velocity along the rod even there; the cross joint's rate is lost.
#[test]
fn a_hexapod_rod_along_its_first_joint_axis_is_reported() -> Result<(), Failure> {
    let robot = Robot::new("hexapod", &Hexapod)?;
    for leg in [0, 3] {
        let name = format!("leg{}", leg + 1);
        let joint = 3 * leg + 1;
        let singular = std::f64::consts::FRAC_PI_2;
        check_leg(&robot, &REGRESSORS[1..], joint, singular, &name)?;
        let sample = robot.with_joint(joint, singular);
        robot.assert_regular("inverse_jacobian_from_joints", &sample)?;
    }
    Ok(())
}

/// Where the kept actuators become singular on the path, only the platform projection has a value;
/// nearby both have.
fn check_partition(
    robot: &Robot<'_>,
    path: impl Fn(f64) -> Vec<f64>,
    bracket: [f64; 2],
) -> Result<Sample, Failure> {
    let kept = robot.model.selection.kept_actuators.clone();
    let t = robot.singular_pose(&kept, &path, bracket)?;
    let sample = robot.at(&path(t));
    robot.assert_refused("idm_red_actuators", &sample, "kept actuators", 1e9)?;
    robot.assert_regular("idm_red_platform", &sample)?;
    let Err(Error::SingularPartition {
        condition,
        kept: named,
    }) = by_runtime(robot, &sample, &kept)
    else {
        return Err("the runtime's partition has a value".into());
    };
    assert!(named.iter().eq(kept.iter().copied()));
    assert!(condition > 1e9, "{condition:e}");
    let nearby = robot.at(&path(t + 1e-3));
    robot.assert_regular("idm_red_actuators", &nearby)?;
    Ok(sample)
}

/// Condition number of a partition by the runtime.
fn by_runtime(robot: &Robot<'_>, sample: &Sample, kept: &[usize]) -> Result<f64, Error> {
    let jacobian = robot.compiled.call("inverse_jacobian", sample);
    let jacobian = jacobian.map_err(|_| Error::Overflow)?;
    let (_, condition) = project(&jacobian, kept, &DMatrix::zeros(kept.len(), 1))?;
    println!("condition of {kept:?}: {condition:e}");
    Ok(condition)
}

/// Without redundancy the only partition is the robot, so inverse dynamics has no value either.
fn check_robot(
    robot: &Robot<'_>,
    path: impl Fn(f64) -> Vec<f64>,
    bracket: [f64; 2],
) -> Result<(), Failure> {
    let sample = check_partition(robot, path, bracket)?;
    robot.assert_refused("inverse_dynamics", &sample, "actuators", 1e9)?;
    Ok(())
}

#[test]
fn a_five_bar_with_aligned_distal_links_is_singular() -> Result<(), Failure> {
    let robot = Robot::new("five_bar", &FiveBar)?;
    // The elbows are half a metre apart if the point is at the height of both.
    let path = |y: f64| vec![0.0, y];
    let bracket = [0.12, 0.15];
    check_robot(&robot, path, bracket)?;
    let kept = &robot.model.selection.kept_actuators;
    let height = robot.singular_pose(kept, path, bracket)?;
    assert!((height - (0.2_f64.powi(2) - 0.15_f64.powi(2)).sqrt()).abs() < 1e-12);
    Ok(())
}

#[test]
fn a_3rrr_with_concurrent_distal_links_is_singular() -> Result<(), Failure> {
    let robot = Robot::new("planar_3rrr", &Planar3Rrr)?;
    let path = |phi: f64| vec![0.02, -0.01, phi];
    check_robot(&robot, path, [0.0, 1.0])
}

#[test]
fn a_hexapod_rotated_by_a_right_angle_is_singular() -> Result<(), Failure> {
    let robot = Robot::new("hexapod", &Hexapod)?;
    let turned = |phi: f64| {
        let (sine, cosine) = (0.5 * phi).sin_cos();
        vec![0.02, -0.01, 0.5, cosine, 0.0, 0.0, sine]
    };
    check_robot(&robot, turned, [0.2, 2.2])
}

/// Each partition of the DualV has its own singular places, where the others are regular.
#[test]
fn dualv_partitions_are_singular_at_different_poses() -> Result<(), Failure> {
    let source = description("dualv")?;
    let path = |phi: f64| vec![0.01, 0.02, phi];
    let partitions: [(&dyn Backend, usize, [f64; 2]); 4] = [
        (&Kept123, 3, [-0.6, -0.55]),
        (&Kept124, 2, [0.5, 0.55]),
        (&Kept134, 1, [-0.65, -0.6]),
        (&Kept234, 0, [0.6, 0.65]),
    ];
    let all_but = |out: usize| -> Vec<usize> { (0..4).filter(|at| *at != out).collect() };
    for (compiled, out, bracket) in partitions {
        let names = all_but(out)
            .iter()
            .map(|at| format!("\"leg{}\"", at + 1))
            .collect::<Vec<_>>();
        let kept = format!("kept_actuators = [{}]", names.join(", "));
        let given = "kept_actuators = [\"leg1\", \"leg2\", \"leg3\"]";
        assert!(source.text.contains(given));
        let text = source.text.replace(given, &kept);
        let robot = Robot::described(&Source::new("robots/dualv.toml", text), compiled)?;
        assert_eq!(robot.model.selection.kept_actuators, all_but(out));
        let sample = check_partition(&robot, path, bracket)?;
        robot.assert_regular("inverse_dynamics", &sample)?;
        for other in (0..4).filter(|other| *other != out) {
            assert!(by_runtime(&robot, &sample, &all_but(other))? < 1e3);
        }
    }
    Ok(())
}

#[test]
fn a_tilted_octopod_has_a_singular_partition() -> Result<(), Failure> {
    let robot = Robot::new("octopod", &Octopod)?;
    let length = 1.09_f64.sqrt();
    let tilted = |angle: f64| {
        let (sine, cosine) = (0.5 * angle).sin_cos();
        let [x, y] = [sine / length, 0.3 * sine / length];
        vec![0.02, -0.01, 0.5, cosine, x, y, 0.0]
    };
    let sample = check_partition(&robot, tilted, [-1.65, -1.5])?;
    // The robot is far from a singularity: all eight legs support the platform, and so do other
    // six.
    robot.assert_regular("inverse_dynamics", &sample)?;
    let kept = &robot.model.selection.kept_actuators;
    let mut partitions = 0;
    for first in 0..8 {
        for second in first + 1..8 {
            let others: Vec<usize> = (0..8).filter(|&at| at != first && at != second).collect();
            let condition = by_runtime(&robot, &sample, &others);
            let is_regular = condition.is_ok_and(|condition| condition < 1e4);
            assert!(!is_regular || others != *kept);
            partitions += usize::from(is_regular);
        }
    }
    assert!(partitions > 0, "no other six legs hold the platform");
    Ok(())
}
