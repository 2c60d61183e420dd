//! Reads the YAML file that accompanies a URDF for Pinocchio users.
//!
//! It lists pairs of coincident frames (`closed_loop`), each `3d` (a point) or `6d` (a frame), and
//! the actuated joints (`name_mot`).

use super::Tree;
use crate::{
    account::YAML,
    files::{Files, Place},
    model::{Body, Closure, ClosureKind, Joint, JointType, Model, Pose},
    prune::record_key,
};
use nalgebra::{Point3, Vector3};
use std::{collections::BTreeMap, path::Path};

/// Reads the YAML file, if there is one.
pub(super) fn read(files: &Files, file: usize, tree: &mut Tree, model: &mut Model) {
    let name = files.name(file);
    let urdf = Path::new(&name);
    let found = ["yaml", "yml"].map(|ending| urdf.with_extension(ending));
    // A folder or a pipe of this name is an error: without its loops the robot is another one.
    let Some(path) = found
        .into_iter()
        .find(|path| path.symlink_metadata().is_ok())
    else {
        return;
    };
    if !path.is_file() {
        let message = format!("`{}` is not a regular file", path.display());
        let help = "users of Pinocchio list the loops and motors of a robot in the YAML file of its name: give that file, or rename this one";
        files.refuse(message, help);
        return;
    }
    let Some(own) = files.read(&path, None) else {
        return;
    };
    let text = files.text(own);
    let Some(entries) = entries(files, own, &text) else {
        return;
    };
    model.notes.push(format!(
        "Loops and motors are those of `{}` next to it.",
        path.file_name().unwrap_or_default().to_string_lossy()
    ));
    for (key, (place, value)) in &entries {
        record_key(files, &YAML, "yaml", key, &value.words().join(" "), place);
    }
    // Joints first: closures and motors refer to those that result.
    if let Some((place, value)) = entries.get("joint_name") {
        kinds(files, place, value, &entries, tree, model);
    }
    if let Some((place, value)) = entries.get("closed_loop") {
        closures(files, place, value, &entries, tree, model);
    }
    if let Some((place, value)) = entries.get("name_mot") {
        motors(files, place, value, model);
    }
}

/// A YAML value: a word or a list of values.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Word(String),
    List(Vec<Value>),
}

/// How closures are written.
const PAIRS: &str = "write closed_loop: [[a, b], [c, d]]";

type Entries = BTreeMap<String, (Place, Value)>;

impl Value {
    fn words(&self) -> Vec<&str> {
        match self {
            Self::Word(word) => vec![word],
            Self::List(list) => list.iter().flat_map(Self::words).collect(),
        }
    }
}

/// Reads top-level keys with lists, in brackets or as hyphenated items.
///
/// Other YAML syntax is not used by these files and is an error.
fn entries(files: &Files, file: usize, text: &str) -> Option<Entries> {
    let mut entries = Entries::new();
    let mut at = 0;
    let mut open: Option<(String, Place, String)> = None;
    let mut close = |open: &mut Option<(String, Place, String)>| {
        let Some((key, place, text)) = open.take() else {
            return;
        };
        match value(&text, 0) {
            Some(_) if entries.contains_key(&key) => {
                let message = format!("`{key}` occurs twice");
                files.report(&place, message, "keep one of them");
            }
            Some(value) => drop(entries.insert(key, (place, value))),
            None => files.report(
                &place,
                format!("`{key}` is not a list"),
                "write [a, b], or one `- a` a line",
            ),
        }
    };
    for line in text.split_inclusive('\n') {
        let bare = line.split(" #").next().unwrap_or_default().trim_end();
        let place = Place {
            file,
            span: at..at + bare.len(),
        };
        at += line.len();
        if bare.trim().is_empty() || bare.starts_with('#') || bare == "---" || bare == "..." {
            continue;
        }
        let is_key = !bare.starts_with([' ', '-', '[', ']']);
        match (is_key, bare.split_once(':'), &mut open) {
            (true, Some((key, rest)), _) => {
                close(&mut open);
                let key = key.trim().trim_matches(['\'', '"']);
                open = Some((key.to_owned(), place, rest.to_owned()));
            }
            (false, _, Some((_, _, text))) => {
                text.push('\n');
                text.push_str(bare);
            }
            _ => files.report(&place, "this line belongs to no key", "write `key: [a, b]`"),
        }
    }
    close(&mut open);
    files.is_clean().then_some(entries)
}

/// Largest depth of nested lists.
const DEPTH: usize = 8;

