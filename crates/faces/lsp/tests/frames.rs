//! Whatever bytes come, the reader of messages ends or goes on, and takes no more memory than came.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

use std::io::Cursor;

use bahn_lsp::{Frame, read};
use proptest::prelude::*;

/// All that is read, as letters: M a message, W none, E the end with a reason, `.` without one.
fn read_all(bytes: &[u8]) -> String {
    let mut input = Cursor::new(bytes);
    let mut found = String::new();
    loop {
        match read(&mut input) {
            Frame::Message(_) => found.push('M'),
            Frame::Wrong(..) => found.push('W'),
            Frame::End(Some(_)) => return found + "E",
            Frame::End(None) => return found + ".",
        }
    }
}

fn frame(text: &str) -> String {
    format!("Content-Length: {}\r\n\r\n{text}", text.len())
}

const NOTE: &str = r#"{"jsonrpc":"2.0","method":"initialized"}"#;

#[test]
fn what_is_no_message_does_not_end_the_stream() {
    let note = frame(NOTE);
    for wrong in [
        "{",
        "null",
        "[]",
        "{\"id\":7}",
        "\u{fffd}",
        "",
        &"[".repeat(100_000),
    ] {
        assert_eq!(
            read_all(format!("{}{note}", frame(wrong)).as_bytes()),
            "WM.",
            "{wrong:.20}"
        );
    }
    // A head without a length, with more than one name, in other letters.
    assert_eq!(read_all(format!("nonsense\r\n\r\n{note}").as_bytes()), "WM.");
    let other = format!("content-length:{}\nContent-Type: a\n\n{NOTE}", NOTE.len());
    assert_eq!(read_all(format!("{other}{note}").as_bytes()), "MM.");
    assert_eq!(read_all(b""), ".");
}

#[test]
fn a_request_that_cannot_be_read_has_its_number() {
    let mut input = Cursor::new(frame(r#"{"id":7,"method":5}"#).into_bytes());
    let Frame::Wrong(_, id) = read(&mut input) else {
        panic!()
    };
    assert_eq!(id, Some(7.into()));
}

/// 2^62 bytes were allocated before one of them had come.
#[test]
fn a_length_beyond_all_messages_ends_the_stream() {
    for length in [
        "4611686018427387904",
        "99999999999999999999999",
        "-1",
        "x",
        "",
        "67108865",
    ] {
        let text = format!("Content-Length: {length}\r\n\r\n{NOTE}");
        assert_eq!(read_all(text.as_bytes()), "E", "{length}");
    }
    // A length that is allowed, of which little comes.
    assert_eq!(read_all(b"Content-Length: 67108864\r\n\r\n{}"), "E");
    assert_eq!(read_all(b"Content-Length: 5"), "E");
    assert_eq!(read_all(&[b'a'; 100_000]), "E");
    assert_eq!(read_all("a: b\r\n".repeat(1000).as_bytes()), "E");
}

proptest! {
    #[test]
    fn any_frames_end(pieces in prop::collection::vec(
        prop_oneof![
            Just(frame(NOTE).into_bytes()),
            "\\PC{0,40}".prop_map(|text| frame(&text).into_bytes()),
            (any::<u64>(), "[ -~]{0,20}").prop_map(|(length, text)|
                format!("Content-Length: {}\r\n\r\n{text}", length >> (length % 64)).into_bytes()),
            prop::collection::vec(any::<u8>(), 0..60),
        ], 0..20,
    )) {
        let bytes = pieces.concat();
        let found = read_all(&bytes);
        prop_assert!(found.ends_with(['E', '.']));
        // Each needs its head.
        prop_assert!(found.len() <= bytes.len() / 2 + 1);
    }
}
