//! Random trees with chains between any bodies compared with the numeric reference in all
//! functions.
//!
//! `OVERACT_RANDOM_SEED=17` repeats one of them and prints its description. Draws whose chains do
//! not close, or are nearly singular, are discarded.

use overact_codegen::Source;
use overact_tests::support::random::skeleton;
use overact_tests::support::{Failure, all_functions::against_reference};
use overact_tier::drawn;

/// Tolerances of functions of base parameters and of all others.
///
/// Regroupings that are not exact are computed numerically and lose digits if columns are nearly
/// dependent. The worst of 200 draws has an error of 2e-7 of an entry and 3e-10 of its matrix.
const TOLERANCES: [f64; 2] = [1e-6, 1e-9];
const STATES: usize = 3;
/// Robots in the default, full and nightly tier.
const COUNT: [u64; 3] = [2, 25, 50];
/// Largest number of draws for each robot.
const DRAWS: u64 = 20;

#[test]
fn random_trees_with_chains_agree_with_the_reference() -> Result<(), Failure> {
    let own = std::env::var("OVERACT_RANDOM_SEED");
    let own: Option<u64> = own.ok().and_then(|seed| seed.parse().ok());
    let count = if own.is_some() { 1 } else { drawn(COUNT) };
    let (mut compared, mut nested, mut branched, mut errors) = (0, 0, 0, Vec::new());
    let mut seed = own.unwrap_or(0);
    while compared < count {
        let text = skeleton(seed);
        if own.is_some() {
            println!("{text}");
        }
        let source = Source::new(format!("random{seed}.toml"), text.clone());
        match against_reference(source, STATES, TOLERANCES) {
            Ok(failures) => {
                compared += 1;
                nested += usize::from(text.contains("body = \"chain"));
                branched += usize::from(text.contains("[leg.branch"));
                errors.extend(
                    failures
                        .into_iter()
                        .map(|line| format!("seed {seed}: {line}")),
                );
            }
            Err(error) => {
                let words = error.to_string();
                let expected = [
                    "never reaches",
                    "does not close",
                    "singular",
                    "regular",
                    "stretched",
                ];
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
    println!(
        "{compared} robots, {nested} with chains or branches on chains, {branched} with branches, of {seed} draws"
    );
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    assert!(own.is_some() || nested > 0, "no chain on a chain was drawn");
    assert!(own.is_some() || branched > 0, "no branch was drawn");
    Ok(())
}

/// Errors of draws must not be syntax errors.
#[test]
fn drawn_descriptions_are_syntactically_valid() {
    for seed in 0..200 {
        let text = skeleton(seed);
        let parsed = overact_codegen::description::parse(&Source::new("random.toml", text.clone()));
        assert!(parsed.is_ok(), "seed {seed}:\n{text}\n{:?}", parsed.err());
    }
}
