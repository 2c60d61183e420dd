//! Tests of the page with an artificial identification that has hostile names.

mod estimates;
mod example;
mod words;

use super::{Attachment, Contents, page};
use crate::{Extent, Units, compare_with_published, numbers, summary, tables};
use example::{HOSTILE, identification, published, series, settings, units};
use overact_identification::{Estimate, Figures, Identification, ParameterEstimate, Thresholds};
use roxmltree::{Document, ParsingOptions};

/// Page with everything that can be shown.
fn full(identification: &Identification) -> String {
    page(&Contents {
        identification,
        units: &units(),
        summary: Some(HOSTILE),
        source: Some(HOSTILE),
        drawing: Some(
            "<svg xmlns=\"http://www.w3.org/2000/svg\"><style>*{color:red}</style></svg>",
        ),
        published: Some(&published()),
        attachments: &[Attachment {
            name: HOSTILE,
            media_type: "text/csv",
            what: HOSTILE,
            text: "a,b\n",
        }],
    })
}

/// Page of an identification alone.
fn bare(identification: &Identification) -> String {
    page(&Contents {
        identification,
        units: &Units::default(),
        summary: None,
        source: None,
        drawing: None,
        published: None,
        attachments: &[],
    })
}

fn parsed(html: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(html, options).expect("a page that is XML")
}

/// Text of an element and its descendants.
fn text(node: roxmltree::Node<'_, '_>) -> String {
    let texts = node.descendants().filter(roxmltree::Node::is_text);
    texts.filter_map(|node| node.text()).collect()
}

fn element<'a>(document: &'a Document<'a>, id: &str) -> roxmltree::Node<'a, 'a> {
    let mut all = document.descendants();
    all.find(|node| node.attribute("id") == Some(id))
        .unwrap_or_else(|| panic!("{id} is on the page"))
}

#[test]
fn the_page_is_well_formed_and_has_all_figures() {
    let html = full(&identification());
    let document = parsed(&html);
    for (id, plots) in [
        ("figure-robot", 0),
        ("figure-parameters", 1),
        ("figure-elimination-platform", 2),
        ("figure-elimination-actuators", 2),
        ("figure-conditioning", 2),
        ("figure-inputs-platform-1", 2),
        ("figure-inputs-actuators-1", 2),
        ("figure-torques-1", 1),
        ("figure-trajectories", 2),
        ("figure-trajectories-held-out", 2),
        ("figure-residuals-platform", 3),
        ("figure-residuals-actuators", 3),
    ] {
        let figure = element(&document, id);
        let named = |node: &roxmltree::Node<'_, '_>, name| node.tag_name().name() == name;
        let svgs: Vec<_> = figure.descendants().filter(|n| named(n, "svg")).collect();
        assert_eq!(svgs.len(), plots, "{id}");
        for svg in svgs {
            let drawn = svg
                .descendants()
                .filter_map(|node| node.attribute("d"))
                .any(|d| d.contains('L') || d.matches('H').count() == 1);
            assert!(drawn, "{id} has lines");
            assert!(
                svg.attribute("aria-label").is_some_and(|l| !l.is_empty()),
                "{id}"
            );
        }
        let caption = figure.descendants().find(|n| named(n, "figcaption"));
        assert!(text(caption.expect("a caption")).len() > 20, "{id}");
    }
    let ids: Vec<_> = document
        .descendants()
        .filter_map(|node| node.attribute("id"))
        .collect();
    let mut unique = ids.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "every id is there once: {ids:?}");
}

#[test]
fn names_are_escaped_and_no_resources_are_loaded() {
    let html = full(&identification());
    let document = parsed(&html);
    for node in document.descendants() {
        assert_ne!(node.tag_name().name(), "script");
        assert_ne!(node.tag_name().name(), "link");
        for attribute in node.attributes() {
            let name = attribute.name();
            assert!(!name.starts_with("on"), "{name}");
            let is_address = name == "href" || name == "src";
            let value = attribute.value();
            assert!(
                !is_address || value.starts_with("data:") || value.starts_with('#'),
                "{name}: {value}"
            );
        }
    }
    let style = document
        .descendants()
        .find(|node| node.tag_name().name() == "style")
        .expect("a style");
    assert!(!text(style).contains("url(") && !text(style).contains("@import"));
}

#[test]
fn names_are_printed_without_control_characters() {
    let mut identification = identification();
    identification.robot += &"x".repeat(5000);
    let output = summary(&identification, Some("report.html"), Extent::Whole)
        + &tables(&identification)
        + &compare_with_published(&identification, Some(&published()));
    let hidden = |c: char| c != '\n' && overact_core::text::is_invisible(c);
    assert!(!output.contains(hidden), "{output:?}");
    for words in [
        "platform projection (torques of all actuators): USE IT FOR WHAT IS LISTED",
        "  Usable: m_platformR.\n",
        "DO NOT USE IT",
        "leg1: clipped",
        "Evidence and plots: report.html",
    ] {
        assert!(output.contains(words), "{words} in {output}");
    }
    let is_long = |line: &&str| line.chars().count() > 400;
    assert_eq!(output.lines().find(is_long), None);
    let page = full(&identification);
    let hidden = |c: char| c != '\n' && overact_core::text::is_invisible(c);
    assert!(!page.contains(hidden));
}

