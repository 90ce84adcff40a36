//! Markers and bytes that survive power-off: M1000-M1999 and B0-B127 [000:11579].
//!
//! The original keeps them in battery memory. Here they go to a journal of fixed length: a ring of records,
//! each with its number and a check sum, of which a change overwrites the oldest. A power-off in the middle
//! of a write, or a damaged place of the medium, costs one record and never the others.

use std::fmt;
use std::io;

use crate::image::retained_cells;
use crate::{Exchange, Image};

/// How often a change is written, in microseconds.
const FLUSH_INTERVAL: u64 = 200_000;

/// The first bytes of a record.
const MARK: [u8; 4] = *b"BPR2";
/// 1000 markers, 8 to a byte, and 128 bytes.
const PAYLOAD: usize = 1000 / 8 + 128;
/// Mark, number, payload, zeros, check sum: a sector, which media write as a whole.
const RECORD: usize = 512;
/// Where the check sum stands.
const SUM: usize = RECORD - 4;
/// Records of the ring.
const RECORDS: usize = 16;
/// Bytes of a journal.
pub const JOURNAL_LENGTH: usize = RECORD * RECORDS;

/// Where the journal lies. The file system belongs to whoever opens the [`Retention`].
pub trait RetentionStorage {
    /// All that was written, as far as it is not much longer than [`JOURNAL_LENGTH`]; `None` when nothing
    /// ever was.
    ///
    /// # Errors
    /// What the medium reports.
    fn read(&mut self) -> io::Result<Option<Vec<u8>>>;

    /// Overwrites bytes from a place on, or adds them at the end; they are on the medium when it returns.
    /// After an error or a power-off any first part of them may be.
    ///
    /// # Errors
    /// What the medium reports.
    fn write(&mut self, at: usize, bytes: &[u8]) -> io::Result<()>;

    /// Keeps a copy of a damaged journal before it is written over.
    ///
    /// # Errors
    /// What the medium reports.
    fn set_aside(&mut self, journal: &[u8]) -> io::Result<()>;
}

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RetentionError {
    /// Reading or writing of the medium failed.
    #[error("retained PLC memory: {0}")]
    Medium(#[from] io::Error),
    /// What is there is something else.
    #[error("this is no journal of retained PLC memory")]
    Foreign,
}

/// What is wrong with a journal that was opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Damage {
    /// Records that are damaged or missing.
    pub records: usize,
    /// What is lost with them.
    pub loss: Loss,
}

/// The values that are lost by damage of the medium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// Nothing: only older values were damaged.
    Nothing,
    /// So many of the latest changes at most: a record where they may have stood is damaged, perhaps by
    /// power-off in the midst of writing it.
    Latest(usize),
    /// All values are lost.
    Everything,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (records, verb) = (self.records, if self.records == 1 { "is" } else { "are" });
        write!(
            f,
            "{records} of {RECORDS} records of the retained PLC memory {verb} damaged: "
        )?;
        match self.loss {
            Loss::Nothing => f.write_str("nothing is lost"),
            Loss::Latest(1) => f.write_str("the latest change may be lost"),
            Loss::Latest(changes) => write!(f, "the latest {changes} changes may be lost"),
            Loss::Everything => f.write_str("all retained markers and bytes are lost and begin with 0"),
        }
    }
}

/// Keeps the retained memory in a journal.
#[derive(Debug)]
pub struct Retention<S> {
    storage: S,
    /// What the last record holds.
    written: Payload,
    /// The number of the record; each has one more than that before.
    number: u64,
    /// The last write failed.
    failed: bool,
    flushed_at: u64,
    damage: Option<Damage>,
}

type Payload = [u8; PAYLOAD];

