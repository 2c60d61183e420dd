//! Motors of several joints, and logs in their coordinates.

use super::{good, listed};

/// An arm of two joints with a log of motors and these motors, whose tables start at line 8.
fn arm(motors: &str) -> String {
    format!(
        "name = \"Arm\"\n[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n\
         [[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n{motors}\n\
         [[place]]\nname = \"arm\"\nshape = \"arm\"\n\
         [data]\ntime = \"t\"\ncoordinates = \"motors\"\n\
         positions = [\"a\", \"b\"]\ntorques = [\"c\", \"d\"]\n"
    )
}

const BOTH: &str = "[[leg.arm.motor]]\nturns = \"q1\"\nratio = 45\n\
                    [[leg.arm.motor]]\nname = \"wrist\"\nturns = \"(q1 + q2)/2\"\nratio = -32";

#[test]
fn a_coupled_motor_follows_joints_and_has_its_own_parameters() {
    let robot = good(&arm(BOTH));
    let joints = &robot.legs[0].joints;
    assert_eq!(joints.len(), 4);
    assert!(joints[2].parameters.is_empty(), "those of joint 1");
    let names: Vec<&str> = joints[3].parameters.iter().map(|p| p.name()).collect();
    assert_eq!(names, ["ia", "fv", "fs"]);
    assert_eq!(joints[3].name.value, "wrist");
    let terms: Vec<(usize, f64)> = joints[3]
        .variable
        .iter()
        .map(|(joint, factor)| (*joint, factor.value()))
        .collect();
    assert_eq!(terms, [(0, 0.5), (1, 0.5)]);
    assert_eq!(
        robot.actuators().len(),
        2,
        "motors are no actuators of their own"
    );
    let data = robot.data.expect("a log");
    assert_eq!(data.transmission, [[45.0, 0.0], [-16.0, -16.0]]);
}

#[test]
fn invalid_coupled_motors_are_rejected() {
    let motor = |keys: &str| {
        let all = listed(&arm(&format!("{BOTH}\n{keys}")).replace("\"motors\"", "\"joints\""));
        assert_eq!(all.len(), 1, "{keys}: {all:#?}");
        all.concat()
    };
    let cases = [
        (
            "[[leg.arm.motor]]",
            "15:1 a motor has no `turns`; joint variables that the motor turns through its gear, for instance turns = \"q5 + q6\"",
        ),
        (
            "[[leg.arm.motor]]\nturns = 0",
            "16:9 a motor must turn a joint; name the joint variables, for instance \"q5 + q6\"",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q1 - q1\"",
            "16:9 a motor must turn a joint; name the joint variables, for instance \"q5 + q6\"",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q2 + 5 deg\"",
            "16:9 a motor turns joint variables without a constant; give the offset of its encoder as `position_offset` of [data]",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q3\"",
            "16:10 unknown name `q3`; did you mean `q1`?",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q2\"\nratio = 0",
            "17:9 a gear of ratio 0 turns nothing; give the turns of the motor for one turn of its output, for instance 100",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q2\"\nratio = \"1e40\"",
            "17:9 the value is too large; in SI units numbers go from 1e-50 to 1e30",
        ),
        (
            "[[leg.arm.motor]]\nname = \"wrist\"\nturns = \"q2\"",
            "16:8 there are two joints or motors `wrist` in this leg; a motor without a name is called by its number, `m1`",
        ),
        (
            "[[leg.arm.motor]]\nturns = \"q2\"\nparameters = \"inertia\"",
            "17:14 a motor has no parameter `xx`; its parameters are \"ia\", \"fv\", \"fs\", \"off\", \"fq\" and those of \"friction by direction\"",
        ),
    ];
    for (keys, expected) in cases {
        assert_eq!(motor(keys), expected, "{keys}");
    }
}

#[test]
fn motor_logs_need_motors_that_determine_the_joints() {
    let one = "[[leg.arm.motor]]\nturns = \"q1\"";
    let help =
        "; describe each motor as [[leg.NAME.motor]] with turns = \"q1\" and its gear's ratio";
    let expected = format!(
        "15:15 a log of motors needs as many motors as actuated joints, 2, but the description has 1{help}"
    );
    assert_eq!(listed(&arm(one)), [expected]);
    let twice = format!("{one}\n{one}\nratio = 3");
    let expected = "18:15 the motors do not determine the joints: some turn the same combinations; \
                    each motor turns something that the others do not";
    assert_eq!(listed(&arm(&twice)), [expected]);
}

#[test]
fn an_error_in_one_motor_is_reported_alone() {
    for (mistake, expected) in [
        ("turns = \"q3\"", "unknown name `q3`"),
        (
            "turns = \"q2\"\nratio = \"45 deg\"",
            "`ratio`: expected a plain number",
        ),
        ("turns = \"q2\"\nratio = 0", "a gear of ratio 0"),
    ] {
        let all = listed(&arm(&format!(
            "[[leg.arm.motor]]\nturns = \"q1\"\n[[leg.arm.motor]]\n{mistake}"
        )));
        assert_eq!(all.len(), 1, "{mistake}: {all:#?}");
        assert!(all[0].contains(expected), "{all:#?}");
    }
    // A fixed joint that stays actuated has no variable, which is not reported again.
    let fixed = arm(BOTH).replacen("\"revolute\"", "\"fixed\"", 1);
    let all = listed(&fixed);
    assert_eq!(all, ["4:12 a fixed joint cannot be actuated"]);
}

/// Two slides that carry a platform along z, with tables of motors from line 11.
fn slides(tables: &str) -> String {
    format!(
        "name = \"Slide\"\n[platform]\nmotion = \"fixed axis\"\naxis = \"z\"\n\
         [[leg.slide.joint]]\ntype = \"prismatic\"\n[leg.slide.end]\n\
         [[place]]\nname = \"left\"\nshape = \"slide\"\n{tables}\n\
         [[place]]\nname = \"right\"\nshape = \"slide\"\n"
    )
}

