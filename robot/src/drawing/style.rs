//! Colours for light and dark mode.

/// Colours of a leg's bodies, alternating: two for light mode, two for dark mode.
const LEGS: [[&str; 4]; 8] = [
    ["#2563eb", "#6ea8fe", "#3b82f6", "#93c5fd"],
    ["#d9480f", "#ff9a5c", "#ea6a1f", "#fdba74"],
    ["#08875f", "#42c796", "#12a374", "#6ee7b7"],
    ["#7c3aed", "#b197fc", "#8b5cf6", "#c4b5fd"],
    ["#c2255c", "#f783ac", "#db3a76", "#f9a8d4"],
    ["#0c7c96", "#3fc1d9", "#1798b5", "#7ddff0"],
    ["#946200", "#d6a53a", "#b07d15", "#eccb7a"],
    ["#475569", "#94a3b8", "#64748b", "#b6c2d2"],
];

/// Number of leg colours; further legs repeat them.
pub(super) const COLOURS: usize = LEGS.len();

/// Rules that do not depend on the leg: class, light declarations, dark declarations.
const FIXED: [(&str, &str, &str); 13] = [
    ("sheet", "fill:#ffffff", "fill:#10151d"),
    ("case", "stroke:#ffffff;fill:none", "stroke:#10151d"),
    (
        "name",
        "fill:#0f172a;font-size:19px;font-weight:650",
        "fill:#f1f5f9",
    ),
    ("text", "fill:#475569;font-size:13.5px", "fill:#a9b6c8"),
    ("tag", "font-size:13.5px;font-weight:600", ""),
    (
        "motor",
        "fill:#ffffff;font-size:12.5px;font-weight:700;stroke:none",
        "",
    ),
    (
        "ink",
        "stroke:#1e293b;fill:#ffffff",
        "stroke:#e2e8f0;fill:#10151d",
    ),
    ("rail", "stroke:#94a3b8;fill:none", "stroke:#5b6a80"),
    (
        "base",
        "stroke:#94a3b8;fill:#94a3b8;fill-opacity:.2",
        "stroke:#64748b;fill:#94a3b8;fill-opacity:.16",
    ),
    (
        "plate",
        "stroke:#334155;fill:#64748b;fill-opacity:.3",
        "stroke:#cbd5e1;fill:#94a3b8;fill-opacity:.32",
    ),
    (
        "globe",
        "stroke:#cbd5e1;fill:#e2e8f0;fill-opacity:.35",
        "stroke:#334155;fill:#1e293b;fill-opacity:.45",
    ),
    ("axis", "stroke:#0f172a;fill:none", "stroke:#f1f5f9"),
    (
        "letter",
        "fill:#0f172a;font-size:12.5px;font-style:italic",
        "fill:#f1f5f9",
    ),
];

/// The style sheet.
pub(super) fn css() -> String {
    let (mut light, mut dark) = (String::new(), String::new());
    for (name, bright, dim) in FIXED {
        light.push_str(&format!(".ov-{name}{{{bright}}}"));
        if !dim.is_empty() {
            dark.push_str(&format!(".ov-{name}{{{dim}}}"));
        }
    }
    for (leg, [first, next, dark_first, dark_next]) in LEGS.iter().enumerate() {
        light.push_str(&leg_rules(leg, first, next));
        // Names use the brighter dark colour to be legible on the sheet.
        light.push_str(&format!(".ov-n{leg}{{fill:{first}}}"));
        dark.push_str(&leg_rules(leg, dark_first, dark_next));
        dark.push_str(&format!(".ov-n{leg}{{fill:{dark_next}}}"));
    }
    format!(
        ".ov-drawing{{font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif}}\
         {light}@media(prefers-color-scheme:dark){{{dark}}}"
    )
}

/// Stroke and fill rules of a leg's two colours.
fn leg_rules(leg: usize, first: &str, next: &str) -> String {
    format!(
        ".ov-a{leg}{{stroke:{first};fill:none}}.ov-b{leg}{{stroke:{next};fill:none}}\
         .ov-f{leg}{{fill:{first}}}.ov-g{leg}{{fill:{next}}}"
    )
}
