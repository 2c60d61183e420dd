//! All robots of `robots/` as compiled Rust, built once for all test binaries.
//!
//! Their modules come from `generated/` or from the build script.

/// A module from the build script, and its robot.
macro_rules! robot {
    ($stem:ident: $robot:ident) => {
        mod $stem {
            include!(concat!(env!("OUT_DIR"), "/", stringify!($stem), ".rs"));
        }
        pub use $stem::$robot;
    };
}

pub use overact_robots::{DualV, Emps, FiveBar, Rx90, ThreeLegPoint};

robot!(ankle: Ankle);
robot!(ankle_offset: AnkleOffset);
robot!(cable_planar: CablePlanar);
robot!(cable_spatial: CableSpatial);
robot!(delta: Delta);
robot!(delta_4: Delta4);
robot!(dvrk_mtm: DvrkMtm);
robot!(excavator: Excavator);
robot!(exechon: Exechon);
robot!(four_bar: FourBar);
robot!(hexapod: Hexapod);
robot!(humanoid_leg: HumanoidLeg);
robot!(kuka_lwr: KukaLwr);
robot!(octopod: Octopod);
robot!(orthoglide: Orthoglide);
robot!(palletiser: Palletiser);
robot!(planar_3prr: Planar3Prr);
robot!(planar_3rrr: Planar3Rrr);
robot!(planar_4prr: Planar4Prr);
robot!(reachy_mini: ReachyMini);
robot!(schoenflies_4: Schoenflies4);
robot!(scotch_yoke: ScotchYoke);
robot!(spatial_3prs: Spatial3Prs);
robot!(spatial_3rps: Spatial3Rps);
robot!(spatial_3rps_ups: Spatial3RpsUps);
robot!(spherical_3rrr: Spherical3Rrr);
robot!(spherical_4rrr: Spherical4Rrr);
robot!(stanford: Stanford);
robot!(stephenson: Stephenson);
robot!(tricept: Tricept);
robot!(tricept_4: Tricept4);
robot!(two_motor_axis: TwoMotorAxis);
robot!(tx40: Tx40);

pub mod derived;
pub mod framed;
pub mod friction;
pub mod known;
pub mod partitions;

use overact::Model;

/// The robot whose description is `robots/<stem>.toml`.
#[must_use]
pub fn by_stem(stem: &str) -> Option<&'static dyn Model> {
    Some(match stem {
        "ankle" => &Ankle,
        "ankle_offset" => &AnkleOffset,
        "cable_planar" => &CablePlanar,
        "cable_spatial" => &CableSpatial,
        "delta" => &Delta,
        "delta_4" => &Delta4,
        "dualv" => &DualV,
        "dvrk_mtm" => &DvrkMtm,
        "emps" => &Emps,
        "excavator" => &Excavator,
        "exechon" => &Exechon,
        "five_bar" => &FiveBar,
        "four_bar" => &FourBar,
        "hexapod" => &Hexapod,
        "humanoid_leg" => &HumanoidLeg,
        "kuka_lwr" => &KukaLwr,
        "octopod" => &Octopod,
        "orthoglide" => &Orthoglide,
        "palletiser" => &Palletiser,
        "planar_3prr" => &Planar3Prr,
        "planar_3rrr" => &Planar3Rrr,
        "planar_4prr" => &Planar4Prr,
        "reachy_mini" => &ReachyMini,
        "rx90" => &Rx90,
        "schoenflies_4" => &Schoenflies4,
        "scotch_yoke" => &ScotchYoke,
        "spatial_3prs" => &Spatial3Prs,
        "spatial_3rps" => &Spatial3Rps,
        "spatial_3rps_ups" => &Spatial3RpsUps,
        "spherical_3rrr" => &Spherical3Rrr,
        "spherical_4rrr" => &Spherical4Rrr,
        "stanford" => &Stanford,
        "stephenson" => &Stephenson,
        "three_leg_point" => &ThreeLegPoint,
        "tricept" => &Tricept,
        "tricept_4" => &Tricept4,
        "two_motor_axis" => &TwoMotorAxis,
        "tx40" => &Tx40,
        _ => return None,
    })
}
