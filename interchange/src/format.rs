//! File formats of robots.

/// File format of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// MuJoCo's format.
    Mjcf,
    /// The format of ROS.
    Urdf,
    /// OpenSYMORO's format.
    Par,
    /// SDFormat, used by Gazebo.
    Sdf,
}
