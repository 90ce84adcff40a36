//! Colours of standard output, on a terminal only.

use std::io::IsTerminal;

use bahn_text::printable_lines;

/// How text is shown.
#[derive(Clone, Copy)]
pub(crate) struct Style(bool);

impl Style {
    /// Colours when standard output is a terminal and NO_COLOR is not set.
    pub fn of_output() -> Style {
        let wanted = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        Style(wanted && std::io::stdout().is_terminal())
    }

    /// A heading or name.
    pub fn bold(self, text: &str) -> String {
        self.wrap("1", text)
    }

    /// What is less important.
    pub fn faint(self, text: &str) -> String {
        self.wrap("2", text)
    }

    /// Text of what an edit takes out, red.
    pub fn removed(self, text: &str) -> String {
        self.wrap("31", text)
    }

    /// What is there, or there instead.
    pub fn added(self, text: &str) -> String {
        self.wrap("32", text)
    }

    /// What the reader must do.
    pub fn warning(self, text: &str) -> String {
        self.wrap("33", text)
    }

    fn wrap(self, code: &str, text: &str) -> String {
        if self.0 {
            format!("\x1b[{code}m{}\x1b[0m", printable_lines(text))
        } else {
            printable_lines(text)
        }
    }
}
