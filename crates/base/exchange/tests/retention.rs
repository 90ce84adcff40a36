//! Power-off loses nothing that was retained before; damage costs what it hits, and is said.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use bahn_exchange::{
    Damage, Exchange, Image, JOURNAL_LENGTH, Loss, MemoryStorage, Number, Retention, RetentionError,
    RetentionStorage,
};
use proptest::prelude::*;
use std::io;

fn image(byte: i32, marker: bool) -> Image {
    let mut image = Image::default();
    image.set_number(b127(), byte);
    image.set_bit("M1999".parse().unwrap(), marker);
    image
}

fn b127() -> Number {
    "B127".parse().unwrap()
}

fn holding(content: Vec<u8>) -> MemoryStorage {
    MemoryStorage {
        content: Some(content),
        aside: Vec::new(),
    }
}

/// Image, damage, and what was kept of the journal.
type Opened = (Image, Option<Damage>, Vec<Vec<u8>>);

/// The image of a journal, what was wrong with it, and what was kept of it.
fn opened(content: Vec<u8>) -> Result<Opened, RetentionError> {
    let retention = Retention::open(holding(content))?;
    let mut exchange = Exchange::default();
    retention.restore(&mut exchange);
    assert_eq!(exchange.nc(), exchange.plc());
    let damage = retention.damage();
    let storage = retention.into_storage();
    let again = Retention::open(holding(storage.content.unwrap())).unwrap();
    assert_eq!(again.damage(), None, "what was damaged is whole now");
    Ok((exchange.plc().clone(), damage, storage.aside))
}

fn restored(content: Vec<u8>) -> Image {
    opened(content).unwrap().0
}

/// A journal with values 1, 2, ... of B127, each with its own record; the last one `last`.
fn journal(last: i32) -> Vec<u8> {
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    for value in 1..=last {
        retention.flush(&image(value, value % 2 == 0)).unwrap();
    }
    retention.into_storage().content.unwrap()
}

#[test]
fn values_are_written_every_200_ms() {
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    retention.tick(&image(1, true), 100_000).unwrap();
    retention.tick(&image(2, true), 200_000).unwrap();
    retention.tick(&image(3, true), 399_999).unwrap();
    let content = retention.into_storage().content.unwrap();
    assert_eq!(restored(content).number(b127()), 2);
}

/// A write that power-off cuts anywhere leaves the values before or after it, and no others.
#[test]
fn a_power_off_inside_a_record_keeps_the_record_before() {
    let before = journal(20);
    let after = journal(21);
    let changed: Vec<usize> = (0..JOURNAL_LENGTH)
        .filter(|at| before[*at] != after[*at])
        .collect();
    let (first, last) = (changed[0], changed[changed.len() - 1]);
    assert!(last - first < 512, "one sector is written");
    for cut in first..=last + 1 {
        let mut torn = before.clone();
        torn[..cut].copy_from_slice(&after[..cut]);
        let (found, damage, _) = opened(torn).unwrap();
        if cut == last + 1 {
            assert_eq!((found, damage), (image(21, false), None));
        } else {
            assert_eq!(found, image(20, true), "cut at {cut}");
        }
    }
}

/// Any bit of any byte may flip: the last valid values count; what may be lost is said, and the damaged
/// journal is kept as it is.
#[test]
fn one_flipped_bit_costs_one_record() {
    let whole = journal(37);
    assert_eq!(whole.len(), JOURNAL_LENGTH);
    // Records 16 to 31 were made with the journal, number 0; then one for each change.
    let newest = (31 + 37) % 16;
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[at] ^= 1 << (at % 8);
        let (found, damage, aside) = opened(damaged.clone()).unwrap();
        let expected = match at / 512 {
            place if place == newest => (36, Loss::Latest(1)),
            // Nobody can tell the oldest record from one that would be newer.
            place if place == (newest + 1) % 16 => (37, Loss::Latest(1)),
            _ => (37, Loss::Nothing),
        };
        assert_eq!(found.number(b127()), expected.0, "byte {at}");
        let records = 1;
        assert_eq!(
            damage,
            Some(Damage {
                records,
                loss: expected.1
            }),
            "byte {at}"
        );
        assert_eq!(aside, [damaged]);
    }
}

