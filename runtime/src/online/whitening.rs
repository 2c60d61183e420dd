//! Removal of the correlation between successive innovations.

use crate::float::Float;

/// First-order whitening of a sequence, whose correlation is estimated on the way.
///
/// Errors of a model and filtered noise are correlated in time. A [`ChangeTest`](super::ChangeTest)
/// of them would raise more false alarms than stated. With the correlation a of successive numbers
/// the output is
///
/// (eₖ - a eₖ₋₁) / √(v (1 - a²)),
///
/// independent numbers of variance 1 if e is a first-order autoregressive sequence of variance v.
/// a and v are averages over a memory of 1000 numbers, beginning with a = 0 and v = 1, which count as
/// 20 numbers. A shift of the mean by δ becomes one by δ √((1 - a)/(1 + a)). Residual control charts do the same
/// (Montgomery and Mastrangelo, *Journal of Quality Technology* 23, 1991).
///
/// ```
/// use overact::online::Whitening;
///
/// let mut whitening = Whitening::new();
/// // A sequence that changes slowly.
/// let outputs = (0..5000).map(|k| whitening.update((0.01 * f64::from(k)).sin()));
/// let last = outputs.last().unwrap();
/// assert!(last.abs() < 1.0);
/// assert!(whitening.correlation() > 0.98);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whitening<T = f64> {
    /// Mean of e².
    variance: T,
    /// Mean of eₖ eₖ₋₁.
    covariance: T,
    last: T,
    /// Number of numbers in the means, up to the memory.
    count: T,
}

/// Numbers that the means remember.
const MEMORY: f64 = 1000.0;

/// Numbers that the initial means count as.
const START: f64 = 20.0;

/// Largest correlation that is removed.
const LARGEST: f64 = 0.999;

impl<T: Float> Default for Whitening<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Float> Whitening<T> {
    /// Whitening with a memory of 1000 numbers.
    ///
    /// ```
    /// use overact::online::Whitening;
    ///
    /// assert_eq!(Whitening::<f64>::new(), Whitening::default());
    /// ```
    #[must_use]
    pub fn new() -> Self {
        Self {
            variance: T::of(1.0),
            covariance: T::ZERO,
            last: T::ZERO,
            count: T::of(START),
        }
    }

    /// The correlation of successive numbers, between -0.999 and 0.999.
    ///
    /// ```
    /// use overact::online::Whitening;
    ///
    /// assert_eq!(Whitening::<f64>::new().correlation(), 0.0);
    /// ```
    #[must_use]
    pub fn correlation(&self) -> T {
        let ratio = self.covariance / self.variance;
        ratio.max(T::of(-LARGEST)).min(T::of(LARGEST))
    }

    /// Whitens a number; zero for one that is not finite, which is left out.
    ///
    /// ```
    /// use overact::online::Whitening;
    ///
    /// let mut whitening = Whitening::new();
    /// assert_eq!(whitening.update(0.5), 0.5);
    /// assert_eq!(whitening.update(f64::NAN), 0.0);
    /// ```
    pub fn update(&mut self, number: T) -> T {
        if !number.is_finite() {
            return T::ZERO;
        }
        // The averages are those before this number, so that an outlier cannot hide itself.
        let correlation = self.correlation();
        let one = T::of(1.0);
        let variance = self.variance * (one - correlation * correlation);
        let white = (number - correlation * self.last) / variance.sqrt();
        // An outlier counts at most as six standard deviations in the averages.
        let most = T::of(6.0) * self.variance.sqrt();
        let bounded = number.max(-most).min(most);
        let smallest = T::of(1e-6);
        let gain = T::of(1.0) / self.count;
        self.variance += gain * (bounded * bounded - self.variance);
        self.variance = self.variance.max(smallest);
        self.covariance += gain * (bounded * self.last - self.covariance);
        self.last = bounded;
        self.count = (self.count + one).min(T::of(MEMORY));
        white
    }
}