/// Parses a bracketed list, hyphenated items or a word; `depth` counts the enclosing lists.
fn value(text: &str, depth: usize) -> Option<Value> {
    if text.trim_start().starts_with('-') {
        return hyphenated(text, depth);
    }
    let mut rest = text.trim();
    let found = bracketed(&mut rest, depth)?;
    rest.trim().is_empty().then_some(found)
}

/// Parses items behind hyphens; lines with more indentation continue an item.
fn hyphenated(text: &str, depth: usize) -> Option<Value> {
    if depth > DEPTH {
        return None;
    }
    let indentation = |line: &str| line.len() - line.trim_start().len();
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let own = lines().next().map(indentation)?;
    let mut items: Vec<String> = Vec::new();
    for line in lines() {
        if indentation(line) > own {
            let item = items.last_mut()?;
            item.push('\n');
            item.push_str(line);
        } else if indentation(line) == own && line.trim_start().starts_with('-') {
            items.push(line.replacen('-', " ", 1));
        } else {
            return None;
        }
    }
    let items = items.iter().map(|item| value(item, depth + 1));
    items.collect::<Option<Vec<_>>>().map(Value::List)
}

fn bracketed(rest: &mut &str, depth: usize) -> Option<Value> {
    *rest = rest.trim_start();
    if depth > DEPTH {
        return None;
    }
    let Some(inside) = rest.strip_prefix('[') else {
        let end = rest.find([',', ']', '\n']).unwrap_or(rest.len());
        let word = rest[..end].trim().trim_matches(['\'', '"']).to_owned();
        *rest = &rest[end..];
        return Some(Value::Word(word));
    };
    *rest = inside;
    let mut list = Vec::new();
    loop {
        *rest = rest.trim_start();
        if let Some(behind) = rest.strip_prefix(']') {
            *rest = behind;
            return Some(Value::List(list));
        }
        list.push(bracketed(rest, depth + 1)?);
        *rest = rest.trim_start();
        match rest.strip_prefix(',') {
            Some(behind) => *rest = behind,
            None if rest.starts_with(']') => {}
            None => return None,
        }
    }
}

fn motors(files: &Files, place: &Place, value: &Value, model: &mut Model) {
    model.says_motors = true;
    for joint in &mut model.joints {
        joint.actuated = false;
    }
    for name in value.words() {
        match model.joint_named(name) {
            Some(joint) => model.joints[joint].actuated = true,
            None => {
                let message = format!("there is no moving joint `{name}`");
                files.report(place, message, "name joints of the URDF that are not fixed");
            }
        }
    }
}

fn closures(
    files: &Files,
    place: &Place,
    value: &Value,
    entries: &Entries,
    tree: &Tree,
    model: &mut Model,
) {
    let pairs = match value {
        Value::List(pairs) => pairs.as_slice(),
        // No value: no loops.
        Value::Word(word) if word.is_empty() => &[],
        Value::Word(word) => {
            let message = format!("`closed_loop` is `{word}`, not a list of pairs of frames");
            files.report(place, message, PAIRS);
            return;
        }
    };
    let given = entries.get("type");
    let types = given.map(|(_, value)| value.words()).unwrap_or_default();
    if let Some((place, _)) = given.filter(|_| types.len() != pairs.len()) {
        let message = format!(
            "`type` has {} entries, but `closed_loop` {}",
            types.len(),
            pairs.len()
        );
        files.report(
            place,
            message,
            "give the type of each closure: `3d` or `6d`",
        );
        return;
    }
    for (at, pair) in pairs.iter().enumerate() {
        let [a, b] = pair.words()[..] else {
            files.report(place, "a closure names two frames", PAIRS);
            continue;
        };
        let find = |name| tree.find(files, name, place);
        let (Some(first), Some(second)) = (find(a), find(b)) else {
            continue;
        };
        let bodies = [first, second];
        let kind = match types
            .get(at)
            .copied()
            .unwrap_or("6d")
            .to_lowercase()
            .as_str()
        {
            "3d" => ClosureKind::Point {
                bodies,
                at: [Point3::origin(); 2],
            },
            "6d" => ClosureKind::Weld {
                bodies,
                at: [Pose::identity(); 2],
            },
            other => {
                let message = format!("a closure of type `{other}` is not supported");
                files.report(place, message, "write `3d` for a point or `6d` for a frame");
                continue;
            }
        };
        let name = format!("{a} and {b}");
        model.closures.push(Closure {
            name,
            kind,
            place: place.clone(),
        });
    }
}

