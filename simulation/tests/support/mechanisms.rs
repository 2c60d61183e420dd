//! Kinematics of the test robots.

use overact::Error;
use std::sync::LazyLock;

/// Inverse kinematics and its derivatives.
pub trait Kinematics: Sync {
    /// Whether the actuators are angles.
    const REVOLUTE: bool;
    fn actuators(&self) -> &'static [&'static str];
    fn coordinates(&self) -> &'static [&'static str];
    fn home(&self) -> Vec<f64>;
    /// q(x).
    fn positions(&self, x: &[f64], q: &mut [f64]) -> Result<(), Error>;
    /// J_p^inv, n x r.
    fn jacobian(&self, x: &[f64], j: &mut [f64]) -> Result<(), Error>;
    /// c(x, v) = dJ/dt v.
    fn convection(&self, x: &[f64], v: &[f64], c: &mut [f64]) -> Result<(), Error>;
    /// J_p^inv and c(x, v) together.
    fn motion(&self, x: &[f64], v: &[f64], j: &mut [f64], c: &mut [f64]) -> Result<(), Error> {
        self.jacobian(x, j)?;
        self.convection(x, v, c)
    }
    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        for (x, s) in pose.iter_mut().zip(step) {
            *x += s;
        }
    }
}

/// The paper's Fig. 1: two motors on one mass.
pub struct TwoMotors;

impl Kinematics for TwoMotors {
    const REVOLUTE: bool = false;
    fn actuators(&self) -> &'static [&'static str] {
        &["left", "right"]
    }
    fn coordinates(&self) -> &'static [&'static str] {
        &["x"]
    }
    fn home(&self) -> Vec<f64> {
        vec![0.0]
    }
    fn positions(&self, x: &[f64], q: &mut [f64]) -> Result<(), Error> {
        q.fill(x[0]);
        Ok(())
    }
    fn jacobian(&self, _: &[f64], j: &mut [f64]) -> Result<(), Error> {
        j[..2].fill(1.0);
        Ok(())
    }
    fn convection(&self, _: &[f64], _: &[f64], c: &mut [f64]) -> Result<(), Error> {
        c[..2].fill(0.0);
        Ok(())
    }
}

/// A shaft with two motors whose pose is (cos, sin) of the angle, so that it is not additive.
///
/// The displacement is a chart like that of a quaternion: a step s rotates by 2 atan(s / 2).
pub struct Shaft;

impl Kinematics for Shaft {
    const REVOLUTE: bool = true;
    fn actuators(&self) -> &'static [&'static str] {
        &["direct", "geared"]
    }
    fn coordinates(&self) -> &'static [&'static str] {
        &["phi"]
    }
    fn home(&self) -> Vec<f64> {
        vec![1.0, 0.0]
    }
    fn positions(&self, x: &[f64], q: &mut [f64]) -> Result<(), Error> {
        q[0] = x[1].atan2(x[0]);
        q[1] = overact::math::wrap_angle(3.0 * q[0]);
        Ok(())
    }
    fn jacobian(&self, _: &[f64], j: &mut [f64]) -> Result<(), Error> {
        j[..2].copy_from_slice(&[1.0, 3.0]);
        Ok(())
    }
    fn convection(&self, _: &[f64], _: &[f64], c: &mut [f64]) -> Result<(), Error> {
        c[..2].fill(0.0);
        Ok(())
    }
    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        let (sin, cos) = (2.0 * (0.5 * step[0]).atan()).sin_cos();
        let [c, s] = [pose[0], pose[1]];
        pose[0] = c * cos - s * sin;
        pose[1] = s * cos + c * sin;
    }
}

/// A point in the plane on three telescopic legs with moving masses: the mass matrix
/// m I + Σ ia_i u_i u_iᵀ depends on the directions u_i of the legs.
pub struct Tripod;

