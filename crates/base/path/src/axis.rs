//! The nine programmable axes and positions of them.

use std::fmt;
use std::ops::{Index, IndexMut};

/// A programmable axis: main axes X, Y, Z, their parallel axes U, V, W and the rotary axes A, B, C
/// [003:534] [003:686].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Axis {
    /// First main axis, mm.
    X,
    /// Second main axis, mm.
    Y,
    /// Third main axis, mm.
    Z,
    /// Rotary axis about X, degrees.
    A,
    /// Rotary axis about Y, degrees.
    B,
    /// Rotary axis about Z, degrees.
    C,
    /// Linear axis parallel to X, mm.
    U,
    /// Linear axis parallel to Y, mm.
    V,
    /// Linear axis parallel to Z, mm.
    W,
}

/// Number of axes. Whoever has something of each axis has a [`PerAxis`] of it.
const COUNT: usize = 9;

impl Axis {
    /// All axes in the order of lists and reports: X Y Z A B C U V W.
    pub const ALL: [Axis; COUNT] = [
        Axis::X,
        Axis::Y,
        Axis::Z,
        Axis::A,
        Axis::B,
        Axis::C,
        Axis::U,
        Axis::V,
        Axis::W,
    ];

    /// The capital letter of its words in programs.
    pub const fn letter(self) -> char {
        match self {
            Axis::X => 'X',
            Axis::Y => 'Y',
            Axis::Z => 'Z',
            Axis::A => 'A',
            Axis::B => 'B',
            Axis::C => 'C',
            Axis::U => 'U',
            Axis::V => 'V',
            Axis::W => 'W',
        }
    }

    /// The axis of a letter, upper or lower case.
    pub const fn from_letter(letter: u8) -> Option<Axis> {
        Some(match letter {
            b'X' | b'x' => Axis::X,
            b'Y' | b'y' => Axis::Y,
            b'Z' | b'z' => Axis::Z,
            b'A' | b'a' => Axis::A,
            b'B' | b'b' => Axis::B,
            b'C' | b'c' => Axis::C,
            b'U' | b'u' => Axis::U,
            b'V' | b'v' => Axis::V,
            b'W' | b'w' => Axis::W,
            _ => return None,
        })
    }

    /// Whether the axis turns (degrees) instead of moving along a line (mm).
    pub const fn is_rotary(self) -> bool {
        matches!(self, Axis::A | Axis::B | Axis::C)
    }

    /// The main axis of the same direction: X for X and U, and so on; `None` for a rotary axis.
    pub const fn main(self) -> Option<Axis> {
        match self {
            Axis::X | Axis::U => Some(Axis::X),
            Axis::Y | Axis::V => Some(Axis::Y),
            Axis::Z | Axis::W => Some(Axis::Z),
            _ => None,
        }
    }

    /// The index of the axis in [`Axis::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.letter())
    }
}

/// A set of axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct AxisSet(u16);

impl AxisSet {
    /// No axis at all.
    pub const EMPTY: AxisSet = AxisSet(0);

    /// Whether the axis is in the set.
    pub const fn contains(self, axis: Axis) -> bool {
        self.0 & (1 << axis as u8) != 0
    }

    /// Puts an axis in.
    pub const fn insert(&mut self, axis: Axis) {
        self.0 |= 1 << axis as u8;
    }

    /// Takes an axis out.
    pub const fn remove(&mut self, axis: Axis) {
        self.0 &= !(1 << axis as u8);
    }

    /// This set with one axis more.
    #[must_use]
    pub const fn with(mut self, axis: Axis) -> AxisSet {
        self.insert(axis);
        self
    }

    /// The axes that are in both sets.
    #[must_use]
    pub const fn intersection(self, other: AxisSet) -> AxisSet {
        AxisSet(self.0 & other.0)
    }

    /// The axes that are in either set.
    #[must_use]
    pub const fn union(self, other: AxisSet) -> AxisSet {
        AxisSet(self.0 | other.0)
    }

