//! Objects that readers derive from a table, kept in memory as long as the table: parts of one stage share them.
//!
//! They are no part of the table's content. Must not know: what the objects are.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use std::sync::{Arc, Mutex, PoisonError};

/// The objects derived from one table.
#[derive(Default)]
pub struct Derived(Mutex<Vec<Arc<dyn Any + Send + Sync>>>);

impl Derived {
    /// The object of this type that `is_meant`, or the one that `make` returns, which is kept. Two threads may make it at the same
    /// time; they get equal objects.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get<T: Any + Send + Sync, E>(
        &self,
        is_meant: impl Fn(&T) -> bool,
        make: impl FnOnce() -> Result<T, E>,
    ) -> Result<Arc<T>, E> {
        let all = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = all().iter().cloned().filter_map(|one| one.downcast::<T>().ok()).find(|one| is_meant(one));
        if let Some(known) = known {
            return Ok(known);
        }
        // Not under the lock: what makes it may run on other threads that ask, too.
        let made = Arc::new(make()?);
        all().push(Arc::<T>::clone(&made));
        Ok(made)
    }
}

/// A copy of a table derives its own.
impl Clone for Derived {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Derived {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Debug for Derived {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Derived").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn an_object_is_made_once_for_each_type_and_meaning() {
        let derived = Derived::default();
        let mut made = 0;
        let mut number = |meant: u32| {
            let make = || {
                made += 1;
                Ok::<_, Infallible>(meant)
            };
            *derived.get(|one| *one == meant, make).unwrap()
        };
        assert_eq!([1, 2, 1, 2].map(&mut number), [1, 2, 1, 2]);
        assert_eq!(made, 2);
        assert_eq!(*derived.get(|_: &String| true, || Ok::<_, Infallible>("text".to_owned())).unwrap(), "text");
        assert_eq!(derived.get(|_: &u8| true, || Err("it failed")), Err("it failed"));
        assert_eq!(derived.get(|_: &u8| true, || Ok::<_, Infallible>(7)).map(|one| *one), Ok(7));
    }
}
