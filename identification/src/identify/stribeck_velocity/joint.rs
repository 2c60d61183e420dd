//! The search for the velocity of one joint: minimum and interval of its profile.

use overact::Model;
use overact_logs::significant;

/// Velocities of each joint in a pass, an odd number.
pub(super) const POINTS: usize = 13;

/// First range of velocities, on both sides of the described one: a factor of 8.
const FIRST_RANGE: f64 = 3.0 * std::f64::consts::LN_2;

/// Range of a later pass by the interval.
const MARGIN: f64 = 1.7;

/// Smallest ratio of interval and range at which the points resolve the interval.
const RESOLVED: f64 = 0.4;

/// State of the search for one velocity.
pub(super) struct Joint {
    pub(super) parameter: String,
    pub(super) unit: &'static str,
    pub(super) described: f64,
    /// Middle of the next range, ln v.
    pub(super) centre: f64,
    /// Half of the range.
    pub(super) range: f64,
    pub(super) found: Option<Minimum>,
    pub(super) is_finished: bool,
}

/// Minimum of a profile over ln v, and the coefficient f there.
#[derive(Clone, Copy)]
pub(super) struct Minimum {
    pub(super) at: f64,
    pub(super) interval: [f64; 2],
    pub(super) coefficient: f64,
}

impl Joint {
    pub(super) fn all(model: &dyn Model, velocities: &[(&'static str, f64)]) -> Vec<Self> {
        let parameters = model.info().parameters;
        let joint = |&(name, described): &(&'static str, f64)| {
            let mut parameters = parameters.iter();
            let is_force = parameters.any(|one| one.name == name && one.unit == "N");
            Self {
                parameter: name.to_owned(),
                unit: if is_force { "m/s" } else { "rad/s" },
                // It is recognised from numbers of the model, with rounding errors.
                described: significant(described, 12).parse().unwrap_or(described),
                centre: described.ln(),
                range: FIRST_RANGE,
                found: None,
                is_finished: false,
            }
        };
        velocities.iter().map(joint).collect()
    }

    /// ln v of a point of the next pass.
    pub(super) fn point(&self, point: usize) -> f64 {
        self.centre + self.range * (2.0 * point as f64 / (POINTS - 1) as f64 - 1.0)
    }

    /// Ends the search without an estimate.
    pub(super) fn give_up(&mut self) {
        self.found = None;
        self.is_finished = true;
    }

    /// Evaluates the profile at the points of a pass, and chooses the next range.
    ///
    /// `rise` is q² s², and `coefficient` the value of f at the lowest point.
    pub(super) fn examine(&mut self, profile: &[f64], rise: f64, coefficient: f64) {
        let lowest = (0..POINTS).min_by(|a, b| profile[*a].total_cmp(&profile[*b]));
        let lowest = lowest.unwrap_or(POINTS / 2);
        let spacing = 2.0 * self.range / (POINTS - 1) as f64;
        let is_inside = lowest > 0 && lowest + 1 < POINTS;
        let (shift, least) = if is_inside {
            vertex(profile[lowest - 1], profile[lowest], profile[lowest + 1])
        } else {
            (0.0, profile[lowest])
        };
        let at = self.point(lowest) + shift * spacing;
        // The square root of a parabola is linear.
        let rooted = |point: usize| (profile[point] - least).max(0.0).sqrt();
        let level = rise.sqrt();
        let crossing = |mut points: Box<dyn Iterator<Item = usize>>| {
            let mut last = (at, 0.0);
            points.find_map(|point| {
                let own = (self.point(point), rooted(point));
                let before = std::mem::replace(&mut last, own);
                let part = (level - before.1) / (own.1 - before.1);
                (own.1 > level).then_some(before.0 + part * (own.0 - before.0))
            })
        };
        let below = (0..=lowest).rev().filter(|&point| self.point(point) < at);
        let above = (lowest..POINTS).filter(|&point| self.point(point) > at);
        let ends = (crossing(Box::new(below)), crossing(Box::new(above)));
        let (Some(low), Some(high)) = ends else {
            self.centre = at;
            self.range *= 2.0;
            if self.range > FIRST_RANGE {
                self.give_up();
            }
            return;
        };
        let half = (high - at).max(at - low);
        self.is_finished = half >= RESOLVED * self.range;
        self.found = Some(Minimum {
            at,
            interval: [low, high],
            coefficient,
        });
        (self.centre, self.range) = (at, MARGIN * half);
    }
}

/// Position and value of the lowest point of the parabola through three points at -1, 0 and 1.
fn vertex(before: f64, middle: f64, after: f64) -> (f64, f64) {
    let curvature = before - 2.0 * middle + after;
    if curvature <= 0.0 {
        return (0.0, middle);
    }
    let slope = 0.5 * (after - before);
    let shift = (-slope / curvature).clamp(-0.5, 0.5);
    (shift, middle + shift * (slope + 0.5 * curvature * shift))
}

#[cfg(test)]
mod tests {
    use super::{Joint, POINTS, vertex};

    #[test]
    fn the_vertex_of_a_parabola_is_exact() {
        let value = |x: f64| 3.0 + 2.0 * (x - 0.25).powi(2);
        let (at, least) = vertex(value(-1.0), value(0.0), value(1.0));
        assert!((at - 0.25).abs() < 1e-15 && (least - 3.0).abs() < 1e-15);
        assert_eq!(vertex(1.0, 1.0, 1.0), (0.0, 1.0));
    }

    #[test]
    fn a_parabolic_profile_gives_its_minimum_and_interval() {
        let mut joint = Joint {
            parameter: String::from("fst_1"),
            unit: "rad/s",
            described: 1.0,
            centre: 0.0,
            range: 2.0,
            found: None,
            is_finished: false,
        };
        let of = |joint: &Joint| -> Vec<f64> {
            let value = |point| 5.0 + 8.0 * (joint.point(point) - 0.1_f64).powi(2);
            (0..POINTS).map(value).collect()
        };
        for _ in 0..3 {
            let profile = of(&joint);
            joint.examine(&profile, 2.0, 1.0);
        }
        let found = joint.found.expect("a minimum");
        assert!(joint.is_finished && (found.at - 0.1).abs() < 1e-12);
        for (end, expected) in found.interval.iter().zip([-0.4, 0.6]) {
            assert!((end - expected).abs() < 1e-12, "{:?}", found.interval);
        }
    }

    #[test]
    fn a_flat_profile_gives_no_estimate() {
        let mut joint = Joint {
            parameter: String::from("fst_1"),
            unit: "rad/s",
            described: 1.0,
            centre: 0.0,
            range: super::FIRST_RANGE,
            found: None,
            is_finished: false,
        };
        joint.examine(&[5.0; POINTS], 2.0, 1.0);
        assert!(joint.is_finished && joint.found.is_none());
    }
}
