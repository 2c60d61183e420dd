//! Identification of the gravity direction, and robots with another gravity.

use crate::{
    calibration::variants::regressor,
    compiled_file::CompiledFile,
    error::{Error, Problem},
    robot::{Robot, served},
};
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    description::Description,
    mechanism::{Mechanism, Number, Ratio},
    model_with,
};
use overact_identification::{Fields, GravityDirection, Log, Settings, gravity_direction};

/// Resolution of an acceleration: 1 m/s² divided by this number.
const DECIMALS: i128 = 1_000_000_000;

impl Robot {
    /// Identifies the gravity direction together with the parameters.
    pub(crate) fn gravity_direction(
        &self,
        runs: &[Log],
        settings: &Settings,
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<GravityDirection, Error> {
        let mechanism = &self.model().model().mechanism;
        if !mechanism.is_tree() {
            let message = "the direction of gravity is not supported for robots with loops";
            return Err(Problem::new(Code::GRAVITY_DIRECTION, message)
                .file(self.file())
                .help("leave `gravity_direction` out, measure the tilt of the base with a level, and write it as `gravity`")
                .into());
        }
        let along = |axis: usize| {
            let mut gravity = [Number::ZERO; 3];
            gravity[axis] = Number::integer(1);
            let field = Mechanism {
                gravity,
                ..mechanism.clone()
            };
            regressor(field).ok_or_else(|| self.without_model())
        };
        let [x, y, z] = [along(0)?, along(1)?, along(2)?];
        let fields = Fields {
            described: mechanism.gravity.map(Number::value),
            along: [&x, &y, &z],
        };
        Ok(gravity_direction(
            self.model(),
            &fields,
            runs,
            settings,
            progress,
        )?)
    }

    /// This robot with another gravity, m/s² in the base frame.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn in_gravity(&self, gravity: [f64; 3]) -> Result<Self, Error> {
        let number = |value: f64| {
            // The cast saturates; a value that large is not a ratio.
            let numerator = (value * DECIMALS as f64).round();
            let ratio = Ratio::new(numerator as i128, DECIMALS).filter(|_| value.is_finite());
            ratio.map(Number::ratio).ok_or_else(|| self.without_model())
        };
        let [x, y, z] = gravity;
        let gravity = [number(x)?, number(y)?, number(z)?];
        let described = self.model().model();
        let mechanism = Mechanism {
            gravity,
            ..described.mechanism.clone()
        };
        let model = model_with(mechanism, &served()).map_err(|_| self.without_model())?;
        Ok(Self::new(CompiledFile {
            file: self.file().to_owned(),
            source: self.source().clone(),
            description: Description {
                gravity,
                ..self.description().clone()
            },
            model,
            warnings: Vec::new(),
        }))
    }

    fn without_model(&self) -> Error {
        let message = "there is no model of this robot for other directions of gravity";
        Problem::new(Code::GRAVITY_DIRECTION, message)
            .file(self.file())
            .into()
    }
}
