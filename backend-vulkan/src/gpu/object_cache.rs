//! Objects by description, each made once. Threads make different objects at the same time. If a thread asks for an object that is
//! being made, it waits.

use crate::base::Error;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Objects that nobody asked for during this many rounds are old. The owner of the cache says when a round ends.
const KEPT_ROUNDS: u64 = 16;

/// One kind of object by its description.
pub(crate) struct ObjectCache<K, V> {
    known: Mutex<KnownObject<K, V>>,
    /// Wakes threads that wait for an object that another one makes.
    made: Condvar,
}

struct KnownObject<K, V> {
    objects: HashMap<K, Object<V>>,
    round: u64,
}

struct Object<V> {
    /// `None` while a thread makes it.
    made: Option<V>,
    /// The round in which it was last asked for.
    asked: u64,
}

/// An object that this thread makes. Dropped, it gives the object to all who wait for it; where it was not made, another tries.
struct PendingObject<'m, K: Hash + Eq, V> {
    objects: &'m ObjectCache<K, V>,
    key: &'m K,
    made: Option<V>,
}

impl<K, V> Default for ObjectCache<K, V> {
    fn default() -> Self {
        ObjectCache { known: Mutex::new(KnownObject { objects: HashMap::new(), round: 0 }), made: Condvar::new() }
    }
}

impl<K: Hash + Eq + Clone, V: Copy> ObjectCache<K, V> {
    /// The object for `key`, made by `make` if there is none yet.
    pub(crate) fn get(&self, key: &K, make: impl FnOnce(&K) -> Result<V, Error>) -> Result<V, Error> {
        if let Some(found) = self.find_or_begin(key) {
            return Ok(found);
        }
        let mut pending = PendingObject { objects: self, key, made: None };
        let made = make(key)?;
        pending.made = Some(made);
        Ok(made)
    }

    /// The object for `key`, if it was made.
    pub(crate) fn find(&self, key: &K) -> Option<V> {
        let KnownObject { objects, round } = &mut *self.known();
        let object = objects.get_mut(key)?;
        object.asked = *round;
        object.made
    }

    /// The object for `key`; `None` if this thread is to make it.
    fn find_or_begin(&self, key: &K) -> Option<V> {
        let mut known = self.known();
        loop {
            let KnownObject { objects, round } = &mut *known;
            let Some(object) = objects.get_mut(key) else {
                objects.insert(key.clone(), Object { made: None, asked: *round });
                return None;
            };
            object.asked = *round;
            if object.made.is_some() {
                return object.made;
            }
            known = self.made.wait(known).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Takes out all.
    pub(super) fn drain(&self) -> Vec<V> {
        self.known().objects.drain().filter_map(|(_, object)| object.made).collect()
    }

    /// Ends a round. Takes out what became old.
    pub(super) fn end_round(&self) -> Vec<V> {
        let KnownObject { objects, round } = &mut *self.known();
        *round += 1;
        let old = objects.extract_if(|_, object| object.made.is_some() && object.asked + KEPT_ROUNDS < *round);
        old.filter_map(|(_, object)| object.made).collect()
    }
}

impl<K: Hash + Eq, V> ObjectCache<K, V> {
    fn known(&self) -> MutexGuard<'_, KnownObject<K, V>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<K: Hash + Eq, V> Drop for PendingObject<'_, K, V> {
    fn drop(&mut self) {
        let objects = &mut self.objects.known().objects;
        match self.made.take() {
            None => drop(objects.remove(self.key)),
            made => {
                if let Some(object) = objects.get_mut(self.key) {
                    object.made = made;
                }
            }
        }
        self.objects.made.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::thread;

    #[test]
    fn one_object_is_made_once_however_many_threads_ask_for_it() {
        let objects = ObjectCache::default();
        for key in 0..20 {
            let (made, asking) = (AtomicU32::new(0), AtomicU32::new(0));
            // It takes until all threads ask for it.
            let make = |_: &u32| {
                while asking.load(Ordering::Relaxed) < 8 {
                    thread::yield_now();
                }
                Ok(made.fetch_add(1, Ordering::Relaxed))
            };
            let ask = || {
                asking.fetch_add(1, Ordering::Relaxed);
                objects.get(&key, make).expect("it is made")
            };
            thread::scope(|scope| {
                let threads: Vec<_> = (0..8).map(|_| scope.spawn(ask)).collect();
                assert!(threads.into_iter().all(|thread| thread.join().expect("no panic") == 0));
            });
            assert_eq!((made.into_inner(), objects.find(&key)), (1, Some(0)));
        }
    }

    #[test]
    fn different_objects_are_made_at_once() {
        let (objects, both_make) = (ObjectCache::default(), Barrier::new(2));
        thread::scope(|scope| {
            for key in 0..2 {
                let (objects, both_make) = (&objects, &both_make);
                scope.spawn(move || {
                    let make = |key: &u32| {
                        both_make.wait();
                        Ok(*key)
                    };
                    assert_eq!(objects.get(&key, make).expect("it is made"), key);
                });
            }
        });
    }

    #[test]
    fn an_object_that_could_not_be_made_is_tried_again() {
        let objects = ObjectCache::default();
        assert!(objects.get(&1, |_| Err::<u32, _>(Error::NoDevice)).is_err());
        let panicked = thread::scope(|scope| scope.spawn(|| objects.get(&1, |_| panic!("a driver's fault"))).join());
        assert!(panicked.is_err());
        assert_eq!(objects.find(&1), None);
        assert_eq!(objects.get(&1, |_| Ok(7)).expect("it is made"), 7);
    }

    #[test]
    fn objects_that_nobody_asks_for_become_old() {
        let objects = ObjectCache::default();
        for key in 0..2 {
            objects.get(&key, |key| Ok(*key)).expect("it is made");
        }
        for _ in 0..KEPT_ROUNDS {
            assert_eq!(objects.end_round(), [0; 0]);
            objects.find(&1).expect("it is kept");
        }
        assert_eq!(objects.end_round(), [0]);
        assert_eq!(objects.drain(), [1]);
    }
}
