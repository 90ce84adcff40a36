//! The program of a channel, around the block that is executed.

use std::path::PathBuf;
use std::time::SystemTime;

use bahn_host::files;
use bahn_screen::{Line, Window, WindowKind};
use bahn_system900::ChannelParameter;
use bahn_text::decode;

use crate::sight::Sight;

/// The text of the program that was looked at last.
#[derive(Debug, Default)]
pub(crate) struct Text {
    file: Option<(PathBuf, Option<SystemTime>)>,
    lines: Vec<String>,
}

impl Text {
    /// Reads the program of P8800 when it is another one, or was written.
    pub fn follow(&mut self, sight: &Sight<'_>) {
        let path = sight.host.program_file(sight.channel);
        let file = path.map(|path| {
            let written = path.metadata().and_then(|about| about.modified()).ok();
            (path, written)
        });
        if file != self.file {
            let bytes = file
                .as_ref()
                .and_then(|(path, _)| files::read_program(path).ok().flatten());
            let text = bytes.map(|bytes| decode(&bytes)).unwrap_or_default();
            self.lines = text.lines().map(|line| line.trim_end().to_owned()).collect();
            self.file = file;
        }
    }

    /// The window of it, with so many lines.
    pub fn window(&self, sight: &Sight<'_>, lines: usize) -> Window {
        if let Some(window) = executed(sight, lines) {
            return window;
        }
        let Some(program) = sight
            .whole(ChannelParameter::Program)
            .filter(|program| *program > 0)
        else {
            return around(sight.words("NO PROGRAM").to_owned(), 0, None, lines, |_| {
                String::new()
            });
        };
        let title = format!("P{program}");
        let start = sight
            .whole(ChannelParameter::StartBlock)
            .filter(|block| *block > 0);
        let is_start = |line: &String| start.is_some_and(|start| number(line) == Some(start));
        let current = self.lines.iter().position(is_start).unwrap_or(0);
        around(title, self.lines.len(), Some(current), lines, |place| {
            self.lines.get(place).cloned().unwrap_or_default()
        })
    }
}

/// The N number of a block.
fn number(line: &str) -> Option<i64> {
    let rest = line.trim_start().strip_prefix(['N', 'n'])?;
    let end = rest
        .find(|digit: char| !digit.is_ascii_digit())
        .unwrap_or(rest.len());
    rest.get(..end)?.parse().ok()
}

/// Around the block that is executed, which may be one of a cycle.
fn executed(sight: &Sight<'_>, lines: usize) -> Option<Window> {
    let control = sight.control();
    let at = control.executed(sight.channel)?.0.block;
    let program = control.reader(sight.channel)?.program(at.program)?;
    let count = usize::try_from(program.block_count()).ok()?;
    let current = usize::try_from(at.block).ok()?;
    let text = |place: usize| {
        u32::try_from(place)
            .map(|block| program.text_of(block))
            .unwrap_or_default()
    };
    let name = program.name();
    let name = name.strip_suffix(".900").unwrap_or(name);
    Some(around(name.to_owned(), count, Some(current), lines, text))
}

/// So many of the lines, around the current one.
pub(crate) fn around(
    title: String,
    total: usize,
    current: Option<usize>,
    lines: usize,
    text: impl Fn(usize) -> String,
) -> Window {
    let at = current.unwrap_or(0);
    let first = at.saturating_sub(lines / 2).min(total.saturating_sub(lines));
    let line = |place: usize| Line {
        text: text(place),
        current: current == Some(place),
        marks: Vec::new(),
    };
    Window {
        title,
        kind: WindowKind::Program,
        lines: (first..total.min(first + lines)).map(line).collect(),
        first,
        total,
    }
}
