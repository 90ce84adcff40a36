//! One program in many spellings has one path.

use crate::support::*;

/// A program with a bit of everything whose spelling varies between files.
const NORMAL: &str = "\
0 BEGIN PGM 77 MM
1 BLK FORM 0.1 Z X+0 Y+0 Z-20
2 BLK FORM 0.2 X+100 Y+100 Z+0
3 TOOL DEF 1 L+0 R+2.5
4 TOOL CALL 1 Z S1000
5 FN 0: Q5 = +12.5
6 CYCL DEF 1.0 PECKING
7 CYCL DEF 1.1 SET UP -2
8 CYCL DEF 1.2 DEPTH -10
9 CYCL DEF 1.3 PECKG -4.5
10 CYCL DEF 1.4 DWELL 0.5
11 CYCL DEF 1.5 F80
12 L Z+100 R0 FMAX M6
13 L X+10 Y-7.25 R0 FMAX M3
14 L Z+2 FMAX M99
15 LBL 2
16 L IX+Q5 F500
17 CYCL CALL
18 CALL LBL 2 REP 2/2
19 L X+0 Y+0 RL F250
20 L Y+40
21 RND R6.5
22 L X+40
23 CC X+40 Y+20
24 C X+40 Y+0 DR-
25 L X-20 R0 FMAX
26 L Z+100 FMAX M2
27 END PGM 77 MM
";

fn path(text: impl Into<Vec<u8>>) -> Vec<Shape> {
    let run = Job::new(text).run();
    run.assert_completed();
    shapes(&run)
}

#[track_caller]
fn same(text: impl Into<Vec<u8>>) {
    let (expected, actual) = (path(NORMAL), path(text));
    assert!(expected.len() > 40);
    assert_eq!(actual, expected);
}

/// Lines without their block numbers.
fn without_numbers() -> String {
    let strip = |line: &'static str| line.split_once(' ').map_or(line, |(_, block)| block);
    NORMAL.lines().flat_map(|line| [strip(line), "\n"]).collect()
}

#[test]
fn without_block_numbers() {
    same(without_numbers());
}

#[test]
fn with_carriage_returns() {
    same(NORMAL.replace('\n', "\r\n"));
}

#[test]
fn in_lower_case() {
    same(NORMAL.to_lowercase());
}

#[test]
fn with_decimal_commas() {
    // The point of a cycle's sub-block is no decimal point.
    let text = NORMAL.lines().map(
        |line| match line.contains("CYCL DEF") || line.contains("BLK FORM") {
            true => match line.rsplit_once(' ') {
                Some((head, value))
                    if !head.ends_with("DEF") && !line.contains("FORM") && !line.contains(".0 ") =>
                {
                    format!("{head} {}\n", value.replace('.', ","))
                }
                _ => format!("{line}\n"),
            },
            false => line.replace('.', ",") + "\n",
        },
    );
    let text: String = text.collect();
    assert!(text.contains("PECKG -4,5") && text.contains("Y-7,25") && text.contains("Q5 = +12,5"));
    same(text);
}

#[test]
fn without_blanks() {
    let text = NORMAL
        .replace("LBL 2", "LBL2")
        .replace("REP 2/2", "REP2/2")
        .replace("FN 0: Q5 = +12.5", "FN0:Q5=+12.5")
        .replace("L X+0 Y+0 RL F250", "LX+0Y+0RLF250")
        .replace("TOOL CALL 1 Z S1000", "TOOL CALL 1ZS1000")
        .replace("C X+40 Y+0 DR-", "CX+40Y+0DR-");
    same(text);
}

#[test]
fn with_empty_placeholders() {
    let text = NORMAL
        .replace("L IX+Q5 F500", "L IX+Q5 R F500 M")
        .replace("L Y+40", "L Y+40 R F M")
        .replace("CYCL CALL", "CYCL CALL M");
    same(text);
}

#[test]
fn with_blanks_inside_words() {
    let text = NORMAL
        .replace("FMAX", "F MAX")
        .replace("S1000", "S 1000")
        .replace("F500", "F 500")
        .replace("+12.5", "+ 12.5")
        .replace("RND R6.5", "RND 6.5")
        .replace("FN 0:", "FN 0 :");
    same(text);
}

#[test]
fn with_cycle_words_of_another_language() {
    let text = NORMAL
        .replace("CYCL DEF 1.0 PECKING", "CYCL DEF 1.0 FORATURA PROF.")
        .replace("SET UP -2", "DIST. -2")
        .replace("DEPTH -10", "PROF. -10")
        .replace("PECKG -4.5", "INCR. -4.5")
        .replace("DWELL 0.5", "SOSTA 0.5");
    same(text);
    same(
        NORMAL
            .replace("PECKING", "TIEFBOHREN")
            .replace("SET UP", "ABST")
            .replace("DEPTH", "TIEFE"),
    );
}

#[test]
fn with_cycle_written_out() {
    same(NORMAL.replace("CYCL DEF 1.", "CYCLE DEF 1."));
    same(NORMAL.replace("CYCL DEF 1.", "CYCL DEF1 ."));
}

#[test]
fn with_a_byte_order_mark() {
    same(format!("\u{feff}{NORMAL}"));
}

#[test]
fn with_blank_lines_and_indentation() {
    let text: String = NORMAL.lines().map(|line| format!("  {line}  \n\n")).collect();
    same(text);
}

#[test]
fn with_comments_and_other_names() {
    let text: String = NORMAL
        .lines()
        .map(|line| format!("{line} ; what it does\n"))
        .collect();
    same(text);
    same(NORMAL.replace("BEGIN PGM 77 MM", "BEGIN PGM MM"));
    same(NORMAL.replace("END PGM 77 MM", "END PGM 78 MM"));
}

#[test]
fn with_eight_bit_comments() {
    let mut bytes = NORMAL.as_bytes().to_vec();
    let at = NORMAL.find("\n3 TOOL").unwrap();
    bytes.splice(at..at, b" ; \x94l f\x81r \xfcber".iter().copied());
    same(bytes);
}

/// Signs: unsigned and signed coordinates are the same.
#[test]
fn without_plus_signs() {
    same(NORMAL.replace('+', ""));
}

/// A block too many does nothing: M8 alone, and skipped blocks where they are passed over.
#[test]
fn with_skipped_blocks() {
    let text = without_numbers().replace("L X-20 R0 FMAX", "/L X+500 Y+500\nL X-20 R0 FMAX");
    let run = Job::new(text).with(|s| s.skip_blocks = true).run();
    run.assert_completed();
    assert_eq!(shapes(&run), path(NORMAL));
}

/// Blocks that go on in the next line.
#[test]
fn with_continuation_lines() {
    same(
        NORMAL
            .replace("L X+10 Y-7.25 R0", "L X+10 ~\n  Y-7.25 ~\n  R0")
            .replace("DEPTH -10", "DEPTH ~\n-10"),
    );
}

/// END PGM is missing: the run ends with the file.
#[test]
fn without_end() {
    same(NORMAL.replace("27 END PGM 77 MM\n", ""));
}

/// All of it at once.
#[test]
fn in_every_way_at_once() {
    let text = without_numbers()
        .replace("CYCL DEF 1.", "CYCLE DEF 1.")
        .replace("FMAX", "F MAX")
        .replace("LBL 2", "LBL2")
        .replace('+', "")
        .replace("L Y40", "  L Y40 R F M   ; up")
        .to_lowercase()
        .replace('\n', "\r\n\r\n");
    same(format!("\u{feff}{text}"));
}
