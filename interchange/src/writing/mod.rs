//! Writes the description as TOML, with a comment at each choice.

mod believable;
mod experiment;
mod platform;

use crate::{
    account::Account,
    assembly::network::Network,
    experiment::Experiment,
    frames::step::angles,
    geometry::digits::{angle, decimal, fine, is_zero},
    model::Pose,
    options::Options,
    plan::{Joint, Leg, Motor, Plan, Spring, word},
};
use overact_description::diagnostic::Span;
use std::fmt::Write as _;

/// A description, and the locations of its joints.
pub(crate) struct WrittenDescription {
    pub(crate) text: String,
    /// Byte ranges of the text and the joint that each belongs to.
    pub(crate) joints: Vec<(Span, usize)>,
}

/// Writes the description.
pub(crate) fn toml(
    network: &Network<'_>,
    plan: &Plan,
    designed: &Result<Experiment, String>,
    account: &Account,
    source: &str,
    options: &Options,
) -> WrittenDescription {
    let model = network.model;
    let mut text = String::new();
    let name = options.name.as_deref().unwrap_or(&model.name);
    let _ = writeln!(
        text,
        "# Made by overact import from {}.",
        comment_text(source)
    );
    text.push_str("# Frames are those of modified Denavit-Hartenberg constants; positions of joints are those of the file.\n");
    if let Some(given) = given(options) {
        comment(
            &mut text,
            &format!("Imported with {given}, which `overact export` also needs."),
        );
    }
    for note in &plan.notes {
        comment(&mut text, note);
    }
    unused(&mut text, account);
    let _ = writeln!(text, "\nname = \"{}\"", robot_name(name));
    let _ = writeln!(
        text,
        "summary = \"{}\"",
        quoted(&format!("{name}, imported from {source}"))
    );
    let _ = writeln!(text, "source = \"{}\"", quoted(source));
    let gravity: Vec<String> = model.gravity.iter().map(|g| decimal(*g)).collect();
    let _ = writeln!(text, "gravity = [{}]", gravity.join(", "));
    let mut joints = Vec::new();
    if let Some(platform) = &plan.platform {
        platform::toml(&mut text, platform);
    }
    for leg in &plan.legs {
        shape(&mut text, leg, &mut joints);
    }
    for leg in &plan.legs {
        place(&mut text, leg);
    }
    for motor in &plan.motors {
        self::motor(&mut text, None, motor);
    }
    for spring in &plan.springs {
        point_spring(&mut text, spring);
    }
    experiment::toml(&mut text, designed);
    values(&mut text, plan, &mut joints);
    WrittenDescription { text, joints }
}

/// Lists contents of the file that are not used although they may change the model.
fn unused(text: &mut String, account: &Account) {
    if account.reported.is_empty() {
        return;
    }
    text.push_str("# Not used from the file:\n");
    for entry in &account.reported {
        let (subject, reason) = (entry.subject(), entry.counted_reason());
        comment(
            text,
            &format!("- line {}: {subject}: {reason}.", entry.line),
        );
    }
}

/// Import options that parameter names depend on; `None` if there are none.
fn given(options: &Options) -> Option<String> {
    let mut words = Vec::new();
    if options.fix_base {
        words.push("--fix-base".to_owned());
    }
    if let Some(model) = &options.model {
        words.push(format!("--model {model}"));
    }
    for (key, names) in [
        ("--actuated", &options.actuated),
        ("--coordinates", &options.coordinates),
    ] {
        words.extend(
            names
                .iter()
                .map(|names| format!("{key} {}", names.join(","))),
        );
    }
    for (key, pairs) in [("--value", &options.values), ("--home", &options.home)] {
        let pairs: Vec<String> = pairs
            .iter()
            .map(|(name, value)| format!("{name}={value:?}"))
            .collect();
        if !pairs.is_empty() {
            words.push(format!("{key} {}", pairs.join(",")));
        }
    }
    if let Some(tolerance) = options.closure_tolerance {
        words.push(format!("--closure-tolerance {tolerance:?}"));
    }
    (!words.is_empty()).then(|| format!("`{}`", words.join(" ")))
}

