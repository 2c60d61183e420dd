//! Inverse kinematics of robots without closed form: Newton's method on the generated closure.

use super::boundary::boundary;
use crate::lowering::Array;
use crate::mechanism::Motion;
use crate::model::RobotModel;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `joints(pose)` by Newton's method.
#[must_use]
pub fn item(model: &RobotModel) -> TokenStream {
    let mechanism = &model.mechanism;
    let counts = mechanism
        .legs
        .iter()
        .map(|l| Literal::usize_unsuffixed(l.independent().count()));
    let quaternion = mechanism
        .platform
        .as_ref()
        .is_some_and(|p| Motion::has_quaternion(p.motion));
    let pose = Array {
        name: "pose".to_owned(),
        shape: vec![mechanism.pose_len()],
    };
    let check = boundary(model, &[pose]);
    let kind = super::expression::kind(model.float);
    quote! {
        #[doc = " Positions q_t of all joints (m, rad): inverse kinematics, eq. (7), in the working mode of the home configuration; by Newton's method."]
        #[doc = ""]
        #[doc = " # Errors"]
        #[doc = " An input is infinite, NaN or too large, the pose is out of reach, or a configuration on the way from home is singular."]
        pub fn joints(
            pose: &[#kind; Self::POSE],
        ) -> ::core::result::Result<[#kind; Self::JOINTS], ::overact::Error> {
            #check
            let mut joints = Self::HOME_JOINTS;
            ::overact::inverse::solve(
                ::overact::inverse::Legs {
                    names: &Self::LEGS,
                    joints: &[#(#counts),*],
                    home_pose: &Self::HOME_POSE,
                    home_joints: &Self::HOME_JOINTS,
                    has_quaternion: #quaternion,
                },
                pose,
                &mut joints,
                ::overact::inverse::Workspace {
                    error: &mut [0.0; Self::JOINTS],
                    jacobian: &mut [0.0; Self::JOINTS * Self::JOINTS],
                    pose: &mut [0.0; Self::POSE],
                },
                |pose, joints, error, jacobian| {
                    let (pose, joints) = (::overact::block::array(pose)?, ::overact::block::array(joints)?);
                    ::overact::block::write(&Self::closure_error_from_joints(pose, joints)?, error);
                    ::overact::block::write(&Self::legs_jacobian_from_joints(pose, joints)?, jacobian);
                    ::core::result::Result::Ok(())
                },
            )?;
            ::core::result::Result::Ok(joints)
        }
    }
}
