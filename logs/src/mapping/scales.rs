//! Sizes and limits of a description.

/// Sizes and limits of a description, by which the units of a log are judged.
///
/// ```text
/// use overact_identification::Scales;
/// let scales = Scales { length: 0.45, torque: vec![20.0, 8.0], ..Scales::default() };
/// assert_eq!(scales.sampling, None);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scales {
    /// Reach, m; 0 for a description without lengths.
    ///
    /// The largest sum of lengths along a leg, or distance between the legs' bases or ends.
    pub length: f64,
    /// Sampling frequency of the virtual experiment, Hz.
    pub sampling: Option<f64>,
    /// Largest torque of each actuator, N m or N; empty if not described.
    pub torque: Vec<f64>,
    /// Largest displacement of each actuator from home, rad or m; empty if not described.
    pub travel: Vec<f64>,
    /// Largest speed of each actuator, rad/s or m/s; empty if not described.
    pub velocity: Vec<f64>,
}

/// Smallest reach (m).
const SHORTEST: f64 = 0.1;

impl Scales {
    /// Reach, m; `None` for a description without lengths.
    #[must_use]
    pub fn reach(&self) -> Option<f64> {
        (self.length > 0.0).then(|| self.length.max(SHORTEST))
    }
}