/// Applies `joint_type`, which changes joints: to spherical, universal or fixed ones.
fn kinds(
    files: &Files,
    place: &Place,
    value: &Value,
    entries: &Entries,
    tree: &mut Tree,
    model: &mut Model,
) {
    let kinds = entries
        .get("joint_type")
        .map(|(_, value)| value.words())
        .unwrap_or_default();
    for (at, name) in value.words().into_iter().enumerate() {
        let kind = kinds.get(at).copied().unwrap_or("no type").to_uppercase();
        let Some(joint) = model.joint_named(name) else {
            let message = format!("there is no moving joint `{name}`");
            files.report(place, message, "name joints of the URDF that are not fixed");
            continue;
        };
        match kind.as_str() {
            "SPHERICAL" => model.joints[joint].kind = JointType::Ball,
            "FIXED" => model.remove_joint(joint),
            other => match universal_axes(other) {
                Some(axes) => make_universal(files, joint, axes, tree, model),
                None => {
                    let message =
                        format!("the joint `{name}` is `{other}`, which is not supported");
                    let help = "write SPHERICAL, FIXED, CARDAN, or UJOINT_ and two of the letters X, Y and Z";
                    files.report(place, message, help);
                }
            },
        }
    }
}

/// Letters of the axes of a universal joint; `None` for other types.
fn universal_axes(kind: &str) -> Option<[char; 2]> {
    if kind == "CARDAN" {
        return Some(['X', 'Y']);
    }
    let mut letters = kind.strip_prefix("UJOINT_")?.chars();
    let (first, second) = (letters.next()?, letters.next()?);
    let is_axis = |letter: char| ('X'..='Z').contains(&letter);
    let is_universal = is_axis(first) && is_axis(second) && first != second;
    (is_universal && letters.next().is_none()).then_some([first, second])
}

/// Unit vector of an axis letter.
fn axis_of(letter: char) -> Vector3<f64> {
    match letter {
        'X' => Vector3::x(),
        'Y' => Vector3::y(),
        _ => Vector3::z(),
    }
}

/// Replaces a joint by two revolute joints about two axes of its frame.
///
/// They have no torques, as in the toolbox of these files.
fn make_universal(
    files: &Files,
    joint: usize,
    axes: [char; 2],
    tree: &mut Tree,
    model: &mut Model,
) {
    let body = model.carried_by(joint);
    let (name, own) = (
        model.joints[joint].name.clone(),
        model.joints[joint].place.clone(),
    );
    let given = [
        ("damping", model.joints[joint].damping),
        ("friction", model.joints[joint].friction),
    ];
    for (attribute, _) in given.into_iter().filter(|(_, value)| *value != 0.0) {
        let reason = "LEFT OUT: the YAML file replaces the joint by a universal one";
        files.demote(&own, "dynamics", Some(attribute), reason);
    }
    let revolute = |letter: char| Joint {
        axis: axis_of(letter),
        ..Joint::new(
            &format!("{name}_{letter}"),
            JointType::Revolute,
            own.clone(),
        )
    };
    model.joints[joint] = revolute(axes[0]);
    model.joints.push(revolute(axes[1]));
    let last = model.joints.len() - 1;
    let between = Body {
        name: format!("{}_{}", model.bodies[body].name, axes[0]),
        parent: model.bodies[body].parent,
        placement: model.bodies[body].placement,
        place: None,
        joint: Some(joint),
        inertia: None,
        has_unknown_inertia: false,
    };
    tree.insert_before(body, between, model);
    let carried = &mut model.bodies[body + 1];
    (carried.parent, carried.placement) = (body, Pose::identity());
    carried.joint = Some(last);
}

#[cfg(test)]
mod tests {
    use super::{Value, universal_axes, value};

    #[test]
    fn universal_joint_axes_are_parsed() {
        assert_eq!(universal_axes("CARDAN"), Some(['X', 'Y']));
        assert_eq!(universal_axes("UJOINT_ZY"), Some(['Z', 'Y']));
        for wrong in ["UJOINT_XX", "UJOINT_X", "UJOINT_XYZ", "UJOINT_AB", "HINGE"] {
            assert_eq!(universal_axes(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn flow_and_block_lists_are_parsed() {
        let word = |text: &str| Value::Word(text.to_owned());
        let pair = Value::List(vec![word("a"), word("b c")]);
        assert_eq!(value(" ['a', \"b c\"]", 0), Some(pair.clone()));
        assert_eq!(
            value("[[a, b c],\n [a, b c]]", 0),
            Some(Value::List(vec![pair.clone(), pair.clone()]))
        );
        assert_eq!(value("\n- a\n- b c", 0), Some(pair));
        assert_eq!(value("[a, [b]", 0), None);
        assert_eq!(value(&"- ".repeat(100_000), 0), None);
    }
}
