//! Robots in scopes where all names of the prelude have another meaning, without warnings.
#![no_implicit_prelude]
#![deny(warnings, missing_docs, nonstandard_style, unused, unused_qualifications)]

/// A possible module of a user.
mod hostile {
    #![allow(non_camel_case_types, dead_code)]

    /// An alias that is common in crates.
    pub type Result<T> = ::core::result::Result<T, ()>;
    pub struct Ok;
    pub struct Err;
    pub struct Some;
    pub struct None;
    pub struct Option;
    pub struct Default;
    pub struct Debug;
    pub struct Clone;
    pub struct f64;
    pub struct usize;
    pub struct bool;
    pub struct str;
    pub struct u8;
    pub mod core {}
    pub mod overact {}
    pub mod std {}
}

/// The attribute.
pub mod by_attribute {
    #[allow(unused_imports)]
    use super::hostile::*;

    /// A robot in a hostile place, with legs in capitals.
    #[::overact::redundant_robot("descriptions/capitals.toml")]
    pub struct Mine;
}

/// The attribute on a struct whose name the generated code uses.
pub mod called_result {
    /// A robot.
    #[::overact::redundant_robot("descriptions/capitals.toml")]
    pub struct Result;
}

/// A generated file.
pub mod by_file {
    #[allow(unused_imports)]
    use super::hostile::*;

    ::core::include!("../../../generated/src/five_bar.rs");
}

fn main() {
    let pose = by_attribute::Mine::HOME_POSE;
    ::core::assert!(by_attribute::Mine::actuator_positions(&pose).is_ok());
    ::core::assert!(called_result::Result::actuator_positions(&pose).is_ok());
    ::core::assert!(by_file::FiveBar::actuator_positions(&by_file::FiveBar::HOME_POSE).is_ok());
}
