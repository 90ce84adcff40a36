//! Power-off loses nothing that was retained before.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use bahn_exchange::{Exchange, Image, MemoryStorage, Number, Retention, RetentionStorage};
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

fn restored(content: Vec<u8>) -> Image {
    let retention = Retention::open(MemoryStorage { content }).unwrap();
    let mut exchange = Exchange::default();
    retention.restore(&mut exchange);
    assert_eq!(exchange.nc(), exchange.plc());
    exchange.plc().clone()
}

#[test]
fn values_are_written_every_200_ms() {
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    retention.tick(&image(1, true), 100_000).unwrap();
    retention.tick(&image(2, true), 200_000).unwrap();
    retention.tick(&image(3, true), 399_999).unwrap();
    let content = retention.into_storage().content;
    assert_eq!(restored(content).number(b127()), 2);
}

#[test]
fn a_power_off_inside_a_record_keeps_the_record_before() {
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    retention.flush(&image(1, true)).unwrap();
    let before = retention.into_storage().content;
    let mut retention = Retention::open(MemoryStorage {
        content: before.clone(),
    })
    .unwrap();
    retention.flush(&image(-2, false)).unwrap();
    let after = retention.into_storage().content;
    for cut in before.len()..=after.len() {
        let found = restored(after[..cut].to_vec());
        let expected = if cut == after.len() {
            image(-2, false)
        } else {
            image(1, true)
        };
        assert_eq!(found, expected, "cut at {cut}");
    }
}

#[test]
fn the_journal_stays_short() {
    let mut retention = Retention::open(MemoryStorage::default()).unwrap();
    for value in 0..1000 {
        retention.flush(&image(value % 100, value % 2 == 0)).unwrap();
    }
    let content = retention.into_storage().content;
    assert!(content.len() <= 64 * 1024, "{}", content.len());
    assert_eq!(restored(content), image(99, false));
}

/// A medium that stores a part of what it should and reports an error, once.
struct Failing {
    content: Vec<u8>,
    part: Option<usize>,
}

impl RetentionStorage for Failing {
    fn read(&mut self) -> io::Result<Vec<u8>> {
        Ok(self.content.clone())
    }

    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.part.take() {
            Some(part) => {
                self.content.extend(&bytes[..part.min(bytes.len())]);
                Err(io::Error::other("medium full"))
            }
            None => {
                self.content.extend(bytes);
                Ok(())
            }
        }
    }

    fn replace(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.content = bytes.to_vec();
        Ok(())
    }
}

#[test]
fn a_failed_write_is_repeated() {
    let storage = Failing {
        content: Vec::new(),
        part: Some(100),
    };
    let mut retention = Retention::open(storage).unwrap();
    assert!(retention.flush(&image(1, true)).is_err());
    retention.flush(&image(1, true)).unwrap();
    retention.flush(&image(2, true)).unwrap();
    assert_eq!(restored(retention.into_storage().content), image(2, true));
}

proptest! {
    #[test]
    fn any_bytes_open_as_a_journal(content in prop::collection::vec(any::<u8>(), 0..600)) {
        restored(content);
    }
}