fn shape(text: &mut String, leg: &Leg, joints: &mut Vec<(Span, usize)>) {
    text.push('\n');
    for line in &leg.comment {
        comment(text, line);
    }
    if leg.base.is_some() || leg.joints.is_empty() {
        let _ = writeln!(text, "[leg.{}]", leg.name);
    }
    if let Some((body, frame)) = &leg.base {
        let mut parts: Vec<String> = body
            .iter()
            .map(|body| format!("body = \"{body}\""))
            .collect();
        parts.extend(placement(frame, true));
        let _ = writeln!(text, "base = {{ {} }}", parts.join(", "));
    }
    for joint in &leg.joints {
        let start = text.len();
        self::joint(text, &leg.name, joint);
        joints.extend(joint.of.map(|of| (start..text.len(), of)));
    }
    for motor in &leg.motors {
        self::motor(text, Some(&leg.name), motor);
    }
    if let Some(end) = &leg.end {
        let _ = writeln!(text, "\n[leg.{}.end]", leg.name);
        let kind = if end.is_rigid { "rigid" } else { "point" };
        let _ = writeln!(text, "type = \"{kind}\"");
        if !end.body.is_empty() {
            let _ = writeln!(text, "body = \"{}\"", end.body);
        }
        for part in placement(&end.at, end.is_rigid) {
            let _ = writeln!(text, "{part}");
        }
    }
}

/// Table of a motor; its torque and position are those behind the gear.
fn motor(text: &mut String, leg: Option<&str>, motor: &Motor) {
    let Motor {
        name, turns, ratio, ..
    } = motor;
    let _ = match leg {
        Some(leg) => writeln!(text, "\n[[leg.{leg}.motor]]\nname = \"{name}\""),
        None => writeln!(text, "\n[motor.{name}]"),
    };
    let _ = writeln!(text, "turns = \"{turns}\"");
    if *ratio != 1.0 {
        let _ = writeln!(text, "ratio = {}", fine(*ratio, *ratio));
    }
}

/// Tables of a spring and of a damper between two points.
fn point_spring(text: &mut String, spring: &Spring) {
    let [from, to] = &spring.ends;
    let mut table = |name: &str, force: &str| {
        let _ = writeln!(text, "\n[[spring]]\nname = \"{name}\"");
        for (key, (body, at)) in [("from", from), ("to", to)] {
            let at: Vec<String> = at.coords.iter().map(|v| decimal(*v)).collect();
            let at = at.join(", ");
            let _ = writeln!(text, "{key} = {{ body = \"{body}\", at = [{at}] }}");
        }
        let _ = writeln!(text, "force = \"{force}\"");
    };
    if spring.stiffness.is_some() {
        let rest = decimal(spring.rest);
        table(&spring.name, &format!("l - {rest} m"));
    }
    if let Some((name, _)) = &spring.damper {
        table(name, "dl");
    }
}

/// `at` and `rotation` of a frame.
fn placement(frame: &Pose, has_rotation: bool) -> Vec<String> {
    let at: Vec<String> = frame
        .translation
        .vector
        .iter()
        .map(|v| decimal(*v))
        .collect();
    let mut parts = vec![format!("at = [{}]", at.join(", "))];
    let turned = angles(&frame.rotation);
    if has_rotation && turned.iter().any(|angle| !is_zero(*angle)) {
        let turned: Vec<String> = turned.iter().map(|v| angle_value(*v)).collect();
        parts.push(format!("rotation = [{}]", turned.join(", ")));
    }
    parts
}

