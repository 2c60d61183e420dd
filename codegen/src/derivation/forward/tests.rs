//! Inverse kinematics in closed form closes every robot of the library, in the working mode of
//! home.

use crate::cas::Arena;
use crate::derivation::{DerivationError, Derived, MotionInput, Selection, derive};
use crate::mechanism::numeric::{platform_frame, target};
use crate::mechanism::states::random_states;
use crate::mechanism::{Home, Mechanism, check};
use overact_core::Function;
use overact_description::diagnostic::Source;
use std::path::PathBuf;

/// Closure tolerance at displaced poses, m and rad.
const CLOSED: f64 = 1e-11;
/// Tolerance at home, which itself is closed to 1e-10.
const AT_HOME: f64 = 1e-8;
const POSES: usize = 20;

fn library() -> Vec<(String, Mechanism)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the library is there")
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    let read = |path: PathBuf| {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(&path).expect("a readable description");
        (name.clone(), mechanism(&name, text))
    };
    files.into_iter().map(read).collect()
}

fn mechanism(name: &str, text: String) -> Mechanism {
    let source = Source::new(name, text);
    let description = overact_description::parse(&source).expect("a right description");
    check(&description).expect("a right mechanism")
}

/// A pose near home, by number.
fn displaced(mechanism: &Mechanism, number: usize) -> Vec<f64> {
    let platform = mechanism.platform.as_ref().expect("a platform");
    let mut pose = mechanism.home.pose.clone();
    let first_angle = pose.len()
        - if platform.motion.has_quaternion() {
            4
        } else {
            0
        };
    let length = 0.05 * mechanism.length_scale();
    for (i, x) in pose.iter_mut().enumerate() {
        let reach = if i < first_angle { length } else { 0.05 };
        // Phases with irrational ratios spread the poses.
        *x += reach * (1.7 * number as f64 + 2.3 * i as f64).sin();
    }
    let norm = pose[first_angle..]
        .iter()
        .map(|q| q * q)
        .sum::<f64>()
        .sqrt();
    pose[first_angle..].iter_mut().for_each(|q| *q /= norm);
    pose
}

/// Displaced poses that the legs allow; those of a platform with parasitic motion are projected
/// onto them.
fn allowed_poses(mechanism: &Mechanism) -> Vec<Vec<f64>> {
    if mechanism.is_parasitic() {
        let states = random_states(mechanism, POSES, 1).into_iter();
        states.map(|state| state.pose).collect()
    } else {
        (0..POSES).map(|at| displaced(mechanism, at)).collect()
    }
}

/// The values of a function without rates for given inputs.
struct Values<'a, 'd> {
    arena: &'a Arena,
    derived: &'d Derived<'a>,
}

impl Values<'_, '_> {
    fn at(&self, inputs: &Home) -> Vec<f64> {
        let entries = self.derived.entries.iter();
        entries.map(|&e| inputs.value(self.arena, e)).collect()
    }

    fn of_pose(&self, pose: &[f64]) -> Vec<f64> {
        self.at(&Home {
            pose: pose.to_vec(),
            ..Home::default()
        })
    }
}

fn derived<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    function: Function,
    from: MotionInput,
) -> Result<Derived<'a>, DerivationError> {
    let selection = Selection::default();
    derive(arena, mechanism, &selection, function, from)
}

#[test]
fn closed_form_joints_close_all_legs_in_the_home_mode() {
    for (name, mechanism) in library() {
        legs_close(&name, &mechanism);
    }
}

