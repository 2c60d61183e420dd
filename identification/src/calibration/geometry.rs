//! Interface of a robot to calibration: actuator positions for a pose and a changed geometry.

use nalgebra::DMatrix;
use overact::{Function, Model};
use serde::Serialize;

/// A length that calibration may change.
#[derive(Debug, Clone, PartialEq)]
pub struct GeometryParameter {
    /// Name, for instance `d_2_leg1`.
    pub name: String,
    /// Kind.
    pub kind: ParameterKind,
    /// Value in the description, m.
    pub described: f64,
}

/// Kind of a calibrated parameter.
///
/// If the data leave a choice which parameter to hold as described, later kinds are held first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ParameterKind {
    /// Encoder reading minus true position (rad, m).
    EncoderOffset,
    /// A length of a leg's chain: b, d or r of a joint's step (m).
    Length,
    /// A coordinate of a leg's attachment point, in the platform frame (m).
    PlatformPoint,
    /// A coordinate of a leg's base point, in the base frame (m).
    BasePoint,
}

/// Actuator positions at a pose, with derivatives.
#[derive(Debug, Clone, Default)]
pub struct Reached {
    /// Positions of the n actuators (rad, m).
    pub positions: Vec<f64>,
    /// J_p^inv, n × r: derivatives with respect to the twist coordinates.
    pub by_pose: DMatrix<f64>,
    /// Derivatives with respect to the parameters, n × parameters.
    pub by_parameter: DMatrix<f64>,
}

/// A robot whose geometry can be changed.
pub trait Geometry: Sync {
    /// The lengths that can be changed.
    fn parameters(&self) -> &[GeometryParameter];

    /// Number of values in the memory of a sample.
    fn memory(&self) -> usize;

    /// Initialises the memory of a sample at a pose of the described geometry.
    ///
    /// # Errors
    /// A pose that the described robot does not reach.
    fn remember(&self, pose: &[f64], memory: &mut [f64]) -> Result<(), overact::Error>;

    /// The robot with `changes` (m) added to the described values of the parameters.
    fn changed(&self, changes: &[f64]) -> Box<dyn ChangedGeometry + '_>;
}

/// A robot with changed geometry.
pub trait ChangedGeometry: Sync {
    /// Evaluates the actuator positions at a pose, with derivatives.
    ///
    /// The memory selects one of several configurations and is updated to the pose.
    ///
    /// # Errors
    /// A pose that the changed robot does not reach.
    fn evaluate(
        &self,
        pose: &[f64],
        memory: &mut [f64],
        reached: &mut Reached,
    ) -> Result<(), overact::Error>;
}

/// The described geometry without parameters; only encoder offsets can be calibrated.
#[derive(Clone, Copy)]
pub struct DescribedGeometry<'a>(&'a dyn Model);

impl std::fmt::Debug for DescribedGeometry<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("DescribedGeometry")
            .field(&self.0.info().name)
            .finish()
    }
}

impl<'a> DescribedGeometry<'a> {
    /// The geometry of a compiled or interpreted model.
    #[must_use]
    pub fn new(model: &'a dyn Model) -> Self {
        Self(model)
    }
}

impl Geometry for DescribedGeometry<'_> {
    fn parameters(&self) -> &[GeometryParameter] {
        &[]
    }

    fn memory(&self) -> usize {
        0
    }

    fn remember(&self, _: &[f64], _: &mut [f64]) -> Result<(), overact::Error> {
        Ok(())
    }

    fn changed(&self, _: &[f64]) -> Box<dyn ChangedGeometry + '_> {
        Box::new(*self)
    }
}

impl ChangedGeometry for DescribedGeometry<'_> {
    fn evaluate(
        &self,
        pose: &[f64],
        _: &mut [f64],
        reached: &mut Reached,
    ) -> Result<(), overact::Error> {
        let sizes = self.0.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let mut jacobian = vec![0.0; n * r];
        reached.positions.resize(n, 0.0);
        let positions = &mut reached.positions;
        self.0
            .evaluate(Function::ActuatorPositions, &[pose], positions)
            .and_then(|()| {
                self.0
                    .evaluate(Function::InverseJacobian, &[pose], &mut jacobian)
            })
            .map_err(|error| error.error)?;
        reached.by_pose = DMatrix::from_row_slice(n, r, &jacobian);
        reached.by_parameter = DMatrix::zeros(n, 0);
        Ok(())
    }
}
