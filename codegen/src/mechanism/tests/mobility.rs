//! Errors of robots whose legs allow other motions than those described.

use super::{PLANAR, assert_diagnosis, changed, diagnosis};
use crate::mechanism::Motion;
use crate::mechanism::check::{plain, rough_home};
use crate::mechanism::mobility::Mobility;
use crate::mechanism::numeric::platform_frame;
use crate::mechanism::parasitic::closed;
use nalgebra::Vector3;
use overact_description::diagnostic::{DiagnosticKind, Source};

/// Three legs of a revolute joint with a horizontal axis, a linear motor and a ball joint. They
/// allow translation along z and rotation about x and y.
fn three_rps(motion: &str) -> String {
    rps(motion, &[0, 120, 240])
}

/// Such legs at some angles around z, deg.
fn rps(motion: &str, angles: &[i32]) -> String {
    let mut text = format!(
        r#"name = "Tripod"
[constants]
r = "0.3 m"
[platform]
motion = "{motion}"
home = {{ z = "0.5 m" }}
[leg.rps]
variables = ["psi"]
base = {{ at = ["r * cos(psi)", "r * sin(psi)", 0], rotation = [0, 0, "psi"] }}
[[leg.rps.joint]]
type = "revolute"
alpha = "90 deg"
[[leg.rps.joint]]
type = "prismatic"
alpha = "-90 deg"
actuated = true
[leg.rps.end]
type = "point"
at = ["r * cos(psi)", "r * sin(psi)", 0]
"#
    );
    for (leg, psi) in angles.iter().enumerate() {
        text += &format!(
            "[[place]]\nname = \"leg{}\"\nshape = \"rps\"\npsi = \"{psi} deg\"\nhome = {{ 2 = \"0.5 m\" }}\n",
            leg + 1
        );
    }
    text
}

#[test]
fn parasitic_motion_is_explained_instead_of_missing_actuators() {
    let text = three_rps("spatial");
    assert_diagnosis(
        &text,
        "5:10",
        &[
            "the platform has 6 degrees of freedom, but the robot has 3 actuators",
            "the legs allow the platform only 3 of these 6 motions (along z, and about x and y)",
            "these determine the others best (condition number 1.0 at home)",
            "has parasitic motion with them, along x and y",
            "write independent = [\"z\", \"rx\", \"ry\"] next to `motion`",
            "leg `rps` has too few joints to follow the platform's motion",
        ],
    );
    assert!(!diagnosis(&text).contains("mark more joints"));
}

/// The three legs with given independent coordinates.
fn with_independent(coordinates: &str) -> String {
    let key = format!("motion = \"spatial\"\nindependent = [{coordinates}]");
    three_rps("spatial").replace("motion = \"spatial\"", &key)
}

#[test]
fn sufficient_independent_coordinates_are_accepted() {
    assert_eq!(
        diagnosis(&with_independent("\"z\", \"rx\", \"ry\"")),
        "a robot"
    );
}

#[test]
fn insufficient_independent_coordinates_are_rejected_with_advice() {
    assert_diagnosis(
        &with_independent("\"x\", \"rx\", \"ry\""),
        "5:10",
        &[
            "the independent coordinates do not determine the platform's motion at home",
            "write independent = [\"z\", \"rx\", \"ry\"], whose condition number is 1.0",
        ],
    );
    assert_diagnosis(
        &with_independent("\"z\", \"rx\""),
        "5:10",
        &[
            "2 coordinates are independent, but the legs allow the platform 3 motions",
            "write independent = [\"z\", \"rx\", \"ry\"]",
        ],
    );
    let twice = diagnosis(&with_independent("\"z\", \"z\""));
    assert!(twice.contains("`z` occurs twice"), "{twice}");
    let all = diagnosis(&with_independent(
        "\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"",
    ));
    assert!(
        all.contains("6 of six coordinates are independent"),
        "{all}"
    );
    let planar = changed(
        PLANAR,
        &[(
            "motion = \"planar\"",
            "motion = \"planar\"\nindependent = [\"x\"]",
        )],
    );
    let planar = self::diagnosis(&planar);
    assert!(
        planar.contains("`independent` has no meaning for this motion"),
        "{planar}"
    );
}

/// A tilted pose without its parasitic displacement is not allowed by the legs. It is projected
/// onto the closures before motions are counted. The legs' planes block the rotation about z.
#[test]
fn a_tilted_home_pose_is_closed_before_motions_are_counted() {
    let tilted = three_rps("spatial").replace(
        "z = \"0.5 m\" }",
        "z = \"0.5 m\", rx = \"20 deg\", ry = \"5 deg\" }",
    );
    assert_diagnosis(
        &tilted,
        "5:10",
        &[
            "the legs allow the platform only 3 of these 6 motions (along z, and about x and y)",
            "these determine the others best (condition number 1.",
            "has parasitic motion with them, along x and y, and about z: write independent = ",
        ],
    );
    assert!(!diagnosis(&tilted).contains("mark more joints"));
}

