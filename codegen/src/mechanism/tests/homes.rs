//! Rough homes of a leg that are as good as any other are all accepted: singular values are nearly
//! equal at some of them, which is no defect of the leg.

use super::said;
use crate::cas::Stream;

const HEXAPOD: &str = include_str!("../../../../cli/templates/spatial-6ups.toml");

/// The hexapod whose last leg starts from these joint positions.
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
fn a_leg_with_nearly_equal_singular_values_follows_the_platform() {
    assert_eq!(said(&hexapod([0.47, -0.24, 0.56])), "a robot");
}

#[test]
fn rough_homes_near_the_wanted_one_are_accepted() {
    let mut stream = Stream::new(3);
    for _ in 0..200 {
        let home = [
            0.5 * stream.number(),
            0.5 * stream.number(),
            0.55 + 0.1 * stream.number(),
        ];
        assert_eq!(said(&hexapod(home)), "a robot", "{home:?}");
    }
}
