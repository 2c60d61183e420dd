//! Motors that turn several joints, tendons, and driven joints that are coupled.

use overact_interchange::{Imported, Options, import};

/// Imports a file; errors are listed with their lines.
fn read(name: &str, text: &str, options: &Options) -> Result<Imported, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("a file");
    import(&file, options).map_err(|errors| {
        let mut all = String::new();
        for (source, diagnostics) in &errors.0 {
            for error in diagnostics {
                let line = error.span.as_ref().map(|span| source.position(span).line);
                let line = line.map_or(String::new(), |line| format!("{line}: "));
                all += &format!("{line}{}\n", error.message);
            }
        }
        all
    })
}

fn imported(name: &str, text: &str) -> Imported {
    read(name, text, &Options::default()).unwrap_or_else(|errors| panic!("{text}: {errors}"))
}

fn refused(name: &str, text: &str) -> String {
    match read(name, text, &Options::default()) {
        Ok(_) => panic!("not refused: {text}"),
        Err(errors) => errors,
    }
}

/// Joints of a description, without comments and parameters.
fn joints(found: &Imported) -> String {
    let lines = found.text.lines();
    let lines = lines.take_while(|line| !line.starts_with("[identification]"));
    let lines = lines.filter(|line| !line.starts_with('#'));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Combinations and ratios of the motor tables.
fn motors(found: &Imported) -> Vec<String> {
    let lines = found.text.lines();
    let of_motor = |line: &&str| line.starts_with("turns") || line.starts_with("ratio");
    lines.filter(of_motor).map(str::to_owned).collect()
}

/// URDF of a wrist with two joints, pitch and roll, and a transmission.
fn wrist(transmission: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0.02 0 0.1'/><mass value='1'/>\
             <inertia ixx='0.02' iyy='0.02' izz='0.01'/></inertial></link>"
        )
    };
    let joint = |name: &str, ends: [&str; 2], axis: &str| {
        format!(
            "<joint name='{name}' type='revolute'><parent link='{}'/><child link='{}'/><axis xyz='{axis}'/></joint>",
            ends[0], ends[1]
        )
    };
    format!(
        "<robot name='wrist' xmlns:drake='d'><link name='base'/>{}{}{}{}\n<transmission>{transmission}</transmission></robot>",
        link("a"),
        link("b"),
        joint("pitch", ["base", "a"], "0 1 0"),
        joint("roll", ["a", "b"], "0 0 1"),
    )
}

const ROLES: &str = "<actuator name='left'><role>actuator1</role><mechanicalReduction>50</mechanicalReduction></actuator>\
    <actuator name='right'><role>actuator2</role><mechanicalReduction>-40</mechanicalReduction></actuator>\
    <joint name='pitch'><role>joint1</role><mechanicalReduction>2</mechanicalReduction></joint>\
    <joint name='roll'><role>joint2</role><mechanicalReduction>3</mechanicalReduction></joint>";

#[test]
fn two_joint_transmissions_become_coupled_motors() {
    let differential =
        format!("<type>transmission_interface/DifferentialTransmission</type>{ROLES}");
    let found = imported("wrist.urdf", &wrist(&differential));
    assert_eq!(
        motors(&found),
        [
            r#"turns = "2.0 * q_pitch + 3.0 * q_roll""#,
            "ratio = 50.0",
            r#"turns = "2.0 * q_pitch - 3.0 * q_roll""#,
            "ratio = -40.0"
        ]
    );
    assert!(found.text.contains("name = \"left\""), "{}", found.text);
    let linkage = differential.replace("Differential", "FourBarLinkage");
    let expected = [
        r#"turns = "q_pitch""#,
        "ratio = 100.0",
        r#"turns = "q_pitch + 3.0 * q_roll""#,
        "ratio = -40.0",
    ];
    assert_eq!(motors(&imported("wrist.urdf", &wrist(&linkage))), expected);
    // ROS 2 has attributes; roles decide, not the order.
    let plugin = "<plugin>transmission_interface/FourBarLinkageTransmission</plugin>\
        <joint name='roll' role='joint2'><mechanical_reduction>3</mechanical_reduction></joint>\
        <actuator name='right' role='actuator2'><mechanical_reduction>-40</mechanical_reduction></actuator>\
        <joint name='pitch' role='joint1'><mechanical_reduction>2</mechanical_reduction></joint>\
        <actuator name='left' role='actuator1'><mechanical_reduction>50</mechanical_reduction></actuator>";
    let text = wrist(plugin)
        .replace("<transmission>", "<ros2_control><transmission>")
        .replace("</transmission>", "</transmission></ros2_control>");
    assert_eq!(motors(&imported("wrist.urdf", &text)), expected);
}