fn joint(text: &mut String, leg: &str, joint: &Joint) {
    text.push('\n');
    for line in &joint.comment {
        comment(text, line);
    }
    let _ = writeln!(
        text,
        "[[leg.{leg}.joint]]\nname = \"{}\"\ntype = \"{}\"",
        joint.name, joint.kind
    );
    if let Some(antecedent) = &joint.antecedent {
        let _ = writeln!(text, "antecedent = \"{antecedent}\"");
    }
    if let Some(pitch) = joint.pitch {
        let _ = writeln!(text, "pitch = {}", decimal(pitch));
    }
    let step = &joint.step;
    let mut angle_key = |key: &str, value: f64| {
        if !is_zero(value) {
            let _ = writeln!(text, "{key} = {}", angle_value(value));
        }
    };
    angle_key("gamma", step.gamma);
    angle_key("alpha", step.alpha);
    for (key, value) in [("b", step.b), ("d", step.d)] {
        if !is_zero(value) {
            let _ = writeln!(text, "{key} = {}", decimal(value));
        }
    }
    variable(text, joint, "theta", "revolute", step.theta, angle);
    variable(text, joint, "r", "prismatic", step.r, decimal);
    if let Some(rest) = joint.spring {
        let rest = match joint.kind {
            "prismatic" => decimal(rest),
            _ => angle(rest),
        };
        let _ = writeln!(text, "spring = \"q - ({rest})\"");
    }
    if joint.actuated {
        text.push_str("actuated = true\n");
    }
    if joint.is_dependent {
        text.push_str("dependent = true\n");
    }
    if let Some(parameters) = &joint.parameters {
        let list: Vec<String> = parameters.iter().map(|p| format!("\"{p}\"")).collect();
        let _ = writeln!(text, "parameters = [{}]", list.join(", "));
    }
}

/// `theta` or `r`: a constant, or a variable plus a constant.
fn variable(
    text: &mut String,
    joint: &Joint,
    key: &str,
    of: &str,
    constant: f64,
    show: fn(f64) -> String,
) {
    let is_own = joint.kind == of || (joint.kind == "helical" && of == "revolute");
    if !is_own {
        if !is_zero(constant) {
            let shown = show(constant);
            let shown = if shown.ends_with("deg") {
                format!("\"{shown}\"")
            } else {
                shown
            };
            let _ = writeln!(text, "{key} = {shown}");
        }
        return;
    }
    let shown = show(constant.abs());
    let sign = if constant < 0.0 { '-' } else { '+' };
    match (&joint.follows, is_zero(constant)) {
        (None, true) => {}
        (None, false) => {
            let _ = writeln!(text, "{key} = \"q {sign} {shown}\"");
        }
        (Some(follows), true) => {
            let _ = writeln!(text, "{key} = \"{follows}\"");
        }
        (Some(follows), false) => {
            let _ = writeln!(text, "{key} = \"{follows} {sign} {shown}\"");
        }
    }
}

fn place(text: &mut String, leg: &Leg) {
    let _ = writeln!(
        text,
        "\n[[place]]\nname = \"{0}\"\nshape = \"{0}\"",
        leg.name
    );
    let moved = leg
        .joints
        .iter()
        .filter(|j| j.kind != "fixed" && j.follows.is_none());
    let moved = moved.filter(|joint| !is_zero(joint.home));
    let home: Vec<String> = moved
        .map(|joint| format!("{} = {}", joint.name, plain(joint.home)))
        .collect();
    if !home.is_empty() {
        let _ = writeln!(text, "home = {{ {} }}", home.join(", "));
    }
}

/// Sizes of a body's moments, relative to which digits are rounding errors.
///
/// They are at least those of its mass at 1 mm, or at 32 mm for second moments: moments about
/// another point are differences of such terms.
struct ParameterSize {
    first: f64,
    second: f64,
}

impl ParameterSize {
    fn of(values: &believable::Values) -> Self {
        let largest = |of: &[&str]| {
            let own = values.iter().filter(|(symbol, _)| of.contains(symbol));
            own.map(|(_, value)| value.abs()).fold(0.0, f64::max)
        };
        let mass = values.iter().find(|(symbol, _)| *symbol == "m");
        let mass = mass.map_or(1.0, |(_, mass)| *mass);
        Self {
            first: largest(&["mx", "my", "mz"]).max(mass * 1e-3),
            second: largest(&["xx", "xy", "xz", "yy", "yz", "zz"]).max(mass * 1e-3),
        }
    }

    /// A value without digits of rounding errors.
    fn shown(&self, symbol: &str, value: f64) -> String {
        let size = match symbol {
            "mx" | "my" | "mz" => self.first,
            "xx" | "xy" | "xz" | "yy" | "yz" | "zz" => self.second,
            _ => value.abs(),
        };
        fine(value, size)
    }
}

