//! Commands of the line on which a program is executed while it is transferred [000:16951-16968] [003:1650-1690].

use std::fmt;
use std::sync::Arc;

use bahn_interpreter::DripFeed;
use bahn_parameters::MessageId;

/// What happens on the line of a program that is executed while it is transferred.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dnc {
    /// `dnc begin NAME`: NC start runs the program of this name as it comes. A transfer of the program that was broken off
    /// goes on instead, after what has come.
    Begin(String),
    /// `dnc text L X+5\n`: text of it, with the escapes of a byte string. Refused while no more is [wanted](bahn_interpreter::DripFeedState).
    Text(Arc<[u8]>),
    /// `dnc end`: nothing more comes.
    End,
    /// `dnc broken`: the line is broken. What has come is executed, as far as it does not depend on what follows.
    Broken,
}

impl Dnc {
    /// Reads what stands after `dnc`.
    pub(crate) fn parse(text: &str) -> Result<Dnc, String> {
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        match word {
            "begin" if !rest.trim().is_empty() => Ok(Dnc::Begin(rest.trim().to_owned())),
            "text" => bahn_text::unescaped(rest)
                .map(|bytes| Dnc::Text(bytes.into()))
                .ok_or_else(|| {
                    "`dnc text` takes text with the escapes of a byte string, as `L X+5\\n`".to_owned()
                }),
            "end" if rest.is_empty() => Ok(Dnc::End),
            "broken" if rest.is_empty() => Ok(Dnc::Broken),
            _ => Err("`dnc` takes `begin` and a name, `text` and text, `end` or `broken`".to_owned()),
        }
    }
}

impl Dnc {
    /// Does what it says of a transfer that has begun: whether that is possible, and what is to be said.
    pub(crate) fn follow(&self, feed: &mut DripFeed) -> (bool, Option<MessageId>) {
        match self {
            Dnc::Begin(_) => (false, None),
            Dnc::Text(text) => feed.take(text).map_or((false, None), |said| (true, said)),
            Dnc::End => (true, feed.end()),
            Dnc::Broken => (true, feed.break_off(MessageId::ProgramIncomplete)),
        }
    }
}

impl fmt::Display for Dnc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Dnc::Begin(name) => write!(f, "begin {name}"),
            Dnc::Text(bytes) => {
                // Blanks at the ends of a line of a script do not count.
                let escaped = bytes.escape_ascii().to_string();
                write!(f, "text {}", escaped.replace(' ', "\\x20"))
            }
            Dnc::End => f.write_str("end"),
            Dnc::Broken => f.write_str("broken"),
        }
    }
}
