//! Distance from a bound, with its multiplier.

/// Distance of an unknown from a bound.
pub(super) struct BoundDistance {
    /// Number of the unknown within its group.
    pub(super) place: usize,
    /// 1 for a lower bound, -1 for an upper one.
    sign: f64,
    pub(super) distance: f64,
    multiplier: f64,
    /// Changes of the distance and of the multiplier.
    proposed: [f64; 2],
}

impl BoundDistance {
    /// Distance sign (value - limit) on the path of a weight; `None` if it is not positive.
    pub(super) fn new(place: usize, sign: f64, distance: f64, weight: f64) -> Option<Self> {
        (distance > 0.0).then(|| Self {
            place,
            sign,
            distance,
            multiplier: weight / distance,
            proposed: [0.0; 2],
        })
    }

    /// Curvature in a step.
    pub(super) fn stiffness(&self) -> f64 {
        self.multiplier / self.distance
    }

    /// Slope of the barrier.
    pub(super) fn slope(&self, weight: f64) -> f64 {
        -self.sign * weight / self.distance
    }

    pub(super) fn product(&self) -> f64 {
        self.distance * self.multiplier
    }

    /// Computes a change of the unknown; returns the largest feasible multiple.
    pub(super) fn propose(&mut self, step: f64, weight: f64) -> f64 {
        let farther = self.sign * step;
        let change = weight / self.distance - self.multiplier - self.stiffness() * farther;
        self.proposed = [farther, change];
        until(self.distance, farther).min(until(self.multiplier, change))
    }

    pub(super) fn advance(&mut self, part: f64) {
        self.distance += self.proposed[0] * part;
        self.multiplier += self.proposed[1] * part;
    }
}

/// Multiple of a change at which a positive value becomes zero.
pub(super) fn until(value: f64, change: f64) -> f64 {
    if change < 0.0 {
        -value / change
    } else {
        f64::INFINITY
    }
}
