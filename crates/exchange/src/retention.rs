//! Markers and bytes that survive power-off: M1000-M1999 and B0-B127 [000:11579].
//!
//! The original keeps them in battery memory. Here they go to a journal: every 200 ms, when something
//! changed, a record with all of them and a check sum is appended. A power-off in the middle of a record
//! leaves the record before it valid.

use std::io;

use crate::image::retained_cells;
use crate::{Exchange, Image};

/// How often a change is written, in microseconds.
const FLUSH_INTERVAL: u64 = 200_000;
/// A journal longer than this is replaced by its last record, in bytes.
const JOURNAL_LENGTH_MAX: usize = 64 * 1024;

/// The first bytes of a record.
const MARK: [u8; 4] = *b"BPR1";
/// 1000 markers, 8 to a byte, and 128 bytes.
const PAYLOAD: usize = 1000 / 8 + 128;
/// Mark, payload, check sum.
const RECORD: usize = 4 + PAYLOAD + 4;

/// Where the journal lies. The file system belongs to whoever opens the [`Retention`].
pub trait RetentionStorage {
    /// All that was written; empty when there is nothing yet.
    ///
    /// # Errors
    /// What the medium reports.
    fn read(&mut self) -> io::Result<Vec<u8>>;

    /// Adds bytes at the end. After an error or a power-off any first part of them may be there.
    ///
    /// # Errors
    /// What the medium reports.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Replaces all by other bytes, atomically: after an error or a power-off either the old or the new
    /// content is there (a new file, renamed).
    ///
    /// # Errors
    /// What the medium reports.
    fn replace(&mut self, bytes: &[u8]) -> io::Result<()>;
}

/// The medium of the retained memory failed.
#[derive(Debug, thiserror::Error)]
#[error("retained PLC memory: {0}")]
pub struct RetentionError(#[from] io::Error);

/// Keeps the retained memory in a journal.
#[derive(Debug)]
pub struct Retention<S> {
    storage: S,
    /// What the last valid record holds.
    written: Payload,
    /// Bytes of the journal; `None` after a failed write, when the end of the journal is not known.
    length: Option<usize>,
    flushed_at: u64,
}

type Payload = [u8; PAYLOAD];

impl<S: RetentionStorage> Retention<S> {
    /// Opens the journal and finds the last complete record.
    ///
    /// # Errors
    /// When the journal cannot be read, or a damaged end cannot be cut off.
    pub fn open(mut storage: S) -> Result<Retention<S>, RetentionError> {
        let journal = storage.read()?;
        let records = journal.chunks(RECORD).map_while(decode);
        let (count, last) = records
            .enumerate()
            .last()
            .map_or((0, [0; PAYLOAD]), |(index, payload)| (index + 1, payload));
        let mut retention = Retention {
            storage,
            written: last,
            length: Some(journal.len()),
            flushed_at: 0,
        };
        if count * RECORD != journal.len() {
            retention.rewrite()?;
        }
        Ok(retention)
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
        if payload == self.written && self.length.is_some() {
            return Ok(());
        }
        let Some(length) = self.length.filter(|length| length + RECORD <= JOURNAL_LENGTH_MAX) else {
            self.written = payload;
            return self.rewrite();
        };
        self.length = None;
        self.storage.append(&encode(&payload))?;
        self.length = Some(length + RECORD);
        self.written = payload;
        Ok(())
    }

    /// The storage, when nothing more is to be written.
    pub fn into_storage(self) -> S {
        self.storage
    }

    fn rewrite(&mut self) -> Result<(), RetentionError> {
        self.length = None;
        self.storage.replace(&encode(&self.written))?;
        self.length = Some(RECORD);
        Ok(())
    }
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

fn encode(payload: &Payload) -> Vec<u8> {
    let mut record = Vec::with_capacity(RECORD);
    record.extend(MARK);
    record.extend(payload);
    record.extend(crc32fast::hash(payload).to_be_bytes());
    record
}

fn decode(record: &[u8]) -> Option<Payload> {
    let rest = record.strip_prefix(&MARK)?;
    let (payload, sum) = rest.split_first_chunk::<PAYLOAD>()?;
    (sum == crc32fast::hash(payload).to_be_bytes()).then_some(*payload)
}

/// A journal in memory: for tests, and for controls that keep nothing.
#[derive(Clone, Debug, Default)]
pub struct MemoryStorage {
    /// What was written.
    pub content: Vec<u8>,
}

impl RetentionStorage for MemoryStorage {
    fn read(&mut self) -> io::Result<Vec<u8>> {
        Ok(self.content.clone())
    }

    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.content.extend(bytes);
        Ok(())
    }

    fn replace(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.content = bytes.to_vec();
        Ok(())
    }
}
