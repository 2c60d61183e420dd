//! Backends for a robot's functions: evaluation of programs, and compiled Rust.

use super::{Failure, Sample};
use nalgebra::DMatrix;
use overact_codegen::RobotModel;
use overact_codegen::interpreter::Rows;
use overact_codegen::lowering::Program;

/// A backend that computes a robot's functions by name.
pub trait Backend {
    /// Name in messages.
    fn label(&self) -> &'static str;

    /// Output of the function at a sample; a vector is a matrix with one column.
    ///
    /// # Errors
    ///
    /// If there is no such function, or it has no value at the sample.
    fn call(&self, function: &str, sample: &Sample) -> Result<DMatrix<f64>, Failure>;
}

/// The evaluation backend.
#[derive(Clone, Copy, Debug)]
pub struct Evaluated<'a>(pub &'a RobotModel);

impl Backend for Evaluated<'_> {
    fn label(&self) -> &'static str {
        "evaluation"
    }

    fn call(&self, function: &str, sample: &Sample) -> Result<DMatrix<f64>, Failure> {
        let found = self.0.functions.iter().find(|f| f.name == function);
        let found = found.ok_or_else(|| format!("no function `{function}`"))?;
        let (program, computes) = (&found.program, found.computes);
        let output = evaluate(program, &|name| sample.argument(computes, name).ok())?;
        Ok(matrix(program, &output))
    }
}

/// Output of a program as a matrix; a vector has one column.
#[must_use]
pub fn matrix(program: &Program, output: &[f64]) -> DMatrix<f64> {
    match program.output.shape[..] {
        [rows, columns] => DMatrix::from_row_slice(rows, columns, output),
        _ => DMatrix::from_row_slice(output.len(), 1, output),
    }
}

/// A program's output, row-major, for inputs by name.
///
/// # Errors
///
/// If an input is missing, or a guard fails.
pub fn evaluate<'a>(
    program: &Program,
    input: &dyn Fn(&str) -> Option<&'a [f64]>,
) -> Result<Vec<f64>, Failure> {
    let rows = program.inputs.iter().map(|array| {
        let values = input(&array.name);
        let values = values.ok_or_else(|| format!("no input `{}`", array.name))?;
        Ok(Rows {
            values,
            shared: false,
        })
    });
    let inputs = rows.collect::<Result<Vec<_>, Failure>>()?;
    let mut output = vec![0.0; program.output.len()];
    program
        .evaluate(1, &inputs, &mut output)
        .map_err(|failed| format!("`{}`: {failed:?}", program.output.name))?;
    Ok(output)
}

/// Result of a compiled function, as a matrix.
pub trait Outcome {
    /// The matrix.
    ///
    /// # Errors
    ///
    /// The function's own.
    fn matrix(self) -> Result<DMatrix<f64>, overact::Error>;
}

impl<const N: usize> Outcome for [f64; N] {
    fn matrix(self) -> Result<DMatrix<f64>, overact::Error> {
        Ok(DMatrix::from_row_slice(N, 1, &self))
    }
}

impl<const R: usize, const C: usize> Outcome for [[f64; C]; R] {
    fn matrix(self) -> Result<DMatrix<f64>, overact::Error> {
        Ok(DMatrix::from_row_slice(R, C, self.as_flattened()))
    }
}

impl<O: Outcome> Outcome for Result<O, overact::Error> {
    fn matrix(self) -> Result<DMatrix<f64>, overact::Error> {
        self?.matrix()
    }
}

/// A [`Backend`] for functions of a compiled robot, with the names of their arguments.
#[macro_export]
macro_rules! compiled_backend {
    ($backend:ident, $label:literal, $robot:path,
     $($function:ident($($argument:ident),*);)*) => {
        #[doc = concat!("The functions of `", stringify!($robot), "`.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $backend;

        impl $crate::support::Backend for $backend {
            fn label(&self) -> &'static str {
                $label
            }

            fn call(
                &self,
                function: &str,
                sample: &$crate::support::Sample,
            ) -> Result<nalgebra::DMatrix<f64>, $crate::support::Failure> {
                match function {
                    $(stringify!($function) => Ok($crate::support::backend::Outcome::matrix(
                        <$robot>::$function(
                            $(overact::block::array(sample.input(stringify!($argument))?)?),*
                        ),
                    )?),)*
                    _ => Err(format!("no function `{function}`").into()),
                }
            }
        }
    };
}

/// A [`Backend`] for a compiled robot with platform, payload and redundant actuators.
#[macro_export]
macro_rules! redundant_backend {
    ($backend:ident, $label:literal, $robot:path) => {
        $crate::compiled_backend! {
            $backend, $label, $robot,
            joints(pose);
            actuator_positions(pose);
            pose_step(pose, missed);
            inverse_jacobian(pose);
            inverse_jacobian_from_joints(pose, joints);
            jacobian(pose);
            legs_jacobian_from_joints(pose, joints);
            legs_platform_jacobian_from_joints(pose, joints);
            closure_platform_jacobian_from_joints(pose, joints);
            closure_actuator_jacobian_from_joints(pose, joints);
            joint_velocities(pose, twist);
            joint_accelerations(pose, twist, acceleration);
            twist_from_actuators(pose, actuator_velocities);
            acceleration_from_actuators(pose, twist, actuator_accelerations);
            idm_red_platform(pose, twist, acceleration);
            idm_red_platform_from_joints(pose, joints, twist, acceleration);
            idm_red_platform_from_actuators(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_actuators(pose, twist, acceleration);
            idm_red_actuators_from_joints(pose, joints, twist, acceleration);
            idm_red_actuators_from_actuators(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_platform_base(pose, twist, acceleration);
            idm_red_platform_base_from_joints(pose, joints, twist, acceleration);
            idm_red_platform_base_from_actuators(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_actuators_base(pose, twist, acceleration);
            idm_red_actuators_base_from_joints(pose, joints, twist, acceleration);
            idm_red_actuators_base_from_actuators(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_payload(pose, twist, acceleration);
            idm_red_payload_from_joints(pose, joints, twist, acceleration);
            idm_red_payload_from_actuators(actuators, actuator_velocities, actuator_accelerations, start);
            idm_red_payload_actuators(pose, twist, acceleration);
            project_platform(pose, torques);
            project_actuators(pose, torques);
            inverse_dynamics(pose, twist, acceleration, parameters);
            inverse_dynamics_from_joints(pose, joints, twist, acceleration, parameters);
            inverse_dynamics_from_actuators(actuators, actuator_velocities, actuator_accelerations, parameters, start);
            inverse_dynamics_base(pose, twist, acceleration, base_parameters);
            inverse_dynamics_base_from_joints(pose, joints, twist, acceleration, base_parameters);
            inverse_dynamics_base_from_actuators(actuators, actuator_velocities, actuator_accelerations, base_parameters, start);
            mass_matrix(pose, parameters);
            mass_matrix_base(pose, base_parameters);
            bias(pose, twist, parameters);
            bias_base(pose, twist, base_parameters);
            forward_dynamics(pose, twist, torques, parameters);
            forward_dynamics_base(pose, twist, torques, base_parameters);
            inverse_dynamics_preloaded(pose, twist, acceleration, parameters, preload);
            project_torques(pose, torques);
            null_space(pose);
            pose_in_closed_form(actuators);
            pose_from_actuators(actuators, start);
        }
    };
}
