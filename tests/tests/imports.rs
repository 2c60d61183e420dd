//! Imports follow the order of modules in each crate, from top to bottom.
//!
//! Within each folder, imports between files have no cycles.

use overact_tests::support::imports::{Module, modules};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::{Mutex, PoisonError},
};

/// Order of modules in a crate or a module, from the bottom up.
struct LayerOrder {
    folder: &'static str,
    /// The module; empty for the crate itself.
    module: &'static str,
    order: &'static [&'static str],
}

const LAYER_ORDERS: [LayerOrder; 10] = [
    LayerOrder {
        folder: "description",
        module: "",
        order: &[
            "diagnostic",
            "effort",
            "expressions",
            "toml_text",
            "robot",
            "experiments",
            "document",
            "root",
            "parameters_file",
        ],
    },
    LayerOrder {
        folder: "codegen",
        module: "",
        order: &[
            "parallel",
            "float",
            "runtime",
            "cas",
            "mechanism",
            "derivation",
            "lowering",
            "interpreter",
            "selection",
            "model",
            "total_cost",
            "choice",
            "request",
            "checked",
            "compile",
            "backends",
            "internals",
        ],
    },
    LayerOrder {
        folder: "codegen",
        module: "derivation",
        order: &[
            "motion_input",
            "function_form",
            "guard",
            "parameter",
            "selection",
            "derivation_error",
            "names",
            "linear_algebra",
            "kinematics",
            "closure",
            "bodies",
            "robot",
            "context",
            "dynamics",
            "regressor",
            "frames",
            "derivatives",
            "forward",
            "functions",
        ],
    },
    LayerOrder {
        folder: "logs",
        module: "",
        order: &[
            "error",
            "problems",
            "significant",
            "display_names",
            "samples",
            "bytes",
            "formats",
            "mapping",
            "unwrapping",
            "resampling",
            "period_sums",
            "run",
            "periods",
            "monitor",
            "read",
        ],
    },
    LayerOrder {
        folder: "identification",
        module: "",
        order: &[
            "with_avx",
            "units",
            "blocks",
            "thresholds",
            "series",
            "filters",
            "gear_friction",
            "prior",
            "online_settings",
            "settings",
            "kinematics",
            "regression",
            "estimation",
            "calibration",
            "gains",
            "gravity",
            "validation",
            "result",
            "online",
            "consistent",
            "assessment",
            "identify",
            "factors",
        ],
    },
    LayerOrder {
        folder: "simulation",
        module: "",
        order: &[
            "error",
            "trajectory",
            "drives",
            "experiment",
            "drivetrain",
            "controller",
            "reference",
            "validation",
            "plant",
            "sensors",
            "run",
            "fleet",
            "cascade",
            "log",
        ],
    },
    LayerOrder {
        folder: "report",
        module: "",
        order: &[
            "text",
            "units",
            "choice",
            "intervals",
            "published",
            "judgement",
            "layout",
            "line_errors",
            "online",
            "terminal",
            "parameters_file",
            "summary",
            "published_comparison",
            "numbers",
            "plot",
            "chart_sheet",
            "page",
            "report_bundle",
        ],
    },
    LayerOrder {
        folder: "robot",
        module: "",
        order: &[
            "counted",
            "drawing",
            "error",
            "names",
            "compiled_file",
            "parameters",
            "interpreted",
            "robot",
            "configuration",
            "experiment",
            "check",
            "import",
            "calibration",
            "excitation",
            "serial",
            "identification",
            "inspection",
        ],
    },
    LayerOrder {
        folder: "interchange",
        module: "",
        order: &[
            "options",
            "format",
            "account",
            "listing",
            "files",
            "xml",
            "prune",
            "geometry",
            "model",
            "bounds",
            "origins",
            "couplings",
            "motors",
            "choices",
            "unsupported",
            "assembly",
            "frames",
            "plan",
            "urdf",
            "mjcf",
            "par",
            "sdf",
            "experiment",
            "writing",
            "import",
            "export",
            "serial",
            "agreement",
        ],
    },
    LayerOrder {
        folder: "cli",
        module: "",
        order: &[
            "failure",
            "names",
            "signals",
            "note",
            "progress",
            "stopwatch",
            "input",
            "output",
            "effort",
            "function_options",
            "functions",
            "states",
            "report",
            "measurements",
            "commands",
            "guarded",
        ],
    },
];