/// A journal may be cut anywhere: the newest of the records that are left counts, and the loss is said.
#[test]
fn truncation_is_never_silent() {
    let whole = journal(37);
    for length in 0..whole.len() {
        let (found, damage, aside) = opened(whole[..length].to_vec()).unwrap();
        let damage = damage.unwrap();
        // Record numbers 53 to 68 hold the values 22 to 37; number 68 stands at place 4.
        let left = length / 512;
        assert_eq!(damage.records, 16 - left);
        let expected = match left {
            0 => 0,
            // Numbers 64 (33) to 68 (37) stand at the places 0 to 4.
            1..=5 => 32 + left as i32,
            _ => 37,
        };
        assert_eq!(found.number(b127()), expected, "{length} bytes");
        let loss = match left {
            0 => Loss::Everything,
            // All that is cut off may have come after what is left.
            1..=5 => Loss::Latest(16 - left),
            _ => Loss::Nothing,
        };
        assert_eq!(damage.loss, loss, "{length} bytes");
        assert_eq!(aside.len(), usize::from(length > 0), "an empty file is not kept");
    }
}

#[test]
fn the_journal_has_one_length() {
    for changes in [0, 1, 1000] {
        assert_eq!(journal(changes).len(), JOURNAL_LENGTH);
    }
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    for value in 0..1000 {
        retention.flush(&image(value % 100, value % 2 == 0)).unwrap();
    }
    let content = retention.into_storage().content.unwrap();
    assert_eq!(restored(content), image(99, false));
}

/// Files of somebody else are refused, not written over.
#[test]
fn other_files_are_refused() {
    let too_long = [journal(3), vec![0]].concat();
    for content in [b"name = 'mill'".to_vec(), vec![7; 8192], too_long] {
        let opened = Retention::open(holding(content));
        assert!(matches!(opened, Err(RetentionError::Foreign)), "{opened:?}");
    }
}

/// A medium that stores a part of what it should and reports an error, once.
struct Failing {
    memory: MemoryStorage,
    part: Option<usize>,
}

impl RetentionStorage for Failing {
    fn read(&mut self) -> io::Result<Option<Vec<u8>>> {
        self.memory.read()
    }

    fn write(&mut self, at: usize, bytes: &[u8]) -> io::Result<()> {
        match self.part.take_if(|_| bytes.len() == 512) {
            Some(part) => {
                self.memory.write(at, &bytes[..part])?;
                Err(io::Error::other("medium full"))
            }
            None => self.memory.write(at, bytes),
        }
    }

    fn set_aside(&mut self, journal: &[u8]) -> io::Result<()> {
        self.memory.set_aside(journal)
    }
}

#[test]
fn a_failed_write_is_repeated() {
    let storage = Failing {
        memory: MemoryStorage::default(),
        part: Some(100),
    };
    let mut retention = Retention::open(storage).unwrap();
    assert!(retention.flush(&image(1, true)).is_err());
    retention.flush(&image(1, true)).unwrap();
    retention.flush(&image(2, true)).unwrap();
    let content = retention.into_storage().memory.content.unwrap();
    assert_eq!(restored(content), image(2, true));
}

proptest! {
    #[test]
    fn any_bytes_open_as_a_journal_or_are_refused(
        content in prop::collection::vec(any::<u8>(), 0..600),
        begun: bool,
    ) {
        let mut content = content;
        for (byte, mark) in content.iter_mut().zip(*b"BPR2").filter(|_| begun) {
            *byte = mark;
        }
        if let Ok((found, damage, _)) = opened(content) {
            prop_assert_eq!(found, Image::default());
            prop_assert_eq!(damage.map(|damage| damage.loss), Some(Loss::Everything));
        }
    }

    /// Several records may be damaged: one that is valid and as new as any other that is counts.
    #[test]
    fn the_newest_valid_record_counts(damaged in prop::collection::btree_set(0..16usize, 0..16), bit in 0..8u32) {
        let mut content = journal(37);
        for place in &damaged {
            content[place * 512 + 200] ^= 1 << bit;
        }
        let values = (22..=37).rev().map(|value| (value, (31 + value as usize) % 16));
        let newest = values.into_iter().find(|(_, place)| !damaged.contains(place)).unwrap().0;
        prop_assert_eq!(restored(content).number(b127()), newest);
    }
}