const ANCHORS: [[f64; 2]; 3] = [[1.0, 0.0], [-0.5, 0.8], [-0.6, -0.7]];

fn leg(x: &[f64], i: usize) -> Result<([f64; 2], f64), Error> {
    let d = [x[0] - ANCHORS[i][0], x[1] - ANCHORS[i][1]];
    let length = d[0].hypot(d[1]);
    if length > 2.0 {
        return Err(Error::OutOfReach { leg: "telescope" });
    }
    Ok(([d[0] / length, d[1] / length], length))
}

impl Kinematics for Tripod {
    const REVOLUTE: bool = false;
    fn actuators(&self) -> &'static [&'static str] {
        &["a", "b", "c"]
    }
    fn coordinates(&self) -> &'static [&'static str] {
        &["x", "y"]
    }
    fn home(&self) -> Vec<f64> {
        vec![0.05, -0.02]
    }
    fn positions(&self, x: &[f64], q: &mut [f64]) -> Result<(), Error> {
        for (i, q) in q.iter_mut().enumerate() {
            *q = leg(x, i)?.1;
        }
        Ok(())
    }
    fn jacobian(&self, x: &[f64], j: &mut [f64]) -> Result<(), Error> {
        for i in 0..3 {
            j[2 * i..2 * i + 2].copy_from_slice(&leg(x, i)?.0);
        }
        Ok(())
    }
    fn convection(&self, x: &[f64], v: &[f64], c: &mut [f64]) -> Result<(), Error> {
        for (i, c) in c.iter_mut().enumerate().take(3) {
            let (u, length) = leg(x, i)?;
            let along = u[0] * v[0] + u[1] * v[1];
            *c = (v[0] * v[0] + v[1] * v[1] - along * along) / length;
        }
        Ok(())
    }
}

/// The DualV with the inertia of each leg at its motor (Table 1, r_p = 0.11 m).
pub struct DualV;

const BASE: f64 = 0.41;
const LINK: f64 = 0.28;
const HALF_PLATFORM: f64 = 0.11;
const GAMMA: [f64; 4] = [15.52, 164.48, -164.48, -15.52];
/// The elbows point away from the platform's centre.
const MODE: [f64; 4] = [-1.0, 1.0, -1.0, 1.0];

/// Cosine and sine of the motors' directions gamma.
static MOTORS: LazyLock<[[f64; 2]; 4]> = LazyLock::new(|| {
    GAMMA.map(|gamma| {
        let (sin, cos) = gamma.to_radians().sin_cos();
        [cos, sin]
    })
});

/// Geometry of a leg.
struct Leg {
    /// From the motor to C, B - A + C - B, and its length.
    span: [f64; 2],
    length: f64,
    /// The direction of the arm B - A.
    direction: [f64; 2],
    /// C - B.
    forearm: [f64; 2],
    /// C relative to the platform's centre.
    lever: [f64; 2],
}

impl Leg {
    /// Leg `i`, by sine and cosine of the platform's angle.
    fn new(x: &[f64], (sin, cos): (f64, f64), i: usize) -> Result<Self, Error> {
        let side = if i < 2 { HALF_PLATFORM } else { -HALF_PLATFORM };
        let lever = [-side * sin, side * cos];
        let [ca, sa] = MOTORS[i];
        let span = [x[0] + lever[0] - BASE * ca, x[1] + lever[1] - BASE * sa];
        let length = (span[0] * span[0] + span[1] * span[1]).sqrt();
        // The angle between arm and span has this cosine.
        let c = length / (2.0 * LINK);
        if c > 1.0 {
            return Err(Error::OutOfReach {
                leg: ["leg1", "leg2", "leg3", "leg4"][i],
            });
        }
        let s = MODE[i] * (1.0 - c * c).sqrt();
        let along = span.map(|span| span / length);
        let direction = [along[0] * c - along[1] * s, along[1] * c + along[0] * s];
        Ok(Self {
            span,
            length,
            direction,
            forearm: [span[0] - LINK * direction[0], span[1] - LINK * direction[1]],
            lever,
        })
    }

