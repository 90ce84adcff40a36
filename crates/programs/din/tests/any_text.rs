//! Any text is a program: reading and executing it comes to an end, and to the same one each time.

mod support;

use std::sync::Arc;

use bahn_din::{Decoder, Program, Step, words};
use bahn_path::Position;
use bahn_text::MemoryFiles;
use proptest::prelude::*;
use support::Bench;

/// Parts of which lines are made, so that many of them can be read.
const PARTS: &[&str] = &[
    "N10",
    "N",
    "X",
    "Y-1.5",
    "Z[",
    "]",
    "[",
    "G00",
    "G01",
    "G02",
    "G03",
    "G4",
    "G91",
    "G18",
    "F100",
    "I1",
    "J-1",
    "R5",
    "M3",
    "M17",
    "M30",
    "H5=",
    "=",
    "-",
    "+",
    "*",
    "**",
    "/",
    "P1",
    "P",
    "S",
    "S2[M3 REV1000]",
    "X[M7 H3=2]",
    "X[INDP G01 FEED=5 POS=1]",
    "INDP",
    "V.G.RW",
    "V.E.A",
    "V.G.M_FCT[3].SYNCH",
    "V.",
    "\"A\"",
    "\"A\"=\"X1\"",
    "\"A\"=\"\\\"A\\\"\"",
    "#FLUSH",
    "#FLUSH WAIT",
    "#EXPL SYN",
    "#CHANNEL SET [M_PRE_OUTPUT E=1]",
    "#VECTOR LIMIT ON[VEL=1]",
    "#COMMENT BEGIN",
    "#COMMENT END",
    "$IF",
    "(",
    ")",
    "(*",
    "*)",
    ";",
    "'16#1F'",
    "'",
    "\"",
    "SIN[30]",
    "EXIST[M3]",
    "L sub",
    "LL SUB",
    "%",
    "%L SUB",
    "%MAIN",
    "\n",
    "\r\n",
    "1",
    "99999999999999999999",
    ".",
    ":",
    "\\",
    "ä",
    "\u{0}",
];

fn text() -> impl Strategy<Value = String> {
    let part = (0..PARTS.len(), prop::bool::ANY).prop_map(|(part, blank)| {
        let part = PARTS.get(part).copied().unwrap_or_default();
        if blank {
            format!("{part} ")
        } else {
            part.to_owned()
        }
    });
    prop::collection::vec(part, 0..60).prop_map(|parts| parts.concat())
}

/// Everything that a text comes to.
fn all_of(bytes: &[u8]) -> String {
    let program = Arc::new(Program::from_bytes("any.nc", bytes));
    let mut reported = format!("{:?}\n{:?}\n", program.faults(), program.landmarks());
    let lines = program.line_count();
    for fault in program.faults() {
        let length = program.line(fault.span.line).chars().count() as u32;
        assert!((1..=lines.max(1)).contains(&fault.span.line), "{fault:?}");
        assert!(
            (1..=length + 1).contains(&fault.span.column),
            "{fault:?} of {length}"
        );
        assert!(fault.span.length >= 1 && !fault.message.is_empty(), "{fault:?}");
    }
    for main in program.mains() {
        let beside = Arc::new(MemoryFiles::from([
            ("sub", "N1 G91 X1 M7\nLL A\n"),
            ("sub.nc", "M1"),
        ]));
        let mut decoder = Decoder::new(Arc::clone(&program), main, Position::ZERO, beside);
        let mut bench = Bench::default();
        for _ in 0..2000 {
            let step = decoder.next(&mut bench);
            let is_over = !matches!(step, Step::Unit(_));
            if let Step::Unit(unit) = &step
                && let Some(motion) = &unit.motion
            {
                assert!(motion.start.known() == motion.end.known(), "{motion:?}");
                assert!(motion.rapid || motion.feed_mm_min > 0.0, "{motion:?}");
            }
            reported += &format!("{step:?}\n");
            if is_over {
                assert_eq!(decoder.next(&mut bench), Step::End);
                break;
            }
        }
    }
    reported
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn texts_of_known_parts(text in text()) {
        prop_assert_eq!(all_of(text.as_bytes()), all_of(text.as_bytes()));
    }

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert_eq!(all_of(&bytes), all_of(&bytes));
    }

    /// Words follow one another within the line.
    #[test]
    fn words_of_any_line(line in text()) {
        for line in line.lines() {
            let mut column = 1;
            for span in words(line) {
                prop_assert!(span.column >= column && span.length >= 1, "{:?} in {:?}", span, line);
                column = span.column + span.length;
            }
            prop_assert!(column <= line.chars().count() as u32 + 1, "{:?}", line);
        }
    }

    /// A line of coordinates, functions and a feed means what it says, however it is spaced.
    #[test]
    fn what_is_written_is_read(
        x in -99999..99999i32, m in 0..1000u16, value in any::<i32>(), feed in 1..100_000u32, glued in prop::bool::ANY,
    ) {
        let blank = if glued { "" } else { "  " };
        let x = f64::from(x) / 1000.0;
        prop_assume!(x != 0.0 && ![2, 17, 29, 30].contains(&m));
        let text = format!("N7{blank}G01{blank}X{x}{blank}F{feed}{blank}M{m}={value}");
        let (units, fault) = support::run_with(&text, &mut Bench::default(), MemoryFiles::default());
        prop_assert_eq!(fault, None);
        prop_assert_eq!(support::reported(&units[0]), format!("N7 M{m}={value} to X{x} Y0 F{feed}"));
    }
}
