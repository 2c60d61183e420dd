//! The pages `docs/import-*.md`: the tables of the formats as they are in the code.
//!
//! `OVERACT_BLESS=1 cargo test -p overact-interchange --lib pages` writes them.

use crate::account::{MJCF, PAR, Rule, SDF, Table, Treatment, URDF, YAML};
use std::{fmt::Write as _, fs, path::Path};

/// A page: its file, title, introduction and tables with their headings.
struct Page {
    file: &'static str,
    title: &'static str,
    introduction: &'static str,
    tables: &'static [(&'static str, &'static Table)],
}

const PAGES: [Page; 4] = [
    Page {
        file: "import-mjcf.md",
        title: "Elements of MJCF",
        introduction: "The table covers MuJoCo's XML reference, up to version 4.0.",
        tables: &[("", &MJCF)],
    },
    Page {
        file: "import-urdf.md",
        title: "Elements of URDF",
        introduction: "The tables cover urdfdom, the notations of loops, the extensions of Gazebo, ROS 2 control, Drake and \
                       MuJoCo, and the YAML file next to a URDF.",
        tables: &[("Elements", &URDF), ("Keys of the YAML file", &YAML)],
    },
    Page {
        file: "import-sdf.md",
        title: "Elements of SDFormat",
        introduction: "The table covers SDFormat 1.4 to 1.12 and extensions of Drake.",
        tables: &[("", &SDF)],
    },
    Page {
        file: "import-par.md",
        title: "Keys of .par files",
        introduction: "The table covers the keys of OpenSYMORO.",
        tables: &[("", &PAR)],
    },
];

impl Page {
    fn text(&self) -> String {
        let mut text = format!("# {}\n\n", self.title);
        let _ = writeln!(
            text,
            "How [`overact import`](import.md) treats each element and attribute. {} Names that are not listed are \
             reported. Contents of ignored elements are ignored, too.",
            self.introduction
        );
        for (heading, table) in self.tables {
            if !heading.is_empty() {
                let _ = write!(text, "\n## {heading}\n");
            }
            text.push_str("\n| element | in | attributes | treatment |\n|---|---|---|---|\n");
            for rule in table.rules {
                rows(&mut text, rule);
            }
        }
        text
    }
}

/// One row for the elements of a rule, and one for each group of attributes.
fn rows(text: &mut String, rule: &Rule) {
    let (elements, own) = (code(rule.elements), treatment(rule.treatment));
    let parents = match rule.within {
        "" => "the file".to_owned(),
        names => code(names),
    };
    let _ = writeln!(text, "| {elements} | {parents} | | {own} |");
    for (names, own) in rule.attributes {
        let _ = writeln!(text, "| | | {} | {} |", code(names), treatment(*own));
    }
}

/// Names as code.
fn code(names: &str) -> String {
    let names: Vec<String> = names
        .split_whitespace()
        .map(|name| format!("`{name}`"))
        .collect();
    names.join(" ")
}

fn treatment(of: Treatment) -> String {
    let unless = |neutral: &str| match neutral {
        "" => String::new(),
        "identity" | "usual gravity" => format!(" unless it is the {neutral}"),
        words => format!(" unless {}", code(words)),
    };
    let text = match of {
        Treatment::Honoured => "honoured".to_owned(),
        Treatment::Opaque => "honoured, without its contents".to_owned(),
        Treatment::Container => "as its contents".to_owned(),
        Treatment::Irrelevant(reason) => format!("ignored: {reason}"),
        Treatment::Reported { neutral, reason } => {
            format!("reported{}: {reason}", unless(neutral))
        }
        Treatment::Rejected {
            neutral, reason, ..
        } => format!("rejected{}: {reason}", unless(neutral)),
    };
    text.replace('<', "&lt;")
}

#[test]
fn format_pages_are_fresh() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let is_blessed = std::env::var_os("OVERACT_BLESS").is_some();
    for page in &PAGES {
        let (path, expected) = (folder.join(page.file), page.text());
        if is_blessed {
            fs::write(&path, expected).expect("a page");
            continue;
        }
        let found = fs::read_to_string(&path).unwrap_or_default();
        assert!(
            found == expected,
            "docs/{} differs from the table; OVERACT_BLESS=1 writes it:\n{expected}",
            page.file
        );
    }
}