    /// The motor's angle.
    fn motor(&self, i: usize) -> f64 {
        self.span[1].atan2(self.span[0]) + MODE[i] * (self.length / (2.0 * LINK)).acos()
    }

    /// (C - B) . ∂B/∂q.
    fn determinant(&self) -> Result<f64, Error> {
        let [c, s] = self.direction;
        let value = LINK * (self.forearm[1] * c - self.forearm[0] * s);
        if value.abs() < 1e-4 {
            return Err(Error::SingularLeg {
                leg: "leg",
                condition: 0.06 / value.abs(),
            });
        }
        Ok(value)
    }

    /// The motor's rate per twist: (C - B) . (Ċ - Ḃ) = 0.
    fn rates(&self) -> Result<[f64; 3], Error> {
        let (f, b) = (self.forearm, self.determinant()?);
        let turn = f[1] * self.lever[0] - f[0] * self.lever[1];
        Ok([f[0] / b, f[1] / b, turn / b])
    }

    /// The motor's acceleration at a twist without acceleration:
    /// (C - B) . (C̈ - B̈) + |Ċ - Ḃ|² = 0.
    fn convection(&self, v: &[f64]) -> Result<f64, Error> {
        let (f, b) = (self.forearm, self.determinant()?);
        let tip = [v[0] - v[2] * self.lever[1], v[1] + v[2] * self.lever[0]];
        let rate = (f[0] * tip[0] + f[1] * tip[1]) / b;
        let [co, s] = self.direction;
        let elbow = [-LINK * s * rate, LINK * co * rate];
        let squared_rate = (tip[0] - elbow[0]).powi(2) + (tip[1] - elbow[1]).powi(2);
        let centripetal = [
            -v[2] * v[2] * self.lever[0] + LINK * co * rate * rate,
            -v[2] * v[2] * self.lever[1] + LINK * s * rate * rate,
        ];
        Ok((f[0] * centripetal[0] + f[1] * centripetal[1] + squared_rate) / b)
    }
}

impl Kinematics for DualV {
    const REVOLUTE: bool = true;
    fn actuators(&self) -> &'static [&'static str] {
        &["leg1", "leg2", "leg3", "leg4"]
    }
    fn coordinates(&self) -> &'static [&'static str] {
        &["x", "y", "phi"]
    }
    fn home(&self) -> Vec<f64> {
        vec![0.0; 3]
    }
    fn positions(&self, x: &[f64], q: &mut [f64]) -> Result<(), Error> {
        let turn = x[2].sin_cos();
        for (i, q) in q.iter_mut().enumerate() {
            *q = Leg::new(x, turn, i)?.motor(i);
        }
        Ok(())
    }
    fn jacobian(&self, x: &[f64], j: &mut [f64]) -> Result<(), Error> {
        let turn = x[2].sin_cos();
        for i in 0..4 {
            j[3 * i..3 * i + 3].copy_from_slice(&Leg::new(x, turn, i)?.rates()?);
        }
        Ok(())
    }
    fn convection(&self, x: &[f64], v: &[f64], c: &mut [f64]) -> Result<(), Error> {
        let turn = x[2].sin_cos();
        for (i, c) in c.iter_mut().enumerate().take(4) {
            *c = Leg::new(x, turn, i)?.convection(v)?;
        }
        Ok(())
    }
    fn motion(&self, x: &[f64], v: &[f64], j: &mut [f64], c: &mut [f64]) -> Result<(), Error> {
        let turn = x[2].sin_cos();
        for i in 0..4 {
            let leg = Leg::new(x, turn, i)?;
            j[3 * i..3 * i + 3].copy_from_slice(&leg.rates()?);
            c[i] = leg.convection(v)?;
        }
        Ok(())
    }
}
