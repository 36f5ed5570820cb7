//! [`tile_arrays`] generates the tile, the range of tiles, and their split and access methods from one list of arrays.
//!
//! ```text
//! range   ├── tile 0 ──┼── tile 1 ──┼─ … ─┤
//!         per tile     one entry for each tile
//!         per point    one entry for each point of each tile, or none at all: an empty array is not in use
//! ```

/// See the module. An array is `shared` or `unique`: `&[T]` or `&mut [T]`.
macro_rules! tile_arrays {
    (
        $(#[$about_tile:meta])* tile $tile:ident;
        $(#[$about_range:meta])* range $range:ident;
        per tile { $($(#[$about_one:meta])* $one:ident: $one_access:ident $One:ty,)* }
        per point { $($(#[$about:meta])* $array:ident: $access:ident $Item:ty,)* }
    ) => {
        $(#[$about_tile])*
        pub(crate) struct $tile<'a> {
            /// Number of points, elastic model and precision.
            pub layout: TileLayout,
            $($(#[$about_one])* pub $one: access!($one_access item 'a $One),)*
            $($(#[$about])* pub $array: access!($access slice 'a $Item),)*
        }

        $(#[$about_range])*
        #[derive(Default)]
        pub(crate) struct $range<'a> {
            /// The tiles, with the places of their points in the arrays.
            pub tiles: &'a [TileLayout],
            $($(#[$about_one])* pub $one: access!($one_access slice 'a $One),)*
            $($(#[$about])* pub $array: access!($access slice 'a $Item),)*
        }

        #[allow(dead_code, reason = "not every list of arrays needs every method")]
        impl<'a> $range<'a> {
            /// Borrows the same range again.
            pub fn reborrow(&mut self) -> $range<'_> {
                $range {
                    tiles: self.tiles,
                    $($one: access!($one_access again self.$one),)*
                    $($array: access!($access again self.$array),)*
                }
            }

            /// Splits into the first `count` tiles, and the others.
            pub fn split(mut self, count: usize) -> (Self, Self) {
                let points = (self.tiles[count].first - self.tiles[0].first) as usize;
                let first = Self {
                    tiles: access!(shared split self.tiles, count),
                    $($one: access!($one_access split self.$one, count),)*
                    $($array: access!($access split self.$array, points.min(self.$array.len())),)*
                };
                (first, self)
            }

            /// Returns tile `k`.
            pub fn tile(&mut self, k: usize) -> $tile<'_> {
                let layout = self.tiles[k];
                let at = (layout.first - self.tiles[0].first) as usize;
                let points = |len: usize| if len == 0 { 0..0 } else { at..at + layout.points as usize };
                $tile {
                    layout,
                    $($one: access!($one_access get self.$one[k]),)*
                    $($array: access!($access part self.$array, points),)*
                }
            }
        }

        #[allow(dead_code, reason = "not every list of arrays needs every method")]
        impl $tile<'_> {
            /// Returns the same tile with arrays whose equal lengths are visible to the compiler.
            #[inline(always)]
            pub fn with_equal_lengths(&mut self) -> $tile<'_> {
                let points = self.rest.len();
                let all_or_none = |len: usize| if len == 0 { 0..0 } else { 0..points };
                $tile {
                    layout: self.layout,
                    $($one: access!($one_access again self.$one),)*
                    $($array: access!($access part self.$array, all_or_none),)*
                }
            }

            /// Borrows the same tile again, for a function outside of the sweep. Passing the sweep's own tile by
            /// reference would make the compiler reload the pointers and lengths of its arrays at every point.
            #[inline(always)]
            pub fn reborrow(&mut self) -> $tile<'_> {
                $tile {
                    layout: self.layout,
                    $($one: access!($one_access again self.$one),)*
                    $($array: access!($access again self.$array),)*
                }
            }
        }
    };
}

/// Shared and unique access to a value or a slice: its type, its first part, an entry, a part, and the same
/// again.
macro_rules! access {
    (shared item $l:lifetime $T:ty) => { &$l $T };
    (unique item $l:lifetime $T:ty) => { &$l mut $T };
    (shared slice $l:lifetime $T:ty) => { &$l [$T] };
    (unique slice $l:lifetime $T:ty) => { &$l mut [$T] };
    (shared split $of:expr, $count:expr) => { $of.split_off(..$count).unwrap_or_default() };
    (unique split $of:expr, $count:expr) => { $of.split_off_mut(..$count).unwrap_or_default() };
    (shared get $of:expr) => { &$of };
    (unique get $of:expr) => { &mut $of };
    (shared part $of:expr, $range:expr) => { &$of[$range($of.len())] };
    (unique part $of:expr, $range:expr) => {{ let range = $range($of.len()); &mut $of[range] }};
    (shared again $of:expr) => { $of };
    (unique again $of:expr) => { &mut *$of };
}

pub(crate) use {access, tile_arrays};
