//! `estimate(factor)` and `merge_r(factor)`: aggregate factors in bounded memory, in any order.
//!
//! Pools are passed between processes as large binaries. The engine sends all groups at once, and
//! for about 40 000 robots these exceed 32-bit offsets.

use super::arrays;
use arrow::{
    array::{ArrayRef, AsArray},
    datatypes::{DataType, Field, FieldRef, Int64Type},
};
use datafusion::{
    error::{DataFusionError, Result},
    logical_expr::{
        Accumulator, AggregateUDFImpl, Signature, Volatility,
        function::{AccumulatorArgs, StateFieldsArgs},
    },
    scalar::ScalarValue,
};
use overact_identification::factors::{Pool, PoolError};
use std::sync::Arc;

/// Either of the two aggregate functions.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct Gather {
    signature: Signature,
    /// Whether the result is the estimate.
    estimates: bool,
}

impl Gather {
    fn new(estimates: bool) -> Self {
        Self {
            signature: Signature::user_defined(Volatility::Immutable),
            estimates,
        }
    }

    pub(super) fn estimate() -> Self {
        Self::new(true)
    }

    pub(super) fn merge_r() -> Self {
        Self::new(false)
    }
}

impl AggregateUDFImpl for Gather {
    fn name(&self) -> &str {
        if self.estimates {
            "estimate"
        } else {
            "merge_r"
        }
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        let binary = |kind: &DataType| {
            use DataType::{Binary, BinaryView, FixedSizeBinary, LargeBinary, Null};
            matches!(
                kind,
                Binary | LargeBinary | BinaryView | FixedSizeBinary(_) | Null
            )
        };
        match given {
            [factor] if binary(factor) => Ok(vec![DataType::LargeBinary]),
            [factor, groups] if binary(factor) && groups.is_integer() => {
                Ok(vec![DataType::LargeBinary, DataType::Int64])
            }
            _ => Err(DataFusionError::Plan(format!(
                "`{0}` takes a column of factors, and the number of independent groups of runs to keep separate: \
                 `{0}(factor)` or `{0}(factor, 64)`",
                self.name()
            ))),
        }
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(if self.estimates {
            DataType::Struct(arrays::of_estimate())
        } else {
            DataType::LargeBinary
        })
    }

    fn state_fields(&self, args: StateFieldsArgs<'_>) -> Result<Vec<FieldRef>> {
        let name = format!("{}[pool]", args.name);
        Ok(vec![Arc::new(Field::new(
            name,
            DataType::LargeBinary,
            true,
        ))])
    }

    fn accumulator(&self, _: AccumulatorArgs<'_>) -> Result<Box<dyn Accumulator>> {
        Ok(Box::new(Gathered {
            pool: Pool::default(),
            fed: false,
            estimates: self.estimates,
        }))
    }
}

#[derive(Debug)]
struct Gathered {
    pool: Pool,
    /// Whether any row was added.
    fed: bool,
    estimates: bool,
}

impl Gathered {
    fn take(&mut self, column: &ArrayRef) -> Result<()> {
        for bytes in column.as_binary::<i64>().iter().flatten() {
            self.fed = true;
            self.pool.take(bytes).map_err(|error| told(&error))?;
        }
        Ok(())
    }
}

/// Converts an error of a pool.
fn told(error: &PoolError) -> DataFusionError {
    DataFusionError::Execution(
        match error {
            PoolError::Twice => {
                "a run occurs in different files: select from the table `factors`, which skips copies"
            }
            _ => "a merged factor is damaged: merge it again from its parts",
        }
        .to_owned(),
    )
}

impl Accumulator for Gathered {
    fn update_batch(&mut self, values: &[ArrayRef]) -> Result<()> {
        if let Some(groups) = values.get(1) {
            let groups = groups.as_primitive::<Int64Type>();
            if let Some(first) = groups.iter().flatten().next() {
                self.pool.limit(first.max(0) as usize);
            }
        }
        self.take(&values[0])
    }

    fn merge_batch(&mut self, states: &[ArrayRef]) -> Result<()> {
        self.take(&states[0])
    }

    fn state(&mut self) -> Result<Vec<ScalarValue>> {
        // A partition without rows does not know the number of groups, so it returns null.
        let pool = self.fed.then(|| self.pool.to_bytes());
        Ok(vec![ScalarValue::LargeBinary(pool)])
    }

    fn evaluate(&mut self) -> Result<ScalarValue> {
        Ok(if self.estimates {
            arrays::value(&self.pool.estimate())
        } else {
            ScalarValue::LargeBinary(Some(self.pool.to_bytes()))
        })
    }

    fn size(&self) -> usize {
        size_of::<Self>() + self.pool.size()
    }
}
