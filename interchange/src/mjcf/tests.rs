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
fn primitive_geom_inertias_match_mujoco() {
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
fn mesh_bodies_without_inertial_have_unknown_inertia() {
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
fn springdamper_time_constants_match_mujoco() {
    assert_spring(&adjusted(""), 3.2041419645219538, 0.628011825046303);
}

#[test]
fn inertia_bounds_and_balancing_match_mujoco() {
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
    // A body without inertia has the least mass at `pos`, also in a frame.
    let bounded = read(
        "<mujoco><compiler boundmass='0.5' boundinertia='0.01'/><worldbody><body><joint/>\
         <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><frame pos='0 0 1' euler='30 20 10'>\
         <body pos='0.1 0.2 0.3' euler='0 0 40'/></frame></body></worldbody></mujoco>",
    );
    assert_inertia(
        &bounded,
        2,
        [0.5, 0.1, 0.2, 0.3, 0.01, 0.01, 0.01, 0.0, 0.0, 0.0],
    );
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
fn settotalmass_scales_bodies_as_in_mujoco() {
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
fn actuator_and_equality_defaults_are_shared() {
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
fn joints_and_inertias_are_expressed_in_the_body_frame() {
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

/// A prism with a U-shaped base, which no point sees whole, as OBJ.
fn u_shape() -> String {
    let base = [
        (0, 0),
        (3, 0),
        (3, 3),
        (2, 3),
        (2, 1),
        (1, 1),
        (1, 3),
        (0, 3),
    ];
    let parts = [
        [0, 1, 4],
        [0, 4, 5],
        [1, 2, 3],
        [1, 3, 4],
        [0, 5, 6],
        [0, 6, 7],
    ];
    let mut text = String::new();
    for height in [0, 1] {
        for (x, y) in base {
            text += &format!(
                "v {} {} {}\n",
                f64::from(x) * 0.1,
                f64::from(y) * 0.1,
                f64::from(height) * 0.1
            );
        }
    }
    for [a, b, c] in parts {
        text += &format!(
            "f {} {} {}\nf {}//1 {}//1 {}//1\n",
            a + 1,
            c + 1,
            b + 1,
            a + 9,
            b + 9,
            c + 9
        );
    }
    for at in 0..8 {
        let next = (at + 1) % 8;
        text += &format!("f {} {} {} {}\n", at + 1, next + 1, next + 9, at + 9);
    }
    text
}

/// Inertia of a body with a mesh geom, from a folder with `u.obj`.
fn with_mesh(asset: &str, geom: &str) -> Model {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("meshes")).expect("a folder");
    std::fs::write(folder.path().join("meshes/u.obj"), u_shape()).expect("a mesh");
    let path = folder.path().join("robot.xml");
    let text = format!(
        "<mujoco><compiler angle='radian' meshdir='meshes'/><asset><mesh file='u.obj' {asset}/></asset><worldbody><body>\
         <joint/><geom type='mesh' mesh='u' {geom}/></body></worldbody></mujoco>"
    );
    std::fs::write(&path, text).expect("a file");
    let files = Files::default();
    let file = files.read(&path, None).expect("a file");
    let model = super::read(&files, file, &Options::default());
    model.unwrap_or_else(|| panic!("{:?}", files.into_errors()))
}

#[test]
fn mesh_inertias_match_mujoco() {
    // MuJoCo keeps the corners in single precision.
    let is_near = |found: f64, expected: f64, size: f64| (found - expected).abs() < 3e-7 * size;
    for (asset, geom, expected) in [
        (
            "",
            "",
            [
                8.617540924,
                0.15,
                0.14263102,
                0.05,
                0.06699130284,
                0.07461755273,
                0.1283246471,
            ],
        ),
        (
            "inertia='exact'",
            "",
            [
                7.000000685,
                0.15,
                0.13571429,
                0.05,
                0.06023810578,
                0.07166667896,
                0.1202381166,
            ],
        ),
        (
            "inertia='shell'",
            "mass='3'",
            [
                3.0,
                0.15,
                0.14333334,
                0.05,
                0.03420000249,
                0.03700000256,
                0.06153333803,
            ],
        ),
        (
            "inertia='exact' scale='-1 1 1'",
            "density='500'",
            [
                3.5000003425,
                -0.15,
                0.13571429,
                0.05,
                0.03011905289,
                0.03583333948,
                0.0601190583,
            ],
        ),
    ] {
        let model = with_mesh(asset, geom);
        let own = model.bodies[1].inertia.expect("an inertia");
        let tensor = own.tensor;
        let found = [
            [own.mass, own.centre.x, own.centre.y, own.centre.z],
            [tensor[(0, 0)], tensor[(1, 1)], tensor[(2, 2)], 0.0],
        ]
        .concat();
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                is_near(found, expected, own.mass),
                "{asset} {geom}: {found} {expected}"
            );
        }
    }
}

#[test]
fn meshes_are_placed_by_their_reference_pose() {
    let asset = "inertia='exact' scale='2 2 -2' refpos='0.1 0 0' refquat='0.9 0.1 0.2 0.3'";
    let own = with_mesh(asset, "mass='3' pos='1 2 3' euler='0.3 0 0'").bodies[1].inertia;
    let own = own.expect("an inertia");
    let [x, y, z] = [1.206766934, 2.219042944, 2.945768067];
    assert!(
        (own.centre.coords - nalgebra::Vector3::new(x, y, z)).norm() < 1e-6,
        "{own:?}"
    );
    let moments = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| own.tensor[at]);
    for (found, expected) in moments.into_iter().zip([
        0.1208252451,
        0.1468274388,
        0.1645922475,
        -0.009589405534,
        0.02824525412,
        -0.04010566593,
    ]) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn a_mesh_without_a_file_has_unknown_inertia() {
    for asset in ["inertia='convex'", "name='v'", "builtin='sphere'"] {
        let model = with_mesh(asset, "");
        assert!(model.bodies[1].inertia.is_none(), "{asset}");
        assert!(model.bodies[1].has_unknown_inertia, "{asset}");
    }
}
