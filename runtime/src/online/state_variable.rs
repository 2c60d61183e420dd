//! State-variable filters: position, velocity and acceleration with one delay.

use super::Error;
use crate::float::Float;

/// A filtered signal with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signal<T = f64> {
    /// The filtered signal.
    pub value: T,
    /// Its first derivative, per second.
    pub velocity: T,
    /// Its second derivative, per second squared.
    pub acceleration: T,
}

/// Butterworth low-pass filter of order N ≥ 3 whose states are the signal and its derivatives.
///
/// The transfer function is H(s) = ωᴺ / (sᴺ + a_{N-1} ω sᴺ⁻¹ + … + ωᴺ), with -3 dB at the cutoff.
/// Its states are x, ẋ, …: the filtered signal and exact derivatives of it. The discrete filter
/// is exact for a signal that is linear between samples, by the matrix exponential of A T.
///
/// Filter all signals of a regression by equal filters: positions give q, q̇ and q̈, torques their
/// [`value`](Signal::value). All then have the same transfer function, so delay and attenuation
/// cancel. What remains is the error of W at filtered positions, of second order in the delay.
/// Choose a cutoff at least five times the highest frequency of the motion.
///
/// ```
/// use overact::online::StateVariableFilter;
///
/// // 40 Hz at 1 kHz, of order 3.
/// let mut position = StateVariableFilter::<3>::new(40.0, 1000.0)?;
/// let mut torque = position;
/// let mut error: f64 = 0.0;
/// for step in 0..2000 {
///     let t = f64::from(step) * 1e-3;
///     // The torque of an inertia of 2 kg m².
///     let q = (10.0 * t).sin();
///     let tau = -2.0 * 100.0 * (10.0 * t).sin();
///     let (q, tau) = (position.update(q)?, torque.update(tau)?);
///     if step > 500 {
///         error = error.max((tau.value - 2.0 * q.acceleration).abs());
///     }
/// }
/// assert!(error < 1e-2);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateVariableFilter<const N: usize, T = f64> {
    /// exp(A T), of states scaled by powers of ω.
    transition: [[T; N]; N],
    /// Effect of the sample before.
    from_last: [T; N],
    /// Effect of the new sample.
    from_new: [T; N],
    /// 2π times the cutoff, rad/s.
    rate: T,
    /// Delay of slow signals, s.
    delay: T,
    state: [T; N],
    last: Option<T>,
}

impl<const N: usize, T: Float> StateVariableFilter<N, T> {
    /// A filter with a cutoff (Hz) for samples at a frequency (Hz).
    ///
    /// # Errors
    /// A cutoff below 10⁻⁵ or above 0.45 of the sampling frequency, or numbers that are not finite
    /// and positive.
    ///
    /// ```
    /// use overact::online::StateVariableFilter;
    ///
    /// assert!(StateVariableFilter::<3>::new(40.0, 1000.0).is_ok());
    /// assert!(StateVariableFilter::<3>::new(600.0, 1000.0).is_err());
    /// ```
    pub fn new(cutoff: T, sampling: T) -> Result<Self, Error> {
        const { assert!(N >= 3 && N <= 8, "the order must be from 3 to 8") };
        let (cutoff, sampling): (f64, f64) = (cutoff.into(), sampling.into());
        let ratio = cutoff / sampling;
        if !(sampling > 0.0 && sampling.is_finite() && (1e-5..=0.45).contains(&ratio)) {
            return Err(Error::Setting {
                setting: "cutoff",
                condition: "from 1e-5 to 0.45 of the sampling frequency",
            });
        }
        let rate = core::f64::consts::TAU * cutoff;
        let coefficients = butterworth::<N>();
        let step = core::f64::consts::TAU * ratio;
        let mut system = [[0.0; N]; N];
        for (row, entries) in system.iter_mut().enumerate() {
            for (column, entry) in entries.iter_mut().enumerate() {
                if row + 1 == N {
                    *entry = -step * coefficients[column];
                } else if column == row + 1 {
                    *entry = step;
                }
            }
        }
        let [exponential, first, second] = exponentials(&system);
        let single = |matrix: [[f64; N]; N]| matrix.map(|row| row.map(T::of));
        // The input enters the last state: B T is `step` times the last unit vector.
        let last = |matrix: &[[f64; N]; N]| matrix.map(|row| row.last().map_or(0.0, |x| x * step));
        let (steady, ramp) = (last(&first), last(&second));
        let mut from_last = [T::ZERO; N];
        for (own, (steady, ramp)) in from_last.iter_mut().zip(steady.iter().zip(ramp)) {
            *own = T::of(steady - ramp);
        }
        Ok(Self {
            transition: single(exponential),
            from_last,
            from_new: ramp.map(T::of),
            rate: T::of(rate),
            delay: T::of(coefficients.get(1).map_or(0.0, |a| a / rate)),
            state: [T::ZERO; N],
            last: None,
        })
    }

