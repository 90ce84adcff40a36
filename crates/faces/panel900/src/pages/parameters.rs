//! PARAMETERS: any parameter by its name, with its value, its status and what the table says of it; a value is entered.
//!
//! Decision: A faulty entry stays in the line until it is another one

use bahn_host::Command900;
use bahn_live::Refusal;
use bahn_screen::Window;
use bahn_system900::{Explanation, Held, Name};

use super::{Arrow, Page, text_window};
use crate::sight::{Desk, Sight};

/// Characters of a line of text.
const WIDTH: usize = 72;

/// What is looked at.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Parameters {
    name: Option<Name>,
}

/// The same in the channel that is shown, where no channel was typed.
fn in_channel(name: Name, entry: &str, channel: u8) -> Name {
    match name {
        Name::P(_, number) if !entry.contains(':') => Name::P(channel, number),
        other => other,
    }
}

/// A text in lines.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let full = lines
            .last()
            .is_some_and(|line| line.chars().count() + word.chars().count() >= WIDTH);
        if full {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

impl Parameters {
    fn lines(sight: &Sight<'_>, name: Name) -> Vec<String> {
        let mut lines = Vec::new();
        match Held::of(sight.memory(), name) {
            Ok(held) => {
                let unit = sight.memory().unit(name);
                let head = format!("{name} = {} {unit}", held.written);
                lines.push(head.trim_end().to_owned());
                lines.extend(wrapped(&held.to_string()));
            }
            Err(error) => lines.push(error.to_string()),
        }
        lines.push(String::new());
        let Some(of) = Explanation::of(name) else {
            lines.push(sight.words("The table has no row for it.").to_owned());
            return lines;
        };
        lines.push(format!("{}: {}", of.base, of.title));
        for (title, text) in [
            ("", of.meaning),
            (sight.words("values"), of.values),
            (sight.words("default"), of.default),
            (sight.words("a change needs"), of.needs_words),
            (sight.words("here"), of.effect),
            ("", of.reason),
            ("", of.source),
        ] {
            let text = match (title, text) {
                (_, "") => continue,
                ("", text) => text.to_owned(),
                (title, text) => format!("{title}: {text}"),
            };
            lines.extend(wrapped(&text));
        }
        lines
    }
}

impl Page for Parameters {
    fn window(&self, sight: &Sight<'_>) -> Window {
        let title = sight.words("PARAMETERS").to_owned();
        match self.name {
            Some(name) => text_window(title, Parameters::lines(sight, name)),
            None => {
                let help = [
                    sight.words("P8800       of the channel that is shown"),
                    sight.words("2:P12151    of channel 2"),
                    sight.words("q102        a system parameter"),
                    sight.words("Then a value: 12.5, $1F, or -- which clears it."),
                ];
                text_window(title, help.map(str::to_owned).into())
            }
        }
    }

    fn prompt(&self, sight: &Sight<'_>) -> String {
        match self.name {
            Some(name) => format!("{name} ="),
            None => sight.words("NAME OF THE PARAMETER:").to_owned(),
        }
    }

    fn soft_keys(&self, sight: &Sight<'_>) -> [&'static str; 2] {
        match self.name {
            Some(_) => [sight.words("CLEAR IT"), sight.words("ANOTHER ONE")],
            None => [""; 2],
        }
    }

    fn soft_key(&mut self, which: usize, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        match (which, self.name) {
            (0, Some(name)) => give(name, "--", desk),
            (1, _) => {
                self.name = None;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn go(&mut self, arrow: Arrow, sight: &Sight<'_>) {
        let by = |number: u32| match arrow {
            Arrow::Up | Arrow::Left => number.checked_sub(1),
            Arrow::Down | Arrow::Right => number.checked_add(1),
        };
        let next = match self.name {
            Some(Name::P(channel, number)) => by(number).map(|number| Name::P(channel, number)),
            Some(Name::Q(number)) => by(number).map(Name::Q),
            None => None,
        };
        if let Some(next) = next.filter(|next| sight.memory().place(*next).is_ok()) {
            self.name = Some(next);
        }
    }

    fn enter(&mut self, entry: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let entry = entry.trim();
        let (named, value) = match entry.split_once('=') {
            Some((name, value)) => (name, Some(value)),
            None => (entry, None),
        };
        if let Ok(name) = named.parse::<Name>() {
            let name = in_channel(name, named, desk.channel);
            let found = desk.sight().memory().place(name);
            found.map_err(|error| Refusal(error.to_string()))?;
            self.name = Some(name);
            return value.map_or(Ok(()), |value| give(name, value, desk));
        }
        match self.name {
            _ if entry.is_empty() => Ok(()),
            Some(name) => give(name, entry, desk),
            None => Err(Refusal(
                entry
                    .parse::<Name>()
                    .map_or_else(|error| error.to_string(), |_| String::new()),
            )),
        }
    }
}

/// As the operator in the parameter editor.
fn give(name: Name, value: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
    let command: Command900 = format!("{name}={value}").parse().map_err(Refusal)?;
    desk.give(command)
}
