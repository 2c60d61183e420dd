//! Random platforms with parasitic motion compared with the numeric reference in all functions.
//!
//! `OVERACT_RANDOM_SEED=17` repeats one of them and prints its description. If a draw's independent
//! coordinates are rejected, the proposed ones must work. Draws whose legs do not close, or are
//! nearly singular, are discarded.
//!
//! Deriving the functions takes nearly all of the time. One robot in four is compared in all
//! functions, the others in one group each.

use overact_codegen::{Choice, Source};
use overact_tests::support::random::parasitic_motion;
use overact_tests::support::{Failure, all_functions::of_functions};
use overact_tier::drawn;

/// Tolerances of functions of base parameters, whose regroupings are computed numerically, and of
/// all others.
const TOLERANCES: [f64; 2] = [1e-7, 1e-9];
const STATES: usize = 3;
/// Robots in the default and full tier.
const COUNT: [u64; 3] = [1, 10, 20];
/// Functions to compare, by seed: all, or those of a group.
const GROUPS: [Option<&str>; 4] = [
    None,
    Some("control"),
    Some("identification"),
    Some("kinematics"),
];
/// Largest number of draws for each robot.
const DRAWS: u64 = 10;

#[test]
fn random_parasitic_platforms_agree_with_the_reference() -> Result<(), Failure> {
    let own = std::env::var("OVERACT_RANDOM_SEED");
    let own: Option<u64> = own.ok().and_then(|seed| seed.parse().ok());
    let count = if own.is_some() { 1 } else { drawn(COUNT) };
    let (mut compared, mut proposed, mut errors) = (0, 0, Vec::new());
    let mut seed = own.unwrap_or(0);
    while compared < count {
        let mut text = parasitic_motion(seed);
        let mut outcome = compare(seed, &text);
        if let Some(better) = outcome
            .as_ref()
            .err()
            .and_then(|e| proposal(&e.to_string()))
        {
            let key = text.lines().find(|line| line.starts_with("independent"));
            text = text.replace(key.unwrap_or_default(), &better);
            outcome = compare(seed, &text);
            proposed += 1;
        }
        if own.is_some() {
            println!("{text}");
        }
        match outcome {
            Ok(failures) => {
                compared += 1;
                let lines = failures.into_iter();
                errors.extend(lines.map(|line| format!("seed {seed}: {line}")));
            }
            Err(error) => {
                let words = error.to_string();
                let expected = ["never reaches", "does not close", "singular", "regular"];
                if own.is_some() || !expected.iter().any(|word| words.contains(word)) {
                    errors.push(format!("seed {seed}: {words}"));
                    compared += 1;
                }
            }
        }
        seed += 1;
        let tried = seed - own.unwrap_or(0);
        assert!(
            tried <= DRAWS * count,
            "hardly a draw closes: {compared} of {tried}"
        );
    }
    println!("{compared} robots of {seed} draws, {proposed} with coordinates that were proposed");
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    Ok(())
}

fn compare(seed: u64, text: &str) -> Result<Vec<String>, Failure> {
    let source = Source::new(format!("random{seed}.toml"), text.to_owned());
    // A repeated one is compared in all functions.
    let group = match std::env::var_os("OVERACT_RANDOM_SEED") {
        Some(_) => None,
        None => GROUPS[usize::try_from(seed)? % GROUPS.len()],
    };
    let chosen = group.map(|name| Choice::new([name]).map_err(|_| format!("no group {name}")));
    of_functions(source, STATES, TOLERANCES, chosen.transpose()?.as_ref())
}

/// Proposed key in place of the draw's own.
fn proposal(words: &str) -> Option<String> {
    let start = words.find("write independent = [")? + "write ".len();
    let rest = &words[start..];
    Some(rest[..=rest.find(']')?].to_owned())
}
