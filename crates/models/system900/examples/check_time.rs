//! How long a data file of 30000 lines takes to check: `cargo run --release -p bahn-system900 --example check_time`.
#![allow(clippy::print_stdout, reason = "an example speaks to people")]

use std::fmt::Write as _;
use std::time::Instant;

use bahn_system900::{DataFile, check};

/// A file of four channels with 32 axes: descriptors, M functions, axes, user blocks; two lines are wrong.
fn text() -> String {
    let mut text = "q2: 4\nq3: 50000\n".to_owned();
    let mut line = |line: String| text += &format!("{line}\n");
    for channel in 1..=4 {
        let d = 100 * channel;
        let begin = 9000 + 10_000 * (channel - 1);
        for (entry, value) in [
            (2, begin),
            (3, 7000),
            (70, 100),
            (71, 1),
            (72, 0),
            (73, 4),
            (74, 0),
        ] {
            line(format!("q{}: {value}", d + entry));
        }
        for axis in 0..8 {
            line(format!(
                "q{}: ${:02X}{:02X}{:02X}{:02X}",
                d + 10 + axis,
                axis + 1,
                8 * (channel - 1) + axis + 1,
                0,
                if axis < 3 { 88 + axis } else { 62 + axis }
            ));
        }
    }
    line("q10: 99".to_owned());
    for quarter in 0..50 {
        line(format!("P{}: $01010501", 11_050 + quarter));
    }
    let rest = 30_000 - text.lines().count() - 2;
    let numbers = (2000..4000)
        .chain((9000..49_000).filter(|q| (q - 9000) % 10_000 < 7000))
        .take(rest);
    for number in numbers {
        let _ = writeln!(text, "q{number}: {}.5 $31000001 ; number {number}", number % 977);
    }
    text + "q50: x\nq51\n"
}

fn main() {
    let text = text();
    let mut best = f64::MAX;
    for _ in 0..10 {
        let begin = Instant::now();
        let checked = check(&DataFile::read(text.as_bytes()));
        best = best.min(begin.elapsed().as_secs_f64());
        let errors: Vec<String> = checked.errors().map(ToString::to_string).collect();
        assert_eq!(errors.len(), 2, "{errors:?}");
    }
    println!("{} lines: {:.1} ms at best", text.lines().count(), best * 1e3);
}
