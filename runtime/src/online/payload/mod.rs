//! Mass, centre of mass and inertia of a payload while the robot moves.

mod projection;
mod pseudo_inertia;

use super::{Error, Filter, Forgetting, Innovation};
use crate::StandardParameter;
use crate::float::Float;
use projection::{Fit, GAP};
use pseudo_inertia::{Inertia, cholesky, inertia, pseudo_inertia};

/// Expected size of a payload: the scale of the prior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PayloadSize<T = f64> {
    /// Largest expected mass, kg.
    pub mass: T,
    /// Largest expected distance of its parts from the body frame's origin, m.
    pub length: T,
}

impl<T: Float> PayloadSize<T> {
    /// Standard deviation of the prior of a parameter, by its place among the ten.
    fn deviation(&self, place: usize) -> T {
        match place {
            0..6 => self.mass * self.length * self.length,
            6..9 => self.mass * self.length,
            _ => self.mass,
        }
    }
}

/// A physically consistent payload.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Payload<T = f64> {
    /// Mass, kg; positive.
    pub mass: T,
    /// Centre of mass in the body frame, m.
    pub centre: [T; 3],
    /// Inertia tensor about the centre of mass, axes of the body frame, kg m².
    pub inertia: [[T; 3]; 3],
    /// The ten inertial parameters about the body frame's origin, in the order of
    /// [`StandardParameter::INERTIA`].
    pub parameters: [T; 10],
    /// Whether the unconstrained estimate belongs to no body, so that the nearest one is given.
    pub is_projected: bool,
}

/// Estimator of a payload's inertial parameters with known parameters of the robot.
///
/// The torques of a robot with payload are y = W χ_robot + W_p χ_p + e. Rows of W_p and residuals
/// y - W χ_robot enter a [`Filter`] of P ≤ 10 parameters. If the robot moves in a plane, or only
/// some combinations are determined, fewer columns than ten save time.
///
/// The prior is no payload, with the standard deviations m, m ℓ and m ℓ² of a [`PayloadSize`]. So
/// there is an estimate at every time. [`payload`](Self::payload) returns the consistent payload
/// nearest to it, in the metric of the information: the pseudo-inertia is positive definite.
/// Parameters without column are chosen so that there is a body, with a wide prior at zero.
///
/// Choose σ as the standard deviation of what the known parameters leave unexplained, not of the
/// sensors alone.
///
/// ```
/// use overact::StandardParameter::{M, Mx};
/// use overact::online::{PayloadEstimator, PayloadSize};
///
/// // A lever with a payload: torque = (m g x cos q + …); the columns are those of m and mx.
/// let size = PayloadSize { mass: 10.0, length: 0.5 };
/// let mut estimator = PayloadEstimator::<2>::new([Mx, M], size)?;
/// for step in 0..500 {
///     let q = 0.01 * f64::from(step);
///     let row = [9.81 * q.cos(), 9.81 * 0.4 * (0.3 * q).sin()];
///     // 2 kg at 0.1 m, seen in what is left of the torque.
///     let residual = row[0] * 0.2 + row[1] * 2.0;
///     estimator.update(&[row], &[residual], &[0.1])?;
/// }
/// let payload = estimator.payload()?;
/// assert!((payload.mass - 2.0_f64).abs() < 0.01);
/// assert!((payload.centre[0] - 0.1).abs() < 0.002);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PayloadEstimator<const P: usize, T = f64> {
    filter: Filter<P, T>,
    places: [usize; P],
    size: PayloadSize<T>,
}

