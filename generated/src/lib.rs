//! The robots of `robots/`, generated and checked in: to use, to read beside the paper, to compare.
//!
//! One module per description. `overact generate robots/*.toml -o generated/src` writes them, and with
//! `--check` says whether they are up to date.

#[rustfmt::skip]
mod delta;
#[rustfmt::skip]
mod delta_4;
#[rustfmt::skip]
mod dualv;
#[rustfmt::skip]
mod emps;
#[rustfmt::skip]
mod five_bar;
#[rustfmt::skip]
mod hexapod;
#[rustfmt::skip]
mod kuka_lwr;
#[rustfmt::skip]
mod octopod;
#[rustfmt::skip]
mod orthoglide;
#[rustfmt::skip]
mod planar_3prr;
#[rustfmt::skip]
mod planar_3rrr;
#[rustfmt::skip]
mod planar_4prr;
#[rustfmt::skip]
mod rx90;
#[rustfmt::skip]
mod schoenflies_4;
#[rustfmt::skip]
mod scotch_yoke;
#[rustfmt::skip]
mod spherical_3rrr;
#[rustfmt::skip]
mod spherical_4rrr;
#[rustfmt::skip]
mod stanford;
#[rustfmt::skip]
mod three_leg_point;
#[rustfmt::skip]
mod two_motor_axis;

pub use delta::Delta;
pub use delta_4::Delta4;
pub use dualv::DualV;
pub use emps::Emps;
pub use five_bar::FiveBar;
pub use hexapod::Hexapod;
pub use kuka_lwr::KukaLwr;
pub use octopod::Octopod;
pub use orthoglide::Orthoglide;
pub use planar_3prr::Planar3Prr;
pub use planar_3rrr::Planar3Rrr;
pub use planar_4prr::Planar4Prr;
pub use rx90::Rx90;
pub use schoenflies_4::Schoenflies4;
pub use scotch_yoke::ScotchYoke;
pub use spherical_3rrr::Spherical3Rrr;
pub use spherical_4rrr::Spherical4Rrr;
pub use stanford::Stanford;
pub use three_leg_point::ThreeLegPoint;
pub use two_motor_axis::TwoMotorAxis;
