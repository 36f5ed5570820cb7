//! Parallel iteration: that of `rayon` with the feature `parallel`, and the same calls on the calling thread without it.
//!
//! Other modules import from here and never from `rayon`. The serial iterators have the methods that the library uses, under
//! the same names. Steps have the same bits with both, because they have the same bits for any number of threads.

#[cfg(feature = "parallel")]
pub(crate) use rayon::{current_num_threads, join};

#[cfg(not(feature = "parallel"))]
pub(crate) use serial::{current_num_threads, join};

/// The traits of parallel iteration.
pub(crate) mod prelude {
    #[cfg(feature = "parallel")]
    pub(crate) use rayon::prelude::*;

    #[cfg(not(feature = "parallel"))]
    pub(crate) use super::serial::{IntoParallelIterator, ParallelSlice, ParallelSliceMut};
}

#[cfg(not(feature = "parallel"))]
mod serial {
    use std::{
        iter,
        slice::{self, Chunks, ChunksMut},
    };

    /// Runs both functions, one after the other.
    pub(crate) fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
        (a(), b())
    }

    /// Returns 1.
    pub(crate) fn current_num_threads() -> usize {
        1
    }

    /// An iterator with the methods of `rayon`'s iterators.
    pub(crate) struct Serial<I>(I);

    impl<I: Iterator> Serial<I> {
        pub(crate) fn with_min_len(self, _: usize) -> Self {
            self
        }

        pub(crate) fn enumerate(self) -> Serial<iter::Enumerate<I>> {
            Serial(self.0.enumerate())
        }

        pub(crate) fn zip<O: IntoParallelIterator>(self, other: O) -> Serial<iter::Zip<I, O::Serial>> {
            Serial(self.0.zip(other.into_par_iter().0))
        }

        pub(crate) fn map<T, F: FnMut(I::Item) -> T>(self, f: F) -> Serial<iter::Map<I, F>> {
            Serial(self.0.map(f))
        }

        pub(crate) fn filter<F: FnMut(&I::Item) -> bool>(self, f: F) -> Serial<iter::Filter<I, F>> {
            Serial(self.0.filter(f))
        }

        pub(crate) fn flat_map_iter<T, F>(self, f: F) -> Serial<iter::FlatMap<I, T, F>>
        where
            T: IntoIterator,
            F: FnMut(I::Item) -> T,
        {
            Serial(self.0.flat_map(f))
        }

        pub(crate) fn for_each(self, f: impl FnMut(I::Item)) {
            self.0.for_each(f);
        }

        pub(crate) fn collect<C: FromIterator<I::Item>>(self) -> C {
            self.0.collect()
        }

        pub(crate) fn collect_into_vec(self, into: &mut Vec<I::Item>) {
            into.clear();
            into.extend(self.0);
        }

        pub(crate) fn sum<T: iter::Sum<I::Item>>(self) -> T {
            self.0.sum()
        }

        pub(crate) fn reduce(
            self,
            identity: impl FnOnce() -> I::Item,
            f: impl FnMut(I::Item, I::Item) -> I::Item,
        ) -> I::Item {
            self.0.fold(identity(), f)
        }
    }

    /// What can be iterated over.
    pub(crate) trait IntoParallelIterator: Sized {
        type Serial: Iterator<Item = Self::Item>;
        type Item;

        fn into_par_iter(self) -> Serial<Self::Serial>;
    }

    impl<I: Iterator> IntoParallelIterator for Serial<I> {
        type Serial = I;
        type Item = I::Item;

        fn into_par_iter(self) -> Self {
            self
        }
    }

    /// Implements [`IntoParallelIterator`] for collections by their own iterators.
    macro_rules! by_own_iterator {
        ($($collection:ty [$($generics:tt)*]),*) => {
            $(impl<$($generics)*> IntoParallelIterator for $collection {
                type Serial = <Self as IntoIterator>::IntoIter;
                type Item = <Self as IntoIterator>::Item;

                fn into_par_iter(self) -> Serial<Self::Serial> {
                    Serial(self.into_iter())
                }
            })*
        };
    }

    by_own_iterator!(
        Vec<T> [T],
        &'a Vec<T> ['a, T],
        [T; N] [T, const N: usize],
        std::ops::Range<usize> []
    );

    /// Iteration over shared slices.
    pub(crate) trait ParallelSlice<T> {
        fn par_iter(&self) -> Serial<slice::Iter<'_, T>>;
        fn par_chunks(&self, size: usize) -> Serial<Chunks<'_, T>>;
    }

    impl<T> ParallelSlice<T> for [T] {
        fn par_iter(&self) -> Serial<slice::Iter<'_, T>> {
            Serial(self.iter())
        }

        fn par_chunks(&self, size: usize) -> Serial<Chunks<'_, T>> {
            Serial(self.chunks(size))
        }
    }

    /// Iteration over exclusive slices, and sorting.
    pub(crate) trait ParallelSliceMut<T> {
        fn par_iter_mut(&mut self) -> Serial<slice::IterMut<'_, T>>;
        fn par_chunks_mut(&mut self, size: usize) -> Serial<ChunksMut<'_, T>>;
        fn par_sort_unstable(&mut self)
        where
            T: Ord;
    }

    impl<T> ParallelSliceMut<T> for [T] {
        fn par_iter_mut(&mut self) -> Serial<slice::IterMut<'_, T>> {
            Serial(self.iter_mut())
        }

        fn par_chunks_mut(&mut self, size: usize) -> Serial<ChunksMut<'_, T>> {
            Serial(self.chunks_mut(size))
        }

        fn par_sort_unstable(&mut self)
        where
            T: Ord,
        {
            self.sort_unstable();
        }
    }
}
