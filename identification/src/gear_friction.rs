//! Friction of gears that is proportional to the transmitted torque.
//!
//! A gear loses a part of the torque x that it transmits. With σ = sign(x q̇), which is 1 if the
//! drive moves the load and -1 if the load moves the drive, the drive delivers
//!
//! ```text
//! y = x (1 + μ σ),   μ = μ_d for σ = 1, μ_b for σ = -1.
//! ```
//!
//! μ_d is the coefficient of driving, with the efficiency 1/(1 + μ_d), and μ_b that of
//! back-driving, with the efficiency 1 - μ_b. x contains everything else that the model describes:
//! inertia, gravity, springs, and Coulomb and viscous friction. (P. Hamon, M. Gautier, P. Garrec,
//! *Dynamic identification of robots with a dry friction model depending on load and velocity*,
//! IROS 2010, have this friction with a single coefficient.)
//!
//! Measured torques y are converted to x before anything else, so that all later stages have a
//! model without gear friction.

use serde::{Deserialize, Serialize};

/// Coefficients of one gear.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearFriction {
    /// μ_d, if the drive moves the load.
    pub driving: f64,
    /// μ_b, if the load moves the drive; below 1.
    pub back_driving: f64,
}

impl GearFriction {
    /// Whether the gear is free of losses.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.driving == 0.0 && self.back_driving == 0.0
    }

    /// 1 + μ σ for a torque and the sign of its joint's velocity, which is -1 to 1.
    ///
    /// x and y have the same sign, since μ_b is below 1.
    fn factor(&self, torque: f64, sign: f64) -> f64 {
        let sigma = torque.signum() * sign;
        let coefficient = if sigma > 0.0 {
            self.driving
        } else {
            self.back_driving
        };
        1.0 + coefficient * sigma
    }

    /// Transmitted torque x of the torque y of the drive (N m, N).
    ///
    /// `sign` is that of the joint's velocity, or its mean over a sampling interval.
    ///
    /// ```
    /// use overact_identification::GearFriction;
    ///
    /// let gear = GearFriction { driving: 0.25, back_driving: 0.2 };
    /// assert_eq!(gear.transmitted(10.0, 1.0), 8.0); // lifts a load
    /// assert_eq!(gear.transmitted(8.0, -1.0), 10.0); // lowers it
    /// ```
    #[must_use]
    pub fn transmitted(&self, torque: f64, sign: f64) -> f64 {
        torque / self.factor(torque, sign)
    }

    /// Torque y of the drive for the transmitted torque x: the inverse of
    /// [`transmitted`](Self::transmitted).
    #[must_use]
    pub fn delivered(&self, torque: f64, sign: f64) -> f64 {
        torque * self.factor(torque, sign)
    }

    /// Derivatives of x with respect to μ_d and μ_b, at a transmitted torque x.
    pub(crate) fn derivatives(&self, torque: f64, sign: f64) -> [f64; 2] {
        let sigma = torque.signum() * sign;
        let own = -torque * sigma / self.factor(torque, sign);
        if sigma > 0.0 { [own, 0.0] } else { [0.0, own] }
    }
}

#[cfg(test)]
mod tests {
    use super::GearFriction;

    #[test]
    fn conversions_are_inverse_and_have_the_stated_derivatives() {
        let gear = GearFriction {
            driving: 0.04,
            back_driving: 0.1,
        };
        for (torque, sign) in [
            (3.0, 1.0),
            (3.0, -1.0),
            (-2.0, 1.0),
            (-2.0, -1.0),
            (4.0, 0.3),
        ] {
            let delivered = gear.delivered(torque, sign);
            assert!((gear.transmitted(delivered, sign) - torque).abs() < 1e-15);
            for (place, more) in [(1e-6, 0.0), (0.0, 1e-6)].into_iter().enumerate() {
                let moved = GearFriction {
                    driving: gear.driving + more.0,
                    back_driving: gear.back_driving + more.1,
                };
                let change = (moved.transmitted(delivered, sign) - torque) / 1e-6;
                assert!((change - gear.derivatives(torque, sign)[place]).abs() < 1e-5);
            }
        }
    }
}
