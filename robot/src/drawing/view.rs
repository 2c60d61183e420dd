//! View direction of a drawing.

use super::scene::{DrawnPart, Point, Scene};
use nalgebra::{Rotation3, Unit, Vector3};
use overact_codegen::mechanism::{Mechanism, Motion};

/// Directions of the sheet in the base frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// To the right.
    pub(super) right: Point,
    /// Upwards.
    pub(super) up: Point,
    /// Towards the reader.
    pub(super) toward: Point,
    /// Rotation axis: the vertical on the sheet, and in space if there is gravity.
    vertical: Point,
    /// Whether the robot is planar and in the plane of the sheet.
    pub(super) planar: bool,
}

/// Elevation of the view of spatial robots, degrees.
const ELEVATION: f64 = 24.0;
/// Number of azimuths that are tried.
const AROUND: usize = 36;

impl View {
    /// View of a mechanism.
    pub(super) fn of(mechanism: &Mechanism, scene: &Scene) -> Self {
        match plane(mechanism, scene) {
            Some(normal) => Self::along(&normal, mechanism),
            None => Self::best(mechanism, scene),
        }
    }

    /// View after rotating the robot about its vertical, then towards the reader, rad.
    pub(super) fn turned(&self, around: f64, over: f64) -> Self {
        // Rotate the viewer opposite to the robot.
        let spin = Rotation3::from_axis_angle(&Unit::new_normalize(self.vertical), -around);
        let right = spin * self.right;
        let tilt = Rotation3::from_axis_angle(&Unit::new_normalize(right), -over);
        let turned = |direction: Point| tilt * (spin * direction);
        Self {
            right,
            up: turned(self.up),
            toward: turned(self.toward),
            vertical: self.vertical,
            planar: self.planar && around == 0.0 && over == 0.0,
        }
    }

    /// Position on paper (right, up) and depth towards the reader, m.
    pub(super) fn project(&self, point: &Point) -> [f64; 3] {
        [
            self.right.dot(point),
            self.up.dot(point),
            self.toward.dot(point),
        ]
    }

    /// View along the normal of a plane, with gravity downwards.
    fn along(normal: &Point, mechanism: &Mechanism) -> Self {
        let fall = gravity(mechanism);
        let in_plane = -(fall - normal * normal.dot(&fall));
        let usual = Vector3::y() - normal * normal.y;
        let other = Vector3::z() - normal * normal.z;
        let up = in_plane
            .try_normalize(1e-6)
            .or_else(|| usual.try_normalize(1e-6))
            .unwrap_or_else(|| other.normalize());
        Self {
            right: up.cross(normal),
            up,
            toward: *normal,
            vertical: up,
            planar: true,
        }
    }

    /// Elevated view that separates the joints best.
    ///
    /// A later azimuth must be better by more than rounding, so that the choice does not depend on
    /// the machine.
    fn best(mechanism: &Mechanism, scene: &Scene) -> Self {
        let up = (-gravity(mechanism))
            .try_normalize(1e-6)
            .unwrap_or_else(Vector3::z);
        let mut best: Option<(f64, Self)> = None;
        for step in 0..AROUND {
            let azimuth = 25.0 + step as f64 * 360.0 / AROUND as f64;
            let view = Self::above(&up, azimuth.to_radians());
            let score = view.clearness(scene);
            if best.as_ref().is_none_or(|(known, _)| score > known + 1e-6) {
                best = Some((score, view));
            }
        }
        best.map_or_else(|| Self::above(&up, 0.5), |(_, view)| view)
    }

    fn above(up: &Point, azimuth: f64) -> Self {
        let seed = if up.z.abs() > 0.9 {
            -Vector3::y()
        } else {
            Vector3::z()
        };
        let front = (seed - up * up.dot(&seed)).normalize();
        let side = up.cross(&front);
        let level = front * azimuth.cos() + side * azimuth.sin();
        let (high, low) = ELEVATION.to_radians().sin_cos();
        let toward = level * low + up * high;
        let right = up.cross(&toward).normalize();
        Self {
            right,
            up: toward.cross(&right),
            toward,
            vertical: *up,
            planar: false,
        }
    }

    /// Mean logarithm of the distances between joints on paper.
    fn clearness(&self, scene: &Scene) -> f64 {
        let places: Vec<[f64; 3]> = scene.landmarks().iter().map(|p| self.project(p)).collect();
        let extent = extent(&places).max(1e-9);
        let (mut sum, mut count) = (0.0, 0_u32);
        for (i, a) in places.iter().enumerate() {
            for b in &places[i + 1..] {
                let distance = (a[0] - b[0]).hypot(a[1] - b[1]) / extent;
                sum += distance.max(0.02).ln();
                count += 1;
            }
        }
        sum / f64::from(count.max(1))
    }
}

fn extent(places: &[[f64; 3]]) -> f64 {
    let range = |axis: usize| {
        let values = || places.iter().map(|p| p[axis]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    range(0).hypot(range(1))
}

fn gravity(mechanism: &Mechanism) -> Point {
    let [x, y, z] = mechanism
        .gravity
        .map(overact_codegen::mechanism::Number::value);
    Vector3::new(x, y, z)
}

/// Normal of the plane in which the robot lies and moves, if there is one.
fn plane(mechanism: &Mechanism, scene: &Scene) -> Option<Point> {
    let axis = |axis: usize| {
        let mut normal = Point::zeros();
        normal[axis] = 1.0;
        normal
    };
    let motion = mechanism.platform.as_ref().map(|p| p.motion);
    let turning = scene.parts.iter().find_map(|(_, part)| match part {
        DrawnPart::Revolute { axis, .. } => Some(*axis),
        _ => None,
    });
    let normal = match motion {
        Some(
            Motion::Planar { axis: a } | Motion::Point { axis: a } | Motion::Rotation { axis: a },
        ) => axis(a),
        _ => match turning {
            Some(turning) => turning,
            None => straight(mechanism, scene)?,
        },
    };
    let flat = |p: &Point| normal.dot(p).abs() < 1e-6;
    let turns = |a: &Point| a.cross(&normal).norm() < 1e-6;
    let lies = scene.parts.iter().all(|(_, part)| match part {
        DrawnPart::Revolute { axis, .. } => turns(axis),
        DrawnPart::Rail { from, to } | DrawnPart::Telescope { from, to, .. } => flat(&(to - from)),
        DrawnPart::Slider { axis, .. } => flat(axis),
        _ => true,
    });
    let first = scene.bases.first().copied().unwrap_or_default();
    // The view is chosen before coincident sliders are separated, so these still lie in one plane.
    let level = scene.points().iter().all(|p| flat(&(p - first)));
    (lies && level).then_some(normal)
}

/// Normal for a robot with parallel prismatic joints only.
///
/// It is the coordinate axis across the slides that keeps gravity in the plane of the sheet, if
/// there is one.
fn straight(mechanism: &Mechanism, scene: &Scene) -> Option<Point> {
    let slide = scene.parts.iter().find_map(|(_, part)| match part {
        DrawnPart::Slider { axis, .. } => Some(*axis),
        _ => None,
    })?;
    let fall = gravity(mechanism);
    let normals = [-Vector3::y(), Vector3::x(), Vector3::z()];
    let across = |n: &Point| n.dot(&slide).abs() < 1e-6;
    let upright = |n: &Point| across(n) && n.dot(&fall).abs() < 1e-6;
    normals
        .iter()
        .find(|n| upright(n))
        .or_else(|| normals.iter().find(|n| across(n)))
        .copied()
}
