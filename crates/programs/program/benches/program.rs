//! Blocks per second of indexing, decoding and formatting a program of a million blocks.
//!
//! ```text
//! cargo bench -p bahn-program
//! ```

#![expect(clippy::unwrap_used, reason = "writing to a string cannot fail")]

use std::fmt::Write;

use bahn_parameters::ControlModel;
use bahn_program::{Block, Chunk, Edit, FormatOptions, Operation, Program, format_program};
use divan::counter::{BytesCount, ItemsCount};
use divan::{Bencher, black_box};

const BLOCKS: u32 = 1_000_000;

fn main() {
    for (name, text) in [
        ("short", short_lines()),
        ("numbered", numbered_lines()),
        ("fn", calculations()),
        ("iso", iso_lines()),
    ] {
        println!(
            "{name}: {:.1} MB, {} bytes a block",
            text.len() as f64 / 1e6,
            text.len() as u32 / BLOCKS
        );
    }
    println!(
        "Block: {} bytes, Operation: {} bytes",
        size_of::<Block>(),
        size_of::<Operation>()
    );
    divan::main();
}

/// Three-axis blocks as CAM systems write them.
fn short_lines() -> String {
    let mut text = String::from("BEGIN PGM BENCH MM\n");
    for i in 0..BLOCKS {
        let i = f64::from(i);
        let (x, y, z) = (
            50.0 + 40.0 * (i * 0.01).cos(),
            50.0 + 40.0 * (i * 0.01).sin(),
            -i * 1e-5,
        );
        writeln!(text, "L X{x:+.3} Y{y:+.3} Z{z:+.3} F1000").unwrap();
    }
    text.push_str("END PGM BENCH MM\n");
    text
}

/// The same with block numbers, compensation and M functions.
fn numbered_lines() -> String {
    let mut text = String::new();
    for (number, line) in short_lines().lines().enumerate() {
        let tail = if line.starts_with("L X") { " R0 M" } else { "" };
        writeln!(text, "{number} {line}{tail}").unwrap();
    }
    text
}

/// The same as the numbered lines in DIN/ISO.
fn iso_lines() -> String {
    let mut text = String::from("%BENCH G71 *\n");
    for (number, line) in (1..).zip(short_lines().lines().skip(1)) {
        let Some(words) = line.strip_prefix("L ") else {
            break;
        };
        let path = if number == 1 { "G01 G40 G90 " } else { "" };
        writeln!(text, "N{number} {path}{words} *").unwrap();
    }
    text.push_str("N99999999 %BENCH G71 *\n");
    text
}

/// A program of calculations.
fn calculations() -> String {
    let mut text = String::from("BEGIN PGM BENCH MM\n");
    for i in 0..BLOCKS {
        writeln!(text, "FN1: Q{} = +Q{} + +{}.25", i % 100, i % 50, i % 1000).unwrap();
    }
    text.push_str("END PGM BENCH MM\n");
    text
}

const PROGRAMS: &[&str] = &["short", "numbered", "fn", "iso"];

/// The name of the file of a program, which says its language.
fn file(name: &str) -> &'static str {
    match name {
        "iso" => "BENCH.I",
        _ => "BENCH.H",
    }
}

fn text(name: &str) -> String {
    match name {
        "short" => short_lines(),
        "numbered" => numbered_lines(),
        "iso" => iso_lines(),
        _ => calculations(),
    }
}

#[divan::bench(args = PROGRAMS, sample_count = 20)]
fn index(bencher: Bencher, name: &str) {
    let text = text(name);
    bencher
        .counter(BytesCount::of_str(&text))
        .counter(ItemsCount::new(BLOCKS))
        .with_inputs(|| text.clone().into_bytes())
        .bench_values(|bytes| Program::from_bytes(file(name), bytes));
}

#[divan::bench(args = PROGRAMS, sample_count = 20)]
fn decode(bencher: Bencher, name: &str) {
    let program = Program::from_bytes(file(name), text(name).into_bytes());
    let mut chunk = Chunk::default();
    bencher.counter(ItemsCount::new(BLOCKS)).bench_local(|| {
        for index in 0..program.chunk_count() {
            program.decode_into(index, &mut chunk);
            black_box(&chunk);
        }
    });
}

#[divan::bench(args = PROGRAMS, sample_count = 10)]
fn format(bencher: Bencher, name: &str) {
    let program = Program::from_bytes(file(name), text(name).into_bytes());
    let mut listing = String::new();
    bencher.counter(ItemsCount::new(BLOCKS)).bench_local(|| {
        listing.clear();
        write!(listing, "{}", format_program(&program, FormatOptions::default())).unwrap();
        black_box(&listing);
    });
}

/// Edits in the middle of a program of a million blocks, as long as the longest in use, and of one of a tenth of
/// that; the new version finds its labels.
#[divan::bench(args = [100_000, 1_000_000], sample_count = 100)]
fn edit(bencher: Bencher, blocks: usize) {
    let program = labelled(blocks);
    let middle = blocks as u32 / 2;
    bencher.bench_local(|| {
        let text = "L X+1 Y+2 R0 FMAX";
        let edit = Edit::Insert { before: middle, text };
        let edited = program.edit(&edit).ok();
        black_box(edited.as_ref().and_then(|edited| edited.label(1)));
        edited
    });
}

#[divan::bench(args = [100_000], sample_count = 20)]
fn renumber(bencher: Bencher, blocks: usize) {
    let program = labelled(blocks);
    bencher.bench_local(|| program.edit(&Edit::Renumber { step: 10 }).ok());
}

/// A program with a subprogram for every hundred blocks.
fn labelled(blocks: usize) -> Program {
    let mut text = String::from("BEGIN PGM BENCH MM\n");
    for (number, line) in short_lines().lines().skip(1).take(blocks).enumerate() {
        match number % 100 {
            0 => writeln!(text, "LBL {}", number / 100 % 60_000 + 1).unwrap(),
            _ => writeln!(text, "{line}").unwrap(),
        }
    }
    text.push_str("END PGM BENCH MM\n");
    Program::from_bytes("BENCH.H", text.into_bytes())
}

/// All that is wrong in a text of 20,000 blocks, as `bahn check` asks it: in DIN/ISO the lengths of the blocks, too.
#[divan::bench(args = ["plain", "iso"])]
fn diagnostics(bencher: Bencher, language: &str) {
    const CHECKED: usize = 20_000;
    let (name, text) = match language {
        "plain" => ("BENCH.H", short_lines()),
        _ => ("BENCH.I", iso_lines()),
    };
    let lines: Vec<&str> = text.lines().take(CHECKED).collect();
    let program = Program::from_bytes(name, lines.join("\n").into_bytes());
    let limits = ControlModel::default().limits();
    bencher
        .counter(ItemsCount::new(CHECKED))
        .bench(|| black_box(program.diagnostics(Some(limits.into())).len()));
}