/// Masses, inertias and friction of the file, as values of the virtual robot and as prior.
fn values(text: &mut String, plan: &Plan, joints: &mut Vec<(Span, usize)>) {
    let single = plan.legs.len() == 1;
    let (mut lines, mut impossible) = (Vec::new(), Vec::new());
    for leg in &plan.legs {
        for joint in &leg.joints {
            let of = if single {
                String::new()
            } else {
                format!("_{}", leg.name)
            };
            if believable::is_impossible(&joint.values) {
                impossible.push(format!("`{}{of}`", joint.name));
            }
            let size = ParameterSize::of(&joint.values);
            for (symbol, value) in &joint.values {
                let shown = size.shown(symbol, *value);
                let is_prior = believable::is_believable(&joint.values, symbol);
                let line = format!("{symbol}_{}{of} = {shown}", joint.name);
                lines.push((is_prior, line, joint.of));
            }
        }
    }
    if let Some(platform) = &plan.platform {
        if believable::is_impossible(&platform.values) {
            impossible.push("`platform`".to_owned());
        }
        let size = ParameterSize::of(&platform.values);
        for (symbol, value) in &platform.values {
            let is_prior = believable::is_believable(&platform.values, symbol);
            let line = format!("{symbol}_platform = {}", size.shown(symbol, *value));
            lines.push((is_prior, line, None));
        }
    }
    let motors = plan.legs.iter().flat_map(|leg| &leg.motors);
    let motors = motors.chain(&plan.motors);
    for motor in motors {
        for (symbol, value) in &motor.values {
            let line = format!("{symbol}_{} = {}", motor.name, fine(*value, value.abs()));
            lines.push((true, line, None));
        }
    }
    for spring in &plan.springs {
        let own = spring.stiffness.map(|value| (&spring.name, value));
        let damper = spring.damper.as_ref().map(|(name, value)| (name, *value));
        for (name, value) in own.into_iter().chain(damper) {
            let line = format!("k_{name} = {}", fine(value, value.abs()));
            lines.push((true, line, None));
        }
    }
    if lines.is_empty() {
        return;
    }
    text.push_str("\n# Masses, inertias and friction of the file: the virtual robot's,\n[experiment.parameters]\n");
    let mut write = |text: &mut String, line: &str, of: Option<usize>| {
        let start = text.len();
        let _ = writeln!(text, "{line}");
        joints.extend(of.map(|of| (start..text.len(), of)));
    };
    let known = lines.iter().filter(|(_, line, _)| !line.ends_with(" = 0"));
    for (_, line, of) in known {
        write(text, line, *of);
    }
    text.push_str("\n# and the prior of identification.\n");
    if !impossible.is_empty() {
        let list = impossible.join(", ");
        let note = format!(
            "LEFT OUT: the moments of inertia of {list}, which are not physically consistent."
        );
        comment(text, &note);
    }
    text.push_str("[prior.values]\n");
    for (_, line, of) in lines.into_iter().filter(|(is_prior, ..)| *is_prior) {
        write(text, &line, of);
    }
}

/// An angle as TOML: a number, or a string with unit.
fn angle_value(value: f64) -> String {
    let shown = angle(value);
    if shown.ends_with("deg") {
        format!("\"{shown}\"")
    } else {
        shown
    }
}

/// A number with all its digits.
fn plain(value: f64) -> String {
    decimal(value)
}

/// Appends a wrapped comment line.
fn comment(text: &mut String, line: &str) {
    let mut width = 0;
    text.push('#');
    for word in comment_text(line)
        .split(' ')
        .filter(|word| !word.is_empty())
    {
        if width > 0 && width + word.len() > 108 {
            text.push_str("\n#");
            width = 0;
        }
        text.push(' ');
        text.push_str(word);
        width += word.len() + 1;
    }
    text.push('\n');
}

/// Replaces control characters, which would end a comment.
fn comment_text(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// Escapes a text as a TOML string.
fn quoted(text: &str) -> String {
    let text = comment_text(text);
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// Name of the robot in upper camel case, like a Rust type.
fn robot_name(name: &str) -> String {
    let word = word(name);
    let capital = |part: &str| {
        let mut letters = part.chars();
        let first = letters.next().map(|c| c.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    };
    let text: String = word.split('_').map(capital).collect();
    if text == "Self" {
        "Robot".to_owned()
    } else {
        text
    }
}
