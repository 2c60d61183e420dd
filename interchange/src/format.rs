//! Formats of robots' files.

/// The format of a robot's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// That of MuJoCo.
    Mjcf,
    /// That of ROS.
    Urdf,
    /// That of OpenSYMORO.
    Par,
    /// That of Gazebo.
    Sdf,
}
