//! Damaged descriptions give located errors or a model, never a panic.

use overact_codegen::{Diagnostics, Effort, Request, RobotModel, Source, compile_with};
use overact_tests::support::description;
use overact_tier::{by_tier, by_tiers};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::mpsc;
use std::time::Duration;

/// Time limit of an answer; valid descriptions need a small part of it.
const TIME_LIMIT: Duration = Duration::from_secs(20);

/// Fragments of descriptions, inserted in wrong places.
const FRAGMENTS: [&str; 40] = [
    "",
    "\"",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    "#",
    "\n",
    "0",
    "-1",
    "1e999",
    "nan",
    "\"nan m\"",
    "\"1e308 m\"",
    "\"1/0\"",
    "\"-(\"",
    "\"q\"",
    "\"q - q\"",
    "\"2 * q\"",
    "\"q2\"",
    "\"sqrt(-1)\"",
    "\"m\"",
    "\"1 kg\"",
    "\"prismatic\"",
    "\"fixed\"",
    "\"spatial\"",
    "\"point\"",
    "\"schoenflies\"",
    "[[place]]",
    "[leg.arm]",
    "[platform]",
    "home = {}",
    "parameters = []",
    "actuated = false",
    "é",
    "\u{0}",
    "[0, 0, 0]",
    "9007199254740993",
];

/// A damage: position in the text, type, length and fragment.
#[derive(Clone, Debug)]
struct Damage {
    at: f64,
    kind: u8,
    length: usize,
    fragment: usize,
}

fn damage() -> impl Strategy<Value = Damage> {
    (0.0..1.0, 0..6_u8, 1..12_usize, 0..FRAGMENTS.len()).prop_map(|(at, kind, length, fragment)| {
        Damage {
            at,
            kind,
            length,
            fragment,
        }
    })
}

/// Text with one damage: characters or lines dropped, doubled, swapped, or replaced.
fn damaged(text: &str, damage: &Damage) -> String {
    let fragment = FRAGMENTS[damage.fragment];
    let lines: Vec<&str> = text.split('\n').collect();
    let line = ((damage.at * lines.len() as f64) as usize).min(lines.len() - 1);
    let replaced = |new: &str| {
        let mut lines = lines.clone();
        lines[line] = new;
        lines.join("\n")
    };
    match damage.kind {
        0 | 1 => {
            let characters: Vec<char> = text.chars().collect();
            let start = ((damage.at * characters.len() as f64) as usize).min(characters.len());
            let end = (start + damage.length).min(characters.len());
            let skip = if damage.kind == 0 { end } else { start };
            let (before, after) = (&characters[..start], &characters[skip..]);
            let middle: Vec<char> = fragment.chars().collect();
            [before, &middle, after].concat().into_iter().collect()
        }
        2 => {
            let end = (line + damage.length).min(lines.len());
            [&lines[..line], &lines[end..]].concat().join("\n")
        }
        3 => replaced(&format!("{0}\n{0}", lines[line])),
        4 => match lines[line].split_once('=') {
            Some((key, _)) => replaced(&format!("{key}= {fragment}")),
            None => replaced(fragment),
        },
        _ => {
            let other = (line + damage.length) % lines.len();
            let mut lines = lines;
            lines.swap(line, other);
            lines.join("\n")
        }
    }
}

/// Description without the parts that do not affect the mechanism, so that damage affects the rest.
fn text() -> String {
    let source = description("dualv").map(|s| s.text).unwrap_or_default();
    let end = source.find("[experiment]").unwrap_or(source.len());
    source[..end].to_owned()
}

/// Answer of the generator; `None` after a panic or timeout.
///
/// If the damage has no effect, the default tier derives the model without searching operations.
fn answer(source: &Source) -> Option<Result<Box<RobotModel>, Diagnostics>> {
    let (sender, receiver) = mpsc::channel();
    let source = source.clone();
    // A thread that never ends is abandoned; the test then fails anyway.
    std::thread::spawn(move || {
        // The receiver may already be gone.
        let request = Request::with_effort(by_tier([Effort::None, Effort::Quick]));
        let compiled = compile_with(&source, &request);
        let _ = sender.send(compiled.map(|compiled| Box::new(compiled.model)));
    });
    receiver.recv_timeout(TIME_LIMIT).ok()
}

/// The same cases on every run, unless `PROPTEST_RNG_SEED` is set; no shrinking, which would repeat
/// slow cases.
fn config() -> ProptestConfig {
    let default = ProptestConfig::default();
    let rng_seed = match default.rng_seed {
        RngSeed::Random => RngSeed::Fixed(2015),
        given @ RngSeed::Fixed(_) => given,
    };
    ProptestConfig {
        cases: by_tiers([64, 96, 256]),
        max_shrink_iters: 0,
        failure_persistence: None,
        rng_seed,
        ..default
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn damaged_descriptions_never_panic(damages in prop::collection::vec(damage(), 1..4)) {
        let whole = text();
        prop_assert!(!whole.is_empty());
        let text = damages.iter().fold(whole, |text, damage| damaged(&text, damage));
        let source = Source::new("damaged.toml", text);
        let Some(answer) = answer(&source) else {
            return Err(TestCaseError::fail(format!("no answer to {damages:?}")));
        };
        if let Err(errors) = answer {
            prop_assert!(!errors.is_empty(), "refused without a reason");
            prop_assert!(!errors.render_plain(&source).is_empty());
            for located in errors.located(&source) {
                prop_assert!(!located.message.is_empty());
            }
        }
    }
}

#[test]
fn huge_lengths_are_rejected_without_overflow() {
    for (key, value) in [("l_oa", "1e308 m"), ("l_ab", "1e200 m"), ("r_p", "1e308 m")] {
        let line = |line: &str| {
            if line.starts_with(&format!("{key} = ")) {
                format!("{key} = \"{value}\"\n")
            } else {
                format!("{line}\n")
            }
        };
        let changed: String = text().lines().map(line).collect();
        let answer = answer(&Source::new("huge.toml", changed));
        assert!(answer.is_some(), "no answer to {key} = {value}");
        assert!(
            answer.is_some_and(|a| a.is_err()),
            "{key} = {value} is a robot"
        );
    }
}
