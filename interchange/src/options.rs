//! What a user decides in the place of the importer.

/// Choices that overrule those of the importer.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Name of the robot; that of the file's model where there is none.
    pub name: Option<String>,
    /// The model that is meant, where a world has several.
    pub model: Option<String>,
    /// Whether a base that floats is fixed where it stands.
    pub fix_base: bool,
    /// The driven joints, in the place of those that the file names.
    pub actuated: Option<Vec<String>>,
    /// Joints that shall be the independent coordinates.
    pub coordinates: Option<Vec<String>>,
    /// Values of symbols in the file, lengths in m and angles in rad.
    pub values: Vec<(String, f64)>,
    /// Positions of joints where the search for a closed home configuration starts, rad or m.
    pub home: Vec<(String, f64)>,
}
