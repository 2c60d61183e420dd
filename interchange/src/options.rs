//! User choices that override those of the importer.

/// Choices that override those of the importer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Name of the robot; by default the name of the file's model.
    pub name: Option<String>,
    /// Model to import from a world with several models.
    pub model: Option<String>,
    /// Whether a floating base is fixed at its pose in the file.
    pub fix_base: bool,
    /// Actuated joints, instead of those of the file.
    pub actuated: Option<Vec<String>>,
    /// Joints to use as independent coordinates.
    pub coordinates: Option<Vec<String>>,
    /// Values of the file's symbols; lengths in m, angles in rad.
    pub values: Vec<(String, f64)>,
    /// Start positions for the search of a closed home configuration, rad or m.
    pub home: Vec<(String, f64)>,
    /// Whether includes and meshes of MJCF files may be outside their folder.
    pub include_outside: bool,
    /// Largest misfit of a closure, in rad and as a fraction of the loops' size; by default 2e-3.
    pub closure_tolerance: Option<f64>,
}
