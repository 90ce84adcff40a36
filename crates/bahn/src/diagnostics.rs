//! Errors as rustc prints them: message, place, the line with a mark, what to do.

use std::io::{self, IsTerminal, Write};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
pub(crate) use bahn_host::{FileFault, Marked, Severity, printable, printable_lines};

use crate::refused;

/// Faults of a file that are printed; the others are counted.
pub(crate) const PRINTED_MAX: usize = 100;

/// Characters of a line that are shown; a line of a broken file may have millions.
const MAX_COLUMNS: usize = 200;

/// Prints a fault as rustc does, with an empty line after it.
pub(crate) fn print_fault(fault: &FileFault) {
    if fault.severity == Severity::Error {
        refused::fault(|| reported(fault), PRINTED_MAX);
    }
    print_styled(&render(fault, is_styled()));
    print_line("");
}

/// A fault as JSON says it.
fn reported(fault: &FileFault) -> refused::FaultReport {
    refused::FaultReport {
        file: fault.path.display().to_string(),
        line: fault.marked.line,
        column: fault.marked.columns.map(|(column, _)| column),
        title: fault.title.clone(),
        message: fault.label.clone(),
    }
}

/// Prints the first [`PRINTED_MAX`] faults, and how many there are besides.
pub(crate) fn print_faults(faults: &[FileFault]) {
    faults.iter().take(PRINTED_MAX).for_each(print_fault);
    print_rest(faults.len().saturating_sub(PRINTED_MAX));
}

/// Says how many faults are not shown.
pub(crate) fn print_rest(count: usize) {
    if count > 0 {
        print_line(&format!("{count} more not shown\n"));
    }
}

/// The text as it is shown, and the bytes of it that are marked.
fn shown(marked: &Marked) -> (String, std::ops::Range<usize>) {
    // Cut first: the line of a broken file may have millions of NULs.
    let text: String = marked.text.chars().take(MAX_COLUMNS).collect();
    let text = printable(text.trim_end_matches(|c: char| c.is_whitespace() || c.is_control()));
    let text = text.as_str();
    let byte_of = |character: usize| {
        text.char_indices()
            .nth(character)
            .map_or(text.len(), |(byte, _)| byte)
    };
    let range = match marked.columns {
        Some((column, length)) => {
            let start = column.saturating_sub(1) as usize;
            byte_of(start)..byte_of(start.saturating_add(length.max(1) as usize))
        }
        None => text.len() - text.trim_start().len()..text.len(),
    };
    (text.to_owned(), range)
}

/// The text for people; where that was opened which is meant is marked, too.
fn render(fault: &FileFault, styled: bool) -> String {
    let level = match fault.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let path = printable(&fault.path.to_string_lossy());
    let (source, range) = shown(&fault.marked);
    let mut snippet = Snippet::source(source)
        .line_start(fault.marked.line as usize)
        .path(path.clone())
        .annotation(AnnotationKind::Primary.span(range).label(printable(&fault.label)));
    let mut other = None;
    if let Some(opened) = &fault.opened {
        let (source, range) = shown(opened);
        let mark = AnnotationKind::Context.span(range).label("opened here");
        if opened.line == fault.marked.line {
            snippet = snippet.annotation(mark);
        } else {
            let place = Snippet::source(source).line_start(opened.line as usize);
            other = Some(place.path(path).annotation(mark));
        }
    }
    let mut group = level.primary_title(printable(&fault.title)).element(snippet);
    if let Some(other) = other {
        group = group.element(other);
    }
    if let Some(help) = &fault.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    renderer.render(&[group])
}

/// Prints what is wrong with the use of the command.
pub(crate) fn print_usage_error(text: &str) {
    let level = if is_styled() {
        "\x1b[1m\x1b[91merror\x1b[0m"
    } else {
        "error"
    };
    refused::error(text);
    let text: Vec<String> = text.lines().map(printable).collect();
    print_styled(&format!("{level}: {}", text.join("\n  ")));
}

/// Prints a line to standard error, with nothing in it that would steer the terminal.
pub(crate) fn print_text(text: &str) {
    print_line(&printable(text));
}

/// Prints lines to standard error, with nothing in them that would steer the terminal.
pub(crate) fn print_line(text: &str) {
    if text.starts_with("error: ") {
        refused::error(text);
    }
    print_styled(&printable_lines(text));
}