    /// Whether no axis is in the set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many axes are in the set.
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The axes of the set in the order of [`Axis::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Axis> {
        Axis::ALL.into_iter().filter(move |axis| self.contains(*axis))
    }
}

impl FromIterator<Axis> for AxisSet {
    fn from_iter<T: IntoIterator<Item = Axis>>(iter: T) -> Self {
        iter.into_iter().fold(AxisSet::EMPTY, AxisSet::with)
    }
}

/// A value for each axis that a path can have.
///
/// ```
/// use bahn_path::{Axis, PerAxis};
/// let mut feeds = PerAxis::splat(15_000.0);
/// feeds[Axis::Z] = 6_000.0;
/// let slowest = feeds.iter().copied().fold(f64::INFINITY, f64::min);
/// assert_eq!((feeds[Axis::X], slowest), (15_000.0, 6_000.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerAxis<T>([T; COUNT]);

impl<T> PerAxis<T> {
    /// What is said of each axis.
    #[inline]
    pub fn from_fn(value: impl FnMut(Axis) -> T) -> PerAxis<T> {
        PerAxis(Axis::ALL.map(value))
    }

    /// What becomes of each value.
    #[inline]
    pub fn map<U>(self, value: impl FnMut(T) -> U) -> PerAxis<U> {
        PerAxis(self.0.map(value))
    }

    /// The values in the order of [`Axis::ALL`].
    #[inline]
    pub const fn values(&self) -> &[T] {
        &self.0
    }

    /// The values in the order of [`Axis::ALL`], one by one.
    #[inline]
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.0.iter()
    }
}

impl<T: Copy> PerAxis<T> {
    /// The same value for each axis.
    #[inline]
    pub const fn splat(value: T) -> PerAxis<T> {
        PerAxis([value; COUNT])
    }
}

impl<T> Index<Axis> for PerAxis<T> {
    type Output = T;
    #[inline]
    fn index(&self, axis: Axis) -> &T {
        &self.0[axis.index()]
    }
}

impl<T> IndexMut<Axis> for PerAxis<T> {
    #[inline]
    fn index_mut(&mut self, axis: Axis) -> &mut T {
        &mut self.0[axis.index()]
    }
}

/// A position of all axes: mm for linear, degrees for rotary axes. An axis that was never programmed
/// and not given a start has no position; its value is NaN.
///
/// ```
/// use bahn_path::{Axis, Position};
/// let mut p = Position::UNKNOWN;
/// p[Axis::X] = 10.0;
/// assert_eq!(p.get(Axis::X), Some(10.0));
/// assert_eq!(p.get(Axis::Y), None);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Position(PerAxis<f64>);

impl Position {
    /// No axis has a position.
    pub const UNKNOWN: Position = Position(PerAxis::splat(f64::NAN));
    /// Every axis at zero.
    pub const ZERO: Position = Position(PerAxis::splat(0.0));

    /// The position of an axis, `None` while it has none.
    pub fn get(&self, axis: Axis) -> Option<f64> {
        let value = self.0[axis];
        if value.is_nan() { None } else { Some(value) }
    }

    /// The axes that have a position.
    pub fn known(&self) -> AxisSet {
        Axis::ALL
            .into_iter()
            .filter(|axis| self.get(*axis).is_some())
            .collect()
    }

    /// The value of each axis; NaN where it has no position.
    pub const fn values(&self) -> &PerAxis<f64> {
        &self.0
    }
}

impl From<PerAxis<f64>> for Position {
    #[inline]
    fn from(values: PerAxis<f64>) -> Self {
        Position(values)
    }
}

impl Index<Axis> for Position {
    type Output = f64;
    #[inline]
    fn index(&self, axis: Axis) -> &f64 {
        &self.0[axis]
    }
}

impl IndexMut<Axis> for Position {
    #[inline]
    fn index_mut(&mut self, axis: Axis) -> &mut f64 {
        &mut self.0[axis]
    }
}

/// Positions are equal when the same axes have a position and the values are equal.
impl PartialEq for Position {
    fn eq(&self, other: &Self) -> bool {
        self.0
            .iter()
            .zip(other.0.iter())
            .all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
    }
}
