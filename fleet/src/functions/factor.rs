//! `factor(robot, columns [, carried])`: aggregates the rows of a log to its R factors.
//!
//! `carried` is `false`, `true`, or the name of a payload if the description has several.
//!
//! A run is filtered as a whole, so all its rows are kept until the last one: 80 kB for 10 s at 200
//! Hz. Rows may come in any order and are sorted by time. Duplicate rows count once.

use crate::robots::Robots;
use arrow::{
    array::{Array, ArrayRef, AsArray, LargeBinaryArray, StringArray, StructArray, UInt64Array},
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
use overact::Model;
use overact_identification::Log;
use overact_logs::{Array as Column, Time, carried_payloads};
use overact_robot::Robot;
use std::sync::Arc;

/// Largest number of values of a run: 512 MB.
const MOST: usize = 1 << 26;

/// The aggregate function.
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
        Field::new("factor", DataType::LargeBinary, true),
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
        use DataType::{Boolean, LargeUtf8, Null, Utf8, Utf8View};
        let numbers = |fields: &Fields| {
            let all = fields.iter();
            DataType::Struct(
                all.map(|own| Field::new(own.name(), DataType::Float64, true))
                    .collect(),
            )
        };
        match given {
            [Utf8 | Utf8View | LargeUtf8, DataType::Struct(fields)] => {
                Ok(vec![Utf8, numbers(fields)])
            }
            [
                Utf8 | Utf8View | LargeUtf8,
                DataType::Struct(fields),
                Boolean | Utf8 | Utf8View | LargeUtf8 | Null,
            ] => Ok(vec![Utf8, numbers(fields), Utf8]),
            _ => Err(DataFusionError::Plan(
                "`factor` takes the name of a robot, the columns of its logs, and the payload if there was one (`true`, or its name): \
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
            state("carried", DataType::Utf8),
            state("rows", DataType::LargeBinary),
        ])
    }

    fn accumulator(&self, _: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        Ok(Box::new(Rows {
            robots: self.robots.clone(),
            robot: String::new(),
            columns: Vec::new(),
            carried: String::new(),
            values: Vec::new(),
        }))
    }
}

/// Rows of a run.
#[derive(Debug)]
struct Rows {
    robots: Robots,
    robot: String,
    columns: Vec<String>,
    /// `true`, or the name of a payload; empty without payload.
    carried: String,
    /// Row-major values.
    values: Vec<f64>,
}

impl Rows {
    fn check(&mut self, robot: &str, columns: &[String], carried: &str) -> Result<()> {
        if self.columns.is_empty() {
            robot.clone_into(&mut self.robot);
            self.columns = columns.to_vec();
            carried.clone_into(&mut self.carried);
        }
        let message = if robot != self.robot || columns != self.columns {
            SEVERAL_ROBOTS
        } else if carried != self.carried {
            SEVERAL_PAYLOADS
        } else if self.values.len() > MOST {
            "`factor` has more than 67 million numbers in a group: group by run"
        } else {
            return Ok(());
        };
        Err(refused(message))
    }

    /// Sets the payload of the log.
    fn carrying(&self, robot: &Robot, log: Log) -> Result<Log, String> {
        let names = robot.payloads();
        match self.carried.as_str() {
            "" => Ok(log),
            own if carried_payloads(own).all(|one| names.contains(&one)) => {
                Ok(log.with_payload_name(own))
            }
            "true" if names.is_empty() => {
                if robot.model().info().payload_parameters.is_empty() {
                    Err("the run carries a payload, but the description has none".to_owned())
                } else {
                    Ok(log.with_payload(true))
                }
            }
            "true" => Err(format!(
                "the robot has several payloads: name the one of the run, of {}",
                names.join(", ")
            )),
            own => Err(if names.is_empty() {
                format!(
                    "there is no payload `{own}`: the description names none, so write `true` or `false`"
                )
            } else {
                format!("there is no payload `{own}`, but {}", names.join(", "))
            }),
        }
    }

    /// Factors, or why there are none.
    fn factors(&self) -> Result<Vec<u8>, String> {
        let robot = self.robots.get(&self.robot).ok_or_else(|| {
            let known: Vec<&str> = self.robots.names().collect();
            format!(
                "no robot has the name `{}`; known are {known:?}",
                self.robot
            )
        })?;
        let Time::Column(time) = robot.mapping().time else {
            return Err("the description has no column of time to sort rows by".to_owned());
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
        let log = self.carrying(robot, log)?;
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

/// Messages on groups with more than one run.
const SEVERAL_ROBOTS: &str = "`factor` has rows of several robots in a group: group by them";
const SEVERAL_PAYLOADS: &str = "`factor` has rows with and without payload, or with several payloads, in a group: group by run";

fn refused(message: &str) -> DataFusionError {
    DataFusionError::Execution(message.to_owned())
}

/// Text that all rows share, empty if null; `None` if they differ.
fn the_only(column: &ArrayRef) -> Option<&str> {
    let mut all = column
        .as_string::<i32>()
        .iter()
        .map(Option::unwrap_or_default);
    let first = all.next()?;
    all.all(|own| own == first).then_some(first)
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
        let robot = the_only(&values[0]).ok_or_else(|| refused(SEVERAL_ROBOTS))?;
        let carried = match values.get(2) {
            Some(own) => the_only(own).ok_or_else(|| refused(SEVERAL_PAYLOADS))?,
            None => "",
        };
        let carried = Some(carried)
            .filter(|own| *own != "false")
            .unwrap_or_default();
        self.check(robot, &columns, carried)?;
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
            // A missing number becomes NaN and is reported with the log.
            let value = |own: &&arrow::array::Float64Array| {
                if own.is_valid(row) {
                    own.value(row)
                } else {
                    f64::NAN
                }
            };
            self.values.extend(numbers.iter().map(value));
        }
        Ok(())
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        let [robots, names, carried] =
            [0, 1, 2].map(|place: usize| states[place].as_string::<i32>());
        let rows = states[3].as_binary::<i64>();
        for at in (0..rows.len()).filter(|at| !rows.value(*at).is_empty()) {
            let columns: Vec<String> = names.value(at).split('\n').map(str::to_owned).collect();
            self.check(robots.value(at), &columns, carried.value(at))?;
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
            ScalarValue::Utf8(Some(self.carried.clone())),
            ScalarValue::LargeBinary(Some(rows)),
        ])
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        let made = self.factors();
        let samples = (self.values.len() / self.columns.len().max(1)) as u64;
        let columns: Vec<ArrayRef> = vec![
            Arc::new(LargeBinaryArray::from(vec![made.as_deref().ok()])),
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
