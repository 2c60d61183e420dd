//! Joints of legs without closed form: Newton's method on the interpreted closure.

use super::InterpretedRobot;
use overact::Function;
use overact::{
    Error, Model, SampleError,
    inverse::{self, Legs},
};
use overact_codegen::{derivation::MotionInput, interpreter::Rows, lowering::Program};

impl InterpretedRobot {
    /// Joint positions of all poses, pose by pose.
    pub(super) fn find_joints(&self, poses: &[f64]) -> Result<Vec<f64>, SampleError> {
        let mechanism = &self.model.mechanism;
        let sizes = self.info().sizes;
        let program = |function| {
            self.model
                .function(function, MotionInput::Joints)
                .map(|f| &f.program)
        };
        let (Some(closure), Some(jacobian)) = (
            program(Function::ClosureError),
            program(Function::LegsJacobian),
        ) else {
            let function = Function::ClosureError.name();
            return Err(SampleError {
                sample: 0,
                error: Error::NotOffered { function },
            });
        };
        let counts: Vec<usize> = mechanism
            .legs
            .iter()
            .map(|l| l.independent().count())
            .collect();
        let names: Vec<&'static str> = mechanism
            .legs
            .iter()
            .map(|leg| self.names.leg(&leg.name))
            .collect();
        let motion = mechanism.platform.as_ref().map(|p| p.motion);
        let legs = Legs {
            names: &names,
            joints: &counts,
            home_pose: &mechanism.home.pose,
            home_joints: &mechanism.home.joints,
            has_quaternion: motion.is_some_and(|m| m.has_quaternion()),
        };
        let mut found = vec![0.0; poses.len() / sizes.pose * sizes.joints];
        let mut error = vec![0.0; sizes.joints];
        let mut square = vec![0.0; sizes.joints * sizes.joints];
        let mut way = vec![0.0; sizes.pose];
        let samples = poses.chunks(sizes.pose).zip(found.chunks_mut(sizes.joints));
        for (sample, (pose, joints)) in samples.enumerate() {
            let workspace = inverse::Workspace {
                error: &mut error,
                jacobian: &mut square,
                pose: &mut way,
            };
            let evaluate = |pose: &[f64], joints: &[f64], error: &mut [f64], square: &mut [f64]| {
                self.run(closure, pose, joints, error)?;
                self.run(jacobian, pose, joints, square)
            };
            inverse::solve(legs, pose, joints, workspace, evaluate)
                .map_err(|error| SampleError { sample, error })?;
        }
        Ok(found)
    }

    fn run(
        &self,
        program: &Program,
        pose: &[f64],
        joints: &[f64],
        out: &mut [f64],
    ) -> Result<(), Error> {
        let rows = |values| Rows {
            values,
            shared: false,
        };
        program
            .evaluate(1, &[rows(pose), rows(joints)], out)
            .map_err(|failed| self.error(program, &failed).error)
    }
}
