//! Names, sizes and tables of a generated robot.

use super::expression::{kind, number};
use crate::derivation::BodyParameter;
use crate::float::Float;
use crate::mechanism::{Mechanism, StandardParameter};
use crate::model::RobotModel;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// The associated constants of the robot's type.
#[must_use]
pub fn items(model: &RobotModel) -> TokenStream {
    let mechanism = &model.mechanism;
    let size = |n: usize| Literal::usize_unsuffixed(n);
    let sizes = [
        ("POSE", mechanism.pose_len(), " Numbers in a pose."),
        (
            "DOF",
            mechanism.dof(),
            " r, independent platform coordinates.",
        ),
        (
            "ACTUATORS",
            mechanism.actuator_count(),
            if mechanism.motors.is_empty() {
                " n, actuated joints."
            } else {
                " n, actuators."
            },
        ),
        (
            "JOINTS",
            mechanism.joints().len(),
            " n_t, joints of all legs.",
        ),
    ];
    let sizes = sizes.map(|(name, value, doc)| {
        let (name, value) = (format_ident!("{name}"), size(value));
        quote!(#[doc = #doc] pub const #name: ::core::primitive::usize = #value;)
    });
    let name = &mechanism.name;
    let legs: Vec<&str> = mechanism.legs.iter().map(|l| l.name.as_str()).collect();
    let actuators = mechanism.actuator_names();
    let joints: Vec<String> = mechanism
        .joints()
        .iter()
        .map(|&j| mechanism.joint_name(j))
        .collect();
    let strings = [
        (
            "LEGS",
            legs.iter().map(ToString::to_string).collect(),
            " Names of the legs.",
        ),
        (
            "ACTUATOR_NAMES",
            actuators,
            " Names of the actuators, in the order of q and τ.",
        ),
        (
            "JOINT_NAMES",
            joints,
            " Names of the joints, in the order of q_t.",
        ),
        (
            "COORDINATES",
            mechanism.coordinates(),
            " Names of the independent coordinates, in the order of the twist.",
        ),
        (
            "POSE_COORDINATES",
            mechanism.pose_coordinates(),
            " Names of the pose coordinates.",
        ),
    ];
    let strings = strings.map(|(name, values, doc): (_, Vec<String>, _)| {
        let (name, count) = (format_ident!("{name}"), size(values.len()));
        quote!(#[doc = #doc] pub const #name: [&'static ::core::primitive::str; #count] = [#(#values),*];)
    });
    let tables = [
        parameters(
            "PARAMETERS",
            " The standard parameters whose columns are not identically zero, in column order.",
            model,
            &model.selection.standard,
        ),
        parameters(
            "PAYLOAD_PARAMETERS",
            " The payload's parameters, in column order.",
            model,
            &model.selection.payload,
        ),
    ];
    let tables = match &model.selection.values {
        Some(values) => parameter_values(model, values),
        None => {
            let base = base_parameters(model);
            quote!(#(#tables)* #base)
        }
    };
    let home = home(model);
    quote! {
        #[doc = " The robot's name."]
        pub const NAME: &'static ::core::primitive::str = #name;
        #(#sizes)*
        #(#strings)*
        #home
        #tables
    }
}

fn home(model: &RobotModel) -> TokenStream {
    let mechanism = &model.mechanism;
    let indices = mechanism.first_joints();
    let indices = indices.iter().map(|&i| Literal::usize_unsuffixed(i));
    let revolute = mechanism.actuator_is_revolute();
    let of_joints = if mechanism.motors.is_empty() {
        " Indices of the actuated joints among all joints."
    } else {
        " Index of each actuator's joint among all joints; of a motor that drives several joints the first."
    };
    let terms = (!mechanism.motors.is_empty()).then(|| actuator_terms(mechanism));
    let kept = mechanism
        .kept_actuators
        .iter()
        .map(|&i| Literal::usize_unsuffixed(i));
    let kept_count = Literal::usize_unsuffixed(mechanism.kept_actuators.len());
    let pose = mechanism.home.pose.iter().map(|&v| number(v, model.float));
    let positions = mechanism
        .home
        .joints
        .iter()
        .map(|&v| number(v, model.float));
    let kind = kind(model.float);
    quote! {
        #[doc = #of_joints]
        pub const ACTUATED_JOINTS: [::core::primitive::usize; Self::ACTUATORS] = [#(#indices),*];
        #terms
        #[doc = " Whether each actuator is revolute (rad, N m); otherwise it is prismatic (m, N)."]
        pub const ACTUATOR_IS_REVOLUTE: [::core::primitive::bool; Self::ACTUATORS] = [#(#revolute),*];
        #[doc = " Kept actuators of the actuator projection (case 2)."]
        pub const KEPT_ACTUATORS: [::core::primitive::usize; #kept_count] = [#(#kept),*];
        #[doc = " Pose of the home configuration (m, rad)."]
        pub const HOME_POSE: [#kind; Self::POSE] = [#(#pose),*];
        #[doc = " Joint positions of the home configuration, which defines the working mode (m, rad)."]
        pub const HOME_JOINTS: [#kind; Self::JOINTS] = [#(#positions),*];
    }
}

/// Joints that each actuator drives, with factors.
fn actuator_terms(mechanism: &Mechanism) -> TokenStream {
    let actuators = mechanism.actuators().into_iter();
    let rows = actuators.map(|actuator| {
        let terms = mechanism.actuator_terms(actuator).into_iter();
        let terms = terms.map(|(joint, factor)| {
            let (joint, factor) = (index(joint), number(factor.value(), Float::F64));
            quote!((#joint, #factor))
        });
        quote!(&[#(#terms),*])
    });
    quote! {
        #[doc = " Joints that each actuator drives: indices among all joints, with factors. Its position is the sum of theirs."]
        pub const ACTUATOR_TERMS: [&'static [(::core::primitive::usize, ::core::primitive::f64)]; Self::ACTUATORS] = [#(#rows),*];
    }
}

fn parameters(name: &str, doc: &str, model: &RobotModel, of: &[BodyParameter]) -> TokenStream {
    let entries = of.iter().map(|&parameter| {
        let name = model.parameter_name(parameter);
        let unit = model.parameter_unit(parameter);
        let symbol = |s: StandardParameter| format_ident!("{s:?}");
        match parameter {
            BodyParameter::Leg {
                leg,
                joint,
                symbol: s,
            } => {
                let shape = model.mechanism.legs[leg].shape;
                let (leg, joint, shape) = (index(leg), index(joint), index(shape));
                let symbol = symbol(s);
                quote!(Parameter::of_leg(#name, StandardParameter::#symbol, #unit, #leg, #joint, #shape))
            }
            BodyParameter::Platform(s) => {
                let symbol = symbol(s);
                quote!(Parameter::of_platform(#name, StandardParameter::#symbol, #unit))
            }
            BodyParameter::Payload(s) | BodyParameter::Load { symbol: s, .. } => {
                let symbol = symbol(s);
                quote!(Parameter::of_payload(#name, StandardParameter::#symbol, #unit))
            }
            BodyParameter::Spring(at) => {
                let (symbol, at) = (symbol(parameter.symbol()), index(at));
                quote!(Parameter::of_spring(#name, StandardParameter::#symbol, #unit, #at))
            }
            BodyParameter::Motor { motor, symbol: s } => {
                let (symbol, at) = (symbol(s), index(motor));
                quote!(Parameter::of_motor(#name, StandardParameter::#symbol, #unit, #at))
            }
        }
    });
    let (name, count) = (format_ident!("{name}"), Literal::usize_unsuffixed(of.len()));
    let names = (!of.is_empty()).then(|| {
        quote!(
            use ::overact::{Parameter, StandardParameter};
        )
    });
    quote! {
        #[doc = #doc]
        pub const #name: [::overact::Parameter; #count] = {
            #names
            [#(#entries),*]
        };
    }
}

/// The values of known parameters.
fn parameter_values(model: &RobotModel, values: &[(BodyParameter, f64)]) -> TokenStream {
    let entries = values.iter().map(|&(parameter, value)| {
        let base = model.base.iter().find(|base| base.parameter == parameter);
        let name = base.map_or_else(
            || model.parameter_name(parameter),
            |base| model.base_name(base),
        );
        let value = number(value, model.float);
        quote!((#name, #value))
    });
    let count = Literal::usize_unsuffixed(values.len());
    let kind = kind(model.float);
    quote! {
        #[doc = " Values of the base parameters and of the payload parameters (SI), which the functions contain as constants."]
        pub const PARAMETER_VALUES: [(&'static ::core::primitive::str, #kind); #count] = [#(#entries),*];
    }
}

fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

fn base_parameters(model: &RobotModel) -> TokenStream {
    let entries = model.base.iter().map(|base| {
        let (name, kept) = (model.base_name(base), model.parameter_name(base.parameter));
        let regrouped = base.regrouped.iter().map(|(parameter, coefficient)| {
            let (name, coefficient) = (
                model.parameter_name(*parameter),
                number(*coefficient, Float::F64),
            );
            quote!((#name, #coefficient))
        });
        quote!(BaseParameter::new(#name, #kept, &[#(#regrouped),*]))
    });
    let count = Literal::usize_unsuffixed(model.base.len());
    quote! {
        #[doc = " The base parameters in the order of the functions' inputs, with the standard parameters regrouped into them."]
        pub const BASE_PARAMETERS: [::overact::BaseParameter; #count] = {
            use ::overact::BaseParameter;
            [#(#entries),*]
        };
    }
}
