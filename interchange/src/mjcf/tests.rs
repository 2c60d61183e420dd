//! Inertias, springs and dampers compared with MuJoCo 4.0.
//!
//! The reference values are `body_mass`, `body_ipos`, the inertia in the body's axes,
//! `jnt_stiffness` and `dof_damping` of the compiled model.

use crate::{files::Files, model::Model, options::Options};

fn read(text: &str) -> Model {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("robot.xml");
    std::fs::write(&path, text).expect("a file");
    let files = Files::default();
    let file = files.read(&path, None).expect("a file");
    let model = super::read(&files, file, &Options::default());
    model.unwrap_or_else(|| panic!("{:?}", files.into_errors()))
}

/// Mass, centre, and moments xx, yy, zz, xy, xz, yz about the centre.
fn assert_inertia(model: &Model, body: usize, expected: [f64; 10]) {
    let own = model.bodies[body].inertia.expect("an inertia");
    let (centre, tensor) = (own.centre, own.tensor);
    let moments = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| tensor[at]);
    let found = [
        [own.mass, centre.x, centre.y, centre.z].as_slice(),
        &moments,
    ]
    .concat();
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= 1e-12 * own.mass.max(1.0),
            "{found} {expected}"
        );
    }
}

#[test]
fn inertias_of_primitive_geoms_are_those_of_mujoco() {
    for (geoms, expected) in [
        (
            "<geom size='0.1' pos='0.1 0 0'/>",
            [
                4.188790204786391,
                0.1,
                0.0,
                0.0,
                0.01675516081914557,
                0.01675516081914557,
                0.01675516081914557,
                0.0,
                0.0,
                0.0,
            ],
        ),
        (
            "<geom type='capsule' fromto='0 0 0 0.3 0.1 0.2' size='0.03'/>",
            [
                1.1710260377977426,
                0.15,
                0.05,
                0.1,
                0.006423548038239754,
                0.015874372168525185,
                0.012330313119668144,
                -0.0035440590488570365,
                -0.007088118097714078,
                -0.0023627060325713592,
            ],
        ),
        (
            "<geom type='cylinder' size='0.03 0.2' euler='0.3 0.2 0.1' mass='2'/>",
            [
                2.0,
                0.0,
                0.0,
                0.0,
                0.026081907863054504,
                0.024917475440515903,
                0.004133950029762958,
                0.0015085199640993113,
                -0.004876634943376455,
                0.007109387370300491,
            ],
        ),
        (
            "<geom type='ellipsoid' size='0.1 0.2 0.3' density='300'/>",
            [
                7.539822368615504,
                0.0,
                0.0,
                0.0,
                0.1960353815840031,
                0.1507964473723101,
                0.07539822368615506,
                0.0,
                0.0,
                0.0,
            ],
        ),
        (
            "<geom type='ellipsoid' fromto='0 0 0 0.3 0.1 0.2' size='0.03'/>",
            [
                0.7052858015123399,
                0.15,
                0.05,
                0.1,
                0.0019717775907995005,
                0.004720377114407591,
                0.0036896522930545553,
                -0.0010307248213530342,
                -0.0020614496427060693,
                -0.0006871498809020232,
            ],
        ),
        (
            "<geom type='box' fromto='0 0 0 0.3 0.1 0.2' size='0.03'/>",
            [
                1.346996659238619,
                0.15,
                0.05,
                0.1,
                0.00627636300507138,
                0.015025427020316508,
                0.01174452801459958,
                -0.0032808990057169233,
                -0.006561798011433848,
                -0.0021872660038112827,
            ],
        ),
        (
            // Groups outside the range and massless geoms do not count.
            "<geom type='box' size='0.1 0.2 0.3'/><geom size='0.1' pos='0 0 0.5' group='4'/><geom size='1' mass='0'/>\
             <frame pos='0.1 0.2 0.3' euler='0.1 0 0'><geom type='capsule' size='0.05 0.1'/></frame>",
            [
                50.0943951023932,
                0.00418089708062597,
                0.00836179416125194,
                0.01254269124187791,
                2.354828795231375,
                1.8145097213202794,
                0.902942780069198,
                -0.04013661197400955,
                -0.060204917961014175,
                -0.11927208415878998,
            ],
        ),
    ] {
        let text = format!(
            "<mujoco><compiler angle='radian' inertiagrouprange='0 3'/><worldbody><body><joint/>{geoms}</body>\
             </worldbody></mujoco>"
        );
        assert_inertia(&read(&text), 1, expected);
    }
}

#[test]
fn bodies_of_meshes_have_inertias_without_values() {
    let model = read(
        "<mujoco><worldbody><body><joint/><geom type='mesh' mesh='m'/></body><body><joint/>\
         <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom type='mesh' mesh='m'/></body></worldbody></mujoco>",
    );
    assert!(model.bodies[1].has_unknown_inertia && model.bodies[1].inertia.is_none());
    assert!(!model.bodies[2].has_unknown_inertia && model.bodies[2].inertia.is_some());
}

