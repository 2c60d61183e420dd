//! Springs and dampers of tendons and of joints in loops.

use overact_interchange::{Imported, Options, export, import};
use std::path::Path;

/// A four-bar with a motor at its crank, sites on the ground, crank and rod, and tendons.
fn four_bar(joint: &str, tendons: &str) -> String {
    format!(
        "<mujoco><compiler angle='radian'/><worldbody><site name='frame' pos='0.05 0 0.2'/>\n\
         <body name='crank'><joint name='crank' axis='0 1 0'/>\n\
         <inertial pos='0 0 0.05' mass='1' diaginertia='0.01 0.01 0.01'/><site name='pin' pos='0.01 0 0.08'/>\n\
         <body name='rod' pos='0 0 0.1'><joint name='knee' axis='0 1 0' {joint}/>\n\
         <inertial pos='0.1 0 0' mass='0.5' diaginertia='0.01 0.01 0.01'/><site name='hook' pos='0.1 0 0.02'/></body></body>\n\
         <body name='rocker' pos='0.3 0 0'><joint name='rocker' axis='0 1 0' damping='0.3'/>\n\
         <inertial pos='0 0 0.05' mass='1' diaginertia='0.01 0.01 0.01'/></body></worldbody>\n\
         <equality><connect body1='rod' body2='rocker' anchor='0.3 0 0'/></equality>\n\
         <tendon>{tendons}</tendon>\n\
         <actuator><motor joint='crank'/></actuator></mujoco>"
    )
}

/// Errors of an import, one for each line.
type Errors = String;

fn read(text: &str) -> Result<Imported, Errors> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("bar.xml");
    std::fs::write(&file, text).expect("a file");
    import(&file, &Options::default()).map_err(|errors| {
        let all = errors.0.iter().flat_map(|(_, diagnostics)| diagnostics);
        all.map(|error| format!("{}\n", error.message)).collect()
    })
}

fn imported(text: &str) -> String {
    let found = read(text).unwrap_or_else(|errors| panic!("{text}: {errors}"));
    assert!(found.account.reported.is_empty(), "{}", found.text);
    found.text
}

const GAS: &str = "<spatial name='gas' stiffness='300' damping='20' springlength='0.15'>\
    <site site='frame'/><site site='hook'/></spatial>";

#[test]
fn a_two_site_tendon_becomes_a_spring_and_a_damper() {
    let text = imported(&four_bar("", GAS));
    for words in [
        "name = \"gas\"\nfrom = { body = \"ground\", at = [0.05, 0, 0.2] }\nto = { body = \"",
        "force = \"l - 0.15 m\"",
        "name = \"gas_damper\"",
        "force = \"dl\"",
        "k_gas = 300",
        "k_gas_damper = 20",
    ] {
        assert!(text.contains(words), "no `{words}` in\n{text}");
    }
}

/// Length without force of the only spring.
fn rest(text: &str) -> f64 {
    let (_, after) = text.split_once("force = \"l - ").expect("a spring");
    let (length, _) = after.split_once(" m\"").expect("a length");
    length.parse().expect("a number")
}

#[test]
fn a_missing_spring_length_is_taken_at_the_joint_rest_positions() {
    let gas = GAS.replace(" springlength='0.15'", "");
    let text = imported(&four_bar("", &gas));
    // From (0.05, 0.2) to (0.1, 0.12).
    let length = 0.05_f64.hypot(0.08);
    assert!((rest(&text) - length).abs() < 1e-12, "{text}");
    // The knee rests at a right angle, where the hook is at (0.02, 0).
    let quarter = std::f64::consts::FRAC_PI_2;
    let text = imported(&four_bar(&format!("springref='{quarter}'"), &gas));
    let length = 0.03_f64.hypot(0.2);
    assert!((rest(&text) - length).abs() < 1e-12, "{text}");
}

#[test]
fn fixed_tendons_add_to_joint_springs_of_loops() {
    let text = imported(&four_bar("stiffness='7' springref='0.5'", ""));
    assert!(text.contains("spring = \"q - (0.5)\""), "{text}");
    let fixed = "<fixed stiffness='2' springlength='1'><joint joint='knee' coef='2'/></fixed>";
    let text = imported(&four_bar("", fixed));
    assert!(text.contains("spring = \"q - (0.5)\""), "{text}");
    let stiffness = |line: &str| {
        let (name, value) = line.split_once(" = ")?;
        name.starts_with("k_knee").then(|| value.parse::<f64>())
    };
    let stiffness = text.lines().find_map(stiffness);
    assert_eq!(stiffness, Some(Ok(8.0)), "{text}");
    // 7 (q - 1.5) + 8 (q - 0.5)
    let text = imported(&four_bar("stiffness='7' springref='1.5'", fixed));
    assert!(text.contains("spring = \"q - (0.96666666"), "{text}");
}

#[test]
fn other_tendon_forces_are_rejected() {
    let refused = |tendon: &str, words: &str| {
        let message = read(&four_bar("", tendon)).expect_err(tendon);
        assert!(message.contains(words), "{message}");
    };
    let three = GAS.replace(
        "<site site='frame'/>",
        "<site site='frame'/><site site='pin'/>",
    );
    refused(&three, "along a path that is no straight line");
    let pulley = GAS.replace(
        "<site site='hook'/>",
        "<pulley divisor='2'/><site site='hook'/>",
    );
    refused(&pulley, "along a path that is no straight line");
    refused(&GAS.replace("'hook'", "'hok'"), "there is no site `hok`");
    refused(
        &GAS.replace("'0.15'", "'0.1 0.2'"),
        "an interval without force",
    );
    refused(
        &GAS.replace("stiffness", "frictionloss='1' stiffness"),
        "exerts forces",
    );
    let several = "<fixed name='t' stiffness='2'><joint joint='knee' coef='2'/><joint joint='crank' coef='1'/></fixed>";
    refused(several, "acts on several joints");
}

#[test]
fn a_tendon_on_one_body_has_no_effect() {
    let gas = GAS.replace("'frame'", "'hook'");
    let found = read(&four_bar("", &gas)).expect("a description");
    assert!(!found.text.contains("[[spring]]"), "{}", found.text);
    assert_eq!(found.account.reported.len(), 1);
}

/// The file with parameters, exported.
fn exported(text: &str, parameters: &str) -> (String, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("a file");
        file
    };
    let file = at("bar.xml", text);
    let values = at("values.toml", &format!("[parameters]\n{parameters}\n"));
    let found = export(Path::new(&file), &values, &Options::default());
    let found = found.unwrap_or_else(|errors| panic!("{errors:?}"));
    (found.text, found.notes)
}

#[test]
fn tendon_stiffness_and_damping_are_exported() {
    let (text, notes) = exported(&four_bar("", GAS), "k_gas = 280\nk_gas_damper = 25");
    assert!(
        text.contains("name='gas' stiffness='280.0' damping='25.0'"),
        "{text}"
    );
    assert!(notes.is_empty(), "{notes:?}");
}
