//! Writes random mechanisms as MJCF, URDF and SDFormat.

use super::mechanism::{JointType, RandomMechanism};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Writes a mechanism as a file.
type Writer = fn(&RandomMechanism) -> String;

/// Suffixes of the formats with the functions that write them.
pub(crate) const FORMATS: [(&str, Writer); 3] = [("xml", mjcf), ("urdf", urdf), ("sdf", sdf)];

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    let each: Vec<String> = values.into_iter().map(|v| format!("{v:?}")).collect();
    each.join(" ")
}

fn vector(own: &Vector3<f64>) -> String {
    numbers(own.iter().copied())
}

/// Roll, pitch and yaw about fixed axes.
fn angles(turn: &Rotation3<f64>) -> String {
    let (roll, pitch, yaw) = turn.euler_angles();
    numbers([roll, pitch, yaw])
}

/// Moments and products of inertia with their names.
fn moments(own: &Matrix3<f64>) -> [(&'static str, f64); 6] {
    [
        ("ixx", own[(0, 0)]),
        ("iyy", own[(1, 1)]),
        ("izz", own[(2, 2)]),
        ("ixy", own[(0, 1)]),
        ("ixz", own[(0, 2)]),
        ("iyz", own[(1, 2)]),
    ]
}

fn name(body: Option<usize>) -> String {
    body.map_or_else(|| "world".to_owned(), |at| format!("b{at}"))
}

fn mjcf(own: &RandomMechanism) -> String {
    let loops: String = { own.loops.iter() }
        .map(|closure| {
            let [a, b] = closure.bodies;
            let (turn, origin) = own.frame(a);
            let anchor = vector(&(turn.inverse() * (closure.point - origin)));
            let other = b.map_or_else(String::new, |_| format!(" body2='{}'", name(b)));
            format!("<connect body1='{}'{other} anchor='{anchor}'/>\n", name(a))
        })
        .collect();
    let equality = if loops.is_empty() {
        String::new()
    } else {
        format!("<equality>{loops}</equality>")
    };
    let motors: String = { own.driven.iter() }
        .map(|body| format!("<motor joint='j{body}'/>"))
        .collect();
    format!(
        "<mujoco model='m'><compiler angle='radian'/>\n<worldbody>{}</worldbody>{equality}\n<actuator>{motors}</actuator></mujoco>\n",
        bodies_on(own, None)
    )
}

/// MJCF of the bodies that a body carries.
fn bodies_on(own: &RandomMechanism, parent: Option<usize>) -> String {
    let mut text = String::new();
    for (at, body) in own.bodies.iter().enumerate() {
        if body.parent != parent {
            continue;
        }
        let (turn, origin) = own.relative(at);
        let turn = nalgebra::UnitQuaternion::from_rotation_matrix(&turn);
        let turn = numbers([turn.w, turn.i, turn.j, turn.k]);
        let inertia = numbers(moments(&body.inertia).map(|(_, value)| value));
        let (kind, axis) = match body.joint {
            JointType::Hinge => ("hinge", vector(&body.axis)),
            JointType::Slide => ("slide", vector(&body.axis)),
            JointType::Ball => ("ball", String::new()),
        };
        let moving = if axis.is_empty() {
            String::new()
        } else {
            format!(" axis='{axis}' damping='{:?}'", body.damping)
        };
        text += &format!(
            "<body name='b{at}' pos='{}' quat='{turn}'>\n<inertial pos='{}' mass='{:?}' fullinertia='{inertia}'/>\n\
             <joint name='j{at}' type='{kind}'{moving}/>\n{}</body>\n",
            vector(&origin),
            vector(&body.centre),
            body.mass,
            bodies_on(own, Some(at))
        );
    }
    text
}

fn urdf(own: &RandomMechanism) -> String {
    let mut text = "<link name='world'/>\n".to_owned();
    for (at, body) in own.bodies.iter().enumerate() {
        let inertia: String = { moments(&body.inertia).into_iter() }
            .map(|(key, value)| format!(" {key}='{value:?}'"))
            .collect();
        text += &format!(
            "<link name='b{at}'><inertial><origin xyz='{}'/><mass value='{:?}'/><inertia{inertia}/></inertial></link>\n",
            vector(&body.centre),
            body.mass
        );
        let (turn, origin) = own.relative(at);
        let mut placed = format!(
            "<origin xyz='{}' rpy='{}'/>",
            vector(&origin),
            angles(&turn)
        );
        let mut parent = name(body.parent);
        if body.joint == JointType::Ball {
            // Three hinges that meet in a point.
            for (stage, axis) in ["1 0 0", "0 1 0", "0 0 1"].iter().enumerate() {
                let child = match stage {
                    2 => name(Some(at)),
                    _ => format!("b{at}_{stage}"),
                };
                if stage < 2 {
                    text += &format!("<link name='{child}'/>\n");
                }
                text += &format!(
                    "<joint name='j{at}_{stage}' type='continuous'><parent link='{parent}'/><child link='{child}'/>{placed}<axis xyz='{axis}'/></joint>\n"
                );
                parent = child;
                placed.clear();
            }
            continue;
        }
        let (kind, limit) = match body.joint {
            JointType::Slide => (
                "prismatic",
                "<limit lower='-9' upper='9' effort='9' velocity='9'/>",
            ),
            JointType::Hinge | JointType::Ball => ("continuous", ""),
        };
        text += &format!(
            "<joint name='j{at}' type='{kind}'><parent link='{parent}'/><child link='b{at}'/>{placed}\
             <axis xyz='{}'/>{limit}<dynamics damping='{:?}'/></joint>\n",
            vector(&body.axis),
            body.damping
        );
    }
    for joint in loops(own) {
        text += &format!("<gazebo>{joint}</gazebo>\n");
    }
    format!("<robot name='m'>\n{text}</robot>\n")
}

fn sdf(own: &RandomMechanism) -> String {
    let mut text = String::new();
    for (at, body) in own.bodies.iter().enumerate() {
        let inertia: String = { moments(&body.inertia).into_iter() }
            .map(|(key, value)| format!("<{key}>{value:?}</{key}>"))
            .collect();
        text += &format!(
            "<link name='b{at}'><pose>{} {}</pose>\n<inertial><pose>{} 0 0 0</pose><mass>{:?}</mass><inertia>{inertia}</inertia></inertial></link>\n",
            vector(&body.origin.coords),
            angles(&body.rotation),
            vector(&body.centre),
            body.mass
        );
        let (kind, axis) = match body.joint {
            JointType::Hinge => ("revolute", vector(&body.axis)),
            JointType::Slide => ("prismatic", vector(&body.axis)),
            JointType::Ball => ("ball", String::new()),
        };
        let axis = if axis.is_empty() {
            axis
        } else {
            format!(
                "<axis><xyz>{axis}</xyz><dynamics><damping>{:?}</damping></dynamics></axis>",
                body.damping
            )
        };
        text += &format!(
            "<joint name='j{at}' type='{kind}'><parent>{}</parent><child>b{at}</child>{axis}</joint>\n",
            name(body.parent)
        );
    }
    text.extend(loops(own));
    format!("<sdf version='1.9'><model name='m'>\n{text}</model></sdf>\n")
}

/// Joints of loops in SDFormat, as also `<gazebo>` of URDF has them.
fn loops(own: &RandomMechanism) -> Vec<String> {
    let each = own.loops.iter().enumerate().map(|(at, closure)| {
        let [child, parent] = closure.bodies;
        // The pose is that of the joint in its child.
        let (turn, origin) = own.frame(child);
        let back = turn.inverse();
        let pose = vector(&(back * (closure.point - origin)));
        let (kind, axis) = match &closure.axis {
            Some(axis) => {
                let axis = vector(&(back * axis));
                ("revolute", format!("<axis><xyz>{axis}</xyz></axis>"))
            }
            None => ("ball", String::new()),
        };
        let (child, parent) = (name(child), name(parent));
        format!(
            "<joint name='loop{at}' type='{kind}'><pose>{pose} 0 0 0</pose><parent>{parent}</parent><child>{child}</child>{axis}</joint>\n"
        )
    });
    each.collect()
}
