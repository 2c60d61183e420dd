//! Descriptions that a query knows by robot name.
//!
//! Each process of a distributed query reads them itself. Factors contain a hash of their
//! description, so that two versions never mix.

use overact::Model;
use overact_robot::Robot;
use std::{
    collections::BTreeMap,
    fmt,
    hash::{Hash, Hasher},
    path::PathBuf,
    sync::Arc,
};

/// Robots by name.
#[derive(Clone, Default)]
pub struct Robots(Arc<BTreeMap<String, Robot>>);

impl Robots {
    /// Reads descriptions.
    ///
    /// # Errors
    /// All errors of the descriptions, and repeated names.
    pub fn read(files: &[PathBuf]) -> Result<Self, String> {
        let (mut robots, mut problems) = (BTreeMap::new(), Vec::new());
        for file in files {
            match Robot::from_toml(file) {
                Ok(robot) => {
                    let name = robot.model().info().name.to_owned();
                    if robots.insert(name.clone(), robot).is_some() {
                        problems.push(format!(
                            "{}: another description also has the name `{name}`",
                            file.display()
                        ));
                    }
                }
                Err(error) => problems.push(error.to_string()),
            }
        }
        if problems.is_empty() {
            Ok(Self(Arc::new(robots)))
        } else {
            Err(problems.join("\n"))
        }
    }

    /// Robot with a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Robot> {
        self.0.get(name)
    }

    /// All names.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

impl PartialEq for Robots {
    fn eq(&self, other: &Self) -> bool {
        self.names().eq(other.names())
    }
}

impl Eq for Robots {}

impl Hash for Robots {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.names().for_each(|name| name.hash(state));
    }
}

impl fmt::Debug for Robots {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}
