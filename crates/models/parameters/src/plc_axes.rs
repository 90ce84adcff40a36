//! The axes that a list of machine parameters has, as its PLC and its tables count them: by index, not by letter.

use std::ops::{Deref, DerefMut};
use std::{array, slice};

/// Axes that a list has at most, and so a channel, its PLC interface and its datum and compensation tables: X, Y, Z, 4
/// and 5, whatever letters the axes have [000:4836-4841] [000:10534] [000:15414-15420].
pub const PLC_AXES: usize = 5;

/// What they are called where their letter is not asked for.
pub const PLC_AXIS_NAMES: PerPlcAxis<&str> = PerPlcAxis(["X", "Y", "Z", "4", "5"]);

/// A value for each of these axes, by its index.
///
/// ```
/// use bahn_parameters::{PLC_AXIS_NAMES, PerPlcAxis};
/// let mut volts = PerPlcAxis::splat(0.0);
/// if let Some(volts) = volts.get_mut(3) {
///     *volts = 0.0015;
/// }
/// let adjusted = PLC_AXIS_NAMES.iter().zip(volts).find(|(_, volts)| *volts != 0.0);
/// assert_eq!(adjusted, Some((&"4", 0.0015)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerPlcAxis<T>(pub [T; PLC_AXES]);

impl<T> PerPlcAxis<T> {
    /// What is said of each axis by its index.
    pub fn from_fn(mut value: impl FnMut(u8) -> T) -> PerPlcAxis<T> {
        PerPlcAxis(array::from_fn(|index| value(index as u8)))
    }

    /// What becomes of each value.
    pub fn map<U>(self, value: impl FnMut(T) -> U) -> PerPlcAxis<U> {
        PerPlcAxis(self.0.map(value))
    }
}

impl<T: Copy> PerPlcAxis<T> {
    /// The same value for each axis.
    pub const fn splat(value: T) -> PerPlcAxis<T> {
        PerPlcAxis([value; PLC_AXES])
    }
}

impl<T> Deref for PerPlcAxis<T> {
    type Target = [T; PLC_AXES];
    fn deref(&self) -> &[T; PLC_AXES] {
        &self.0
    }
}

impl<T> DerefMut for PerPlcAxis<T> {
    fn deref_mut(&mut self) -> &mut [T; PLC_AXES] {
        &mut self.0
    }
}

impl<T> IntoIterator for PerPlcAxis<T> {
    type Item = T;
    type IntoIter = array::IntoIter<T, PLC_AXES>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a, T> IntoIterator for &'a PerPlcAxis<T> {
    type Item = &'a T;
    type IntoIter = slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a, T> IntoIterator for &'a mut PerPlcAxis<T> {
    type Item = &'a mut T;
    type IntoIter = slice::IterMut<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}