/// The closed-form joints are those of home at home, and close the legs at poses around it.
fn legs_close(name: &str, mechanism: &Mechanism) {
    let Some(platform) = &mechanism.platform else {
        return;
    };
    let arena = Arena::new();
    let derived = derived(&arena, mechanism, Function::Joints, MotionInput::Pose)
        .unwrap_or_else(|e| panic!("{name}: {e:?}"));
    let joints = Values {
        arena: &arena,
        derived: &derived,
    };
    let at_home = joints.of_pose(&mechanism.home.pose);
    for (found, home) in at_home.iter().zip(&mechanism.home.joints) {
        assert!(
            (found - home).abs() < AT_HOME,
            "{name}: {found} at home, not {home}"
        );
    }
    for pose in allowed_poses(mechanism) {
        let found = joints.of_pose(&pose);
        let frame = platform_frame(platform.motion, &pose);
        for (index, leg) in mechanism.legs.iter().enumerate() {
            let end = target(leg.end.as_ref().expect("an end"), &frame);
            let q = &found[mechanism.leg_range(index)];
            // The course of a cable depends on its pulley.
            if leg.cable.is_some() {
                continue;
            }
            let gap = leg.closure_error(q, &end).amax();
            assert!(gap < CLOSED, "{name}, {}: open by {gap:e}", leg.name);
        }
    }
}

/// A plane whose normal the first joint tilts across the leg's base: a rotation γ about z, then a
/// right angle about x, which the base undoes.
#[test]
fn the_first_joint_may_tilt_and_rotate_the_plane_of_its_leg() {
    let first = "[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n";
    let tilted = format!("{first}gamma = \"25 deg\"\nalpha = \"90 deg\"\n");
    let given = include_str!("../../../../robots/planar_3rrr.toml");
    let text = given
        .replace(
            "rotation = [0, 0, \"psi\"]",
            "rotation = [\"-90 deg\", \"-25 deg\", \"psi\"]",
        )
        .replace(first, &tilted);
    assert!(text.len() > given.len() + 40);
    let mechanism = mechanism("tilted", text);
    legs_close("tilted", &mechanism);
}

/// Whether a robot's pose has a closed form; if so, it returns the poses of the given actuator
/// positions.
fn recovers_pose(name: &str, mechanism: &Mechanism) -> bool {
    let arena = Arena::new();
    let found = derived(
        &arena,
        mechanism,
        Function::PoseInClosedForm,
        MotionInput::Actuators,
    );
    let Ok(found) = found else { return false };
    let inverse = derived(
        &arena,
        mechanism,
        Function::ActuatorPositions,
        MotionInput::Pose,
    )
    .unwrap_or_else(|e| panic!("{name}: {e:?}"));
    let values = |derived| Values {
        arena: &arena,
        derived,
    };
    for number in 0..POSES {
        let pose = displaced(mechanism, number);
        let measured = Home {
            actuators: values(&inverse).of_pose(&pose),
            ..Home::default()
        };
        for (found, wanted) in values(&found).at(&measured).iter().zip(&pose) {
            let error = (found - wanted).abs();
            assert!(error < 1e-10, "{name}: {found}, not {wanted}");
        }
    }
    true
}

#[test]
fn closed_form_forward_kinematics_recovers_the_pose() {
    let mut with_closed_form = Vec::new();
    for (name, mechanism) in library() {
        if recovers_pose(&name, &mechanism) {
            with_closed_form.push(mechanism.name);
        }
    }
    // The robots whose legs keep a platform point at a fixed distance from a point that an actuator
    // moves.
    let expected = [
        "Delta",
        "Delta4",
        "DualV",
        "FiveBar",
        "Orthoglide",
        "ThreeLegPoint",
    ];
    assert_eq!(with_closed_form, expected);
}

#[test]
fn forward_kinematics_accepts_an_off_centre_platform_origin() {
    let text = include_str!("../../../../robots/dualv.toml")
        .replace("at = [0, \"at\", 0]", "at = [\"30 mm\", \"at\", 0]")
        .replace("at = \"r_p\"", "at = \"r_p + 20 mm\"")
        .replace("at = \"-r_p\"", "at = \"20 mm - r_p\"")
        .replace("x = \"0 m\", y = \"0 m\"", "x = \"-30 mm\", y = \"-20 mm\"");
    assert!(recovers_pose("off centre", &mechanism("off centre", text)));
}
