//! Chains between any bodies of a branched skeleton agree with the numeric reference.
//!
//! Chains start on the ground or on moving bodies, run along a branch or between branches, and end
//! on slides. Ends are points or rigid. Some robots have several chains and redundant motors.
//!
//! The reference cuts every loop, keeps all joints of the tree free and closes the cuts by Lagrange
//! multipliers.

use overact_codegen::Source;
use overact_tests::support::tree::{self, SKELETON};
use overact_tests::support::{Failure, all_functions::against_reference, model_of};
use overact_tier::{by_tier, by_tiers, is_full};

const TOLERANCE: f64 = 1e-9;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [3, 20, 60];

/// A drive of two crossing axes and a slide between two bodies.
fn drive(name: &str, from: &str, to: &str) -> String {
    let slide = "type = \"prismatic\"\nactuated = true";
    tree::drive(name, [from, to], [slide, "0.6 m"])
}

/// Compares all functions of a description with the reference.
fn compare(what: &str, text: String) -> Result<(), Failure> {
    let failures = against_reference(
        Source::new("chains.toml", text),
        by_tiers(STATES),
        [TOLERANCE; 2],
    )?;
    assert!(failures.is_empty(), "{what}:\n{}", failures.join("\n"));
    Ok(())
}

fn between(from: &str, to: &str) -> Result<(), Failure> {
    let text = format!("{SKELETON}{}", drive("drive", from, to));
    compare(&format!("from {from} to {to}"), text)
}

#[test]
fn chains_from_the_ground_agree() -> Result<(), Failure> {
    between("ground", "c")
}

#[test]
fn chains_along_a_branch_agree() -> Result<(), Failure> {
    between("a", "c")
}

#[test]
fn chains_back_along_a_branch_agree() -> Result<(), Failure> {
    between("c", "a")
}

#[test]
fn chains_between_branches_against_a_prismatic_joint_agree() -> Result<(), Failure> {
    between("c", "e")
}

#[test]
fn chains_between_branches_along_a_prismatic_joint_agree() -> Result<(), Failure> {
    between("e", "b")
}

#[test]
fn two_chains_on_one_skeleton_agree() -> Result<(), Failure> {
    let text = format!(
        "{SKELETON}{}{}",
        drive("one", "d", "c"),
        drive("two", "ground", "e")
    );
    compare("two chains", text)
}

/// Chains on the bodies of a chain on the ground: from it, and in the full tier to it and in
/// between.
#[test]
fn chains_on_a_grounded_chain_agree() -> Result<(), Failure> {
    let first = drive("one", "ground", "c");
    let ends = [("one.2", "e"), ("d", "one.2"), ("one.3", "one.1")];
    for (from, to) in by_tier([&ends[..1], &ends]) {
        let text = format!("{SKELETON}{first}{}", drive("two", from, to));
        compare(&format!("from {from} to {to}"), text)?;
    }
    Ok(())
}

/// A chain on a moving chain, and in the full tier a third one on both.
#[test]
fn chains_on_a_moving_chain_agree() -> Result<(), Failure> {
    let drives = [
        drive("one", "a", "c"),
        drive("two", "one.2", "e"),
        drive("three", "two.3", "one.3"),
    ];
    let drives = by_tier([&drives[..2], &drives]).concat();
    compare("chains on a chain", format!("{SKELETON}{drives}"))
}

/// A branch of two actuated joints on a body of a chain.
fn branch(name: &str, body: &str) -> String {
    format!(
        r#"[leg.{name}]
base = {{ body = "{body}", at = ["0.2 m", "0.1 m", "-0.05 m"], rotation = ["-25 deg", "70 deg", "10 deg"] }}
[[leg.{name}.joint]]
name = "turn"
type = "revolute"
alpha = "35 deg"
actuated = true
[[leg.{name}.joint]]
name = "slide"
type = "prismatic"
alpha = "-80 deg"
d = "0.1 m"
actuated = true
[[place]]
name = "{name}"
shape = "{name}"
home = {{ turn = "15 deg", slide = "0.1 m" }}
"#
    )
}

/// Branches on bodies of chains: with a chain's end, and in the full tier with a chain's start and
/// with no chain.
#[test]
fn branches_on_chains_agree() -> Result<(), Failure> {
    let first = drive("one", "ground", "c");
    if is_full() {
        compare(
            "a branch",
            format!("{SKELETON}{first}{}", branch("hand", "one.2")),
        )?;
    }
    let ends = [("one.3", "hand.turn"), ("hand.slide", "e")];
    for (from, to) in by_tier([&ends[..1], &ends]) {
        let text = format!(
            "{SKELETON}{first}{}{}",
            branch("hand", "one.2"),
            drive("two", from, to)
        );
        compare(&format!("a branch, and from {from} to {to}"), text)?;
    }
    Ok(())
}