/// Prints what has colours of ours; nobody can be told when that fails.
fn print_styled(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Whether standard error shows colours.
pub(crate) fn is_styled() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(text: &str, columns: Option<(u32, u32)>) -> (String, String) {
        let (shown, range) = shown(&Marked {
            line: 1,
            text: text.into(),
            columns,
        });
        let mark = shown[range].to_owned();
        (shown, mark)
    }

    #[test]
    fn marks_count_characters() {
        assert_eq!(marked("  L X+5 ; Höhe  ", None).1, "L X+5 ; Höhe");
        assert_eq!(marked("; Höhe oops", Some((8, 4))).1, "oops");
        assert_eq!(marked("L X", Some((9, 4))).1, "");
        assert_eq!(marked("", None), (String::new(), String::new()));
    }

    #[test]
    fn lines_are_short_and_do_not_steer_the_terminal() {
        assert_eq!(marked("L\x1b[31m\tX\u{202e}", None).0, "L\u{241b}[31m X\u{fffd}");
        assert_eq!(marked(&"\0".repeat(1_000_000), None).0, "");
        assert_eq!(marked(&"X".repeat(1_000_000), None).0.len(), MAX_COLUMNS);
    }

    /// Characters of no width, of two columns, of UTF-16 that was read as Latin: nothing panics.
    #[test]
    fn any_character_is_shown() {
        let characters = (0..0x3100).chain(0xfe00..0x10000).chain(0x1f300..0x1f700);
        for c in characters.filter_map(char::from_u32) {
            for (text, columns) in [
                (format!("{c}"), Some((1, 1))),
                (format!("{c}{c}L {c}X"), Some((2, 2))),
                (format!("L {c}"), Some((5, 9))),
                (format!("{c} {c}"), None),
                (format!("{c}").repeat(200), Some((150, 40))),
                (format!("{c}L ").repeat(60), Some((190, 3))),
            ] {
                let marked = Marked {
                    line: u32::MAX,
                    text,
                    columns,
                };
                let fault = FileFault {
                    severity: Severity::Error,
                    title: "0 not a valid command".into(),
                    path: "A".into(),
                    marked: marked.clone(),
                    label: format!("{c}"),
                    help: Some("help".into()),
                    opened: Some(marked),
                };
                assert!(render(&fault, true).contains("not a valid"));
            }
        }
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig { failure_persistence: None, cases: 256, ..Default::default() })]

        /// Whatever stands in a file, wherever the mark is, under whatever name.
        #[test]
        fn anything_is_shown(
            text in "([L= ;\\[\\]\u{0}\u{ad}\u{300}\u{200b}\u{3000}\u{feff}\u{1f600}]|\\PC|[\u{80}-\u{ff}]){0,250}",
            label in "\\PC{0,40}",
            line in 0_u32..,
            opened in 0_u32..,
            columns in proptest::option::of((0_u32..300, 0_u32..300)),
            help in proptest::option::of("\\PC{0,60}"),
        ) {
            let marked = |line, columns| Marked { line, text: text.clone(), columns };
            for opened in [None, Some(marked(opened, None)), Some(marked(line, Some((3, 1))))] {
                let fault = FileFault {
                    severity: Severity::Warning,
                    title: label.clone(),
                    path: text.clone().into(),
                    marked: marked(line, columns),
                    label: label.clone(),
                    help: help.clone(),
                    opened,
                };
                proptest::prop_assert!(!render(&fault, false).is_empty());
            }
        }
    }

    /// What is open is marked where it was opened, on another line or on the same.
    #[test]
    fn what_was_opened_is_marked_too() {
        let marked = |line, text: &str, columns| Marked {
            line,
            text: text.to_owned(),
            columns: Some(columns),
        };
        let fault = |opened| FileFault {
            severity: Severity::Error,
            title: "16 jump within a parenthesis".into(),
            path: "M.PLC".into(),
            marked: marked(12, "  JP 5", (3, 2)),
            label: String::new(),
            help: None,
            opened: Some(opened),
        };
        let text = render(&fault(marked(9, "A[", (1, 2))), false);
        assert!(
            text.contains(":12:3") && text.contains("9 | A[") && text.contains("opened here"),
            "{text}"
        );
        let same = render(&fault(marked(12, "  JP 5", (6, 1))), false);
        assert_eq!(same.matches("JP 5").count(), 1, "{same}");
        assert!(same.contains("opened here"), "{same}");
    }

    #[test]
    fn errors_look_like_those_of_rustc() {
        let program = bahn_program::Program::from_bytes("1.H", b"BEGIN PGM 1 MM\nL X+1 ~\n  Ynan".to_vec());
        let fault = FileFault {
            severity: Severity::Error,
            title: "ENTRY VALUE INCORRECT".into(),
            path: "1.H".into(),
            marked: Marked::of_block(&program, 1),
            label: "block 1: no number".into(),
            help: None,
            opened: None,
        };
        let expected = "\
error: ENTRY VALUE INCORRECT
 --> 1.H:3:3
  |
3 |   Ynan
  |   ^^^^ block 1: no number";
        assert_eq!(render(&fault, false), expected);
    }
}
