//! Table of a robot's functions: names, descriptions, equations, inputs, shapes.

mod condition;
mod table;
mod variants;

pub use condition::Condition;
pub use variants::Function;

use crate::columns::Columns;
use crate::size::{Extent, Input, Sizes};

impl Function {
    /// The name without the input motion; of a frame's function with `frame` for the frame's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// One sentence with the equation of Briot, Krut, Gautier 2015.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        self.entry().summary
    }

    /// The inputs in the order of the arguments.
    ///
    /// For a robot without a platform their names are [`Input::name_without_platform`].
    #[must_use]
    pub const fn inputs(self) -> &'static [Input] {
        self.entry().inputs
    }

    /// Rows and columns of the output, which is row-major; a vector has one column.
    #[must_use]
    pub const fn shape(self, sizes: &Sizes) -> (usize, usize) {
        let entry = self.entry();
        let columns = match entry.columns {
            Some(columns) => sizes.extent(columns),
            None => 1,
        };
        (sizes.extent(entry.rows), columns)
    }

    /// Rows and columns of the output as sizes of the robot; `None` columns for a vector.
    #[must_use]
    pub const fn extents(self) -> (Extent, Option<Extent>) {
        let entry = self.entry();
        (entry.rows, entry.columns)
    }

    /// Whether the output is a vector and not a matrix.
    #[must_use]
    pub const fn is_vector(self) -> bool {
        self.entry().columns.is_none()
    }

    /// Condition for a robot to have the function.
    #[must_use]
    pub const fn condition(self) -> Condition {
        self.entry().condition
    }

    /// Standard or base columns, if the function has columns of parameters.
    #[must_use]
    pub const fn columns(self) -> Option<Columns> {
        match self.entry().columns {
            Some(Extent::Parameters | Extent::PayloadParameters) => Some(Columns::Standard),
            Some(Extent::BaseParameters) => Some(Columns::Base),
            _ => None,
        }
    }

    /// Standard or base parameters, if the function has their values as an input.
    #[must_use]
    pub const fn parameters(self) -> Option<Columns> {
        match self {
            Self::InverseDynamics(columns)
            | Self::MassMatrix(columns)
            | Self::Bias(columns)
            | Self::ForwardDynamics(columns)
            | Self::InverseDynamicsByDisplacement(columns)
            | Self::InverseDynamicsByTwist(columns)
            | Self::ForwardDynamicsByDisplacement(columns)
            | Self::ForwardDynamicsByTwist(columns) => Some(columns),
            Self::InverseDynamicsPreloaded
            | Self::TotalMass
            | Self::CentreOfMass
            | Self::CentreOfMassJacobian
            | Self::KineticEnergy
            | Self::PotentialEnergy => Some(Columns::Standard),
            _ => None,
        }
    }

    /// Whether the function uses base parameters, as columns or as an input.
    #[must_use]
    pub const fn is_of_base_parameters(self) -> bool {
        let of = match self.columns() {
            None => self.parameters(),
            columns => columns,
        };
        matches!(of, Some(Columns::Base))
    }
}
