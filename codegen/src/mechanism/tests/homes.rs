//! Rough homes of a leg that are all acceptable. At some of them singular values are nearly equal,
//! which is no defect.

use super::{assert_diagnosis, changed, diagnosis};
use crate::cas::Stream;

const HEXAPOD: &str = include_str!("../../../../cli/templates/spatial-6ups.toml");

/// The hexapod whose last leg has these rough joint positions.
fn hexapod(home: [f64; 3]) -> String {
    let [cross, cylinder, rod] = home;
    let at = HEXAPOD.find("name = \"leg6\"").expect("a last leg");
    let (before, last) = HEXAPOD.split_at(at);
    let home = format!("home = {{ cross = {cross}, cylinder = {cylinder}, rod = {rod} }}");
    let last = last.replacen("home = { rod = \"0.5 m\" }", &home, 1);
    assert!(last.contains(&home));
    format!("{before}{last}")
}

#[test]
fn a_leg_with_nearly_equal_singular_values_is_accepted() {
    assert_eq!(diagnosis(&hexapod([0.47, -0.24, 0.56])), "a robot");
}

#[test]
fn approximate_home_poses_are_accepted() {
    let mut stream = Stream::new(3);
    for _ in 0..200 {
        let home = [
            0.5 * stream.number(),
            0.5 * stream.number(),
            0.55 + 0.1 * stream.number(),
        ];
        assert_eq!(diagnosis(&hexapod(home)), "a robot", "{home:?}");
    }
}

#[test]
fn a_leg_fully_stretched_at_home_is_rejected() {
    let five_bar = include_str!("../../../../robots/five_bar.toml");
    // The length of an arm is 0.45 m, and the motors are 0.2 m apart.
    let stretched = (0.45_f64.powi(2) - 0.1_f64.powi(2)).sqrt();
    let home = |y: f64| changed(five_bar, &[("y = \"0.30 m\"", &format!("y = {y}"))]);
    let expected = [
        "leg `left` is singular at the home configuration",
        "leg `right` is singular at the home configuration",
        "neither stretched nor folded",
    ];
    assert_diagnosis(&home(stretched), "45:1", &expected);
    assert_eq!(diagnosis(&home(stretched - 1e-6)), "a robot");
}
