//! `factor(robot, columns)`: the rows of a log as its factor.
//!
//! A run is filtered as a whole, so all its rows are kept until the last has come: 80 kB of 10 s at 200 Hz. They come
//! in any order, and are put in that of their time. A row that is there twice counts once.

use crate::robots::Robots;
use arrow::{
    array::{Array, ArrayRef, AsArray, BinaryArray, StringArray, StructArray, UInt64Array},
    compute::cast,
    datatypes::{DataType, Field, FieldRef, Fields, Float64Type},
};
use datafusion::{
    error::{DataFusionError, Result},
    logical_expr::{
        Accumulator, AggregateUDFImpl, Signature, Volatility,
        function::{AccumulatorArgs, StateFieldsArgs},
    },
    scalar::ScalarValue,
};
use overact_identification::data::{Array as Column, Time};
use std::sync::Arc;

/// Numbers of a run, at most: 512 MB.
const MOST: usize = 1 << 26;

/// The aggregate.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct FactorOfLog {
    signature: Signature,
    robots: Robots,
}

impl FactorOfLog {
    pub(super) fn new(robots: Robots) -> Self {
        Self {
            signature: Signature::user_defined(Volatility::Immutable),
            robots,
        }
    }
}

fn of_result() -> Fields {
    [
        Field::new("factor", DataType::Binary, true),
        Field::new("samples", DataType::UInt64, true),
        Field::new("problem", DataType::Utf8, true),
    ]
    .into_iter()
    .collect()
}

impl AggregateUDFImpl for FactorOfLog {
    fn name(&self) -> &str {
        "factor"
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        match given {
            [
                DataType::Utf8 | DataType::Utf8View | DataType::LargeUtf8,
                DataType::Struct(fields),
            ] => {
                let numbers = fields
                    .iter()
                    .map(|own| Field::new(own.name(), DataType::Float64, true));
                Ok(vec![DataType::Utf8, DataType::Struct(numbers.collect())])
            }
            _ => Err(DataFusionError::Plan(
                "`factor` takes the name of a robot and the columns of its logs: \
                 `factor('FiveBar', named_struct('time', time, 'q_left', q_left, …))`"
                    .to_owned(),
            )),
        }
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(DataType::Struct(of_result()))
    }

    fn state_fields(&self, args: StateFieldsArgs<'_>) -> Result<Vec<FieldRef>> {
        let state =
            |name: &str, kind| Arc::new(Field::new(format!("{}[{name}]", args.name), kind, true));
        Ok(vec![
            state("robot", DataType::Utf8),
            state("columns", DataType::Utf8),
            state("rows", DataType::Binary),
        ])
    }

    fn accumulator(&self, _: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        Ok(Box::new(Rows {
            robots: self.robots.clone(),
            robot: String::new(),
            columns: Vec::new(),
            values: Vec::new(),
        }))
    }
}

/// The rows of a run.
#[derive(Debug)]
struct Rows {
    robots: Robots,
    robot: String,
    columns: Vec<String>,
    /// Row after row.
    values: Vec<f64>,
}

impl Rows {
    fn check(&mut self, robot: &str, columns: &[String]) -> Result<()> {
        if self.columns.is_empty() {
            robot.clone_into(&mut self.robot);
            self.columns = columns.to_vec();
        }
        let message = if robot != self.robot || columns != self.columns {
            "`factor` has rows of several robots in a group: group by them"
        } else if self.values.len() > MOST {
            "`factor` has more than 67 million numbers in a group: group by run"
        } else {
            return Ok(());
        };
        Err(DataFusionError::Execution(message.to_owned()))
    }