/// Files of a crate, parsed once for all tests.
fn crate_of(folder: &'static str) -> &'static [Module] {
    static ALL: Mutex<BTreeMap<&str, &[Module]>> = Mutex::new(BTreeMap::new());
    let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
    all.entry(folder).or_insert_with(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        modules(&root.join(folder).join("src")).leak()
    })
}

impl LayerOrder {
    /// Layer of a path; `None` if it does not lead into the ordered module.
    fn layer<'p>(&self, path: &'p [String]) -> Option<&'p String> {
        if self.module.is_empty() {
            return path.first();
        }
        path.get(1).filter(|_| path[0] == self.module)
    }

    /// Imports of a file that violate the order.
    fn violations(&self, file: &Module) -> Vec<String> {
        let place = |name: &str| self.order.iter().position(|known| *known == name);
        let Some(own) = self.layer(&file.path) else {
            return Vec::new();
        };
        let name = file.path.join("/");
        let Some(floor) = place(own) else {
            return vec![format!(
                "`{own}` has no place in the order of {}",
                self.folder
            )];
        };
        let imported = file.imports.iter().filter_map(|path| self.layer(path));
        let imported: BTreeSet<&String> = imported.collect();
        let violation = |layer: &String| match place(layer) {
            Some(other) if other <= floor => None,
            Some(_) => Some(format!("{name} imports up, from `{layer}`")),
            None => Some(format!(
                "{name} imports `{layer}`, which is no module, from the root of the order"
            )),
        };
        imported.into_iter().filter_map(violation).collect()
    }
}

/// Files of each folder that import from each other in a cycle.
fn circles(modules: &[Module]) -> Vec<(String, BTreeSet<String>)> {
    let known: BTreeSet<&[String]> = modules.iter().map(|m| m.path.as_slice()).collect();
    let mut folders: BTreeMap<String, BTreeMap<&str, BTreeSet<&str>>> = BTreeMap::new();
    for module in modules {
        for import in &module.imports {
            let lengths = (1..=import.len()).rev();
            let target = lengths
                .map(|length| &import[..length])
                .find(|path| known.contains(path));
            let Some(target) = target else { continue };
            let pairs = module.path.iter().zip(target);
            let shared = pairs.take_while(|(own, other)| own == other).count();
            if let (Some(own), Some(other)) = (module.path.get(shared), target.get(shared)) {
                let folder = folders.entry(module.path[..shared].join("/")).or_default();
                folder.entry(own).or_default().insert(other);
            }
        }
    }
    let circle = |(folder, mut imports): (String, BTreeMap<&str, BTreeSet<&str>>)| {
        // Files without remaining imports or importers are in no cycle.
        loop {
            let sources: BTreeSet<&str> = imports.keys().copied().collect();
            let targets: BTreeSet<&str> = imports.values().flatten().copied().collect();
            let before = imports.len() + imports.values().map(BTreeSet::len).sum::<usize>();
            imports.retain(|source, _| targets.contains(source));
            for targets in imports.values_mut() {
                targets.retain(|target| sources.contains(target));
            }
            imports.retain(|_, targets| !targets.is_empty());
            let after = imports.len() + imports.values().map(BTreeSet::len).sum::<usize>();
            if before == after {
                break;
            }
        }
        let files: BTreeSet<String> = imports.keys().map(|file| (*file).to_owned()).collect();
        (folder, files)
    };
    let found = folders.into_iter().map(circle);
    found.filter(|(_, files)| !files.is_empty()).collect()
}

