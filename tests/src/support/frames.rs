//! Expected outputs of functions of frames, of the centre of mass and of energies.

use super::{Failure, Sample};
use crate::reference::dynamics::Dynamics;
use crate::reference::energy::total_energy;
use crate::reference::kinematics::BodyMotion;
use crate::reference::linear::pseudo_inverse;
use crate::reference::masses::masses;
use crate::reference::{Frame, Mechanism, State};
use nalgebra::{DMatrix, DVector, Rotation3, UnitQuaternion, Vector3, Vector6};
use overact::{FrameFunction, FrameQuantity, Function};
use overact_codegen::mechanism::{self, Angle, FrameBody, Number};

/// A frame on a body, as plain data.
#[derive(Clone, Copy, Debug)]
pub struct FrameOnBody {
    /// Leg and joint of the body; `None` for the platform.
    pub body: Option<(usize, usize)>,
    /// Placement in the body's frame.
    pub placement: Frame,
}

/// Frames of a mechanism and the origin of its axes in the description's base frame.
#[derive(Clone, Debug)]
pub struct Frames {
    /// The frames.
    pub all: Vec<FrameOnBody>,
    /// The origin.
    pub origin: Vector3<f64>,
}

impl Frames {
    /// The frames of a mechanism.
    #[must_use]
    pub fn of(mechanism: &mechanism::Mechanism) -> Self {
        let vector = |values: [Number; 3]| Vector3::from(values.map(Number::value));
        let frame = |frame: &mechanism::Frame| {
            let [rx, ry, rz] = frame.placement.rotation.map(Angle::value);
            let rotation = Rotation3::from_euler_angles(rx, ry, rz).into_inner();
            FrameOnBody {
                body: match frame.body {
                    FrameBody::Platform => None,
                    FrameBody::Joint(body) => Some((body.leg, body.joint)),
                },
                placement: Frame::new(rotation, vector(frame.placement.at)),
            }
        };
        Self {
            all: mechanism.frames.iter().map(frame).collect(),
            origin: vector(mechanism.origin),
        }
    }

    /// Motion of a frame in a state.
    #[must_use]
    pub fn motion(&self, mechanism: &Mechanism, frame: usize, state: &State) -> BodyMotion {
        let FrameOnBody { body, placement } = self.all[frame];
        let body = match body {
            None => state.platform(mechanism),
            Some((leg, joint)) => state.legs(mechanism)[leg][joint],
        };
        body.carried(placement)
    }

    /// Position and quaternion with w first, of either sign.
    #[must_use]
    pub fn pose(&self, mechanism: &Mechanism, frame: usize, state: &State) -> DVector<f64> {
        let Frame { rotation, position } = self.motion(mechanism, frame, state).frame;
        let rotation = Rotation3::from_matrix_unchecked(rotation);
        let q = UnitQuaternion::from_rotation_matrix(&rotation);
        let p = position + self.origin;
        DVector::from_column_slice(&[p.x, p.y, p.z, q.w, q.i, q.j, q.k])
    }
}

/// Output of a function; `None` for those of other kinds.
///
/// # Errors
///
/// If the reference cannot compute a motion.
pub fn output(
    frames: &Frames,
    dynamics: &Dynamics<'_>,
    function: Function,
    sample: &Sample,
) -> Result<Option<DMatrix<f64>>, Failure> {
    let (mechanism, state) = (dynamics.mechanism, dynamics.state);
    let (parameters, dof) = (&sample.all_parameters, mechanism.dof());
    let still = DVector::zeros(dof);
    let moving = |twist: &DVector<f64>| -> Result<State, Failure> {
        let state = State::with_joints(mechanism, &state.pose, &state.q, twist, &still)?;
        Ok(state)
    };
    let units =
        || (0..dof).map(|k| moving(&DVector::from_fn(dof, |at, _| f64::from(u8::from(at == k)))));
    let number = |value: f64| DMatrix::from_element(1, 1, value);
    let six = |value: Vector6<f64>| DMatrix::from_column_slice(6, 1, value.as_slice());
    let three = |value: Vector3<f64>| DMatrix::from_column_slice(3, 1, value.as_slice());
    Ok(Some(match function {
        Function::TotalMass => number(masses(mechanism, state, parameters).mass),
        Function::CentreOfMass => {
            let sums = masses(mechanism, state, parameters);
            three(sums.moment / sums.mass + frames.origin)
        }
        Function::CentreOfMassJacobian => {
            let columns = units().map(|moved| {
                let sums = masses(mechanism, &moved?, parameters);
                Ok(DVector::from_column_slice(
                    (sums.momentum / sums.mass).as_slice(),
                ))
            });
            DMatrix::from_columns(&columns.collect::<Result<Vec<_>, Failure>>()?)
        }
        Function::PotentialEnergy => {
            let of_origin = mechanism.gravity.dot(&frames.origin);
            let sums = masses(mechanism, state, parameters);
            number(-mechanism.gravity.dot(&sums.moment) - sums.mass * of_origin)
        }
        Function::KineticEnergy => {
            let at_rest = total_energy(mechanism, &moving(&still)?, parameters);
            number(total_energy(mechanism, state, parameters) - at_rest)
        }
        Function::Frame(FrameFunction { frame, quantity }) => {
            let of = |state: &State| frames.motion(mechanism, frame, state);
            match quantity {
                FrameQuantity::Pose => {
                    let pose = frames.pose(mechanism, frame, state);
                    DMatrix::from_column_slice(7, 1, pose.as_slice())
                }
                FrameQuantity::Jacobian => {
                    let columns =
                        units().map(|moved| Ok(six(of(&moved?).twist()).column(0).into_owned()));
                    DMatrix::from_columns(&columns.collect::<Result<Vec<_>, Failure>>()?)
                }
                FrameQuantity::Velocity => six(of(state).twist()),
                FrameQuantity::AccelerationBias => {
                    six(of(&moving(&state.twist)?).twist_derivative())
                }
                FrameQuantity::Torques => {
                    let wrench = Vector6::from_column_slice(&sample.wrench);
                    let forces = units().map(|moved| Ok(-of(&moved?).twist().dot(&wrench)));
                    let forces = forces.collect::<Result<Vec<f64>, Failure>>()?;
                    let transposed = dynamics.jacobians.inverse.transpose();
                    let torques = pseudo_inverse(&transposed) * DVector::from_vec(forces);
                    let torques = dynamics.with_tensions(&torques);
                    DMatrix::from_column_slice(torques.len(), 1, torques.as_slice())
                }
            }
        }
        _ => return Ok(None),
    }))
}

/// Changes the sign of a pose's quaternion to that of a wanted one.
pub fn with_sign_of(found: &mut DMatrix<f64>, wanted: &DMatrix<f64>) {
    let product: f64 = (3..7).map(|at| found[at] * wanted[at]).sum();
    if product < 0.0 {
        (3..7).for_each(|at| found[at] = -found[at]);
    }
}
