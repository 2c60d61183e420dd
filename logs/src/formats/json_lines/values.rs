//! Values of the requested columns of a JSON object.

use std::{cell::RefCell, fmt};

use serde::de::{self, DeserializeSeed, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::{
    names::Step,
    parse::parse,
    records::{Fault, Record},
};

/// Value of a requested column.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Missing,
    Number(f64),
    Text(String),
    Null,
    /// An object or a list.
    Inner,
    /// The same key twice in an object.
    Twice,
}

/// Requested columns below a step, as a tree.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    /// Places among the requested columns of this value.
    places: Vec<usize>,
    inner: Vec<(Step, Self)>,
}

impl Wanted {
    /// Adds the requested column `place`.
    pub(super) fn add(&mut self, path: &[Step], place: usize) {
        let Some((step, rest)) = path.split_first() else {
            self.places.push(place);
            return;
        };
        let known = self.inner.iter().position(|(own, _)| own == step);
        let at = known.unwrap_or_else(|| {
            self.inner.push((step.clone(), Self::default()));
            self.inner.len() - 1
        });
        self.inner[at].1.add(rest, place);
    }

    fn key(&self, key: &str) -> Option<&Self> {
        let mut inner = self.inner.iter();
        inner
            .find_map(|(step, own)| matches!(step, Step::Key(known) if known == key).then_some(own))
    }

    fn item(&self, place: usize) -> Option<&Self> {
        let mut inner = self.inner.iter();
        inner.find_map(|(step, own)| (*step == Step::Item(place)).then_some(own))
    }

    /// Reads the requested columns of an object.
    ///
    /// # Errors
    /// Text that is not JSON.
    pub(super) fn read(&self, record: &Record<'_>, values: &mut [Value]) -> Result<(), Fault> {
        let values = RefCell::new(values);
        parse(record, &mut |input| {
            values.borrow_mut().fill(Value::Missing);
            let seed = Seed {
                wanted: self,
                values: &values,
            };
            seed.deserialize(input)
        })
    }
}

/// Reads the requested columns of a value.
struct Seed<'w> {
    wanted: &'w Wanted,
    values: &'w RefCell<&'w mut [Value]>,
}

impl Seed<'_> {
    fn set(&self, value: &Value) {
        let mut values = self.values.borrow_mut();
        for place in &self.wanted.places {
            let own = &mut values[*place];
            *own = match own {
                Value::Missing => value.clone(),
                _ => Value::Twice,
            };
        }
    }
}

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = ();

    fn deserialize<D: de::Deserializer<'de>>(self, input: D) -> Result<(), D::Error> {
        input.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<(), E> {
        self.set(&Value::Number(f64::from(u8::from(value))));
        Ok(())
    }

    fn visit_f64<E>(self, value: f64) -> Result<(), E> {
        self.set(&Value::Number(value));
        Ok(())
    }

    fn visit_u64<E>(self, value: u64) -> Result<(), E> {
        self.set(&Value::Number(value as f64));
        Ok(())
    }

    fn visit_i64<E>(self, value: i64) -> Result<(), E> {
        self.set(&Value::Number(value as f64));
        Ok(())
    }

    fn visit_str<E>(self, text: &str) -> Result<(), E> {
        if !self.wanted.places.is_empty() {
            self.set(&match text.trim().parse() {
                Ok(number) => Value::Number(number),
                Err(_) => Value::Text(text.to_owned()),
            });
        }
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        self.set(&Value::Null);
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        self.set(&Value::Inner);
        while let Some(found) = map.next_key_seed(Key(self.wanted))? {
            match found {
                Some(wanted) => map.next_value_seed(Self {
                    wanted,
                    values: self.values,
                })?,
                None => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        self.set(&Value::Inner);
        for place in 0.. {
            let goes_on = match self.wanted.item(place) {
                Some(wanted) => list
                    .next_element_seed(Self {
                        wanted,
                        values: self.values,
                    })?
                    .is_some(),
                None => list.next_element::<IgnoredAny>()?.is_some(),
            };
            if !goes_on {
                break;
            }
        }
        Ok(())
    }
}

/// Finds a key among the requested ones.
struct Key<'w>(&'w Wanted);

impl<'de, 'w> DeserializeSeed<'de> for Key<'w> {
    type Value = Option<&'w Wanted>;

    fn deserialize<D: de::Deserializer<'de>>(self, input: D) -> Result<Self::Value, D::Error> {
        input.deserialize_str(self)
    }
}

impl<'w> Visitor<'_> for Key<'w> {
    type Value = Option<&'w Wanted>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E>(self, key: &str) -> Result<Self::Value, E> {
        Ok(self.0.key(key))
    }
}
