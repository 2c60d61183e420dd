//! The six constants between two frames (Khalil and Kleinfinger).

use crate::{
    geometry::exact::{about, cleaned, fifteenths},
    model::Pose,
};
use nalgebra::{Point3, Rotation3, Vector3};
use std::f64::consts::PI;

/// Rot(z, γ) Trans(z, b) Rot(x, α) Trans(x, d) Rot(z, θ) Trans(z, r).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Step {
    pub(crate) gamma: f64,
    pub(crate) b: f64,
    pub(crate) alpha: f64,
    pub(crate) d: f64,
    pub(crate) theta: f64,
    pub(crate) r: f64,
}

/// Sine of the angle below which two axes count as parallel.
pub(crate) const PARALLEL: f64 = 1e-11;

impl Step {
    /// Constants between two frames; `None` if nearly parallel axes would lose digits.
    pub(crate) fn between(from: &Pose, to: &Pose) -> Option<Self> {
        let relative = from.inv_mul(to);
        let (rotation, at) = (cleaned(&relative.rotation), relative.translation.vector);
        let z = rotation * Vector3::z();
        let sine = z.x.hypot(z.y);
        if (PARALLEL..NEARLY).contains(&sine) {
            return None;
        }
        let step = if sine < PARALLEL {
            Self::parallel(z.z < 0.0, &rotation, &at)
        } else {
            Self::crossing(sine, &rotation, &at)
        };
        Some(step)
    }

    fn parallel(is_opposite: bool, rotation: &Rotation3<f64>, at: &Vector3<f64>) -> Self {
        let alpha = if is_opposite { PI } else { 0.0 };
        let away = at.x.hypot(at.y);
        let (gamma, d) = if away < 1e-14 {
            (0.0, 0.0)
        } else {
            near(round(at.y.atan2(at.x)), away)
        };
        let r = if is_opposite { -at.z } else { at.z };
        Self {
            gamma,
            b: 0.0,
            alpha,
            d,
            theta: turn(gamma, alpha, rotation),
            r,
        }
    }

    fn crossing(sine: f64, rotation: &Rotation3<f64>, at: &Vector3<f64>) -> Self {
        let z = rotation * Vector3::z();
        let (gamma, alpha) = near(round(z.x.atan2(-z.y)), round(sine.atan2(z.z)));
        let at = about(2, -gamma) * at;
        let (sin, cos) = crate::geometry::exact::sin_cos(alpha);
        let r = -at.y / sin;
        let b = at.z - r * cos;
        Self {
            gamma,
            b,
            alpha,
            d: at.x,
            theta: turn(gamma, alpha, rotation),
            r,
        }
    }

    /// Frame after the step.
    pub(crate) fn frame(&self) -> Pose {
        let along = |axis: usize, by: f64| {
            Pose::from_parts(Vector3::ith(axis, by).into(), Rotation3::identity())
        };
        let turned =
            |axis: usize, by: f64| Pose::from_parts(Vector3::zeros().into(), about(axis, by));
        turned(2, self.gamma)
            * along(2, self.b)
            * turned(0, self.alpha)
            * along(0, self.d)
            * turned(2, self.theta)
            * along(2, self.r)
    }
}

/// Sine of the angle between two axes below which a step loses digits.
pub(crate) const NEARLY: f64 = 2e-3;

/// Normalises γ to a quarter turn in either direction; `other` changes sign if needed.
fn near(gamma: f64, other: f64) -> (f64, f64) {
    if gamma > PI / 2.0 + 1e-9 {
        (gamma - PI, -other)
    } else if gamma <= -PI / 2.0 + 1e-9 {
        (gamma + PI, -other)
    } else {
        (gamma, other)
    }
}

/// Remaining rotation about z.
fn turn(gamma: f64, alpha: f64, rotation: &Rotation3<f64>) -> f64 {
    let left = (about(2, gamma) * about(0, alpha)).inverse() * rotation;
    let m = left.matrix();
    round(m[(1, 0)].atan2(m[(0, 0)]))
}

