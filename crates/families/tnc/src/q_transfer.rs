//! Q100 to Q107, which the PLC writes.

use bahn_path::LiveData;

/// First Q parameter that the PLC may write [000:6997-7008].
pub(crate) const Q_FROM_PLC: u16 = 100;
const COUNT: usize = 8;

/// Values of the PLC for the program that runs. They are transferred with the next M, S or T strobe
/// [000:11657-11663]: what is written during one counts from the next one on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QTransfer {
    written: [Option<f64>; COUNT],
    transferred: [Option<f64>; COUNT],
}

impl QTransfer {
    /// The PLC writes a Q parameter.
    pub fn write(&mut self, number: u16, value: f64) {
        let place = number.checked_sub(Q_FROM_PLC).map(usize::from);
        if let Some(slot) = place.and_then(|place| self.written.get_mut(place)) {
            *slot = Some(value);
        }
    }

    /// A strobe goes out.
    pub fn strobe(&mut self) {
        for (written, transferred) in self.written.iter_mut().zip(&mut self.transferred) {
            *transferred = written.take().or(*transferred);
        }
    }

    /// What the program reads from now on.
    pub fn answer(&mut self) -> LiveData {
        LiveData {
            q_values: take(&mut self.transferred).collect(),
            ..LiveData::default()
        }
    }

    /// All values, transferred or not.
    pub fn take_all(&mut self) -> Vec<(u16, f64)> {
        self.strobe();
        take(&mut self.transferred).collect()
    }
}

fn take(values: &mut [Option<f64>; COUNT]) -> impl Iterator<Item = (u16, f64)> + '_ {
    (Q_FROM_PLC..)
        .zip(values)
        .filter_map(|(number, value)| Some((number, value.take()?)))
}
