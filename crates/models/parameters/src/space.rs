//! What all kinds of parameters have in common: names, contents, entry.

use std::fmt;

mod q;

pub use q::{PARAMETERS_MIN, QError, QName, QParameters, QStatus, Receivers};

/// What a parameter holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Content {
    /// Nothing, shown as `--`: no number, not 0 either. Machine parameters are never cleared.
    Cleared,
    /// A number in the unit of what it sets.
    Number(f64),
}

/// A space of parameters with names: the machine parameters of a TNC ([`crate::ParameterList`]), or system and channel
/// parameters of a System 900 ([`QParameters`]). Lists, editors and comparisons need no more of them.
///
/// ```
/// use bahn_parameters::space::{Content, ParameterSpace, QParameters, differences};
/// use bahn_parameters::{ControlModel, ParameterList};
///
/// let mut list = ParameterList::reference(ControlModel::Tnc415b);
/// let before = list.clone();
/// let name = list.name("MP7440")?;
/// list.enter(name, "%00001")?;
/// assert_eq!(list.written(name)?, "%00001");
/// assert_eq!(differences(&before, &list), [name]);
///
/// // In channel 1, P7000 is the 5000th parameter after the user block that begins at q10000.
/// let mut q = QParameters::new(30_000).unwrap();
/// for (name, value) in [("q102", "10000"), ("q103", "5000")] {
///     q.enter(q.name(name)?, value)?;
/// }
/// q.enter(q.name("1:P7000")?, "$1F")?;
/// assert_eq!(q.content(q.name("q15000")?)?, Content::Number(31.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait ParameterSpace {
    /// What a parameter is called.
    type Name: Copy + Ord + fmt::Display;
    /// Why a name or an entry is refused.
    type Error: std::error::Error;

    /// Reads a name.
    ///
    /// # Errors
    /// When it is none, or the space has no such parameter.
    fn name(&self, text: &str) -> Result<Self::Name, Self::Error>;

    /// The names of all parameters that can hold something, in ascending order.
    fn names(&self) -> impl Iterator<Item = Self::Name>;

    /// What a parameter holds.
    ///
    /// # Errors
    /// When the space has no such parameter.
    fn content(&self, name: Self::Name) -> Result<Content, Self::Error>;

    /// What a parameter holds as the control shows it.
    ///
    /// # Errors
    /// When the space has no such parameter.
    fn written(&self, name: Self::Name) -> Result<String, Self::Error>;

    /// Enters a value as an operator writes it.
    ///
    /// # Errors
    /// When it is no value, or none for this parameter, or the parameter is locked.
    fn enter(&mut self, name: Self::Name, value: &str) -> Result<(), Self::Error>;
}

/// The names of the parameters that are not the same in two spaces; one that only one of them has is not the same.
pub fn differences<S: ParameterSpace>(a: &S, b: &S) -> Vec<S::Name> {
    let content = |space: &S, name| space.content(name).ok();
    let mut names: Vec<S::Name> = a
        .names()
        .chain(b.names())
        .filter(|name| content(a, *name) != content(b, *name))
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}
