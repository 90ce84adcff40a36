//! The medium of what survives power-off, when the supply goes or the disk is full in the middle of a write: any first part of
//! what is written may be on it.

use std::io;

use bahn_exchange::{Exchange, Image, MemoryStorage, Retention, RetentionError, RetentionStorage};
use bahn_tnc::{Control, Remembered};

use crate::torture::dice::Dice;
use bahn_host::{read_remembered, write_remembered};

/// The longest piece of a journal in which a failure is tried, bytes.
const PIECE: usize = 1600;

/// A medium that takes so many bytes more, and then none.
struct Failing {
    inner: MemoryStorage,
    left: usize,
}

impl RetentionStorage for Failing {
    fn read(&mut self) -> io::Result<Option<Vec<u8>>> {
        self.inner.read()
    }

    fn write(&mut self, at: usize, bytes: &[u8]) -> io::Result<()> {
        let part = bytes.get(..self.left.min(bytes.len())).unwrap_or(bytes);
        self.left -= part.len();
        self.inner.write(at, part)?;
        match part.len() == bytes.len() {
            true => Ok(()),
            false => Err(io::ErrorKind::StorageFull.into()),
        }
    }

    fn set_aside(&mut self, journal: &[u8]) -> io::Result<()> {
        self.inner.set_aside(journal)
    }
}

/// What was on the medium before the run that is tried.
pub(super) struct Medium {
    before: Image,
}

impl Medium {
    /// All that the control has now was written.
    pub fn of(control: &Control) -> Medium {
        Medium {
            before: control.exchange().plc().clone(),
        }
    }

    /// The supply goes while what has changed since is written; a seed and the time say at which byte.
    ///
    /// # Errors
    /// In words, what is found that was neither before nor now.
    pub fn fails(&self, control: &Control, chance: u64) -> Result<(), String> {
        let mut dice = Dice::new(chance);
        self.journal(control.exchange().plc(), dice.below(PIECE))?;
        let others = (1..control.channels()).filter_map(|number| control.channel(number));
        let all = std::iter::once(control.remember()).chain(others.map(|channel| channel.remember()));
        for remembered in all {
            file(&remembered, &mut dice)?;
        }
        Ok(())
    }

    /// The journal of markers and bytes: what was, or what is; and with room again what is.
    fn journal(&self, now: &Image, left: usize) -> Result<(), String> {
        let tried = || -> Result<bool, RetentionError> {
            let before = journal_with(MemoryStorage::default(), &self.before)?;
            let whole = journal_with(before.clone(), now)?;
            let mut failing = Retention::open(Failing {
                inner: before.clone(),
                left,
            })?;
            let failed = failing.flush(now).is_err();
            let cut = failing.into_storage().inner;
            let [was, is, found] = [before, whole, cut.clone()].map(cells);
            let (was, is, found) = (was?, is?, found?);
            // A disk that was full has room again.
            let again = cells(journal_with(cut, now)?)?;
            Ok((found == is || failed && found == was) && again == is)
        };
        match tried() {
            Ok(true) => Ok(()),
            Ok(false) => Err(format!(
                "after a failure at byte {left} the journal holds neither what was nor what is"
            )),
            Err(error) => Err(format!("after a failure at byte {left}: {error}")),
        }
    }
}

/// A journal in which an image is written, too.
fn journal_with(storage: MemoryStorage, image: &Image) -> Result<MemoryStorage, RetentionError> {
    let mut retention = Retention::open(storage)?;
    retention.flush(image)?;
    Ok(retention.into_storage())
}

/// The retained cells that a journal says.
fn cells(storage: MemoryStorage) -> Result<Vec<u8>, RetentionError> {
    let mut exchange = Exchange::default();
    Retention::open(storage)?.restore(&mut exchange);
    Ok(exchange.retained().collect())
}

/// The file of what the control remembers: whole it says the same again, a part of it is refused. It appears under its name
/// when it is whole (`crates/machine/host/src/files.rs`).
fn file(remembered: &Remembered, dice: &mut Dice) -> Result<(), String> {
    let text = write_remembered(remembered);
    match read_remembered(text.as_bytes()) {
        Ok(read) if read == *remembered => {}
        Ok(read) => return Err(format!("{remembered:?} is read as {read:?}")),
        Err(error) => return Err(format!("what the control remembers cannot be read: {error}")),
    }
    let end = dice.below(text.len().saturating_sub(1));
    let part = text.as_bytes().get(..end).unwrap_or_default();
    match read_remembered(part) {
        Err(_) => Ok(()),
        Ok(_) => Err(format!("{end} of {} bytes are taken for the whole", text.len())),
    }
}
