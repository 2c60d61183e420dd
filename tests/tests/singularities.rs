//! Near singular configurations the robots say so, compiled and evaluated: which leg, or which actuators,
//! and by how much.
//!
//! Legs are led to their singularity by their joints: a stretched arm, a rod that lies along the first
//! axis of its universal joint. Partitions are led there by the pose: along a path the determinant of the
//! kept actuators' rows of J_p^inv changes its sign, and bisection meets the place to rounding. There
//! case 2 has no value and says so; case 1, which needs no partition, has one.

use nalgebra::{DMatrix, Matrix6};
use overact::Error;
use overact_codegen::RobotModel;
use overact_codegen::evaluation::{Rows, Workspace};
use overact_codegen::lowering::Condition;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::served::project;
use overact_tests::support::{Backend, Failure, Sample};

macro_rules! compiled {
    ($($name:ident: $robot:ident,)*) => {
        $(overact_tests::compiled_backend!($name, "compiled", overact_robots::$robot,
            inverse_jacobian(pose);
            inverse_jacobian_from_joints(pose, joints);
            idm_red_platform(pose, twist, acceleration);
            idm_red_platform_from_joints(pose, joints, twist, acceleration);
            idm_red_actuators(pose, twist, acceleration);
            inverse_dynamics(pose, twist, acceleration, parameters););)*
    };
}

compiled! {
    CompiledFiveBar: FiveBar,
    CompiledPlanar3Rrr: Planar3Rrr,
    CompiledHexapod: Hexapod,
    CompiledOctopod: Octopod,
}

/// Why a function has no value.
#[derive(Clone, Debug, PartialEq)]
struct Refusal {
    /// The leg, or which actuators.
    what: String,
    /// How many times smaller a determinant is than at home; 0 where a leg does not reach.
    condition: f64,
}

/// A robot in both forms and a sample to be moved.
struct Robot<'a> {
    compiled: &'a dyn Backend,
    model: RobotModel,
    sample: Sample,
}

impl<'a> Robot<'a> {
    fn new(stem: &str, compiled: &'a dyn Backend) -> Result<Self, Failure> {
        let (model, expected) = described(stem)?;
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

    /// What compiled code and evaluation give.
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
        let failed = program.evaluate(1, &inputs, &mut output, &mut Workspace::default());
        Ok(match failed {
            Ok(()) => Ok(overact_tests::support::backend::matrix(program, &output)),
            Err(failed) => Err(match &program.guards[failed.guard].condition {
                Condition::Reach { leg } => Refusal {
                    what: leg.clone(),
                    condition: 0.0,
                },
                Condition::Leg { leg, home } => Refusal {
                    what: leg.clone(),
                    condition: home / failed.value.abs(),
                },
                Condition::Platform { actuators, home } => Refusal {
                    what: (*actuators).to_owned(),
                    condition: home / failed.value.abs(),
                },
            }),
        })
    }

    /// Both forms refuse, and for the same reason.
    fn assert_refused(
        &self,
        function: &str,
        sample: &Sample,
        what: &str,
        least: f64,
    ) -> Result<(), Failure> {
        for found in self.call(function, sample)? {
            let Err(refusal) = found else {
                return Err(format!("{function} has a value").into());
            };
            println!("{function}: {refusal:?}");
            assert_eq!(refusal.what, what, "{function}");
            assert!(refusal.condition >= least, "{function}: {refusal:?}");
        }
        Ok(())
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
        Error::OutOfReach { leg } => (leg, 0.0),
        Error::SingularLeg { leg, condition } => (leg, condition),
        Error::SingularPlatform {
            actuators,
            condition,
        } => (actuators, condition),
        other => return Err(other.into()),
    };
    Ok(Refusal {
        what: what.to_owned(),
        condition,
    })
}

/// A leg's joint goes to where the leg is singular: within 1e-10 rad that is an error with the leg's
/// name, at 1e-4 rad there is a value.
fn check_leg(robot: &Robot<'_>, joint: usize, singular: f64, leg: &str) -> Result<(), Failure> {
    for function in [
        "inverse_jacobian_from_joints",
        "idm_red_platform_from_joints",
    ] {
        for near in [0.0, 1e-10, -1e-10] {
            let sample = robot.with_joint(joint, singular + near);
            robot.assert_refused(function, &sample, leg, 1e9)?;
        }
        robot.assert_regular(function, &robot.with_joint(joint, singular + 1e-4))?;
    }
    Ok(())
}