impl<const P: usize, T: Float> PayloadEstimator<P, T> {
    /// An estimator of the parameters of these columns.
    ///
    /// # Errors
    /// Columns that are not different inertial parameters, or sizes that are not positive.
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// assert!(PayloadEstimator::<10>::new(StandardParameter::INERTIA, size).is_ok());
    /// assert!(PayloadEstimator::<1>::new([StandardParameter::Fv], size).is_err());
    /// ```
    pub fn new(columns: [StandardParameter; P], size: PayloadSize<T>) -> Result<Self, Error> {
        let mut places = [0; P];
        for (index, (own, column)) in places.iter_mut().zip(columns).enumerate() {
            let mut all = StandardParameter::INERTIA.iter();
            let found = all.position(|one| *one == column);
            let is_new = !columns.iter().take(index).any(|other| *other == column);
            *own = found.filter(|_| is_new).ok_or(Error::Setting {
                setting: "columns",
                condition: "different inertial parameters",
            })?;
        }
        let is_positive = |x: T| x > T::ZERO && x.is_finite();
        if !is_positive(size.mass) || !is_positive(size.length) {
            return Err(Error::Setting {
                setting: "size",
                condition: "a positive mass and length",
            });
        }
        let deviations = places.map(|place| size.deviation(place));
        Ok(Self {
            filter: Filter::from_standard_deviations(&[T::ZERO; P], &deviations)?,
            places,
            size,
        })
    }

    /// The estimator with a rule of forgetting; see [`Forgetting`].
    ///
    /// Forgetting ends at the prior, so payloads may change at any time.
    ///
    /// # Errors
    /// [`Error::Setting`] for a factor outside (0, 1].
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{Forgetting, PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// let estimator = PayloadEstimator::new(StandardParameter::INERTIA, size)?;
    /// assert!(estimator.with_forgetting(Forgetting::Directional(0.999)).is_ok());
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn with_forgetting(self, forgetting: Forgetting<T>) -> Result<Self, Error> {
        Ok(Self {
            filter: self.filter.with_forgetting(forgetting)?,
            ..self
        })
    }

    /// Adds a sample: for each of M torques the payload's row, the residual y - W χ_robot, and its
    /// standard deviation.
    ///
    /// # Errors
    /// As [`Filter::update_block`]; the state is then unchanged.
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// let mut estimator = PayloadEstimator::new([StandardParameter::M], size)?;
    /// // Two joints: the payload's rows, and torques beyond those of the robot.
    /// let [first, _] = estimator.update(&[[4.0], [2.0]], &[8.0, 4.0], &[0.1, 0.1])?;
    /// assert!((first.residual - 8.0_f64).abs() < 1e-12);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update<const M: usize>(
        &mut self,
        rows: &[[T; P]; M],
        residuals: &[T; M],
        sigma: &[T; M],
    ) -> Result<[Innovation<T>; M], Error> {
        self.filter.update_block(rows, residuals, sigma)
    }

    /// Adds a sample whose number of torques is known at run time, and writes the innovations.
    ///
    /// # Errors
    /// As [`Filter::update_slices`]; the state is then unchanged.
    pub fn update_slices(
        &mut self,
        rows: &[[T; P]],
        residuals: &[T],
        sigma: &[T],
        innovations: &mut [Innovation<T>],
    ) -> Result<(), Error> {
        self.filter
            .update_slices(rows, residuals, sigma, innovations)
    }