#[test]
fn closed_loop_motors_drive_joints_of_several_legs() {
    let robot = good(&slides(
        "[motor.sum]\nturns = \"left.q1 + 0.5*right.q1\"\nratio = 3\n\
         [motor.own]\nturns = \"2*right.q1\"\nparameters = [\"ia\"]",
    ));
    assert!(robot.legs.iter().all(|leg| leg.joints.len() == 1));
    let terms = |index: usize| -> Vec<(usize, usize, f64)> {
        let terms = robot.motors[index].terms.iter();
        terms
            .map(|term| (term.joint.leg, term.joint.joint, term.factor.value()))
            .collect()
    };
    assert_eq!(terms(0), [(0, 0, 1.0), (1, 0, 0.5)]);
    assert_eq!(terms(1), [(1, 0, 2.0)]);
    let names = |index: usize| -> Vec<&str> {
        let parameters = robot.motors[index].parameters.iter();
        parameters.map(|symbol| symbol.name()).collect()
    };
    assert_eq!(names(0), ["ia", "fv", "fs"]);
    assert_eq!(names(1), ["ia"]);
    assert_eq!(robot.motors[0].kind, crate::JointKind::Prismatic);
}

#[test]
fn motors_of_a_leg_are_placed_with_it() {
    let robot = good(&slides("").replace(
        "[leg.slide.end]",
        "[[leg.slide.motor]]\nname = \"belt\"\nturns = \"2*q1\"\n[leg.slide.end]",
    ));
    let legs: Vec<Option<usize>> = robot.motors.iter().map(|motor| motor.leg).collect();
    assert_eq!(legs, [Some(0), Some(1)]);
    let names: Vec<&str> = { robot.motors[1].parameters.iter() }
        .map(|symbol| symbol.name())
        .collect();
    assert_eq!(
        names,
        ["ia", "fv", "fs"],
        "those of the passive joint are its bearings'"
    );
}

#[test]
fn invalid_motors_of_closed_loop_robots_are_rejected() {
    let first = "[motor.a]\nturns = \"left.q1\"\n";
    let cases = [
        (
            "[motor.a]\nturns = \"left.q2\"",
            "12:10 unknown name `left.q2`; did you mean `left.q1`?",
        ),
        (
            "[motor.a]\nturns = \"left.q1 - left.q1\"",
            "12:9 a motor must turn a joint; name the joint variables, for instance \"q5 + q6\"",
        ),
        (
            "[motor.1a]\nturns = \"left.q1\"",
            "11:8 `1a` cannot be the name of a motor; use letters, digits and underscores, a letter first",
        ),
        (
            "[motor.left]\nturns = \"left.q1\"\n[motor.a]\nturns = \"left.q1\"\nname = \"b\"",
            "15:1 unknown key `name`; known keys: ",
        ),
    ];
    for (tables, expected) in cases {
        let all = listed(&slides(tables));
        assert_eq!(all.len(), 1, "{tables}: {all:#?}");
        assert!(
            all[0].contains(expected) || all[0] == expected,
            "{tables}: {all:#?}"
        );
    }
    let clash = slides(&format!("{first}[motor.left]\nturns = \"right.q1\"")).replace(
        "type = \"prismatic\"",
        "type = \"prismatic\"\nactuated = true",
    );
    let all = listed(&clash);
    assert_eq!(
        all,
        ["14:8 another actuator is also called `left`; rename this motor, or the joint or leg"]
    );
}

#[test]
fn serial_motors_may_be_described_outside_their_leg() {
    let text = arm("").replace(
        "[data]",
        "[motor.one]\nturns = \"q1\"\nratio = 45\n\
         [motor.wrist]\nturns = \"(arm.q1 + q2)/2\"\nratio = -32\n[data]",
    );
    let robot = good(&text);
    assert!(
        robot.motors.is_empty(),
        "they are coupled joints of the leg"
    );
    let data = robot.data.expect("a log");
    assert_eq!(data.transmission, [[45.0, 0.0], [-16.0, -16.0]]);
}

#[test]
fn closed_loop_logs_may_have_motor_or_joint_coordinates() {
    let log = |coordinates: &str, motors: &str| {
        slides(motors)
            + "[data]\ntime = \"t\"\npositions = [\"a\", \"b\"]\ntorques = [\"c\", \"d\"]\n"
            + coordinates
    };
    let both = "[motor.a]\nturns = \"left.q1 + right.q1\"\nratio = 3\n\
                [motor.b]\nturns = \"left.q1 - right.q1\"";
    let transmission = |coordinates: &str| {
        let robot = good(&log(coordinates, both));
        robot.data.expect("a log").transmission
    };
    let gears = [[3.0, 0.0], [0.0, 1.0]];
    assert_eq!(transmission(""), gears);
    assert_eq!(transmission("coordinates = \"motors\""), gears);
    // θ = T q, and the log has q.
    let joints = transmission("coordinates = \"joints\"");
    assert_eq!(joints, [[0.5, 0.5], [0.5, -0.5]]);
    let dependent_motors = "[motor.a]\nturns = \"left.q1 + right.q1\"\n\
                 [motor.b]\nturns = \"2*left.q1 + 2*right.q1\"";
    let all = listed(&log("coordinates = \"joints\"", dependent_motors));
    assert_eq!(
        all,
        [
            "22:15 the motors do not determine the joints: some turn the same combinations; \
             use coordinates = \"motors\", the positions and torques of the motors themselves"
        ]
    );
}
