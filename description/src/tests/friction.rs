//! Asymmetric friction, known torques, and their errors.

use super::{good, listed, single};
use overact_core::StandardParameter as P;

#[test]
fn directional_friction_replaces_symmetric_friction() {
    let robot = good(&single(
        "",
        "parameters = [\"ia\", \"friction by direction\"]\nstribeck = \"3 deg/s\"",
    ));
    let joint = &robot.legs[0].joints[0];
    let own = [P::Ia, P::FvPos, P::FsPos, P::FvNeg, P::FsNeg, P::Fst];
    assert_eq!(joint.parameters, own);
    let velocity = joint.stribeck.expect("a velocity").value();
    assert!((velocity - 3_f64.to_radians()).abs() < 1e-15);
    // Quadratic friction is added to either.
    let robot = good(&single("", "parameters = [\"friction\", \"fq\"]"));
    assert_eq!(
        robot.legs[0].joints[0].parameters,
        [P::Fv, P::Fs, P::Off, P::Fq]
    );
    // Parts of it may be combined with symmetric friction: the columns are independent.
    let robot = good(&single(
        "",
        "parameters = [\"fv\", \"fs\", \"fv_pos\", \"fs_neg\"]",
    ));
    assert_eq!(robot.legs[0].joints[0].parameters.len(), 4);
}

#[test]
fn known_torques_are_evaluated() {
    let cases = [
        ("2 N m * sin(q)", 2.0 * 0.3_f64.sin()),
        ("1.5 N m", 1.5),
        ("30 mN m/deg * q", 0.03 * 0.3_f64.to_degrees()),
    ];
    for (text, value) in cases {
        let robot = good(&single("", &format!("known = \"{text}\"")));
        let known = robot.legs[0].joints[0].known.clone().expect("a torque");
        assert!((known.value(0.3) - value).abs() < 1e-14, "{text}");
    }
}

#[test]
fn invalid_friction_is_rejected() {
    let joint = |keys: &str| {
        let all = listed(&single("", keys));
        assert_eq!(all.len(), 1, "{keys}: {all:#?}");
        all.concat()
    };
    let instead = "leave `fv`, `fs` and `off` out if friction differs by direction, for instance \
                   parameters = [\"inertia\", \"ia\", \"friction by direction\"]";
    let cases = [
        (
            "parameters = [\"all\", \"friction by direction\"]",
            format!(
                "6:14 `fv` of this list is contained in `fv_pos` and `fv_neg`: viscous friction occurs twice; {instead}"
            ),
        ),
        (
            "parameters = [\"off\", \"fs_pos\", \"fs_neg\"]",
            format!(
                "6:14 `off` of this list is contained in `fs_pos` and `fs_neg`: an offset occurs twice; {instead}"
            ),
        ),
        (
            "parameters = [\"fs_poss\"]",
            "6:15 unknown parameter `fs_poss`; did you mean `fs_pos`?".to_owned(),
        ),
        (
            "parameters = [\"fst\"]",
            "6:15 `fst` is not listed; the key stribeck = \"0.05 rad/s\" of the joint adds it".to_owned(),
        ),
        (
            "stribeck = 0",
            "6:12 a Stribeck velocity is positive; give the velocity at which the excess of friction at standstill has fallen to one half, for instance \"0.05 rad/s\"".to_owned(),
        ),
        (
            "stribeck = \"-1 rad/s\"",
            "6:12 a Stribeck velocity is positive; give the velocity at which the excess of friction at standstill has fallen to one half, for instance \"0.05 rad/s\"".to_owned(),
        ),
        (
            "stribeck = true",
            "6:12 `stribeck`: expected a number or an expression, found a boolean".to_owned(),
        ),
        (
            "parameters = [\"fl\"]",
            "6:15 `fl` is not listed; the key friction_load = \"40 N m * cos(q)\" of the joint adds it".to_owned(),
        ),
        (
            "friction_load = \"30 N m\"",
            "6:17 friction under a load that does not depend on the position is Coulomb friction; leave `friction_load` out, its parameter is `fs`; or write the load with the joint variable, for instance friction_load = \"40 N m * cos(q)\"".to_owned(),
        ),
        (
            "friction_load = \"cos(q^2)\"",
            "6:18 `cos` takes an angle that is linear in the joint variable; for instance cos(q - 20 deg)".to_owned(),
        ),
        (
            "known = \"sin(q) * 1 m\"",
            "6:9 expected a torque (N m), found a length; give its factors their units, for instance \"2 N m * cos(q)\"".to_owned(),
        ),
        (
            "known = \"q\"",
            "6:9 expected a torque (N m), found an angle; give its factors their units, for instance \"2 N m * cos(q)\"".to_owned(),
        ),
        (
            "known = \"2 N m * q1\"",
            "6:18 unknown name `q1`; did you mean `q`?".to_owned(),
        ),
    ];
    for (keys, expected) in cases {
        assert_eq!(joint(keys), expected, "{keys}");
    }
    let message = joint("stribeck = \"2 mm/s\"");
    let expected = "6:12 `stribeck`: expected an angular speed (rad/s), found a speed";
    assert!(message.starts_with(expected), "{message}");
}

#[test]
fn friction_and_known_torques_of_fixed_joints_are_rejected() {
    let fixed = |key: &str| {
        let text = format!(
            "name = \"Arm\"\n[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n\
             [[leg.arm.joint]]\ntype = \"fixed\"\n{key}\n\
             [[place]]\nname = \"arm\"\nshape = \"arm\"\n"
        );
        listed(&text)
    };
    let expected = "7:12 a fixed joint has no friction; give it to a joint that moves";
    assert_eq!(fixed("stribeck = 1"), [expected]);
    let expected = "7:9 no torque acts on a fixed joint; give it to a joint that moves";
    assert_eq!(fixed("known = \"1 N m\""), [expected]);
    let expected =
        "7:15 a fixed joint has no parameter `fv_pos`; its parameters are the ten of \"inertia\"";
    assert_eq!(fixed("parameters = [\"fv_pos\"]"), [expected]);
    let expected = "7:17 a fixed joint has no friction; give it to a joint that moves";
    assert_eq!(fixed("friction_load = \"q\""), [expected]);
}

#[test]
fn gain_identification_excludes_known_torques() {
    let table = "[identification]\ngains = true\nknown = { zz_1 = \"1 kg m^2\" }";
    let text = format!("{}{table}\n", single("", "known = \"1 N m\""));
    let expected = "12:9 gains are not identified if torques of joints are known: a gain scales measured torques, not known ones; leave out `gains`, or the key `known` of joints and springs";
    assert_eq!(listed(&text), [expected]);
}