/// A joint coupled to a later one: in a skeleton, to one of another branch, and in a chain.
#[test]
fn joints_coupled_to_later_joints_agree() -> Result<(), Failure> {
    let follower = |leg: &str, leader: &str| {
        format!(
            "[[leg.{leg}.joint]]\nname = \"f\"\ntype = \"revolute\"\ntheta = \"0.2 * q_{leader}\"\n"
        )
    };
    let before = "[[leg.tree.joint]]\nname = \"c\"";
    let skeleton = SKELETON.replacen(before, &format!("{}{before}", follower("tree", "e")), 1);
    let chain = drive("one", "ground", "c");
    compare("a skeleton", format!("{skeleton}{chain}"))?;
    let mut chain = chain.replace("3 = ", "c = ");
    for name in ["a", "b", "c"] {
        let named = format!("[[leg.one.part]]\nname = \"{name}\"\n");
        chain = chain.replacen("[[leg.one.joint]]\n", &named, 1);
    }
    let first = "[[leg.one.part]]";
    let chain = chain.replacen(first, &format!("{}{first}", follower("one", "b")), 1);
    let chain = chain.replace("leg.one.part", "leg.one.joint");
    compare("a chain", format!("{SKELETON}{chain}"))
}

/// A four-bar on a moving arm, whose coupler has its own pin on the crank.
#[test]
fn chains_with_rigid_ends_agree() -> Result<(), Failure> {
    let text = r#"name = "RigidEnd"
[leg.arm]
[[leg.arm.joint]]
name = "shoulder"
type = "revolute"
alpha = "70 deg"
actuated = true
[[leg.arm.joint]]
name = "crank"
type = "revolute"
alpha = "-30 deg"
d = "0.3 m"
actuated = true
[leg.loop]
base = { body = "shoulder", at = ["0.6 m", 0, 0], rotation = ["-30 deg", 0, 0] }
[[leg.loop.joint]]
name = "rocker"
type = "revolute"
actuated = true
[[leg.loop.joint]]
name = "coupler"
type = "revolute"
d = "0.22 m"
[[leg.loop.joint]]
name = "pin"
type = "revolute"
d = "0.28 m"
parameters = ["fs"]
[leg.loop.end]
body = "crank"
at = ["0.1 m", 0, 0]
rotation = [0, 0, "30 deg"]
[[place]]
name = "arm"
shape = "arm"
home = { crank = "90 deg" }
[[place]]
name = "loop"
shape = "loop"
home = { rocker = "102 deg", coupler = "102 deg", pin = "-84 deg" }
"#;
    compare("a rigid end", text.to_owned())
}

/// A crank of 0.1 m that swings a rocker of 0.25 m through a coupler of 0.3 m.
fn crank(home: u32) -> String {
    format!(
        "name = \"Crank\"\ngravity = [0.0, -9.81, 0.0]\n\n\
         [[leg.drive.joint]]\nname = \"motor\"\ntype = \"revolute\"\nactuated = true\n\n\
         [leg.loop]\nbase = {{ at = [0.35, 0.0, 0.0] }}\n\
         end = {{ type = \"point\", body = \"motor\", at = [0.1, 0.0, 0.0] }}\n\
         [[leg.loop.joint]]\nname = \"rocker\"\ntype = \"revolute\"\n\
         [[leg.loop.joint]]\nname = \"coupler\"\ntype = \"revolute\"\nd = 0.25\n\
         [[leg.loop.joint]]\nname = \"tip\"\ntype = \"fixed\"\nd = 0.3\nparameters = []\n\n\
         [[place]]\nname = \"drive\"\nshape = \"drive\"\nhome = {{ motor = \"{home} deg\" }}\n\
         [[place]]\nname = \"loop\"\nshape = \"loop\"\n\
         home = {{ rocker = \"110 deg\", coupler = \"90 deg\" }}\n"
    )
}

#[test]
fn regroupings_of_a_crank_do_not_depend_on_its_home() -> Result<(), Failure> {
    let regroupings = |home: u32| -> Result<Vec<(String, String, f64)>, Failure> {
        let model = model_of(&Source::new("crank.toml", crank(home)))?;
        let name = |parameter| model.parameter_name(parameter);
        let all = model.base.iter().flat_map(|base| {
            let own = base.regrouped.iter();
            own.map(|(parameter, factor)| (name(base.parameter), name(*parameter), *factor))
        });
        Ok(all.collect())
    };
    let wanted = regroupings(20)?;
    assert!(!wanted.is_empty());
    for home in [45, 90, 135] {
        assert_eq!(regroupings(home)?, wanted, "home at {home} deg");
    }
    Ok(())
}
