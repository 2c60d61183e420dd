//! Serial robots as URDF.
//!
//! Gravity of a URDF points along -z of the world, so the base is turned if the robot's does not.

use super::{SerialTree, centred, comment, escaped, number, numbers};
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Effort and velocity limits of joints: the format requires them, and none are known.
const NO_LIMIT: &str = "effort=\"1e9\" velocity=\"1e9\"";
/// Cosine of a pitch at which roll and yaw are not separate.
const GIMBAL: f64 = 1e-12;

/// The file.
pub(super) fn text(tree: &SerialTree) -> String {
    let mut out = format!("<robot name=\"{}\">\n", escaped(&tree.name));
    out += &comment(tree);
    let is_taken = |name: &str| tree.bodies.iter().any(|own| own.name == name);
    let mut base = "base".to_owned();
    while is_taken(&base) {
        base.push('_');
    }
    let _ = writeln!(out, "  <link name=\"{base}\"/>");
    for own in &tree.bodies {
        let name = escaped(&own.name);
        let (mass, centre, inertia) = centred(&own.inertia);
        let _ = writeln!(
            out,
            "  <link name=\"{name}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>",
            numbers(centre.as_slice()),
            number(mass)
        );
        let entries = [
            ("ixx", (0, 0)),
            ("ixy", (0, 1)),
            ("ixz", (0, 2)),
            ("iyy", (1, 1)),
            ("iyz", (1, 2)),
            ("izz", (2, 2)),
        ];
        let entries = entries.map(|(key, at)| format!("{key}=\"{}\"", number(inertia[at])));
        let _ = writeln!(
            out,
            "      <inertia {}/>\n    </inertial>\n  </link>",
            entries.join(" ")
        );
    }
    for own in &tree.bodies {
        let name = escaped(&own.name);
        let parent = own
            .parent
            .map_or(base.clone(), |at| escaped(&tree.bodies[at].name));
        let placement = match own.parent {
            Some(_) => own.placement,
            None => upright(&tree.gravity) * own.placement,
        };
        let kind = if own.is_revolute {
            "revolute"
        } else {
            "prismatic"
        };
        let _ = writeln!(
            out,
            "  <joint name=\"{name}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    <child link=\"{name}\"/>\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    <axis xyz=\"0 0 1\"/>",
            numbers(placement.translation.vector.as_slice()),
            numbers(&roll_pitch_yaw(&placement.rotation))
        );
        let [least, most] = own.range.map(number);
        let _ = writeln!(
            out,
            "    <limit lower=\"{least}\" upper=\"{most}\" {NO_LIMIT}/>"
        );
        if let Some((leader, factor)) = own.follows {
            let _ = writeln!(
                out,
                "    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"0\"/>",
                escaped(&tree.bodies[leader].name),
                number(factor)
            );
        }
        out += "  </joint>\n";
    }
    out + "</robot>\n"
}

/// Rotation of the base that turns gravity to -z.
fn upright(gravity: &Vector3<f64>) -> Isometry3<f64> {
    let down = -Vector3::z();
    let turn = UnitQuaternion::rotation_between(gravity, &down);
    // Gravity may point along +z, or be zero.
    let turn = turn.unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI));
    let turn = if gravity.norm() == 0.0 || (gravity.x == 0.0 && gravity.y == 0.0 && gravity.z < 0.0)
    {
        UnitQuaternion::identity()
    } else {
        turn
    };
    Isometry3::from_parts(Translation3::identity(), turn)
}

/// Angles of Rz(yaw) Ry(pitch) Rx(roll).
fn roll_pitch_yaw(turn: &UnitQuaternion<f64>) -> [f64; 3] {
    let m: Matrix3<f64> = *turn.to_rotation_matrix().matrix();
    let cosine = m[(0, 0)].hypot(m[(1, 0)]);
    let pitch = (-m[(2, 0)]).atan2(cosine);
    if cosine < GIMBAL {
        return [0.0, pitch, (-m[(0, 1)]).atan2(m[(1, 1)])];
    }
    [
        m[(2, 1)].atan2(m[(2, 2)]),
        pitch,
        m[(1, 0)].atan2(m[(0, 0)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::{roll_pitch_yaw, upright};
    use nalgebra::{Rotation3, UnitQuaternion, Vector3};

    #[test]
    fn angles_give_the_rotation_again() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for angles in [
            [0.3, -1.2, 2.0],
            [0.4, quarter, 0.9],
            [-1.0, -quarter, 0.2],
            [quarter, 0.0, -quarter],
        ] {
            let [x, y, z] = angles;
            let turn = UnitQuaternion::from(Rotation3::from_euler_angles(x, y, z));
            let [x, y, z] = roll_pitch_yaw(&turn);
            let again = UnitQuaternion::from(Rotation3::from_euler_angles(x, y, z));
            assert!(turn.angle_to(&again) < 1e-14, "{angles:?}");
        }
    }

    #[test]
    fn gravity_points_down() {
        for gravity in [
            [0.0, 0.0, -9.81],
            [0.0, 0.0, 9.81],
            [3.0, -1.0, 2.0],
            [0.0, 9.81, 0.0],
        ] {
            let gravity = Vector3::from(gravity);
            let turned = upright(&gravity) * gravity;
            assert!((turned + Vector3::z() * gravity.norm()).norm() < 1e-14);
        }
    }
}
