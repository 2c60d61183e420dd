//! Friction of gears that is proportional to the transmitted torque.
//!
//! A gear loses a part of the torque x that it transmits. With σ = sign(x q̇), which is 1 if the
//! drive moves the load and -1 if the load moves the drive, the drive delivers
//!
//! ```text
//! y = x (1 + μ σ).
//! ```
//!
//! The efficiency is 1/(1 + μ) in one direction and 1 - μ in the other. x contains everything else
//! that the model describes: inertia, gravity, springs, and Coulomb and viscous friction.
//! (P. Hamon, M. Gautier, P. Garrec, *Dynamic identification of robots with a dry friction model
//! depending on load and velocity*, IROS 2010.)
//!
//! Separate coefficients μ_d and μ_b of both directions differ from their mean like a wrong gain of
//! the drive: y = x (1 + κ + μ σ) with κ = (μ_d - μ_b)/2. A common factor of all torques and all
//! parameters changes no equation, so κ needs known masses; it is zero here.
//!
//! Measured torques y are converted to x before anything else, so that all later stages have a
//! model without gear friction.

use serde::{Deserialize, Serialize};

/// Friction of one gear.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearFriction {
    /// Coefficient μ, below 1.
    pub coefficient: f64,
}

impl GearFriction {
    /// Whether the gear is free of losses.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.coefficient == 0.0
    }

    /// 1 + μ σ for a torque and the sign of its joint's velocity, which is -1 to 1.
    ///
    /// x and y have the same sign, since μ is below 1.
    fn factor(&self, torque: f64, sign: f64) -> f64 {
        1.0 + self.coefficient * torque.signum() * sign
    }

    /// Transmitted torque x of the torque y of the drive (N m, N).
    ///
    /// `sign` is that of the joint's velocity, or its mean over a sampling interval.
    ///
    /// ```
    /// use overact_identification::GearFriction;
    ///
    /// let gear = GearFriction { coefficient: 0.25 };
    /// assert_eq!(gear.transmitted(10.0, 1.0), 8.0); // lifts a load
    /// assert_eq!(gear.transmitted(6.0, -1.0), 8.0); // lowers it
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

    /// Derivative of x with respect to μ, at a transmitted torque x.
    pub(crate) fn derivative(&self, torque: f64, sign: f64) -> f64 {
        -torque * torque.signum() * sign / self.factor(torque, sign)
    }
}

#[cfg(test)]
mod tests {
    use super::GearFriction;

    #[test]
    fn torque_conversions_are_inverse_with_the_stated_derivative() {
        let gear = GearFriction { coefficient: 0.1 };
        let moved = GearFriction {
            coefficient: 0.1 + 1e-6,
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
            let change = (moved.transmitted(delivered, sign) - torque) / 1e-6;
            assert!((change - gear.derivative(torque, sign)).abs() < 1e-5);
        }
    }
}
