//! How long errors take to follow what is typed, in a program of 10 000 blocks.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;

use support::InProcess;
use support::client::Client;

/// Blocks of the program.
const BLOCKS: usize = 10_000;
/// From the change to the diagnostics; a tenth of a second is felt as at once.
const LIMIT: Duration = Duration::from_millis(100);
/// Tests are not optimised throughout, and other tests run beside.
const UNOPTIMISED: u32 = 5;

fn program() -> String {
    let mut text =
        String::from("0 BEGIN PGM 1 MM\n1 TOOL DEF 1 L+0 R+2\n2 TOOL CALL 1 Z S1000\n3 FN 0: Q1 = +2\n");
    for block in 4..BLOCKS - 1 {
        let (x, y) = (block % 97, block % 89);
        text += &format!("{block} L X+{x} Y-{y}.5 R0 F{} ; Ü\n", 100 + block % 7);
    }
    text + &format!("{} END PGM 1 MM\n", BLOCKS - 1)
}

#[test]
fn errors_follow_at_once() {
    let mut client = Client::start(InProcess::start(), Value::Null);
    let mut document = client.open_text(Path::new("/none/1.H"), "tnc-plain", &program());
    assert_eq!(client.diagnostics(&document), [] as [Value; 0]);
    let mut times = Vec::new();
    let wrong = "5000 L X+1..5 ";
    let right = "5000 L X+53 ";
    assert_eq!(5000 % 97, 53);
    for (old, new, errors) in [(right, wrong, 1), (wrong, right, 0)].repeat(5) {
        let start = Instant::now();
        client.edit(&mut document, old, new);
        assert_eq!(client.diagnostics(&document).len(), errors);
        times.push(start.elapsed());
    }
    times.sort();
    let median = times[times.len() / 2];
    println!(
        "from a change to its diagnostics: median {median:?}, longest {:?}",
        times[times.len() - 1]
    );
    let limit = if cfg!(debug_assertions) {
        LIMIT * UNOPTIMISED
    } else {
        LIMIT
    };
    assert!(median < limit, "{median:?}");
}
