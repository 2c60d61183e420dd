//! Cargo metadata of the workspace's packages and their dependencies.

use crate::Failure;
use crate::files::repository;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A package of the workspace or a dependency.
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) version: String,
    /// Licence expression of its manifest.
    pub(crate) licence: Option<String>,
    /// Minimum Rust version.
    pub(crate) rust_version: Option<String>,
    /// Whether it belongs to the workspace.
    pub(crate) is_member: bool,
    /// Whether it is published.
    pub(crate) is_published: bool,
    pub(crate) description: Option<String>,
    /// Items that its archive or the registry's page lacks.
    pub(crate) lacks: Vec<&'static str>,
    /// What the registry shows of it.
    pub(crate) page: Page,
    /// Version requirements on packages of the workspace by name, except development dependencies.
    pub(crate) siblings: Vec<(String, String)>,
}

/// A package's page in the registry.
pub(crate) struct Page {
    pub(crate) keywords: Vec<String>,
    pub(crate) categories: Vec<String>,
    /// Path of its text, from the package's folder.
    pub(crate) readme: Option<String>,
    /// Whether the manifest has settings for docs.rs.
    pub(crate) has_docs_rs_settings: bool,
}

#[cfg(test)]
impl Package {
    /// A sound package of version 1.2.0.
    pub(crate) fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            version: "1.2.0".to_owned(),
            licence: Some("MIT".to_owned()),
            rust_version: Some("1.89".to_owned()),
            is_member: true,
            is_published: true,
            description: Some("a package".to_owned()),
            lacks: Vec::new(),
            page: Page {
                keywords: vec!["robotics".to_owned()],
                categories: vec!["science::robotics".to_owned()],
                readme: Some("README.md".to_owned()),
                has_docs_rs_settings: true,
            },
            siblings: Vec::new(),
        }
    }
}

/// The cargo that runs this task.
pub(crate) fn cargo_command() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs cargo and returns its standard output.
pub(crate) fn cargo(arguments: &[&str]) -> Result<String, Failure> {
    let mut command = cargo_command();
    command.args(arguments).current_dir(repository(""));
    let output = command.stderr(std::process::Stdio::inherit()).output()?;
    if !output.status.success() {
        return Err(format!("`cargo {}` failed", arguments.join(" ")).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// Cargo's target folder.
pub(crate) fn target() -> Result<PathBuf, Failure> {
    let text = cargo(&["metadata", "--format-version", "1", "--no-deps"])?;
    let document: Value = serde_json::from_str(&text)?;
    let folder = document["target_directory"].as_str();
    Ok(folder.ok_or("cargo names no target folder")?.into())
}

/// All packages, each once.
pub(crate) fn packages() -> Result<Vec<Package>, Failure> {
    let text = cargo(&["metadata", "--format-version", "1", "--locked"])?;
    let document: Value = serde_json::from_str(&text)?;
    let members = list(&document["workspace_members"]);
    let packages = list(&document["packages"]).iter();
    Ok(packages.map(|one| package(one, members)).collect())
}

fn package(one: &Value, members: &[Value]) -> Package {
    let text = |key: &str| one[key].as_str().map(str::to_owned);
    let siblings = list(&one["dependencies"]).iter().filter_map(|dependency| {
        let is_kept = dependency["path"].is_string() && dependency["kind"] != "dev";
        let name = dependency["name"].as_str()?.to_owned();
        is_kept.then(|| {
            (
                name,
                dependency["req"].as_str().unwrap_or_default().to_owned(),
            )
        })
    });
    Package {
        name: text("name").unwrap_or_default(),
        version: text("version").unwrap_or_default(),
        licence: text("license"),
        rust_version: text("rust_version"),
        is_member: members.contains(&one["id"]),
        is_published: one["publish"].is_null(),
        description: text("description"),
        lacks: lacks(one),
        page: Page {
            keywords: texts(&one["keywords"]),
            categories: texts(&one["categories"]),
            readme: text("readme"),
            has_docs_rs_settings: one["metadata"]["docs"]["rs"].is_object(),
        },
        siblings: siblings.collect(),
    }
}

/// Items of a package that a registry shows or its archive needs, but that are missing.
fn lacks(one: &Value) -> Vec<&'static str> {
    let keys = ["documentation", "readme", "repository"].into_iter();
    let keys = keys.filter(|key| one[*key].is_null());
    let folder = Path::new(one["manifest_path"].as_str().unwrap_or_default()).parent();
    let has = |file: &str| folder.is_some_and(|folder| folder.join(file).is_file());
    let files = ["LICENSE-APACHE", "LICENSE-MIT"].into_iter();
    keys.chain(files.filter(|file| !has(file))).collect()
}

/// Names of the workspace's libraries without documentation examples.
pub(crate) fn without_examples() -> Result<Vec<String>, Failure> {
    let text = cargo(&["metadata", "--format-version", "1", "--no-deps"])?;
    let document: Value = serde_json::from_str(&text)?;
    let is_silent = |package: &&Value| {
        let libraries = list(&package["targets"]).iter().filter(|target| {
            let kinds = list(&target["kind"]);
            kinds
                .iter()
                .any(|kind| kind == "lib" || kind == "proc-macro")
        });
        libraries.clone().count() > 0 && libraries.clone().all(|one| one["doctest"] == false)
    };
    let silent = list(&document["packages"]).iter().filter(is_silent);
    let names = silent.filter_map(|package| package["name"].as_str().map(str::to_owned));
    Ok(names.collect())
}

/// Texts of a list in a document.
fn texts(value: &Value) -> Vec<String> {
    let texts = list(value).iter().filter_map(Value::as_str);
    texts.map(str::to_owned).collect()
}

/// List in a document; empty if absent.
pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}
