//! A platform whose directions of motion change with its pose.

use overact_codegen::{Source, check};
use overact_interchange::{Options, export, import};
use std::path::Path;

const MASS: &str = r#"<inertial pos="0.01 0 0.05" mass="1.5" diaginertia=".01 .012 .013"/>"#;

/// A 3-RPS with its legs at given angles; the platform is a body of the first leg.
fn three_legs(angles: [f64; 3], more: &str) -> String {
    let (base, plate, height) = (0.28, 0.19, 0.45);
    let (mut bodies, mut closures, mut motors) = (String::new(), String::new(), String::new());
    for (leg, angle) in angles.into_iter().enumerate() {
        let (sine, cosine) = angle.sin_cos();
        let across = plate - base;
        let end = format!("{} {} {height}", across * cosine, across * sine);
        let inside = if leg == 0 {
            format!(
                r#"<body name="plate" pos="{} {} {height}">{MASS}<joint name="ball" type="ball" pos="{} {} 0"/>{more}</body>"#,
                -base * cosine,
                -base * sine,
                plate * cosine,
                plate * sine
            )
        } else {
            closures += &format!(
                r#"<connect name="end{leg}" body1="rod{leg}" body2="plate" anchor="{end}"/>"#
            );
            String::new()
        };
        bodies += &format!(
            r#"<body name="leg{leg}" pos="{} {} 0">{MASS}<joint name="hinge{leg}" axis="{} {cosine} 0"/>
<body name="rod{leg}">{MASS}<joint name="slide{leg}" type="slide" axis="{end}"/>{inside}</body></body>
"#,
            base * cosine,
            base * sine,
            -sine
        );
        motors += &format!(r#"<motor joint="slide{leg}"/>"#);
    }
    format!(
        r#"<mujoco model="three legs"><worldbody>{bodies}</worldbody><equality>{closures}</equality><actuator>{motors}</actuator></mujoco>"#
    )
}

fn written(folder: &Path, text: &str) -> std::path::PathBuf {
    let path = folder.join("robot.xml");
    std::fs::write(&path, text).expect("a file");
    path
}

#[test]
fn a_3_rps_has_three_independent_coordinates() {
    let third = std::f64::consts::TAU / 3.0;
    for angles in [[0.0, third, 2.0 * third], [0.1, 2.0, 4.4]] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = written(folder.path(), &three_legs(angles, ""));
        let imported = import(&path, &Options::default());
        let text = imported.expect("a robot").text;
        assert!(
            text.contains(r#"independent = ["z", "rx", "ry"]"#),
            "{text}"
        );
        assert!(text.contains("m_platform = 1.5\n"), "{text}");
        let source = Source::new("made.toml", text.clone());
        let checked = match check(&source) {
            Ok(checked) => checked,
            Err(errors) => panic!("{}\n{text}", errors.render_plain(&source)),
        };
        let mechanism = &checked.mechanism;
        assert_eq!((mechanism.dof(), mechanism.actuated().len()), (3, 3));
        // Parameters of the platform have no place in the file yet.
        let parameters = folder.path().join("found.toml");
        std::fs::write(&parameters, "[parameters]\nm_platform = 2.0\n").expect("a file");
        assert!(export(&path, &parameters, &Options::default()).is_err());
    }
}

#[test]
fn a_wrist_on_such_a_platform_is_on_a_skeleton_with_dependent_joints() {
    let wrist = format!(r#"<body name="wrist">{MASS}<joint name="wrist" axis="0 0 1"/></body>"#);
    let folder = tempfile::tempdir().expect("a folder");
    let text = three_legs([0.0, 2.1, 4.2], &wrist);
    let text = text.replace("</actuator>", r#"<motor joint="wrist"/></actuator>"#);
    let path = written(folder.path(), &text);
    let imported = import(&path, &Options::default());
    let text = imported.expect("a robot").text;
    let source = Source::new("made.toml", text.clone());
    let checked = match check(&source) {
        Ok(checked) => checked,
        Err(errors) => panic!("{}\n{text}", errors.render_plain(&source)),
    };
    let mechanism = &checked.mechanism;
    assert_eq!((mechanism.dof(), mechanism.actuated().len()), (4, 4));
    assert_eq!(mechanism.pose_len() - mechanism.dof(), 4, "{text}");
    let coordinates = mechanism.coordinates();
    assert!(
        coordinates.contains(&"slide0".to_owned()),
        "{coordinates:?}"
    );
    assert!(coordinates.contains(&"wrist".to_owned()), "{coordinates:?}");
}