/// Three legs at equal angles block the rotation about z at every pose: the last component of the
/// quaternion stays zero. At other angles it does not.
#[test]
fn coordinates_held_at_zero_by_closures_are_found() {
    let still = |angles: &[i32]| {
        let motion = "spatial\"\nindependent = [\"z\", \"rx\", \"ry\"]\nsource = \"";
        let text = rps(motion, angles).replace("source = \"\"\n", "");
        let source = Source::new("rps.toml", text);
        let description = overact_description::parse(&source).expect("a description");
        crate::mechanism::check(&description)
            .expect("a robot")
            .still
    };
    assert_eq!(still(&[0, 120, 240]), [6]);
    assert!(still(&[0, 100, 240]).is_empty());
}

/// The ball of each leg stays in the vertical plane of its slide, n · (p + R a) = 0. The three
/// equations and their derivatives n · v + (R a × n) · ω = 0 do not depend on the legs' joints.
#[test]
fn projected_poses_and_motions_satisfy_the_planes_of_the_legs() {
    let tilted = three_rps("spatial").replace(
        "z = \"0.5 m\" }",
        "z = \"0.5 m\", rx = \"20 deg\", ry = \"5 deg\" }",
    );
    let source = Source::new("rps.toml", tilted);
    let description = overact_description::parse(&source).expect("a description");
    let mechanism = plain(&description);
    let rough = rough_home(&description);
    let found = closed(&mechanism, &rough).expect("a pose that the legs allow");
    let pose = platform_frame(Motion::Spatial, &found.home.pose);
    let mobility = Mobility::at_home(&found).expect("motions");
    assert_eq!(mobility.count(), 3);
    let size = found.length_scale();
    let start = platform_frame(Motion::Spatial, &rough.pose);
    let mut missed: f64 = 0.0;
    for psi in [0.0_f64, 120.0, 240.0].map(f64::to_radians) {
        let normal = Vector3::new(-psi.sin(), psi.cos(), 0.0);
        let ball = Vector3::new(psi.cos(), psi.sin(), 0.0) * 0.3;
        missed = missed.max(
            normal
                .dot(&(start * nalgebra::Point3::from(ball)).coords)
                .abs(),
        );
        let arm = pose.rotation * ball;
        let gap = normal.dot(&(pose.translation.vector + arm));
        assert!(gap.abs() < 1e-9, "{gap}");
        for twist in mobility.allowed.column_iter() {
            let linear = Vector3::new(twist[0], twist[1], twist[2]) * size;
            let angular = Vector3::new(twist[3], twist[4], twist[5]);
            let rate = normal.dot(&linear) + arm.cross(&normal).dot(&angular);
            assert!(rate.abs() < 1e-9, "{rate}");
        }
    }
    // The start is not an allowed pose.
    assert!(missed > 1e-3, "{missed}");
}

/// Three legs of three parallel axes each keep a free platform in a plane that does not change.
#[test]
fn a_narrower_motion_is_proposed_without_parasitic_motion() {
    let free = [
        ("motion = \"planar\"", "motion = \"spatial\""),
        ("phi = \"0 deg\"", "rz = \"0 deg\""),
    ];
    let text = changed(PLANAR, &free);
    let diagnosis = diagnosis(&text);
    for words in [
        "only 3 of these 6 motions (along x and y, and about z)",
        "choose a `motion` that the legs allow",
    ] {
        assert!(diagnosis.contains(words), "{words}\nin\n{diagnosis}");
    }
    assert!(!diagnosis.contains("parasitic motion"), "{diagnosis}");
}

#[test]
fn a_motion_not_enforced_by_the_legs_is_rejected() {
    assert_diagnosis(
        &three_rps("fixed axis"),
        "5:10",
        &[
            "the legs do not restrict the platform to this motion",
            "they allow 3 motions, along z, and about x and y, and the actuators drive all of them",
        ],
    );
}

/// Four actuators drive the three allowed motions: one internal torque, not three.
#[test]
fn redundant_actuators_do_not_replace_leg_constraints() {
    let text = rps("fixed axis", &[0, 120, 240, 180]);
    let what =
        ["they allow 3 motions, along z, and about x and y, and the actuators drive all of them"];
    assert_diagnosis(&text, "5:10", &what);
    let description =
        overact_description::parse(&Source::new("rps.toml", text)).expect("a description");
    let errors = super::super::check(&description).expect_err("another robot");
    let kinds: Vec<DiagnosticKind> = errors.iter().map(|error| error.kind).collect();
    assert_eq!(kinds, [DiagnosticKind::NotHeld]);
}

#[test]
fn rods_that_replace_parallelograms_are_accepted() {
    let rods = include_str!("../../../../robots/delta_4.toml");
    assert_eq!(
        diagnosis(rods.split("\n[identification]").next().unwrap_or(rods)),
        "a robot"
    );
}