#[test]
fn short_summaries_list_usable_parameters_in_fifty_lines() {
    let mut identification = identification();
    identification.warnings.clear();
    identification.calibration = None;
    // Only the least known parameter may be used.
    let verdict = &mut identification.verdicts[0];
    verdict.listed = vec![String::from("p_0")];
    let (model, stage) = (verdict.model, verdict.stage);
    identification.estimates.retain(|one| one.model == model);
    let own = |one: &&mut Estimate| one.stage == stage;
    let estimate = identification
        .estimates
        .iter_mut()
        .find(own)
        .expect("an answer");
    let known = estimate.parameters[1].clone();
    estimate.parameters = (0..90)
        .map(|number| ParameterEstimate {
            name: format!("p_{number}"),
            interval_95: [-9.0, -1.0 - f64::from(number) * 0.01],
            ..known.clone()
        })
        .collect();
    let whole = summary(&identification, None, Extent::Whole);
    assert!(
        (0..90).all(|number| whole.contains(&format!("\np_{number} "))),
        "{whole}"
    );
    let short = summary(&identification, None, Extent::Short);
    let rows = short.lines().filter(|line| line.starts_with("p_")).count();
    assert!(
        short.lines().count() <= 50 && (10..40).contains(&rows),
        "{short}"
    );
    assert!(
        short.lines().all(|line| line.chars().count() <= 100),
        "{short}"
    );
    assert!(
        short.contains("\np_0 ") && short.contains("\np_89 "),
        "{short}"
    );
    assert!(!short.contains("\np_1 "), "{short}");
    assert!(
        short.contains(" more; the most precise one is known to "),
        "{short}"
    );
    assert!(short.contains("and 65 more."), "{short}");
}

#[test]
fn missing_parts_are_not_mentioned() {
    let mut identification = identification();
    let of = |identification: &Identification, units: &Units| {
        page(&Contents {
            identification,
            units,
            summary: None,
            source: None,
            drawing: None,
            published: None,
            attachments: &[],
        })
    };
    identification.settings.standstill_velocity = vec![0.0625];
    identification.runs[0].standstill_equations = vec![17];
    let html = of(&identification, &Units::default());
    assert!(html.contains("the prediction of validation data is no worse"));
    assert!(html.contains("Equations skipped at standstill"));
    assert!(html.contains("17, below 0.0625 rad/s or m/s"));
    assert!(!html.contains("translate the platform"), "there is none");
    identification.cross_validation.clear();
    let html = of(&identification, &Units::default());
    assert!(!html.contains("the prediction of validation data is no worse"));
    let output = summary(&identification, None, Extent::Whole);
    assert!(
        output.contains("base parameters: ") && output.contains("by the r_sigma rule: "),
        "{output}"
    );
}

#[test]
fn the_verdict_is_first_and_lists_trusted_parameters() {
    let html = full(&identification());
    let document = parsed(&html);
    let sections: Vec<_> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "section")
        .filter_map(|node| node.attribute("id"))
        .collect();
    assert_eq!(sections[..3], ["verdict", "parameters", "scope"]);
    assert_eq!(sections.len(), 19, "{sections:?}");
    let summary = "Platform projection, recommended parameters: use it for what is listed. Actuator projection, recommended parameters: do not use it.";
    let header = document
        .descendants()
        .find(|node| node.tag_name().name() == "header");
    let header = text(header.expect("a head"));
    assert!(header.contains(summary), "{header}");
    let scope = text(element(&document, "scope"));
    assert!(scope.contains("The gains are right"), "{scope}");
    let verdict = text(element(&document, "verdict"));
    for words in [
        "Usable: m_platformR.",
        "One parameter is biased. Details.",
        "leg1: clipped. Details.",
        "All base parameters: use it.",
    ] {
        assert!(verdict.contains(words), "{words} in {verdict}");
    }
    assert_eq!(verdict.matches("lipped").count(), 1, "once, as a reason");
    let conditioning = text(element(&document, "conditioning"));
    assert!(
        conditioning.contains("held out at 0.00 s"),
        "the crossing is reported: {conditioning}"
    );
}

