//! Loops with redundant closures, exact and with rounded numbers, and points that are pins.

use overact_codegen::{Checked, Source, check};
use overact_interchange::{Errors, Imported, Options, import};

const MASS: &str = r#"<inertial pos="0.1 0.02 0.05" mass="1" diaginertia=".01 .012 .013"/>"#;

fn read(text: &str, tolerance: Option<f64>) -> Result<Imported, Errors> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.xml");
    std::fs::write(&path, text).expect("a file");
    let options = Options {
        closure_tolerance: tolerance,
        ..Options::default()
    };
    import(&path, &options)
}

fn messages(errors: &Errors) -> String {
    let each = errors.0.iter();
    each.map(|(source, errors)| errors.render_plain(source))
        .collect()
}

/// A file that is accepted, and the check of its description.
#[track_caller]
fn accepted(text: &str) -> (Imported, Checked) {
    let imported = read(text, None).unwrap_or_else(|errors| panic!("{}", messages(&errors)));
    let source = Source::new("made.toml", imported.text.clone());
    match check(&source) {
        Ok(checked) => (imported, checked),
        Err(errors) => panic!("{}\n{}", errors.render_plain(&source), imported.text),
    }
}

/// Largest change of an import.
fn misfit(imported: &Imported) -> f64 {
    let each = imported.misfits.iter();
    each.map(|own| own.length.max(own.angle))
        .fold(0.0, f64::max)
}

/// Accepts a mechanism of one degree of freedom, whose changes are near a given size.
#[track_caller]
fn assert_one_degree_of_freedom(text: &str, error: f64) {
    let (imported, checked) = accepted(text);
    assert_eq!(checked.mechanism.dof(), 1);
    let misfit = misfit(&imported);
    if error == 0.0 {
        assert_eq!(misfit, 0.0, "{:?}", imported.misfits);
    } else {
        let is_small = (0.05 * error..8.0 * error).contains(&misfit);
        assert!(is_small, "{misfit:e} for {error:e}");
        // Without a tolerance the same loops do not move.
        assert!(read(text, Some(0.0)).is_err());
    }
}

/// A parallelogram with three cranks; the second and third crank are too long by an error.
fn three_cranks(error: f64) -> String {
    format!(
        r#"<mujoco model="cranks"><worldbody>
<body name="a">{MASS}<joint name="a" axis="0 1 0"/>
 <body name="rod" pos=".07 0 .11">{MASS}<joint name="rod" axis="0 1 0"/>
  <site name="b_rod" pos=".21 0 0"/><site name="c_rod" pos=".44 0 .02"/></body></body>
<body name="b" pos=".21 0 0">{MASS}<joint name="b" axis="0 1 0"/><site name="b_end" pos=".07 0 {}"/></body>
<body name="c" pos=".44 0 .02">{MASS}<joint name="c" axis="0 1 0"/><site name="c_end" pos="{} 0 .11"/></body>
</worldbody><equality><connect name="second" site1="b_rod" site2="b_end"/>
<connect name="third" site1="c_rod" site2="c_end"/></equality>
<actuator><motor joint="a"/></actuator></mujoco>"#,
        0.11 + 0.7 * error,
        0.07 + error
    )
}

#[test]
fn a_parallelogram_with_three_cranks_moves_with_rounded_lengths() {
    for error in [0.0, 1e-6, 3e-4] {
        assert_one_degree_of_freedom(&three_cranks(error), error);
    }
    let errors = read(&three_cranks(1e-2), None).expect_err("a loop that does not move");
    assert!(messages(&errors).contains("robot.xml:"));
}

/// An elliptic trammel whose bar is also held by a crank, with slides tilted by an angle.
fn trammel(error: f64, tilt: f64) -> String {
    format!(
        r#"<mujoco model="trammel"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/><site name="end" pos="{} 0 .09"/></body>
<body name="along" pos=".14 0 0">{MASS}<joint name="along" type="slide" axis="1 {tilt} 0"/>
 <body name="bar">{MASS}<joint name="bar" axis="0 1 0"/><site name="top" pos="-.14 0 .18"/><site name="middle" pos="-.07 0 .09"/></body></body>
<body name="up" pos="0 0 .18">{MASS}<joint name="up" type="slide" axis="0 0 1"/><site name="slot"/></body>
</worldbody><equality><connect site1="top" site2="slot"/><connect site1="end" site2="middle"/></equality>
<actuator><motor joint="along"/></actuator></mujoco>"#,
        0.07 + error
    )
}

#[test]
fn a_trammel_with_a_crank_moves_with_rounded_lengths_and_tilted_slides() {
    assert_one_degree_of_freedom(&trammel(0.0, 0.0), 0.0);
    assert_one_degree_of_freedom(&trammel(1e-4, 0.0), 1e-4);
    assert_one_degree_of_freedom(&trammel(0.0, 1e-4), 1e-4);
    assert_one_degree_of_freedom(&trammel(1e-4, 2e-4), 2e-4);
}

