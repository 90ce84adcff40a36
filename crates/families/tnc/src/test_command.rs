//! What the operator asks of a test run that is on its way.

use std::fmt;

/// An input of TEST RUN [003:1531-1535]; in commands it stands after `test-run`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TestCommand {
    /// `stop`: the test is interrupted where it is.
    Interrupt,
    /// `stop N`: it is interrupted at a block of its main program, or the first one after it that moves or stops
    /// [003:1524].
    InterruptAt(u32),
    /// `go-on`: an interrupted test goes on [003:1535].
    GoOn,
    /// `q N VALUE`: a Q parameter of an interrupted test [003:4337-4342].
    Q(u16, f64),
}

impl TestCommand {
    /// Reads what stands after `test-run`.
    ///
    /// # Errors
    /// What is expected.
    pub fn parse(text: &str) -> Result<TestCommand, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let command = match words.as_slice() {
            ["stop"] => Some(TestCommand::Interrupt),
            ["stop", block] => block.parse().ok().map(TestCommand::InterruptAt),
            ["go-on"] => Some(TestCommand::GoOn),
            ["q", number, value] => number
                .parse()
                .ok()
                .zip(value.parse().ok().filter(|value: &f64| value.is_finite()))
                .map(|(number, value)| TestCommand::Q(number, value)),
            _ => None,
        };
        command.ok_or_else(|| "`test-run` takes `stop`, `stop BLOCK`, `go-on` or `q N VALUE`".to_owned())
    }
}

impl fmt::Display for TestCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TestCommand::Interrupt => write!(f, "stop"),
            TestCommand::InterruptAt(block) => write!(f, "stop {block}"),
            TestCommand::GoOn => write!(f, "go-on"),
            TestCommand::Q(number, value) => write!(f, "q {number} {value}"),
        }
    }
}