#[test]
fn checks_are_shown_with_their_evidence() {
    let html = full(&identification());
    let document = parsed(&html);
    let is = |node: &roxmltree::Node<'_, '_>, name| node.tag_name().name() == name;
    let checks = element(&document, "checks");
    let headings: Vec<String> = checks
        .descendants()
        .filter(|node| is(node, "h3"))
        .map(text)
        .collect();
    let begins = |at: usize, words: &str| headings[at].starts_with(words);
    assert!(
        begins(0, "Clipped torque: actuator projection"),
        "most serious first: {headings:?}"
    );
    assert!(begins(
        1,
        "Position noise in the regressor: platform projection"
    ));
    let biased = text(element(&document, "check-2"));
    for words in [
        "Measured: 0.001 probability. Limit: 0.01 probability.",
        "1\u{a0}% of all reports",
        "Do not use: a<b>",
    ] {
        assert!(biased.contains(words), "{words} in {biased}");
    }
    // Passed checks are collapsed, with their plots.
    let folded = element(&document, "figure-check-1");
    assert!(folded.ancestors().any(|node| is(&node, "details")));
    let shown = element(&document, "figure-check-3");
    assert!(shown.ancestors().all(|node| !is(&node, "details")));
    let dashed = shown
        .descendants()
        .filter(|node| node.attribute("class") == Some("rule"));
    assert_eq!(dashed.count(), 2, "both limits");
    // Every link of the verdict has a target.
    for link in document
        .descendants()
        .filter_map(|node| node.attribute("href"))
    {
        if let Some(id) = link.strip_prefix('#') {
            element(&document, id);
        }
    }
}

#[test]
fn tables_contain_the_estimates() {
    let html = full(&identification());
    let document = parsed(&html);
    let parameters = text(element(&document, "parameters"));
    for number in [
        "0.04450.0427 … 0.0463−1.00 %",
        "−2.200*",
        "outside its own interval",
        "−1.92",
        "1.931.08",
        "zz_1 + 0.0784",
    ] {
        assert!(parameters.contains(number), "{number} in {parameters}");
    }
    let validation = text(element(&document, "validation"));
    for number in ["5.0", "5.5", "4.5", "9.1"] {
        assert!(validation.contains(number), "{number} in {validation}");
    }
    let tracking = text(element(&document, "tracking"));
    for number in ["leg1 (mrad)", "8", "2", "75.0", "6.35"] {
        assert!(tracking.contains(number), "{number} in {tracking}");
    }
    let limits = text(element(&document, "limits"));
    assert!(
        limits.contains("No effect on the torques")
            && limits.contains("Eliminated by the r_σ rule")
    );
}

#[test]
fn the_plotted_part_contains_the_largest_residual() {
    let part = super::elements::select::worst_part(&[series("x")]);
    assert_eq!(part.len(), 300);
    assert!(part.contains(&300), "{part:?}");
}

#[test]
fn an_empty_identification_still_has_a_page() {
    let empty = Identification {
        robot: String::from("robot"),
        runs: Vec::new(),
        base_parameters: Vec::new(),
        without_effect: Vec::new(),
        estimates: Vec::new(),
        consistent: Vec::new(),
        cross_validation: Vec::new(),
        warnings: Vec::new(),
        checks: Vec::new(),
        assumptions: Vec::new(),
        unseen: Vec::new(),
        verdicts: Vec::new(),
        thresholds: Thresholds::default(),
        calibration: None,
        gravity: None,
        gains: Vec::new(),
        gain_parameters: Vec::new(),
        gear_friction: Vec::new(),
        stribeck_velocities: Vec::new(),
        motors: Vec::new(),
        functions_base: Vec::new(),
        tracking: Vec::new(),
        timings: Vec::new(),
        online: Vec::new(),
        errors_in_regressor: Vec::new(),
        settings: settings(),
        figures: Figures::default(),
    };
    let html = bare(&empty);
    let document = parsed(&html);
    assert!(
        document
            .descendants()
            .all(|node| node.tag_name().name() != "figure")
    );
}

#[test]
fn the_csv_contains_every_number_once() -> Result<(), Box<dyn std::error::Error>> {
    let csv = numbers(&identification())?;
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>()?;
    let value = |wanted: [&str; 6]| -> Vec<f64> {
        rows.iter()
            .filter(|row| {
                wanted
                    .iter()
                    .enumerate()
                    .all(|(at, text)| row.get(at) == Some(*text))
            })
            .filter_map(|row| row.get(6)?.parse().ok())
            .collect()
    };
    let of = |name, quantity| ["parameter", "platform", "recommended", "", name, quantity];
    assert_eq!(value(of("m_platformR", "value")), [-1.92]);
    assert_eq!(value(of("m_platformR", "interval_95_high")), [-1.92 * 0.96]);
    assert_eq!(
        value(of(HOSTILE, "correlated_standard_deviation")),
        [0.02 * 0.0445]
    );
    let torque = [
        "cross_validation_torque",
        "actuators",
        "recommended",
        "held out",
        "leg1",
    ];
    let [a, b, c, d, e] = torque;
    assert_eq!(value([a, b, c, d, e, "closure_percent"]), [5.5]);
    assert_eq!(
        value(["tracking", "", "", "held out", "leg1", "pd"]),
        [8e-3]
    );
    Ok(())
}
