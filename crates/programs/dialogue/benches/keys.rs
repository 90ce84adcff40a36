//! Time of a key with what is shown after it, in a program of a million blocks.
//!
//! ```text
//! cargo bench -p bahn-dialogue
//! ```

#![expect(clippy::unwrap_used, reason = "the benchmark enters what it knows")]

use std::fmt::Write;
use std::sync::Arc;

use bahn_dialogue::{Editor, Key, Setting};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_program::Program;
use divan::{Bencher, black_box};

const BLOCKS: u32 = 1_000_000;

fn main() {
    divan::main();
}

/// An editor in the middle of a long program.
fn editor() -> Editor {
    let mut text = String::from("BEGIN PGM BENCH MM\n");
    for block in 0..BLOCKS {
        let x = f64::from(block % 1000) / 10.0;
        writeln!(text, "L X{x:+} Y+5 Z-1 F1000").unwrap();
    }
    text.push_str("END PGM BENCH MM\n");
    let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc415b));
    let program = Program::from_bytes("BENCH.H", text.into_bytes());
    let mut editor = Editor::new(Arc::new(program), setting);
    editor.go_to(BLOCKS / 2);
    editor
}

fn press(editor: &mut Editor, names: &str) {
    for key in names.split(' ').filter_map(Key::from_name) {
        black_box(editor.key(key));
        black_box(editor.view(10, 10));
    }
}

/// Ten keys that make a block.
#[divan::bench]
fn a_block(bencher: Bencher) {
    let editor = editor();
    bencher
        .with_inputs(|| editor.clone())
        .bench_local_values(|mut editor| press(&mut editor, "L X 1 0 ENT RL ENT 5 ENT NO_ENT"));
}

/// Seven keys that change a value.
#[divan::bench]
fn a_value(bencher: Bencher) {
    let editor = editor();
    bencher
        .with_inputs(|| editor.clone())
        .bench_local_values(|mut editor| press(&mut editor, "RIGHT RIGHT 1 2 POINT 5 END"));
}

/// A word that no other block has: half a million blocks are looked at.
#[divan::bench(sample_count = 10)]
fn a_word_that_is_nowhere(bencher: Bencher) {
    let mut editor = editor();
    press(&mut editor, "L X 1 ENT NO_ENT NO_ENT 9 ENT RIGHT RIGHT RIGHT");
    bencher
        .with_inputs(|| editor.clone())
        .bench_local_values(|mut editor| press(&mut editor, "DOWN"));
}

/// A text that no block has: all blocks are looked at.
#[divan::bench(sample_count = 10)]
fn a_text_that_is_nowhere(bencher: Bencher) {
    let mut editor = editor();
    press(&mut editor, "SK5 Q 7 7");
    bencher
        .with_inputs(|| editor.clone())
        .bench_local_values(|mut editor| press(&mut editor, "ENT"));
}
