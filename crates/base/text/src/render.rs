//! A fault for people, as rustc prints it: message, place, the line with a mark, what to do.

use std::ops::Range;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use crate::diagnostic::{Diagnostic, Severity};
use crate::printable::printable;
use crate::span::Span;

/// Characters of a line that are shown; a line of a broken file may have millions.
const MAX_COLUMNS: usize = 200;

/// The text for people, with the colours of a terminal or without; other places that belong to the fault are marked, too.
pub fn render(fault: &Diagnostic, styled: bool) -> String {
    let level = match fault.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let (source, range) = shown(&fault.source, fault.span);
    let label = AnnotationKind::Primary
        .span(range)
        .label(printable(&fault.label()));
    let mut snippet = snippet(&fault.file, fault.span, source).annotation(label);
    let mut others = Vec::new();
    for related in &fault.related {
        let (source, range) = shown(&related.source, related.span);
        let mark = AnnotationKind::Context
            .span(range)
            .label(printable(&related.message));
        let is_here = related.file.as_os_str().is_empty() || related.file == fault.file;
        if is_here && related.span.line == fault.span.line {
            snippet = snippet.annotation(mark);
        } else {
            let file = if is_here { &fault.file } else { &related.file };
            others.push(self::snippet(file, related.span, source).annotation(mark));
        }
    }
    let mut group: Group<'_> = level.primary_title(printable(&fault.message)).element(snippet);
    for other in others {
        group = group.element(other);
    }
    if let Some(help) = &fault.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    let renderer = match styled {
        true => Renderer::styled(),
        false => Renderer::plain(),
    };
    renderer.render(&[group])
}

fn snippet<'a>(file: &Path, span: Span, source: String) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let snippet = Snippet::source(source).line_start(span.line as usize);
    snippet.path(printable(&file.to_string_lossy()))
}

/// The line as it is shown, and the bytes of it that are marked.
fn shown(source: &str, span: Span) -> (String, Range<usize>) {
    // Cut first: the line of a broken file may have millions of NULs.
    let text: String = source.chars().take(MAX_COLUMNS).collect();
    let text = printable(text.trim_end_matches(|c: char| c.is_whitespace() || c.is_control()));
    let text = text.as_str();
    let byte_of = |character: usize| {
        text.char_indices()
            .nth(character)
            .map_or(text.len(), |(byte, _)| byte)
    };
    let range = match span.columns() {
        Some((column, length)) => {
            let start = column.saturating_sub(1) as usize;
            byte_of(start)..byte_of(start.saturating_add(length.max(1) as usize))
        }
        None => text.len() - text.trim_start().len()..text.len(),
    };
    (text.to_owned(), range)
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::diagnostic::Related;

    fn span(line: u32, columns: Option<(u32, u32)>) -> Span {
        let (column, length) = columns.unwrap_or_default();
        Span { line, column, length }
    }

    fn marked(text: &str, columns: Option<(u32, u32)>) -> (String, String) {
        let (shown, range) = shown(text, span(1, columns));
        let mark = shown[range].to_owned();
        (shown, mark)
    }

    fn opened(span: Span, source: &str) -> Related {
        Related {
            file: "".into(),
            span,
            message: "opened here".to_owned(),
            source: source.to_owned(),
        }
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
                let place = span(u32::MAX, columns);
                let fault = Diagnostic {
                    help: Some("help".into()),
                    related: vec![opened(place, &text)],
                    ..Diagnostic::error(place, "0 not a valid command")
                        .with_detail(format!("{c}"))
                        .at("A", text)
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
            other in 0_u32..,
            columns in proptest::option::of((0_u32..300, 0_u32..300)),
            help in proptest::option::of("\\PC{0,60}"),
        ) {
            for place in [None, Some(span(other, None)), Some(span(line, Some((3, 1))))] {
                let fault = Diagnostic::warning(span(line, columns), label.clone());
                let fault = Diagnostic {
                    related: place.map(|place| opened(place, &text)).into_iter().collect(),
                    ..fault.with_detail(label.clone()).with_help(help.clone()).at(text.clone(), text.clone())
                };
                proptest::prop_assert!(!render(&fault, false).is_empty());
            }
        }
    }

    /// What is open is marked where it was opened, on another line, on the same, in another file.
    #[test]
    fn what_was_opened_is_marked_too() {
        let fault = |related| Diagnostic {
            related: vec![related],
            ..Diagnostic::error(Span::new(12, 3, 2), "16 jump within a parenthesis").at("M.PLC", "  JP 5")
        };
        let text = render(&fault(opened(Span::new(9, 1, 2), "A[")), false);
        assert!(
            text.contains(":12:3") && text.contains("9 | A[") && text.contains("opened here"),
            "{text}"
        );
        let same = render(&fault(opened(Span::new(12, 6, 1), "  JP 5")), false);
        assert_eq!(same.matches("JP 5").count(), 1, "{same}");
        assert!(same.contains("opened here"), "{same}");
        let elsewhere = Related {
            file: "N.PLC".into(),
            ..opened(Span::new(12, 1, 2), "A[")
        };
        let elsewhere = render(&fault(elsewhere), false);
        assert!(
            elsewhere.contains("N.PLC:12:1") && elsewhere.contains("12 | A["),
            "{elsewhere}"
        );
    }

    #[test]
    fn errors_look_like_those_of_rustc() {
        let fault = Diagnostic::error(Span::new(3, 3, 4), "ENTRY VALUE INCORRECT")
            .with_detail("no number")
            .in_block("1")
            .in_text("1.H", "BEGIN PGM 1 MM\nL X+1 ~\n  Ynan");
        let expected = "\
error: ENTRY VALUE INCORRECT
 --> 1.H:3:3
  |
3 |   Ynan
  |   ^^^^ block 1: no number";
        assert_eq!(render(&fault, false), expected);
    }
}