/// Two bodies in a row, the first on two hinges, the second on a spring, and a static body.
fn adjusted(compiler: &str) -> Model {
    read(&format!(
        "<mujoco><compiler angle='radian' {compiler}/><worldbody><body><joint axis='0 1 0'/><joint axis='1 0 0'/>\
         <inertial pos='0.1 0.2 0' mass='1' fullinertia='0.01 0.03 0.035 0.002 0.001 0'/><body pos='0.3 0 0'>\
         <joint name='x' axis='0 0 1' springdamper='0.2 0.7' armature='0.01' damping='7'/>\
         <inertial pos='0.1 0 0.1' mass='2' diaginertia='0.001 0.02 0.0205'/></body></body>\
         <body name='still'><geom size='0.1' mass='1'/></body></worldbody>\
         <actuator><motor joint='x' gear='3' armature='0.002' damping='0.1'/></actuator></mujoco>"
    ))
}

/// Stiffness, and damping of the joint itself.
fn assert_spring(model: &Model, stiffness: f64, damping: f64) {
    let spring = &model.joints[2];
    let found = spring.spring.expect("a spring").0;
    assert!((found - stiffness).abs() < 1e-8, "{found} {stiffness}");
    // The actuator adds 3² times its own damping.
    let found = spring.damping - 0.9;
    assert!((found - damping).abs() < 1e-8, "{found} {damping}");
    assert!((spring.armature - 0.028).abs() < 1e-15);
}

#[test]
fn springs_follow_from_time_constants_as_in_mujoco() {
    assert_spring(&adjusted(""), 3.2041419645219538, 0.628011825046303);
}

#[test]
fn bounds_and_balance_of_inertias_are_those_of_mujoco() {
    let model = adjusted("boundmass='1.5' boundinertia='0.015'");
    let first = [
        1.5,
        0.1,
        0.2,
        0.0,
        0.015178569854112275,
        0.030050578459071647,
        0.03500813064094345,
        0.0014882148073512224,
        0.0007948047464417647,
        2.0278937106454055e-05,
    ];
    assert_inertia(&model, 2, first);
    assert_inertia(
        &model,
        3,
        [2.0, 0.1, 0.0, 0.1, 0.015, 0.02, 0.0205, 0.0, 0.0, 0.0],
    );
    assert!(
        model.bodies[1].inertia.is_none(),
        "between the hinges of one body"
    );
    assert_spring(&model, 3.30623326, 0.64802172);
    let balanced = read(
        "<mujoco><compiler boundinertia='0.02' balanceinertia='true'/><worldbody><body><joint/>\
         <inertial pos='0.1 0 0' mass='1' diaginertia='0.001 0.001 0.05'/></body></worldbody></mujoco>",
    );
    assert_inertia(
        &balanced,
        1,
        [1.0, 0.1, 0.0, 0.0, 0.03, 0.03, 0.03, 0.0, 0.0, 0.0],
    );
}

#[test]
fn the_total_mass_scales_all_bodies_as_in_mujoco() {
    let model = adjusted("boundmass='1.5' settotalmass='8'");
    assert_inertia(
        &model,
        2,
        [2.4, 0.1, 0.2, 0.0, 0.016, 0.048, 0.056, 0.0032, 0.0016, 0.0],
    );
    assert_inertia(
        &model,
        3,
        [3.2, 0.1, 0.0, 0.1, 0.0016, 0.032, 0.0328, 0.0, 0.0, 0.0],
    );
    assert_spring(&model, 4.36807, 0.85614172);
    let fused = adjusted("settotalmass='8' fusestatic='true'");
    let mass = |body: usize| fused.bodies[body].inertia.expect("an inertia").mass;
    assert!((mass(2) - 8.0 / 3.0).abs() < 1e-12 && (mass(3) - 16.0 / 3.0).abs() < 1e-12);
}

#[test]
fn defaults_of_one_actuator_are_those_of_all_and_equalities_share_theirs() {
    let model = read(
        "<mujoco><default><motor gear='5' armature='0.1'/><general damping='2'/><equality active='false'/></default>\
         <worldbody><body><joint name='j'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><body><joint name='k'/>\
         <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></body></worldbody>\
         <equality><joint joint1='k' joint2='j'/></equality><actuator><position joint='j'/></actuator></mujoco>",
    );
    assert_eq!(
        (model.joints[0].armature, model.joints[0].damping),
        (2.5, 50.0)
    );
    assert!(model.joints[1].follow.is_none());
}

#[test]
fn joints_and_inertias_are_in_the_frame_of_their_body() {
    let model = read(
        "<mujoco><worldbody><body><frame pos='0.1 0 0' euler='90 0 0'><joint name='j' axis='0 1 0'/>\
         <inertial pos='0 0 0.2' mass='1' diaginertia='1 2 3'/></frame></body></worldbody></mujoco>",
    );
    let joint = &model.joints[0];
    assert!((joint.at.coords - nalgebra::Vector3::new(0.1, 0.0, 0.0)).norm() < 1e-15);
    assert!((joint.axis - nalgebra::Vector3::z()).norm() < 1e-15);
    assert_inertia(
        &model,
        1,
        [1.0, 0.1, -0.2, 0.0, 1.0, 3.0, 2.0, 0.0, 0.0, 0.0],
    );
}