#[test]
fn incomplete_transmissions_are_rejected() {
    for (from, to, expected) in [
        (
            "joint2",
            "joint3",
            "the transmission needs two elements <joint>",
        ),
        (
            "name='roll'><role>",
            "name='rol'><role>",
            "there is no joint `rol`",
        ),
        (
            ">3<",
            ">0<",
            "<mechanicalReduction> must be a number other than 0",
        ),
    ] {
        let text = format!("<type>transmission_interface/DifferentialTransmission</type>{ROLES}");
        assert!(text.contains(from));
        let message = refused("wrist.urdf", &wrist(&text.replacen(from, to, 1)));
        assert!(message.starts_with(&format!("2: {expected}")), "{message}");
    }
}

#[test]
fn drake_rotors_become_joint_and_motor_inertias() {
    let rotor = "<drake:rotor_inertia value='0.001'/><drake:gear_ratio value='30'/>";
    let single = format!("<joint name='pitch'/><actuator name='m'>{rotor}</actuator>");
    let found = imported("wrist.urdf", &wrist(&single));
    assert!(found.text.contains("ia_pitch = 0.9\n"), "{}", found.text);
    let both = format!("<type>transmission_interface/DifferentialTransmission</type>{ROLES}")
        .replacen("</role>", &format!("</role>{rotor}"), 1);
    let found = imported("wrist.urdf", &wrist(&both));
    assert!(found.text.contains("ia_left = 0.9\n"), "{}", found.text);
}

/// MJCF of three hinges in a row, with more elements.
fn hinges(more: &str) -> String {
    let body = |at: usize| {
        format!(
            "<body pos='0.3 0 0'><joint name='j{at}' axis='0 1 0' ref='0.{at}'/>\
             <inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.02'/>"
        )
    };
    let bodies: String = (1..=3).map(body).collect();
    format!(
        "<mujoco model='row'><compiler angle='radian'/><worldbody>{bodies}</body></body></body></worldbody>\n{more}</mujoco>"
    )
}

fn tendon(attributes: &str) -> String {
    format!(
        "<tendon><fixed name='t' {attributes}><joint joint='j2' coef='1'/><joint joint='j3' coef='-0.5'/></fixed></tendon>"
    )
}

#[test]
fn a_fixed_tendon_motor_drives_its_joints() {
    let more = tendon("damping='0.2' armature='0.01'")
        + "<actuator><motor joint='j1' gear='7'/><motor name='m' tendon='t' gear='10' armature='0.001'/></actuator>";
    let found = imported("row.xml", &hinges(&more));
    assert_eq!(
        motors(&found),
        [
            r#"turns = "q_j1""#,
            "ratio = 7.0",
            r#"turns = "q_j2 - 0.5 * q_j3""#,
            "ratio = 10.0"
        ]
    );
    for line in ["ia_m = 0.11\n", "fv_m = 0.2\n"] {
        assert!(found.text.contains(line), "{}", found.text);
    }
    // The rotor belongs to the motor, not to its joints.
    let joint = found.text.split("name = \"j2\"").nth(1).expect("j2");
    let own = joint.lines().find(|line| line.starts_with("parameters"));
    assert_eq!(
        own,
        Some("parameters = [\"inertia\", \"fv\", \"fs\", \"off\"]")
    );
}

#[test]
fn a_tendon_motor_of_coupled_joints_becomes_a_joint_motor() {
    let coupling = "<equality><joint joint1='j3' joint2='j2' polycoef='0 2'/></equality>";
    let more = tendon("frictionloss='0.1'").replace("-0.5", "0.5")
        + coupling
        + "<actuator><motor name='m' tendon='t' gear='10' armature='0.001'/></actuator>";
    let found = imported("row.xml", &hinges(&more));
    assert_eq!(motors(&found), [""; 0]);
    // j2 + 0.5 · 2 j2 = 2 j2: 4 times gear² · 0.001, and 2 times 0.1.
    for line in ["ia_j2 = 0.4\n", "fs_j2 = 0.2\n"] {
        assert!(found.text.contains(line), "{}", found.text);
    }
}

