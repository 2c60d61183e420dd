//! Robots of `robots/`: one test per robot, compiled and described.

use super::conversion::reference;
use super::expected::Expected;
use super::{Failure, description, model_with, repository};
use overact_codegen::mechanism::{JointKind, TwistCoordinate};
use overact_codegen::{Effort, Request, RobotModel};
use overact_tier::{by_tier, is_full, is_night};
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

/// Defines one test per robot of the library, `check(stem, &Robot)`, and one that no robot is
/// missing.
#[macro_export]
macro_rules! library {
    ($check:path) => {
        $crate::library! { $check;
            ankle: Ankle,
            ankle_offset: AnkleOffset,
            cable_planar: CablePlanar,
            cable_spatial: CableSpatial,
            delta: Delta,
            delta_4: Delta4,
            dualv: DualV,
            dvrk_mtm: DvrkMtm,
            emps: Emps,
            excavator: Excavator,
            exechon: Exechon,
            five_bar: FiveBar,
            four_bar: FourBar,
            hexapod: Hexapod,
            humanoid_leg: HumanoidLeg,
            kuka_lwr: KukaLwr,
            octopod: Octopod,
            orthoglide: Orthoglide,
            palletiser: Palletiser,
            planar_3prr: Planar3Prr,
            planar_3rrr: Planar3Rrr,
            planar_4prr: Planar4Prr,
            reachy_mini: ReachyMini,
            rx90: Rx90,
            schoenflies_4: Schoenflies4,
            scotch_yoke: ScotchYoke,
            spatial_3prs: Spatial3Prs,
            spatial_3rps: Spatial3Rps,
            spatial_3rps_ups: Spatial3RpsUps,
            spherical_3rrr: Spherical3Rrr,
            spherical_4rrr: Spherical4Rrr,
            stanford: Stanford,
            stephenson: Stephenson,
            three_leg_point: ThreeLegPoint,
            tricept: Tricept,
            tricept_4: Tricept4,
            two_motor_axis: TwoMotorAxis,
            tx40: Tx40,
        }
    };
    ($check:path; $($stem:ident: $robot:ident,)*) => {
        $(#[test]
        fn $stem() -> Result<(), $crate::support::Failure> {
            if !$crate::support::library::is_of_the_tier(stringify!($stem)) {
                return Ok(());
            }
            $check(stringify!($stem), &overact_compiled::$robot)
        })*

        #[test]
        fn all_descriptions_are_tested() -> Result<(), $crate::support::Failure> {
            assert_eq!($crate::support::library::stems()?, [$(stringify!($stem)),*]);
            Ok(())
        }
    };
}

/// Robots of the nightly tier only, each with a robot of the default tier that has the same motion.
///
/// They take a third of the time of all robots.
const NIGHT_ROBOTS: [(&str, &str); 4] = [
    ("delta_4", "delta"),
    ("octopod", "hexapod"),
    ("orthoglide", "delta"),
    ("spherical_4rrr", "spherical_3rrr"),
];

/// Robots of the full tier, each with a robot of the default tier that has the same motion.
///
/// They take half the time of the remaining robots. The default tier keeps redundant robots of
/// planar, point, Schoenflies and one-axis motion, and a platform with parasitic motion.
const FULL_TIER_ROBOTS: [(&str, &str); 8] = [
    ("ankle_offset", "ankle"),
    ("cable_spatial", "hexapod"),
    ("exechon", "spatial_3prs"),
    ("planar_4prr", "dualv"),
    ("reachy_mini", "hexapod"),
    ("spatial_3rps", "spatial_3prs"),
    ("spatial_3rps_ups", "spatial_3prs"),
    ("tricept_4", "tricept"),
];

/// Whether the current tier tests a robot.
#[must_use]
pub fn is_of_the_tier(stem: &str) -> bool {
    let has = |robots: &[(&str, &str)]| robots.iter().any(|(name, _)| *name == stem);
    let is_left_to_night = has(&NIGHT_ROBOTS) && !is_night();
    let is_left_to_full = has(&FULL_TIER_ROBOTS) && !is_full();
    !is_left_to_night && !is_left_to_full
}

/// Names of all descriptions in `robots/`, sorted.
///
/// # Errors
///
/// If the folder cannot be read.
pub fn stems() -> Result<Vec<String>, Failure> {
    let mut stems = Vec::new();
    for entry in std::fs::read_dir(repository("robots"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
            stems.extend(stem);
        }
    }
    stems.sort();
    Ok(stems)
}

/// Model and reference of a robot of `robots/`.
pub type Described = (RobotModel, Expected);

/// Model and reference of a description in `robots/`, computed once per test binary.
///
/// Operations are searched in the full tier only; the compiled robots test the search in both
/// tiers.
///
/// # Errors
///
/// The description's errors as text.
pub fn described(stem: &str) -> Result<&'static Described, Failure> {
    type Once = OnceLock<Result<Described, String>>;
    static ALL: Mutex<BTreeMap<String, &'static Once>> = Mutex::new(BTreeMap::new());
    let once: &'static Once = {
        let mut all = ALL.lock().map_err(|error| error.to_string())?;
        all.entry(stem.to_owned())
            .or_insert_with(|| Box::leak(Box::default()))
    };
    let described = once.get_or_init(|| derived(stem).map_err(|error| error.to_string()));
    described.as_ref().map_err(|error| error.as_str().into())
}

fn derived(stem: &str) -> Result<Described, Failure> {
    let source = description(stem)?;
    let request = Request::with_effort(by_tier([Effort::None, Effort::Quick]));
    let model = model_with(&source, &request)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    Ok((model, expected))
}

/// Half ranges of random poses around home, by twist coordinate.
#[must_use]
pub fn workspace(model: &RobotModel) -> Vec<f64> {
    let mechanism = &model.mechanism;
    let Some(platform) = &mechanism.platform else {
        // Joints of a tree are unrestricted; those of a skeleton are limited by the chains.
        let [turn, slide] = match mechanism.skeleton() {
            Some(_) => [0.25, 0.1 * mechanism.length_scale()],
            None => [2.5, 0.3],
        };
        let reach = |at| match mechanism.joint(at).kind {
            JointKind::Revolute => turn,
            _ => slide,
        };
        let joints = mechanism.joints();
        let own = mechanism.coordinate_joints().into_iter();
        let own = own.filter(|&at| !mechanism.joint(joints[at]).dependent);
        return own.map(|at| reach(joints[at])).collect();
    };
    let reach = |c: &TwistCoordinate| match c {
        TwistCoordinate::Linear(_) => 0.1 * mechanism.length_scale(),
        TwistCoordinate::Angular(_) => 0.2,
    };
    platform.motion.twist().iter().map(reach).collect()
}
