//! What a contact hands on to the one after it.

use std::any::Any;

use serde::{Deserialize, Serialize};

/// What a contact knew when it was no longer needed.
#[derive(Debug, Default)]
pub struct ContactMemory {
    /// What answers depend on.
    pub state: ContactState,
    /// What makes the next contact quicker and changes none of its answers.
    pub cache: ContactCache,
}

/// The history of a contact whose answers depend on it: plastic strains, for instance. A march keeps
/// it in its checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The fields, in an order of the law's own.
    pub fields: Vec<StateField>,
}

/// A field of a contact's history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateField {
    /// Its name, which ends in its unit.
    pub name: String,
    /// Its numbers, in an order of the law's own.
    pub values: Vec<f64>,
}

/// Whatever a contact likes to keep for the next one; each law knows its own.
#[derive(Debug, Default)]
pub struct ContactCache(Option<Box<dyn Any + Send + Sync>>);

impl ContactCache {
    /// Keeps a value.
    pub fn of<T: Any + Send + Sync>(value: T) -> Self {
        Self(Some(Box::new(value)))
    }

    /// The value that was kept, if it is of this type.
    pub fn into_inner<T: Any>(self) -> Option<T> {
        let value = self.0?.downcast::<T>().ok()?;
        Some(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cache_gives_its_value_to_the_law_that_kept_it_alone() {
        assert_eq!(ContactCache::of(3_u8).into_inner::<u8>(), Some(3));
        assert_eq!(ContactCache::of(3_u8).into_inner::<u16>(), None);
        assert_eq!(ContactCache::default().into_inner::<u8>(), None);
    }
}
