//! Tests of the text around the tables.

use super::{element, full, identification, parsed, text};

#[test]
fn undetectable_faults_precede_untestable_assumptions() {
    let mut own = identification();
    let without = full(&own);
    own.unseen = vec![String::from(
        "delay of the torques: 1 ms would shift `a<b>` by 5 σ",
    )];
    own.assumptions = vec![String::from("the clock is right")];
    let html = full(&own);
    let document = parsed(&html);
    let after = |id: &str| {
        let list = element(&document, id).next_sibling_element();
        let list = list.and_then(|words| words.next_sibling_element());
        text(list.expect("a list behind the heading and its words"))
    };
    assert!(after("unseen").contains("Delay of the torques: 1 ms would shift a<b> by 5 σ"));
    assert!(after("assumptions").contains("The clock is right"));
    assert!(html.find("id=\"unseen\"") < html.find("id=\"assumptions\""));
    assert!(!without.contains("id=\"unseen\""));
}

#[test]
fn summary_figures_are_joined_to_their_units() {
    let html = full(&identification());
    let document = parsed(&html);
    let mut all = document.descendants();
    let facts = all.find(|node| node.attribute("class") == Some("facts"));
    let output = text(facts.expect("the result in a few numbers"));
    for (unit, separated) in [("\u{a0}%", " %"), ("\u{a0}s, ", " s, ")] {
        assert!(
            output.contains(unit) && !output.contains(separated),
            "{output:?}"
        );
    }
}