#[test]
fn a_scotch_yoke_moves_with_tilted_slides_and_a_block_off_the_plane() {
    let yoke = |tilt: f64, offset: f64| {
        format!(
            r#"<mujoco model="yoke"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/><site name="pin" pos=".05 0 .06"/></body>
<body name="yoke" pos=".05 0 0">{MASS}<joint name="yoke" type="slide" axis="1 {tilt} 0"/>
 <body name="block" pos="0 {offset} .06">{MASS}<joint name="slot" type="slide" axis="0 {tilt} 1"/><site name="bore"/></body></body>
</worldbody><equality><connect site1="pin" site2="bore"/></equality><actuator><motor joint="crank"/></actuator></mujoco>"#
        )
    };
    assert_one_degree_of_freedom(&yoke(0.0, 0.0), 0.0);
    assert_one_degree_of_freedom(&yoke(3e-4, 0.0), 3e-4);
    assert_one_degree_of_freedom(&yoke(0.0, 1e-4), 1e-4);
    assert_one_degree_of_freedom(&yoke(3e-4, 1e-4), 3e-4);
}

/// A Delta with six rods between balls; one rod's lower end is displaced by an error.
fn delta(error: f64) -> String {
    let (base, plate, wide, height) = (0.16, 0.05, 0.04, 0.42);
    let (arm_x, arm_z) = (0.18, -0.14);
    let (rod_x, rod_z) = (plate - base - arm_x, -height - arm_z);
    let (mut bodies, mut closures, mut motors) = (String::new(), String::new(), String::new());
    for leg in 0..3 {
        let angle = f64::from(leg) * std::f64::consts::TAU / 3.0;
        let mut rods = String::new();
        for (side, y) in [("l", wide), ("r", -wide)] {
            let name = format!("rod{leg}{side}");
            let carries = leg == 0 && side == "l";
            let error = if leg == 1 && side == "r" { error } else { 0.0 };
            let inside = if carries {
                format!(
                    r#"<body name="plate" pos="{} {} {rod_z}">{MASS}<joint name="plate" type="ball" pos="{plate} {wide} 0"/></body>"#,
                    rod_x - plate,
                    -wide
                )
            } else {
                let anchor = format!("{rod_x} 0 {}", rod_z + error);
                closures += &format!(
                    r#"<connect name="end{name}" body1="{name}" body2="plate" anchor="{anchor}"/>"#
                );
                String::new()
            };
            rods += &format!(
                r#"<body name="{name}" pos="{arm_x} {y} {arm_z}">{MASS}<joint name="{name}" type="ball"/>{inside}</body>"#
            );
        }
        bodies += &format!(
            r#"<body name="base{leg}" euler="0 0 {angle}"><body name="arm{leg}" pos="{base} 0 0">{MASS}<joint name="arm{leg}" axis="0 1 0"/>{rods}</body></body>"#
        );
        motors += &format!(r#"<motor joint="arm{leg}"/>"#);
    }
    format!(
        r#"<mujoco model="delta"><compiler angle="radian"/><worldbody>{bodies}</worldbody><equality>{closures}</equality><actuator>{motors}</actuator></mujoco>"#
    )
}

#[test]
fn the_platform_of_a_delta_translates_if_its_rods_are_rounded() {
    for error in [0.0, 2e-5] {
        let (imported, checked) = accepted(&delta(error));
        let mechanism = &checked.mechanism;
        assert_eq!((mechanism.dof(), mechanism.actuated().len()), (3, 3));
        let misfit = misfit(&imported);
        assert!(
            (0.05 * error..=20.0 * error).contains(&misfit),
            "{misfit:e}"
        );
        assert_eq!(imported.spins.len(), 6);
    }
    // Without changes the platform turns a little, which only all rods together determine.
    let turning = read(&delta(2e-5), Some(0.0)).expect("a platform that turns");
    assert!(
        turning.text.contains("dependent = true"),
        "{}",
        turning.text
    );
}

#[test]
fn a_point_closure_in_a_planar_loop_is_a_pin() {
    // A chain through the closing point: a pin is one joint, and a ball would be three.
    let text = format!(
        r#"<mujoco model="bar"><worldbody><body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="coupler" pos="0 0 .1">{MASS}<joint name="coupler" axis="0 1 0"/>
  <body name="rocker" pos=".3 0 .1">{MASS}<joint name="rocker" axis="0 1 0"/></body></body></body></worldbody>
<equality><connect name="ground" body1="rocker" anchor="0 0 -.2"/></equality><actuator><motor joint="crank"/></actuator></mujoco>"#
    );
    let (_, checked) = accepted(&text);
    let chain = &checked.mechanism.legs[1];
    let moving = chain.joints.iter().filter(|joint| joint.name != "tip");
    assert_eq!(moving.count(), 2);
}

#[test]
fn a_point_closure_is_a_pin_in_a_planar_loop_next_to_a_spatial_one() {
    // The rod with two balls moves in space and drives the same crank.
    let text = format!(
        r#"<mujoco model="bar"><worldbody><body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="coupler" pos="0 0 .1">{MASS}<joint name="coupler" axis="0 1 0"/>
  <body name="rocker" pos=".3 0 .1">{MASS}<joint name="rocker" axis="0 1 0"/></body></body>
 <body name="rod" pos="0 .1 .1">{MASS}<joint name="ball" type="ball"/></body></body>
<body name="lever" pos="-.2 .3 .1">{MASS}<joint name="lever" axis="1 0 1"/></body></worldbody>
<equality><connect name="ground" body1="rocker" anchor="0 0 -.2"/><connect name="end" body1="rod" body2="lever" anchor="-.2 .2 .15"/></equality>
<actuator><motor joint="crank"/></actuator></mujoco>"#
    );
    let (_, checked) = accepted(&text);
    let legs = checked.mechanism.legs.iter();
    let joints = legs.flat_map(|leg| &leg.joints);
    let closing = joints.filter(|joint| joint.name.contains("ground"));
    assert_eq!(closing.count(), 1);
}

#[test]
fn two_point_closures_form_a_pin_and_three_a_rigid_joint() {
    let bar = |points: &[[f64; 3]], error: f64| {
        let (mut first, mut second, mut closures) = (String::new(), String::new(), String::new());
        for (at, [x, y, z]) in points.iter().enumerate() {
            first += &format!(r#"<site name="a{at}" pos="{} {y} {}"/>"#, 0.3 + x, 0.1 + z);
            let y = if at == 1 { y + error } else { *y };
            second += &format!(r#"<site name="b{at}" pos="{x} {y} {}"/>"#, 0.2 + z);
            closures += &format!(r#"<connect site1="a{at}" site2="b{at}"/>"#);
        }
        format!(
            r#"<mujoco model="bar"><worldbody>
<body name="crank">{MASS}<joint name="crank" axis="0 1 0"/>
 <body name="coupler" pos="0 0 .1">{MASS}<joint name="coupler" axis="0 1 0"/>{first}</body></body>
<body name="rocker" pos=".3 0 0">{MASS}<joint name="rocker" axis="0 1 0"/>{second}
 <body name="tool" pos="0 0 .3">{MASS}<joint name="tool" axis="1 0 0"/></body></body>
</worldbody><equality>{closures}</equality><actuator><motor joint="crank"/><motor joint="tool"/></actuator></mujoco>"#
        )
    };
    let line = [[0.0, -0.05, 0.0], [0.0, 0.05, 0.0]];
    let (imported, checked) = accepted(&bar(&line, 0.0));
    assert_eq!(checked.mechanism.dof(), 2);
    assert!(imported.text.contains("are a pin through them"));
    let (imported, _) = accepted(&bar(&line, 1e-5));
    assert!(
        (misfit(&imported) - 1e-5).abs() < 1e-9,
        "{:?}",
        imported.misfits
    );
    // A third point fixes the coupler to the rocker, and the loop cannot move.
    let plane = [line[0], line[1], [0.04, 0.0, 0.0]];
    let errors = read(&bar(&plane, 0.0), None).expect_err("a loop that does not move");
    assert!(
        messages(&errors).contains("`crank`"),
        "{}",
        messages(&errors)
    );
}

#[test]
fn a_sarrus_linkage_moves_along_a_line() {
    // The hinges of the second leg are rotated by 90 degrees; two points are its last hinge.
    let leg = |name: &str, end: &str| {
        format!(
            r#"<body name="{name}1" pos=".2 0 0">{MASS}<joint name="{name}1" axis="0 1 0"/>
<body name="{name}2" pos=".09 0 .12">{MASS}<joint name="{name}2" axis="0 1 0"/>{end}</body></body>"#
        )
    };
    for error in [0.0, 1e-5] {
        let plate = format!(
            r#"<body name="plate" pos="-.09 0 .12">{MASS}<joint name="plate" axis="0 1 0"/>
<site name="p1" pos="-.15 .2 {error}"/><site name="p2" pos="-.25 .2 0"/></body>"#
        );
        let ends = r#"<site name="q1" pos="-.09 -.05 .12"/><site name="q2" pos="-.09 .05 .12"/>"#;
        let text = format!(
            r#"<mujoco model="sarrus"><worldbody>{}<body name="turned" euler="0 0 90">{}</body></worldbody>
<equality><connect site1="p1" site2="q1"/><connect site1="p2" site2="q2"/></equality>
<actuator><motor joint="a1"/></actuator></mujoco>"#,
            leg("a", &plate),
            leg("b", ends)
        );
        let (imported, checked) = accepted(&text);
        assert_eq!(checked.mechanism.dof(), 1);
        assert!(misfit(&imported) <= 3.0 * error, "{:?}", imported.misfits);
    }
}
