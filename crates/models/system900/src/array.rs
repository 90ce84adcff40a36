//! The array of the system parameters: four bytes and four status bytes each [002:12-26].

use crate::status::Status;
use crate::value::shown;

/// The least number of system parameters, q3 [002:384-385].
pub const PARAMETERS_MIN: usize = 30_000;
/// The greatest number: the introduction counts up to 50000 [002:3].
pub const PARAMETERS_MAX: usize = 50_000;

/// What a parameter holds, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    pub(crate) mantissa: i32,
    pub(crate) status: Status,
}

impl Cell {
    /// The four bytes; `None` when it is cleared.
    pub fn bits(self) -> Option<i32> {
        self.status.is_loaded().then_some(self.mantissa)
    }

    /// What it counts: its decimals stand after the point; `None` when it is cleared.
    pub fn number(self) -> Option<f64> {
        let scale = 10f64.powi(self.status.decimals().into());
        Some(f64::from(self.bits()?) / scale)
    }

    /// A number without a fraction; `None` for others, and when it is cleared.
    pub fn whole(self) -> Option<i64> {
        let scale = 10i64.checked_pow(self.status.decimals().into())?;
        let bits = i64::from(self.bits()?);
        (bits % scale == 0).then_some(bits / scale)
    }

    /// The status bytes.
    pub fn status(self) -> Status {
        self.status
    }

    /// As the control shows it: `12.500`, `$1F`, `--`.
    pub fn written(self) -> String {
        match self.bits() {
            None => "--".to_owned(),
            Some(bits) if self.status.is_hexadecimal() => format!("${bits:X}"),
            Some(bits) => shown(bits.into(), self.status.decimals()),
        }
    }
}

/// A number as people read it, `--` for none.
pub(crate) fn number_or_none(number: Option<f64>) -> String {
    number.map_or("--".to_owned(), |number| number.to_string())
}

/// The system parameters by their numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array(Vec<Cell>);

impl Array {
    pub fn new(count: usize) -> Array {
        Array(vec![Cell::default(); count])
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn resize(&mut self, count: usize) {
        self.0.resize(count, Cell::default());
    }

    pub fn cells_mut(&mut self) -> impl Iterator<Item = &mut Cell> {
        self.0.iter_mut()
    }

    pub fn start(&mut self) {
        for cell in &mut self.0 {
            cell.status = cell.status.started();
        }
    }

    /// A parameter that is not there is cleared.
    pub fn get(&self, number: u32) -> Cell {
        let index = usize::try_from(number).ok();
        let cell = index.and_then(|index| self.0.get(index));
        cell.copied().unwrap_or_default()
    }

    pub fn slot(&mut self, index: usize) -> Option<&mut Cell> {
        self.0.get_mut(index)
    }
}