/// Rounds to a multiple of 15° if the angle is one up to rounding.
pub(crate) fn round(angle: f64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a small whole number")]
    fifteenths(angle, 1e-12).map_or(angle, |k| k as f64 * PI / 12.0)
}

/// Line in space, as a joint axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) point: Point3<f64>,
    /// Unit vector.
    pub(crate) direction: Vector3<f64>,
}

/// Feet of the common normal of two lines that are not parallel.
pub(crate) fn feet(first: Line, second: Line) -> (Point3<f64>, Point3<f64>) {
    let (p, u) = (first.point, first.direction);
    let (q, w) = (second.point, second.direction);
    let (between, c) = (q - p, u.dot(&w));
    let denominator = 1.0 - c * c;
    let s = (between.dot(&u) - c * between.dot(&w)) / denominator;
    let t = (c * between.dot(&u) - between.dot(&w)) / denominator;
    (p + u * s, q + w * t)
}

/// Angles of a rotation Rz(rz) Ry(ry) Rx(rx).
pub(crate) fn angles(rotation: &Rotation3<f64>) -> [f64; 3] {
    let m = cleaned(rotation);
    let m = m.matrix();
    let ry = (-m[(2, 0)]).atan2(m[(0, 0)].hypot(m[(1, 0)]));
    if m[(0, 0)].hypot(m[(1, 0)]) < 1e-12 {
        let left = about(1, ry).inverse() * rotation;
        let left = left.matrix();
        return [round(left[(2, 1)].atan2(left[(1, 1)])), round(ry), 0.0];
    }
    let (rx, rz) = (m[(2, 1)].atan2(m[(2, 2)]), m[(1, 0)].atan2(m[(0, 0)]));
    [round(rx), round(ry), round(rz)]
}

#[cfg(test)]
mod tests {
    use super::{Step, angles};
    use crate::{geometry::exact::about, model::Pose};
    use nalgebra::{Rotation3, Vector3};

    fn pose(numbers: [f64; 6]) -> Pose {
        let [x, y, z, rx, ry, rz] = numbers;
        let rotation = Rotation3::from_euler_angles(rx, ry, rz);
        Pose::from_parts(Vector3::new(x, y, z).into(), rotation)
    }

    fn distance(a: &Pose, b: &Pose) -> f64 {
        let turned = (a.rotation.matrix() - b.rotation.matrix()).amax();
        turned.max((a.translation.vector - b.translation.vector).amax())
    }

    #[test]
    fn six_constants_reach_any_frame() {
        let mut seed = 1_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            f64::from(u32::try_from(seed >> 33).unwrap_or(0)) / f64::from(1_u32 << 30) - 1.0
        };
        for _ in 0..200 {
            let (from, to) = (
                pose([(); 6].map(|()| next())),
                pose([(); 6].map(|()| 3.0 * next())),
            );
            let step = Step::between(&from, &to).expect("axes that cross");
            assert!(distance(&(from * step.frame()), &to) < 1e-13);
            assert!(step.gamma.abs() <= 1.6);
        }
        for parallel in [
            [0.1, 0.2, 0.3, 0.0, 0.0, 0.4],
            [0.1, 0.2, 0.3, std::f64::consts::PI, 0.0, 0.4],
        ] {
            let to = pose(parallel);
            let step = Step::between(&Pose::identity(), &to).expect("parallel axes");
            assert!(distance(&step.frame(), &to) < 1e-13, "{step:?}");
        }
        assert!(Step::between(&Pose::identity(), &pose([0.1, 0.0, 0.0, 1e-5, 0.0, 0.0])).is_none());
    }

    #[test]
    fn angles_reproduce_their_rotation() {
        for [rx, ry, rz] in [
            [0.3, -0.2, 2.0],
            [0.5, std::f64::consts::FRAC_PI_2, 0.0],
            [3.0, -1.4, -3.0],
        ] {
            let rotation = about(2, rz) * about(1, ry) * about(0, rx);
            let [a, b, c] = angles(&rotation);
            let again = about(2, c) * about(1, b) * about(0, a);
            assert!((again.matrix() - rotation.matrix()).amax() < 1e-14);
        }
    }
}