#[test]
fn tendon_equalities_couple_two_joints() {
    let motor = "<actuator><motor joint='j1'/><motor joint='j2'/></actuator>";
    let both = "<tendon><fixed name='s'><joint joint='j3' coef='2'/></fixed>\
        <fixed name='t'><joint joint='j2' coef='3'/></fixed></tendon>";
    let equality = "<equality><tendon tendon1='s' tendon2='t' polycoef='0.2 4'/></equality>";
    let found = imported("row.xml", &hinges(&format!("{both}{equality}{motor}")));
    // 2 (j3 - ref3) = 0.2 + 4 · 3 (j2 - ref2).
    let joint = "<equality><joint joint1='j3' joint2='j2' polycoef='0.1 6'/></equality>";
    let expected = imported("row.xml", &hinges(&format!("{joint}{motor}")));
    assert_eq!(joints(&found), joints(&expected));
    let one = "<tendon><fixed name='s'><joint joint='j3' coef='2'/><joint joint='j2' coef='-12'/></fixed></tendon>";
    let equality = "<equality><tendon tendon1='s' polycoef='0.2'/></equality>";
    let found = imported("row.xml", &hinges(&format!("{one}{equality}{motor}")));
    assert_eq!(joints(&found), joints(&expected));
    let equality = "<equality><tendon tendon1='s' tendon2='t'/></equality>";
    let three = format!(
        "{}{equality}{motor}",
        tendon("").replace(
            "</tendon>",
            "<fixed name='s'><joint joint='j1' coef='1'/></fixed></tendon>"
        )
    );
    let message = refused("row.xml", &hinges(&three));
    assert!(message.contains("does not couple two joints"), "{message}");
}

#[test]
fn tendons_with_forces_are_rejected_and_others_reported() {
    let motor = "<actuator><motor joint='j1'/></actuator>";
    for attributes in [
        "stiffness='3'",
        "damping='3'",
        "frictionloss='3'",
        "armature='3'",
    ] {
        let message = refused("row.xml", &hinges(&(tendon(attributes) + motor)));
        assert!(message.starts_with("2: the "), "{message}");
        let path =
            format!("<tendon><spatial {attributes}><site site='s'/></spatial></tendon>{motor}");
        let message = refused("row.xml", &hinges(&path));
        assert!(message.starts_with("2: the "), "{message}");
    }
    let limited = tendon("range='-1 1' limited='true'") + motor;
    let found = imported("row.xml", &hinges(&limited));
    let reported: Vec<String> = found
        .account
        .reported
        .iter()
        .map(|own| own.subject())
        .collect();
    assert_eq!(reported, ["fixed"]);
    let pulled = "<tendon><spatial name='t'/></tendon><actuator><motor tendon='t'/></actuator>";
    let message = refused("row.xml", &hinges(pulled));
    assert!(message.contains("pulls at a spatial tendon"), "{message}");
    let message = refused(
        "row.xml",
        &hinges("<actuator><motor tendon='t'/></actuator>"),
    );
    assert!(message.contains("there is no tendon `t`"), "{message}");
}

#[test]
fn single_joint_tendons_add_to_the_joint_parameters() {
    let one = "<tendon><fixed damping='0.5' frictionloss='0.25' armature='0.1'><joint joint='j2' coef='-2'/></fixed></tendon>\
        <actuator><motor joint='j1'/></actuator>";
    let found = imported("row.xml", &hinges(one));
    for line in ["ia_j2 = 0.4\n", "fv_j2 = 2.0\n", "fs_j2 = 0.5\n"] {
        assert!(found.text.contains(line), "{}", found.text);
    }
}

#[test]
fn driven_joints_lead_their_coupled_joints() {
    let motors = "<actuator><motor joint='j1'/><motor joint='j3'/></actuator>";
    let coupled =
        |relation: &str| hinges(&format!("<equality><joint {relation}/></equality>{motors}"));
    // j3 - ref3 = 0.1 + 2 (j2 - ref2), and its inverse.
    let follower = imported(
        "row.xml",
        &coupled("joint1='j3' joint2='j2' polycoef='0.1 2'"),
    );
    let leader = imported(
        "row.xml",
        &coupled("joint1='j2' joint2='j3' polycoef='-0.05 0.5'"),
    );
    assert_eq!(joints(&follower), joints(&leader));
}