impl<S: RetentionStorage> Retention<S> {
    /// Opens the journal and finds the last valid record. A damaged one is set aside and written anew: see
    /// [`Retention::damage`].
    ///
    /// # Errors
    /// When the journal cannot be read, is something else, or cannot be set aside or written.
    pub fn open(mut storage: S) -> Result<Retention<S>, RetentionError> {
        let journal = storage.read()?;
        let (last, damage) = journal.as_deref().map_or(Ok((None, None)), examine)?;
        if let Some(journal) = journal.as_deref().filter(|_| damage.is_some())
            && journal.iter().any(|byte| *byte != 0)
        {
            storage.set_aside(journal)?;
        }
        let (number, written) = last.unwrap_or((0, [0; PAYLOAD]));
        let mut retention = Retention {
            storage,
            written,
            number,
            failed: false,
            flushed_at: 0,
            damage,
        };
        if journal.is_none() || damage.is_some() {
            retention.fill()?;
        }
        Ok(retention)
    }

    /// What was wrong with the journal that was opened.
    pub fn damage(&self) -> Option<Damage> {
        self.damage
    }

    /// Puts the retained values into both images, as at power-on.
    pub fn restore(&self, exchange: &mut Exchange) {
        let mut image = Image::default();
        unpack(&self.written, &mut image);
        *exchange = Exchange::with(image);
    }

    /// Writes what changed when 200 ms have passed since the last time. `now` is the control's time in
    /// microseconds.
    ///
    /// # Errors
    /// When the medium fails; the values are tried again the next time.
    pub fn tick(&mut self, image: &Image, now: u64) -> Result<(), RetentionError> {
        if now.saturating_sub(self.flushed_at) < FLUSH_INTERVAL {
            return Ok(());
        }
        self.flushed_at = now;
        self.flush(image)
    }

    /// Writes what changed at once: power fails, or the program ends.
    ///
    /// # Errors
    /// When the medium fails.
    pub fn flush(&mut self, image: &Image) -> Result<(), RetentionError> {
        let payload = pack(image);
        if payload == self.written && !self.failed {
            return Ok(());
        }
        let number = self.number.wrapping_add(1);
        self.failed = true;
        self.storage.write(place_of(number), &encode(number, &payload))?;
        (self.written, self.number, self.failed) = (payload, number, false);
        Ok(())
    }

    /// The medium that the journal writes to.
    pub fn storage(&self) -> &S {
        &self.storage
    }

    /// The storage, when nothing more is to be written.
    pub fn into_storage(self) -> S {
        self.storage
    }

    /// Writes the values into all records of the ring.
    fn fill(&mut self) -> Result<(), RetentionError> {
        const ALL: u64 = RECORDS as u64;
        // Who counts to the end of 64 bits begins anew.
        let first = self
            .number
            .checked_add(ALL)
            .map_or(0, |number| number / ALL * ALL);
        let numbers = first..first.saturating_add(ALL);
        let ring: Vec<u8> = numbers.flat_map(|number| encode(number, &self.written)).collect();
        self.storage.write(0, &ring)?;
        self.number = first.saturating_add(ALL - 1);
        Ok(())
    }
}

/// The newest record of a journal, its number and values, and what is wrong with the others.
type Examined = (Option<(u64, Payload)>, Option<Damage>);

fn examine(journal: &[u8]) -> Result<Examined, RetentionError> {
    let valid: Vec<(u64, Payload)> = journal
        .chunks(RECORD)
        .enumerate()
        .filter_map(|(place, record)| {
            decode(record).filter(|(number, _)| place_of(*number) == place * RECORD)
        })
        .collect();
    let newest = valid.iter().copied().max_by_key(|(number, _)| *number);
    let begun = journal.iter().zip(MARK).all(|(byte, mark)| *byte == mark);
    let ours = newest.is_some() || begun || journal.iter().all(|byte| *byte == 0);
    if !ours || journal.len() > JOURNAL_LENGTH {
        return Err(RetentionError::Foreign);
    }
    let records = RECORDS - valid.len();
    let loss = newest.map_or(Loss::Everything, |(newest, _)| {
        // What came after the newest one stood in the records that follow it in the ring.
        let there = |number: &u64| {
            valid
                .iter()
                .any(|(other, _)| place_of(*other) == place_of(*number))
        };
        match (newest.wrapping_add(1)..newest.wrapping_add(RECORDS as u64))
            .take_while(|number| !there(number))
            .count()
        {
            0 => Loss::Nothing,
            changes => Loss::Latest(changes),
        }
    });
    Ok((newest, (records > 0).then_some(Damage { records, loss })))
}