    /// Multiplies the information by a factor, for example after a detected change.
    ///
    /// # Errors
    /// [`Error::Setting`] for a factor outside (0, 1].
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// let mut estimator = PayloadEstimator::new([StandardParameter::M], size)?;
    /// estimator.update(&[[9.81]], &[20.0], &[0.1])?;
    /// estimator.discount(1e-9)?;
    /// assert!(estimator.filter().standard_deviations()?[0] > 9.9);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn discount(&mut self, factor: T) -> Result<(), Error> {
        self.filter.discount(factor)
    }

    /// The filter of the P parameters, with the unconstrained estimate and its covariance.
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// let estimator = PayloadEstimator::new([StandardParameter::M], size)?;
    /// assert_eq!(estimator.filter().standard_deviations()?, [10.0]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[must_use]
    pub const fn filter(&self) -> &Filter<P, T> {
        &self.filter
    }

    /// The physically consistent payload nearest to the estimate.
    ///
    /// Half the sum of squares of R χ - z, in standard deviations, is at most 0.005 above that of
    /// the nearest one. An estimate that belongs to no body takes up to 100 steps of about 6000
    /// multiplications. So do not call this at every sample of a fast controller.
    ///
    /// # Errors
    /// [`Error::Overflow`] of an estimate that is not finite.
    ///
    /// ```
    /// use overact::StandardParameter;
    /// use overact::online::{PayloadEstimator, PayloadSize};
    ///
    /// let size = PayloadSize { mass: 10.0, length: 0.3 };
    /// let mut estimator = PayloadEstimator::new([StandardParameter::M], size)?;
    /// // No body has a negative mass.
    /// estimator.update(&[[1.0]], &[-2.0], &[0.1])?;
    /// let payload = estimator.payload()?;
    /// assert!(payload.is_projected && payload.mass > 0.0 && payload.mass < 0.01);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn payload(&self) -> Result<Payload<T>, Error> {
        let estimate = self.filter.estimate()?;
        let mut raw: Inertia<T> = [T::ZERO; 10];
        for (place, value) in self.places.iter().zip(estimate) {
            raw.iter_mut()
                .skip(*place)
                .take(1)
                .for_each(|own| *own = value);
        }
        let length = self.size.length;
        // With all ten columns, the estimate itself is the nearest if it is a body.
        if P == 10 && cholesky(&pseudo_inertia(&raw, length)).is_some() {
            return described(raw, false);
        }
        let (factor, side) = self.filter.factor();
        let fit = Fit {
            factor,
            side,
            places: &self.places,
            length,
            weights: self.weights(),
        };
        let fitted = fit.improve(self.start(&raw));
        // Fewer columns fit exactly if there is a body with these values.
        let is_projected = P == 10 || fitted.cost > T::of(10.0 * GAP);
        described(inertia(&fitted.pseudo, length), is_projected)
    }

    /// Weights of parameters without column: a wide prior, which keeps them finite.
    fn weights(&self) -> [T; 10] {
        let mut weights = [T::ZERO; 10];
        for (place, weight) in weights.iter_mut().enumerate() {
            if !self.places.contains(&place) {
                *weight = T::of(0.1) / self.size.deviation(place);
            }
        }
        weights
    }

    /// A body with the estimated mass and centre as far as they are possible, and a radius of ℓ/2.
    fn start(&self, raw: &Inertia<T>) -> [T; 10] {
        let mass = raw[9].max(T::of(0.01) * self.size.mass);
        let half = T::of(0.5);
        let bounded = |moment: T| (moment / (mass * self.size.length)).max(-half).min(half);
        let [x, y, z] = [raw[6], raw[7], raw[8]].map(bounded);
        let square = half * half;
        [
            x * x + square,
            x * y,
            y * y + square,
            x * z,
            y * z,
            z * z + square,
            x,
            y,
            z,
            T::of(1.0),
        ]
        .map(|entry| entry * mass)
    }
}

/// A payload from its ten parameters.
fn described<T: Float>(parameters: Inertia<T>, is_projected: bool) -> Result<Payload<T>, Error> {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = parameters;
    let centre = [mx / mass, my / mass, mz / mass];
    let [x, y, z] = centre;
    // Steiner's theorem.
    let inertia = [
        [
            xx - mass * (y * y + z * z),
            xy + mass * x * y,
            xz + mass * x * z,
        ],
        [
            xy + mass * x * y,
            yy - mass * (x * x + z * z),
            yz + mass * y * z,
        ],
        [
            xz + mass * x * z,
            yz + mass * y * z,
            zz - mass * (x * x + y * y),
        ],
    ];
    let numbers = parameters.iter().chain(&centre);
    if numbers.chain(inertia.as_flattened()).all(|x| x.is_finite()) {
        Ok(Payload {
            mass,
            centre,
            inertia,
            parameters,
            is_projected,
        })
    } else {
        Err(Error::Overflow)
    }
}
