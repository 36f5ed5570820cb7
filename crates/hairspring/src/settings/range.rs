//! Ranges of parameters.

use super::parameter::Setting;
use glam::Vec3;

/// The values that a parameter accepts. An absent optional value is always accepted. Numbers must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// On or off.
    Switch,
    /// One of the parameter's words.
    Words,
    /// A table of other parameters.
    Table,
    /// A range that is described in words and checked by a function.
    Described,
    /// Finite numbers.
    Finite,
    /// Minimum and maximum.
    Between(f32, f32),
    /// This number or more.
    AtLeast(f32),
    /// More than this number.
    Above(f32),
    /// More than the first number, and at most the second.
    AboveAtMost(f32, f32),
    /// 0, or a value between these.
    ZeroOr(f32, f32),
    /// Linear red, green and blue, 0 to 1 each.
    Color,
    /// A vector that is long enough to be normalized.
    Direction,
}

impl Range {
    /// Returns whether the range contains all numbers of a value.
    pub fn accepts(&self, value: &(impl Setting + ?Sized)) -> bool {
        let numbers = value.numbers();
        let all = |inside: &dyn Fn(f64) -> bool| numbers.iter().all(|x| x.is_finite() && inside(*x));
        let between = |x: f64, min: f32, max: f32| (f64::from(min)..=f64::from(max)).contains(&x);
        match *self {
            Self::Switch | Self::Words | Self::Table | Self::Described => true,
            Self::Finite => all(&|_| true),
            Self::Between(min, max) => all(&|x| between(x, min, max)),
            Self::AtLeast(min) => all(&|x| x >= f64::from(min)),
            Self::Above(min) => all(&|x| x > f64::from(min)),
            Self::AboveAtMost(min, max) => all(&|x| x > f64::from(min) && x <= f64::from(max)),
            Self::ZeroOr(min, max) => all(&|x| x == 0.0 || between(x, min, max)),
            Self::Color => all(&|x| between(x, 0.0, 1.0)),
            Self::Direction => numbers
                .chunks_exact(3)
                .all(|v| Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32).try_normalize().is_some()),
        }
    }

    /// Returns the least and the greatest number, if the range has both.
    pub fn bounds(&self) -> Option<(f32, f32)> {
        match *self {
            Self::Between(min, max) | Self::AboveAtMost(min, max) => Some((min, max)),
            Self::ZeroOr(_, max) => Some((0.0, max)),
            Self::Color => Some((0.0, 1.0)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_belong_to_the_range_and_numbers_must_be_finite() {
        for (range, inside, outside) in [
            (Range::Between(-1e-3, 1e-3), vec![-1e-3, 1e-3], vec![-1.01e-3, 1.01e-3, f32::NAN]),
            (Range::AtLeast(0.0), vec![0.0, 1e30], vec![-1e-30, f32::INFINITY, f32::NAN]),
            (Range::Above(0.0), vec![1e-30], vec![0.0, f32::INFINITY, f32::NAN]),
            (Range::AboveAtMost(0.0, 1e6), vec![1e6], vec![0.0, 1.01e6]),
            (Range::ZeroOr(1.0, 10.0), vec![0.0, 1.0, 10.0], vec![0.5, 11.0, -1.0]),
            (Range::Finite, vec![-3.0], vec![f32::NAN, f32::INFINITY]),
        ] {
            assert!(inside.iter().all(|x| range.accepts(x)), "{range:?}");
            assert!(outside.iter().all(|x| !range.accepts(x)), "{range:?}");
            assert!(range.accepts(&None::<f32>), "{range:?}");
        }
        assert!(Range::Color.accepts(&Vec3::ONE) && !Range::Color.accepts(&Vec3::new(0.0, 1.1, 0.0)));
        assert!(Range::Direction.accepts(&Vec3::Y) && !Range::Direction.accepts(&Vec3::ZERO));
        assert!(!Range::Direction.accepts(&Vec3::new(f32::NAN, 0.0, 0.0)));
    }
}