/// The byte of the journal where a record stands.
fn place_of(number: u64) -> usize {
    (number % RECORDS as u64) as usize * RECORD
}

/// What of an image survives power-off, packed: M1000-M1999, eight to a byte, and B0-B127.
pub fn retained_memory(image: &Image) -> Vec<u8> {
    pack(image).to_vec()
}

/// An image with the packed memory of [`retained_memory`]; `None` when it has another length.
pub fn image_of(memory: &[u8]) -> Option<Image> {
    let mut image = Image::default();
    unpack(memory.try_into().ok()?, &mut image);
    Some(image)
}

fn pack(image: &Image) -> Payload {
    let mut payload = [0; PAYLOAD];
    let cells = image.cells();
    for (index, cell) in retained_cells().enumerate() {
        let value = cells.get(cell).copied().unwrap_or(0);
        let (at, value) = place(index, value);
        if let Some(byte) = payload.get_mut(at) {
            *byte |= value;
        }
    }
    payload
}

fn unpack(payload: &Payload, image: &mut Image) {
    for (index, cell) in retained_cells().enumerate() {
        let (at, mask) = place(index, 1);
        let byte = payload.get(at).copied().unwrap_or(0);
        let value = if index < 1000 {
            u8::from(byte & mask != 0)
        } else {
            byte
        };
        if let Some(cell) = image.cells_mut().get_mut(cell) {
            *cell = value;
        }
    }
}

/// The byte of the payload for a retained cell, and its value there.
fn place(index: usize, value: u8) -> (usize, u8) {
    match index.checked_sub(1000) {
        None => (index / 8, value.min(1) << (index % 8)),
        Some(byte) => (1000 / 8 + byte, value),
    }
}

fn encode(number: u64, payload: &Payload) -> Vec<u8> {
    let mut record = Vec::with_capacity(RECORD);
    record.extend(MARK);
    record.extend(number.to_be_bytes());
    record.extend(payload);
    record.resize(SUM, 0);
    record.extend(crc32fast::hash(&record).to_be_bytes());
    record
}

fn decode(record: &[u8]) -> Option<(u64, Payload)> {
    let (content, sum) = record.split_at_checked(SUM)?;
    if sum != crc32fast::hash(content).to_be_bytes() {
        return None;
    }
    let (number, rest) = content.strip_prefix(&MARK)?.split_first_chunk()?;
    let (payload, _) = rest.split_first_chunk::<PAYLOAD>()?;
    Some((u64::from_be_bytes(*number), *payload))
}

/// A journal in memory: for tests, and for controls that keep nothing.
#[derive(Clone, Debug, Default)]
pub struct MemoryStorage {
    /// What was written; `None` when nothing ever was.
    pub content: Option<Vec<u8>>,
    /// The damaged journals that were kept.
    pub aside: Vec<Vec<u8>>,
}

impl RetentionStorage for MemoryStorage {
    fn read(&mut self) -> io::Result<Option<Vec<u8>>> {
        Ok(self.content.clone())
    }

    fn write(&mut self, at: usize, bytes: &[u8]) -> io::Result<()> {
        let content = self.content.get_or_insert_default();
        content.resize(content.len().max(at + bytes.len()), 0);
        if let Some(there) = content.get_mut(at..at + bytes.len()) {
            there.copy_from_slice(bytes);
        }
        Ok(())
    }

    fn set_aside(&mut self, journal: &[u8]) -> io::Result<()> {
        self.aside.push(journal.to_vec());
        Ok(())
    }
}