#[test]
fn a_stretched_arm_of_the_five_bar_is_named() -> Result<(), Failure> {
    let robot = Robot::new("five_bar", &CompiledFiveBar)?;
    check_leg(&robot, 1, 0.0, "left")?;
    check_leg(&robot, 3, 0.0, "right")?;
    // From the pose, what lies beyond the stretched arm is out of its reach: 0.45 m from the motor.
    for (x, leg) in [(-0.1 + 0.451, "left"), (0.1 - 0.451, "right")] {
        let sample = robot.at(&[x, 0.0]);
        robot.assert_refused("idm_red_platform", &sample, leg, 0.0)?;
    }
    Ok(())
}

#[test]
fn a_stretched_leg_of_the_3rrr_is_named() -> Result<(), Failure> {
    let robot = Robot::new("planar_3rrr", &CompiledPlanar3Rrr)?;
    for (leg, name) in ["leg1", "leg2", "leg3"].into_iter().enumerate() {
        check_leg(&robot, 3 * leg + 1, 0.0, name)?;
    }
    Ok(())
}

#[test]
fn a_rod_of_the_hexapod_along_the_first_axis_of_its_joint_is_named() -> Result<(), Failure> {
    let robot = Robot::new("hexapod", &CompiledHexapod)?;
    for (leg, name) in ["leg1", "leg4"]
        .into_iter()
        .zip([0, 3])
        .map(|(n, l)| (l, n))
    {
        check_leg(&robot, 3 * leg + 1, std::f64::consts::FRAC_PI_2, name)?;
    }
    Ok(())
}

/// Where the kept actuators become singular on the path, case 2 says so and case 1 has a value; beside
/// that place both have.
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
    let jacobian = robot.compiled.call("inverse_jacobian", &sample)?;
    let inputs = DMatrix::zeros(kept.len(), 1);
    let by_runtime = project(&jacobian, &kept, &inputs);
    let Err(Error::SingularPartition { condition, .. }) = by_runtime else {
        return Err("the runtime's partition has a value".into());
    };
    println!("by the runtime: condition {condition:e}");
    assert!(condition > 1e9, "{condition:e}");
    let beside = robot.at(&path(t + 1e-3));
    robot.assert_regular("idm_red_actuators", &beside)?;
    Ok(sample)
}

/// Without redundancy the partition is the robot: inverse dynamics has no value either.
fn check_robot(
    robot: &Robot<'_>,
    path: impl Fn(f64) -> Vec<f64>,
    bracket: [f64; 2],
) -> Result<(), Failure> {
    let sample = check_partition(robot, path, bracket)?;
    robot.assert_refused("inverse_dynamics", &sample, "actuators", 1e9)
}

#[test]
fn five_bar_with_distal_links_in_line() -> Result<(), Failure> {
    let robot = Robot::new("five_bar", &CompiledFiveBar)?;
    // The elbows are half a metre apart where the point is at the height of both.
    let path = |y: f64| vec![0.0, y];
    let [low, high] = [0.12, 0.15];
    check_robot(&robot, path, [low, high])?;
    let kept = &robot.model.selection.kept_actuators;
    let height = robot.singular_pose(kept, path, [low, high])?;
    assert!((height - (0.2_f64.powi(2) - 0.15_f64.powi(2)).sqrt()).abs() < 1e-12);
    Ok(())
}

#[test]
fn planar_3rrr_with_three_distal_links_through_a_point() -> Result<(), Failure> {
    let robot = Robot::new("planar_3rrr", &CompiledPlanar3Rrr)?;
    let path = |phi: f64| vec![0.02, -0.01, phi];
    check_robot(&robot, path, [0.0, 1.0])
}

/// A pose turned about the vertical.
fn turned(phi: f64) -> Vec<f64> {
    let (sine, cosine) = (0.5 * phi).sin_cos();
    vec![0.02, -0.01, 0.5, cosine, 0.0, 0.0, sine]
}

#[test]
fn hexapod_turned_by_a_right_angle() -> Result<(), Failure> {
    let robot = Robot::new("hexapod", &CompiledHexapod)?;
    check_robot(&robot, turned, [0.2, 2.2])
}

#[test]
fn octopod_whose_kept_legs_are_singular_before_the_robot_is() -> Result<(), Failure> {
    let robot = Robot::new("octopod", &CompiledOctopod)?;
    let sample = check_partition(&robot, turned, [0.0, 1.2])?;
    robot.assert_regular("inverse_dynamics", &sample)?;
    // Other six legs determine the platform there.
    let jacobian = robot.compiled.call("inverse_jacobian", &sample)?;
    let others = [0, 1, 2, 3, 4, 6];
    let inputs = DMatrix::zeros(6, 1);
    let (_, condition) = project(&jacobian, &others, &inputs)?;
    println!("condition of {others:?}: {condition:.1}");
    let _ = Matrix6::<f64>::identity();
    Ok(())
}
