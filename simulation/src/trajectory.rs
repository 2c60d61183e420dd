//! Desired motions of the platform: displacement s(t) from home with analytic derivatives.
//!
//! The pose is x(t) = displace(x_home, s(t)). If all platform coordinates are additive (every
//! motion without quaternion), the twist is v = ds/dt and its derivative d²s/dt². With a
//! quaternion, s is in the chart that the model's `displace` defines about home. The twist is then
//! computed numerically from the actuators' motion (module `reference`).
//!
//! Periodic trajectories are finite Fourier series: s_c(t) = Σ a sin(2π h f t + φ). They are
//! smooth, band-limited and can be averaged over periods, which suits identification. A run starts
//! in the state of the series at t = 0, so there is no transient.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A desired motion about the home pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Trajectory {
    /// A finite Fourier series on the platform coordinates.
    Periodic {
        /// Frequency of the first harmonic, Hz.
        fundamental_hz: f64,
        /// The terms of the series, any number per coordinate.
        terms: Vec<Term>,
    },
    /// Rest-to-rest motions between points, each a quintic polynomial of time.
    PointToPoint {
        /// Displacements from the home pose, r numbers each (m, rad).
        points: Vec<Vec<f64>>,
        /// Times at which the points are reached, increasing, s. The platform rests at the first
        /// point before the first time and at the last point after the last.
        times: Vec<f64>,
    },
}

/// One term of a Fourier series: amplitude sin(2π harmonic fundamental t + phase).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Name of the platform coordinate.
    pub coordinate: String,
    /// Multiple of the fundamental frequency, at least 1.
    pub harmonic: u32,
    /// Amplitude, m or rad.
    pub amplitude: f64,
    /// Phase, rad.
    #[serde(default)]
    pub phase_rad: f64,
}

/// A displacement and its derivatives, r numbers each.
#[derive(Debug)]
pub struct Displacement<'a> {
    /// s, m or rad.
    pub position: &'a mut [f64],
    /// ds/dt, m/s or rad/s.
    pub velocity: &'a mut [f64],
    /// d²s/dt², m/s² or rad/s².
    pub acceleration: &'a mut [f64],
}

impl Trajectory {
    /// Writes the displacement at time `t` (s).
    ///
    /// Terms of unknown coordinates and surplus points are ignored; a validated experiment has
    /// none.
    pub fn evaluate(&self, coordinates: &[&str], t: f64, out: &mut Displacement<'_>) {
        out.position.fill(0.0);
        out.velocity.fill(0.0);
        out.acceleration.fill(0.0);
        match self {
            Self::Periodic {
                fundamental_hz,
                terms,
            } => {
                for term in terms {
                    if let Some(c) = coordinates.iter().position(|name| *name == term.coordinate) {
                        let rate = TAU * fundamental_hz * f64::from(term.harmonic);
                        let (sin, cos) = (rate * t + term.phase_rad).sin_cos();
                        out.position[c] += term.amplitude * sin;
                        out.velocity[c] += term.amplitude * rate * cos;
                        out.acceleration[c] -= term.amplitude * rate * rate * sin;
                    }
                }
            }
            Self::PointToPoint { points, times } => point_to_point(points, times, t, out),
        }
    }

    /// Time scale of the motion, s: one radian of the fastest harmonic, or half of the shortest
    /// segment.
    #[must_use]
    pub fn time_scale(&self) -> f64 {
        match self {
            Self::Periodic {
                fundamental_hz,
                terms,
            } => {
                let highest = terms.iter().map(|term| term.harmonic).max().unwrap_or(1);
                1.0 / (TAU * fundamental_hz * f64::from(highest.max(1)))
            }
            Self::PointToPoint { times, .. } => {
                let shortest = times
                    .windows(2)
                    .map(|w| w[1] - w[0])
                    .fold(f64::INFINITY, f64::min);
                if shortest.is_finite() {
                    0.5 * shortest
                } else {
                    1.0
                }
            }
        }
    }

    /// Trajectory as lines of a TOML table.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        match self {
            Self::Periodic {
                fundamental_hz,
                terms,
            } => {
                text += &format!(
                    "kind = \"periodic\"\nfundamental_hz = {fundamental_hz:?}\nterms = [\n"
                );
                for Term {
                    coordinate,
                    harmonic,
                    amplitude,
                    phase_rad,
                } in terms
                {
                    // The name is quoted with escapes common to Rust and TOML.
                    text += &format!(
                        "  {{ coordinate = {coordinate:?}, harmonic = {harmonic}, amplitude = {amplitude:?}, phase_rad = {phase_rad:?} }},\n"
                    );
                }
            }
            Self::PointToPoint { points, times } => {
                text += &format!("kind = \"point_to_point\"\ntimes = {times:?}\npoints = [\n");
                for point in points {
                    text += &format!("  {point:?},\n");
                }
            }
        }
        text + "]\n"
    }
}

/// The quintic with zero velocity and acceleration at both ends: with u from 0 to 1,
/// s = a + (b - a)(10 u³ - 15 u⁴ + 6 u⁵).
fn point_to_point(points: &[Vec<f64>], times: &[f64], t: f64, out: &mut Displacement<'_>) {
    // The number of points already reached selects the segment.
    let reached = times
        .iter()
        .take_while(|time| **time <= t)
        .count()
        .min(points.len());
    let (Some(start), Some(end)) = (
        points.get(reached.saturating_sub(1)),
        points.get(reached).or(points.last()),
    ) else {
        return;
    };
    for (position, start) in out.position.iter_mut().zip(start) {
        *position = *start;
    }
    if reached == 0 || reached >= points.len() || reached >= times.len() {
        return;
    }
    let span = times[reached] - times[reached - 1];
    let u = (t - times[reached - 1]) / span;
    let blend = u * u * u * (10.0 + u * (6.0 * u - 15.0));
    let slope = 30.0 * u * u * (1.0 - u) * (1.0 - u) / span;
    let curvature = 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (span * span);
    for (c, (start, end)) in start.iter().zip(end).enumerate().take(out.position.len()) {
        let way = end - start;
        out.position[c] = start + way * blend;
        out.velocity[c] = way * slope;
        out.acceleration[c] = way * curvature;
    }
}
