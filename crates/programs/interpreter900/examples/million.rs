//! How long 1,000,000 short G1 blocks take to read: `cargo run --release --example million`.

use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use bahn_interpreter900::Reader900;
use bahn_path::{ElementSource, Position, Step};
use bahn_system900::DataFile;
use bahn_text::MemoryFiles;

const BLOCKS: u32 = 1_000_000;

fn main() {
    let file =
        DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nq111: $02020059\nq112: $0303005A\n");
    let mut text = String::from("N1 G1 F3000\n");
    for block in 0..BLOCKS {
        let x = f64::from(block % 1000) * 0.1;
        let y = f64::from(block % 777) * 0.05;
        let _ = writeln!(text, "N{} G1 X{x:.3} Y{y:.3}", block + 2);
    }
    let begin = Instant::now();
    let beside = Arc::new(MemoryFiles::default());
    let mut reader = Reader900::new("P1000.900", text.as_bytes(), 1, Position::ZERO, beside);
    reader.give_memory(file.memory().clone());
    let opened = begin.elapsed();
    let mut elements = 0;
    while let Step::Element(_) = reader.next() {
        elements += 1;
    }
    println!(
        "opened {opened:?}, {elements} elements after {:?}",
        begin.elapsed()
    );
}