    /// Filters a sample. The filter starts at rest at the first sample.
    ///
    /// # Errors
    /// [`Error::NotFinite`] of a sample and [`Error::Overflow`] of a result. The state is then
    /// unchanged.
    ///
    /// ```
    /// use overact::online::StateVariableFilter;
    ///
    /// let mut filter = StateVariableFilter::<3>::new(40.0, 1000.0)?;
    /// let first = filter.update(2.0)?;
    /// assert_eq!([first.value, first.velocity, first.acceleration], [2.0, 0.0, 0.0]);
    /// assert!(filter.update(f64::NAN).is_err());
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update(&mut self, sample: T) -> Result<Signal<T>, Error> {
        if !sample.is_finite() {
            return Err(Error::NotFinite { input: "sample" });
        }
        let Some(last) = self.last else {
            self.restart(sample);
            return Ok(self.signal());
        };
        let mut state = [T::ZERO; N];
        let effects = self.from_last.iter().zip(&self.from_new);
        for ((next, row), (old, new)) in state.iter_mut().zip(&self.transition).zip(effects) {
            let own: T = row.iter().zip(&self.state).map(|(a, x)| *a * *x).sum();
            *next = own + *old * last + *new * sample;
        }
        let before = core::mem::replace(&mut self.state, state);
        let signal = self.signal();
        let numbers = [signal.value, signal.velocity, signal.acceleration];
        if numbers.iter().chain(&state).all(|x| x.is_finite()) {
            self.last = Some(sample);
            Ok(signal)
        } else {
            self.state = before;
            Err(Error::Overflow)
        }
    }

    /// Sets the filter to rest at a value.
    ///
    /// ```
    /// use overact::online::StateVariableFilter;
    ///
    /// let mut filter = StateVariableFilter::<4>::new(40.0, 1000.0)?;
    /// filter.restart(2.0);
    /// let signal = filter.update(2.0)?;
    /// assert!((signal.value - 2.0_f64).abs() < 1e-12 && signal.velocity.abs() < 1e-9);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn restart(&mut self, value: T) {
        self.state = [T::ZERO; N];
        self.state.iter_mut().take(1).for_each(|x| *x = value);
        self.last = Some(value);
    }

    /// Delay of signals far below the cutoff, in seconds.
    ///
    /// ```
    /// use overact::online::StateVariableFilter;
    ///
    /// let filter = StateVariableFilter::<3>::new(40.0, 1000.0)?;
    /// assert!((filter.delay() - 0.007957747_f64).abs() < 1e-9);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[must_use]
    pub const fn delay(&self) -> T {
        self.delay
    }

    /// The states in SI units.
    fn signal(&self) -> Signal<T> {
        let mut states = self.state.iter().copied();
        let mut next = || states.next().unwrap_or(T::ZERO);
        Signal {
            value: next(),
            velocity: next() * self.rate,
            acceleration: next() * self.rate * self.rate,
        }
    }
}

/// Coefficients a₀ … a_{N-1} of the Butterworth polynomial for ω = 1.
///
/// a_k / a_{k-1} = cos((k - 1) γ) / sin(k γ) with γ = π / 2N.
fn butterworth<const N: usize>() -> [f64; N] {
    let mut coefficients = [1.0; N];
    let mut last = 1.0;
    for (k, own) in coefficients.iter_mut().enumerate().skip(1) {
        let angle = core::f64::consts::FRAC_PI_2 / N as f64;
        let (_, cosine) = crate::math::sin_cos((k - 1) as f64 * angle);
        let (sine, _) = crate::math::sin_cos(k as f64 * angle);
        last *= cosine / sine;
        *own = last;
    }
    coefficients
}

/// exp(Z), φ₁(Z) = Σ Zᵏ/(k+1)! and φ₂(Z) = Σ Zᵏ/(k+2)!, by scaling and doubling.
///
/// φ₁(2Z) = (exp(Z) + 1) φ₁(Z) / 2 and φ₂(2Z) = (φ₁(Z)² + 2 φ₂(Z)) / 4.
fn exponentials<const N: usize>(system: &[[f64; N]; N]) -> [[[f64; N]; N]; 3] {
    const DOUBLINGS: i32 = 8;
    const TERMS: u32 = 12;
    let scaled = system.map(|row| row.map(|entry| entry / f64::from(1 << DOUBLINGS)));
    let mut second = scalar::<N>(0.0);
    // Horner's rule from the last term: each φ is its constant plus Z times what follows.
    let mut factorial = 1.0;
    (1..=TERMS + 2).for_each(|k| factorial *= f64::from(k));
    for term in (0..=TERMS).rev() {
        second = product(&scaled, &second);
        add(&mut second, &scalar(1.0 / factorial));
        factorial /= f64::from(term + 2);
    }
    let mut first = product(&scaled, &second);
    add(&mut first, &scalar(1.0));
    let mut exponential = product(&scaled, &first);
    add(&mut exponential, &scalar(1.0));
    for _ in 0..DOUBLINGS {
        let mut next = product(&first, &first);
        add(&mut next, &second);
        add(&mut next, &second);
        second = next.map(|row| row.map(|x| 0.25 * x));
        let mut sum = exponential;
        add(&mut sum, &scalar(1.0));
        first = product(&sum, &first).map(|row| row.map(|x| 0.5 * x));
        exponential = product(&exponential, &exponential);
    }
    [exponential, first, second]
}

/// A multiple of the unit matrix.
fn scalar<const N: usize>(value: f64) -> [[f64; N]; N] {
    let mut matrix = [[0.0; N]; N];
    for (place, row) in matrix.iter_mut().enumerate() {
        row.iter_mut().skip(place).take(1).for_each(|x| *x = value);
    }
    matrix
}

fn add<const N: usize>(sum: &mut [[f64; N]; N], other: &[[f64; N]; N]) {
    for (own, other) in sum.as_flattened_mut().iter_mut().zip(other.as_flattened()) {
        *own += other;
    }
}

fn product<const N: usize>(left: &[[f64; N]; N], right: &[[f64; N]; N]) -> [[f64; N]; N] {
    left.map(|row| {
        let mut sums = [0.0; N];
        for (factor, others) in row.iter().zip(right) {
            for (sum, other) in sums.iter_mut().zip(others) {
                *sum += factor * other;
            }
        }
        sums
    })
}