    /// The factors, or why there are none.
    fn factors(&self) -> Result<Vec<u8>, String> {
        let robot = self.robots.get(&self.robot).ok_or_else(|| {
            let known: Vec<&str> = self.robots.names().collect();
            format!(
                "no robot has the name `{}`; known are {known:?}",
                self.robot
            )
        })?;
        let Time::Column(time) = robot.mapping().time else {
            return Err(
                "the description has no column of time, by which rows could be put in order"
                    .to_owned(),
            );
        };
        let place = self.columns.iter().position(|own| *own == time);
        let place = place.ok_or_else(|| format!("there is no column `{time}`"))?;
        let width = self.columns.len();
        let mut rows: Vec<&[f64]> = self.values.chunks_exact(width).collect();
        rows.sort_by(|a, b| a[place].total_cmp(&b[place]));
        rows.dedup();
        let columns: Vec<Vec<f64>> = (0..width)
            .map(|column| rows.iter().map(|row| row[column]).collect())
            .collect();
        let named: Vec<Column<'_>> = self
            .columns
            .iter()
            .zip(&columns)
            .map(|(name, values)| Column {
                name,
                shape: (values.len(), 1),
                values,
            })
            .collect();
        let told = |error: &dyn std::fmt::Display| error.to_string();
        let log = robot
            .log_of_arrays("the run", &named, false)
            .map_err(|error| told(&error))?;
        let settings = robot.settings(log.sampling_frequency());
        let factory = robot.factory(&settings).map_err(|error| told(&error))?;
        let run = factory.run(&log, "", None).map_err(|error| told(&error))?;
        Ok(run
            .records()
            .iter()
            .flat_map(overact_identification::factors::Record::to_bytes)
            .collect())
    }
}

impl Accumulator for Rows {
    fn update_batch(&mut self, values: &[ArrayRef]) -> Result<()> {
        let rows = values[1].as_struct();
        if rows.is_empty() {
            return Ok(());
        }
        let columns: Vec<String> = rows
            .column_names()
            .iter()
            .map(|name| (*name).to_owned())
            .collect();
        let robots = values[0].as_string::<i32>();
        let first = robots.value(0).to_owned();
        if robots.iter().any(|own| own != Some(first.as_str())) {
            self.check("", &columns)?;
        }
        self.check(&first, &columns)?;
        let numbers = rows
            .columns()
            .iter()
            .map(|column| cast(column, &DataType::Float64));
        let numbers = numbers.collect::<std::result::Result<Vec<_>, _>>()?;
        let numbers: Vec<_> = numbers
            .iter()
            .map(|own| own.as_primitive::<Float64Type>())
            .collect();
        for row in 0..rows.len() {
            // A number that is not there is none, and told as such with the log.
            let value = |own: &&arrow::array::Float64Array| match own.is_valid(row) {
                true => own.value(row),
                false => f64::NAN,
            };
            self.values.extend(numbers.iter().map(value));
        }
        Ok(())
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        let (robots, names) = (states[0].as_string::<i32>(), states[1].as_string::<i32>());
        let rows = states[2].as_binary::<i32>();
        for at in (0..rows.len()).filter(|at| !rows.value(*at).is_empty()) {
            let columns: Vec<String> = names.value(at).split('\n').map(str::to_owned).collect();
            self.check(robots.value(at), &columns)?;
            let (numbers, _) = rows.value(at).as_chunks::<8>();
            self.values
                .extend(numbers.iter().map(|own| f64::from_le_bytes(*own)));
        }
        Ok(())
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        let rows = self
            .values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect();
        Ok(vec![
            ScalarValue::Utf8(Some(self.robot.clone())),
            ScalarValue::Utf8(Some(self.columns.join("\n"))),
            ScalarValue::Binary(Some(rows)),
        ])
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        let made = self.factors();
        let samples = (self.values.len() / self.columns.len().max(1)) as u64;
        let columns: Vec<ArrayRef> = vec![
            Arc::new(BinaryArray::from(vec![made.as_deref().ok()])),
            Arc::new(UInt64Array::from(vec![samples])),
            Arc::new(StringArray::from(vec![
                made.as_ref().err().map(String::as_str),
            ])),
        ];
        Ok(ScalarValue::Struct(Arc::new(StructArray::new(
            of_result(),
            columns,
            None,
        ))))
    }

    fn size(&self) -> usize {
        size_of::<Self>() + 8 * self.values.capacity()
    }
}