#[test]
fn imports_follow_the_layer_order() {
    let mut all = Vec::new();
    for layers in &LAYER_ORDERS {
        let mut seen = BTreeSet::new();
        for file in crate_of(layers.folder) {
            seen.extend(layers.layer(&file.path).cloned());
            let violations = layers.violations(file).into_iter();
            all.extend(violations.map(|one| format!("{}: {one}", layers.folder)));
        }
        let missing = layers
            .order
            .iter()
            .filter(|module| !seen.contains(**module));
        all.extend(missing.map(|module| format!("{}: there is no `{module}`", layers.folder)));
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn no_folder_has_cyclic_imports() {
    const OTHERS: [&str; 4] = ["core", "runtime", "macros", "xtask"];
    let mut left = BTreeMap::new();
    let folders = LAYER_ORDERS
        .iter()
        .map(|layers| layers.folder)
        .chain(OTHERS);
    for folder in folders {
        for (inside, files) in circles(crate_of(folder)) {
            left.insert(format!("{folder}/{inside}"), files);
        }
    }
    assert_eq!(left, BTreeMap::new());
}

#[test]
fn an_import_from_a_higher_layer_is_detected() {
    let layers = LayerOrder {
        folder: "crate",
        module: "",
        order: &["low", "high"],
    };
    let violation_count = |text: &str, file: &[&str]| {
        let file = Module::of(file, text, &BTreeMap::new());
        layers.violations(&file).len()
    };
    assert_eq!(
        violation_count("use crate::{low::A, high::B};", &["high"]),
        0
    );
    assert_eq!(
        violation_count("use crate::{low::A, high::B};", &["low"]),
        1
    );
    assert_eq!(violation_count("fn a() { super::high::b(); }", &["low"]), 1);
    assert_eq!(
        violation_count("use super::super::high;", &["low", "room"]),
        1
    );
    assert_eq!(violation_count("use super::high;", &["low", "room"]), 0);
    assert_eq!(violation_count("use crate::Thing;", &["high"]), 1);
    assert_eq!(
        violation_count("// crate::high\npub(crate) fn a() {}", &["low"]),
        0
    );
    assert_eq!(
        violation_count("#[cfg(test)] mod tests { use crate::high; }", &["low"]),
        0
    );
    assert_eq!(violation_count("", &["attic"]), 1);
}

#[test]
fn an_import_from_a_higher_layer_of_a_module_is_detected() {
    let layers = LayerOrder {
        folder: "crate",
        module: "room",
        order: &["low", "high"],
    };
    let violation_count = |text: &str, file: &[&str]| {
        let file = Module::of(file, text, &BTreeMap::new());
        layers.violations(&file).len()
    };
    assert_eq!(
        violation_count("use crate::room::low::A;", &["room", "high"]),
        0
    );
    assert_eq!(violation_count("use super::high::A;", &["room", "low"]), 1);
    assert_eq!(violation_count("use super::high;", &["room"]), 0);
    assert_eq!(violation_count("use crate::room::high::A;", &["other"]), 0);
}

#[test]
fn an_import_cycle_through_a_reexport_is_detected() {
    let files = |first: &str| {
        let reexports = BTreeMap::from([(
            vec!["room".to_owned(), "Thing".to_owned()],
            vec!["room".to_owned(), "b".to_owned(), "Thing".to_owned()],
        )]);
        let module = |path: &[&str], text: &str| Module::of(path, text, &reexports);
        circles(&[
            module(&["room"], "pub use b::Thing;"),
            module(&["room", "a"], first),
            module(&["room", "b"], "use super::c::d;"),
            module(&["room", "c"], "pub fn d() { super::a::f() }"),
            module(&["room", "e"], "use super::a;"),
        ])
    };
    assert!(files("").is_empty());
    let found = files("use super::Thing;");
    let circle = ["a", "b", "c"].map(str::to_owned).into();
    assert_eq!(found, [("room".to_owned(), circle)]);
}