#[test]
fn coupled_motors_are_kept_in_closed_loop_robots() {
    let more = "<equality><connect body1='b3' anchor='0.2 0 0'/></equality>".to_owned()
        + &tendon("")
        + "<actuator><motor name='belt' tendon='t' armature='0.2'/></actuator>";
    let text = hinges(&more).replacen("<body pos", "<body name='b1' pos", 1);
    let at = text.rfind("<body pos='0.3 0 0'").expect("a body");
    let text = format!(
        "{}<body name='b3' pos='0.2 0 0.3'{}",
        &text[..at],
        &text[at + 19..]
    );
    let found = imported("row.xml", &text);
    assert!(
        found.text.contains("[motor.belt]\nturns = \""),
        "{}",
        found.text
    );
    assert!(found.text.contains("ia_belt = 0.2"), "{}", found.text);
    assert!(!found.text.contains("actuated = true"), "{}", found.text);
}

#[test]
fn two_motors_may_turn_the_same_joints_of_a_loop() {
    let body = |name: &str, at: &str, inside: &str| {
        format!(
            "<body name='{name}' pos='{at}'><inertial pos='0.1 0 0.02' mass='0.5' diaginertia='1e-3 2e-3 2e-3'/>\
             <joint name='q_{name}' axis='0 -1 0'/>{inside}</body>"
        )
    };
    let bodies = body("crank", "0 0 0", &body("coupler", "0.1 0 0", ""))
        + &body("rocker", "0.4 0 0", "")
        + &body("fan", "1 0 0", "");
    let tendon = |name: &str, fan: f64| {
        format!(
            "<fixed name='{name}'><joint joint='q_crank' coef='3'/><joint joint='q_fan' coef='{fan}'/></fixed>"
        )
    };
    let text = format!(
        "<mujoco><worldbody>{bodies}</worldbody>\
         <equality><connect body1='coupler' body2='rocker' anchor='0.3 0 0.25'/></equality>\
         <tendon>{}{}</tendon>\
         <actuator><motor name='left' tendon='t'/><motor name='right' tendon='u'/></actuator></mujoco>",
        tendon("t", 1.0),
        tendon("u", -1.0)
    );
    let found = imported("robot.xml", &text).text;
    assert!(found.contains("[motor.left]") && found.contains("[motor.right]"));
    assert!(!found.contains("actuated = true"), "{found}");
}

#[test]
fn uniform_gravity_compensation_scales_gravity() {
    let row = |second: &str, joints: &str| {
        let text = hinges("<actuator><motor joint='j1'/></actuator>");
        let text = text.replace("<joint ", &format!("<joint {joints} "));
        let text = text.replace("<body pos", "<body gravcomp='0.75' pos");
        let at = text.rfind("gravcomp='0.75'").expect("a body");
        format!("{}gravcomp='{second}'{}", &text[..at], &text[at + 15..])
    };
    let found = imported("row.xml", &row("0.75", ""));
    assert!(
        found.text.contains("gravity = [0, 0, -2.4525]"),
        "{}",
        found.text
    );
    assert!(found.account.reported.is_empty());
    let found = imported("row.xml", &row("0.5", ""));
    assert!(
        found.text.contains("gravity = [0, 0, -9.81]"),
        "{}",
        found.text
    );
    assert_eq!(found.account.reported[0].subject(), "body gravcomp");
    let found = imported("row.xml", &row("0.5", "actuatorgravcomp='true'"));
    assert!(
        found.text.contains("gravity = [0, 0, -9.81]"),
        "{}",
        found.text
    );
    assert!(found.account.reported.is_empty());
}

#[test]
fn adhesion_acts_on_contacts_and_drives_no_joint() {
    let more = |adhesion: &str| {
        hinges(&format!(
            "<actuator><motor joint='j1'/>{adhesion}</actuator>"
        ))
    };
    let found = imported(
        "robot.xml",
        &more("<adhesion body='a' gain='3' ctrlrange='0 1'/>"),
    );
    assert_eq!(joints(&found), joints(&imported("robot.xml", &more(""))));
    assert!(found.account.reported.is_empty(), "{:?}", found.account);
    let mut ignored = found.account.ignored.iter();
    assert!(ignored.any(|entry| entry.element == "adhesion"));
}

#[test]
fn gears_of_all_motors_of_a_joint_are_described() {
    let actuators = "<actuator><motor name='first' joint='j1' gear='-5'/>\
         <velocity name='second' joint='j1' gear='3'/></actuator>";
    let found = imported("row.xml", &hinges(actuators));
    for gear in ["Motor `first` with gear -5:", "Motor `second` with gear 3:"] {
        assert!(found.text.contains(gear), "{gear}: {}", found.text);
    }
}
