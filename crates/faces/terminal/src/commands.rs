//! The command line: what is typed after `:`.

use bahn_panel::{Button, EMERGENCY_STOP, Input, InputText, Key, Language, around, filled};

use crate::machine::Machine;

/// What a command wants.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Order {
    /// An input for the station.
    Give(Input),
    /// A key of the machine stays down.
    Hold(String),
    /// The key is released.
    Release(String),
    /// The list of short cuts.
    Help,
    /// The panel is left.
    Quit,
}

/// What a command takes.
#[derive(Clone, Copy)]
enum Takes {
    /// Names of keys and numbers, one after the other.
    Keys,
    /// A key of the machine that stays down, or comes up.
    Hold(Button),
    /// The command stands alone.
    Nothing(fn() -> Order),
    /// A number for a field.
    Number(fn(f64) -> InputText),
    /// A whole number for a field.
    Count(fn(u32) -> InputText),
    /// On or off; without a word on.
    Switch(fn(bool) -> InputText),
    /// Everything that follows, as text.
    Text(fn(String) -> InputText),
    /// Axis and factor, or steps.
    Handwheel,
}

/// A line of the table.
pub(crate) struct Command {
    /// The word that is typed.
    pub word: &'static str,
    /// The argument in the help, such as `KEY..`.
    pub argument: &'static str,
    /// What the command does, for the help.
    pub what: &'static str,
    takes: Takes,
}

const fn command(word: &'static str, argument: &'static str, what: &'static str, takes: Takes) -> Command {
    Command {
        word,
        argument,
        what,
        takes,
    }
}

/// The commands. Any other word is a key.
pub(crate) const COMMANDS: &[Command] = &[
    command(
        "key",
        "NAME ...",
        "presses keys, types numbers: key L X 12.5 ENT",
        Takes::Keys,
    ),
    command(
        "hold",
        "NAME",
        "a key stays down: hold X+, hold END",
        Takes::Hold(Button::Pressed),
    ),
    command("release", "NAME", "it comes up", Takes::Hold(Button::Released)),
    command(
        "feed",
        "PERCENT",
        "the feed override knob",
        Takes::Number(|percent| InputText {
            feed_override: Some(percent),
            ..InputText::default()
        }),
    ),
    command(
        "spindle",
        "PERCENT",
        "the spindle override knob",
        Takes::Number(|percent| InputText {
            spindle_override: Some(percent),
            ..InputText::default()
        }),
    ),
    command(
        "handwheel",
        "AXIS FACTOR | STEPS",
        "its axis and factor, or turns it",
        Takes::Handwheel,
    ),
    command(
        "power",
        "on|off",
        "the supply of the control",
        Takes::Switch(|on| InputText {
            power: Some(on),
            ..InputText::default()
        }),
    ),
    command(
        "speed",
        "FACTOR",
        "time passes so many times as fast, 0.1 to 100",
        Takes::Number(|factor| InputText {
            speed: Some(factor),
            ..InputText::default()
        }),
    ),
    command(
        "pause",
        "on|off",
        "time stands",
        Takes::Switch(|on| InputText {
            pause: Some(on),
            ..InputText::default()
        }),
    ),
    command(
        "cycles",
        "COUNT",
        "so many contour cycles, while time stands",
        Takes::Count(|count| InputText {
            cycles: Some(count),
            ..InputText::default()
        }),
    ),
    command(
        "goto",
        "SECONDS",
        "back to a moment since power-on",
        Takes::Number(|time_s| InputText {
            go_to: Some(time_s),
            ..InputText::default()
        }),
    ),
    command(
        "text",
        "TEXT",
        "a line of text, as if typed",
        Takes::Text(|line| InputText {
            text: Some(line),
            ..InputText::default()
        }),
    ),
    command(
        "lesson",
        "NAME",
        "a lesson begins; without a name it ends",
        Takes::Text(|name| InputText {
            lesson: Some(name),
            ..InputText::default()
        }),
    ),
    command(
        "done",
        "",
        "what the lesson asks is done",
        Takes::Nothing(|| Order::Give(Input::HandIn)),
    ),
    command(
        "action",
        "TEXT",
        "what scripts do (docs/scripts.md)",
        Takes::Text(|action| InputText {
            action: Some(action),
            ..InputText::default()
        }),
    ),
    command("help", "", "this list", Takes::Nothing(|| Order::Help)),
    command(
        "quit",
        "",
        "switches the machine off; everything is kept",
        Takes::Nothing(|| Order::Quit),
    ),
];

/// What a line wants.
///
/// # Errors
/// What is wrong with it, in words.
pub(crate) fn read(line: &str, machine: &Machine, language: Language) -> Result<Vec<Order>, String> {
    let line = line.trim();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    if word.is_empty() {
        return Ok(Vec::new());
    }
    let known = COMMANDS
        .iter()
        .find(|command| command.word.eq_ignore_ascii_case(word))
        .or_else(|| (word == "q").then(|| COMMANDS.last()).flatten());
    // Keys may stand alone.
    let Some(command) = known else {
        return keys(line, machine, language);
    };
    let give = |text: InputText| {
        let input = Input::try_from(text).map_err(|refusal| refusal.to_string())?;
        Ok(vec![Order::Give(input)])
    };
    match command.takes {
        Takes::Keys => keys(rest, machine, language),
        Takes::Hold(button) => {
            // The key of the keyboard that is held: END, for the warm start.
            if rest.eq_ignore_ascii_case(Key::End.name()) {
                return Ok(vec![Order::Give(Input::Held(Key::End, button))]);
            }
            let name = machine
                .key(rest)
                .ok_or_else(|| filled(around(language, "the machine has no key {1}"), &[rest]))?;
            Ok(vec![match button {
                Button::Pressed => Order::Hold(name),
                Button::Released => Order::Release(name),
            }])
        }
        Takes::Nothing(order) => Ok(vec![order()]),
        Takes::Number(field) => {
            let number = rest.parse().ok().filter(|number: &f64| number.is_finite());
            give(field(number.ok_or_else(|| usage(command, language))?))
        }
        Takes::Count(field) => give(field(rest.parse().map_err(|_| usage(command, language))?)),
        Takes::Switch(field) => match rest {
            "" | "on" => give(field(true)),
            "off" => give(field(false)),
            _ => Err(usage(command, language)),
        },
        Takes::Text(field) => give(field(rest.to_owned())),
        Takes::Handwheel => give(handwheel(rest).ok_or_else(|| usage(command, language))?),
    }
}

fn usage(command: &Command, language: Language) -> String {
    format!("{} {}", command.word, around(language, command.argument))
}

fn handwheel(rest: &str) -> Option<InputText> {
    let mut words = rest.split_whitespace();
    let first = words.next()?;
    let mut text = InputText::default();
    match (first.parse(), first.as_bytes()) {
        (Ok(steps), _) => text.handwheel = Some(steps),
        (Err(_), [axis]) => {
            text.handwheel_axis = Some(char::from(axis.to_ascii_uppercase()));
            text.factor = match words.next() {
                Some(factor) => Some(factor.parse().ok()?),
                None => None,
            };
        }
        _ => return None,
    }
    words.next().is_none().then_some(text)
}

/// Keys of control and machine by their names, and numbers by their digits.
fn keys(words: &str, machine: &Machine, language: Language) -> Result<Vec<Order>, String> {
    let mut orders = Vec::new();
    for word in words.split_whitespace() {
        let name = word.to_ascii_uppercase();
        let mut digits = word.chars().map(Key::of_character);
        if let Some(key) = Key::from_name(&name) {
            orders.push(Order::Give(Input::Key(key)));
        } else if let Some(name) = machine.key(&name) {
            orders.push(Order::Give(Input::Machine(name, bahn_panel::KeyAction::Tap)));
        } else if word
            .chars()
            .all(|typed| typed.is_ascii_digit() || "-.".contains(typed))
            && let Some(keys) = digits.by_ref().collect::<Option<Vec<_>>>()
        {
            orders.extend(keys.into_iter().map(|key| Order::Give(Input::Key(key))));
        } else {
            return Err(filled(around(language, "there is no key {1}"), &[word]));
        }
    }
    match orders.is_empty() {
        true => Err(format!("key {}", around(language, "NAME ..."))),
        false => Ok(orders),
    }
}

/// What the last word of a line may become: names that begin with it.
pub(crate) fn completions(line: &str, machine: &Machine) -> Vec<String> {
    let begin = line.split_whitespace().next_back().unwrap_or_default();
    if begin.is_empty() || line.ends_with(char::is_whitespace) {
        return Vec::new();
    }
    let is_first = !line.trim().contains(char::is_whitespace);
    let words = COMMANDS.iter().map(|command| command.word);
    let words = words
        .filter(|word| is_first && word.starts_with(begin))
        .map(str::to_owned);
    let keys = Key::ALL.iter().filter(|key| machine.has(**key));
    let keys = keys.map(|key| key.name().to_owned());
    let begin = begin.to_ascii_uppercase();
    let keys = keys
        .chain(machine.keys.iter().cloned())
        .chain([EMERGENCY_STOP.to_owned()])
        .filter(|name| name.starts_with(&begin));
    words.chain(keys).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_panel::{KeyAction, Switch};

    fn machine() -> Machine {
        Machine::of_keys(&["X-", "X+", "NC_START", "RAPID"])
    }

    #[test]
    fn keys_and_numbers_are_typed_by_name() {
        let read = read("KEY L X -12.5 nc_start", &machine(), Language::English).unwrap();
        let control = [
            Key::L,
            Key::X,
            Key::Sign,
            Key::Digit1,
            Key::Digit2,
            Key::Point,
            Key::Digit5,
        ];
        let mut expected: Vec<_> = control.map(|key| Order::Give(Input::Key(key))).into();
        let start = Input::Machine("NC_START".to_owned(), KeyAction::Tap);
        expected.push(Order::Give(start));
        assert_eq!(read, expected);
        assert_eq!(
            super::read("CE", &machine(), Language::English).unwrap(),
            [Order::Give(Input::Key(Key::Ce))]
        );
        assert_eq!(super::read("X+", &machine(), Language::English).unwrap().len(), 1);
        for (typed, button) in [("hold end", Button::Pressed), ("release END", Button::Released)] {
            assert_eq!(
                super::read(typed, &machine(), Language::English).unwrap(),
                [Order::Give(Input::Held(Key::End, button))]
            );
        }
        for wrong in ["key", "nonsense", "key L 1z", "hold Q"] {
            assert!(
                super::read(wrong, &machine(), Language::English).is_err(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn knobs_and_time_are_set() {
        for (line, input) in [
            ("feed 80", Input::FeedOverride(80.0)),
            ("spindle 110.5", Input::SpindleOverride(110.5)),
            ("handwheel -250", Input::Handwheel(-250)),
            ("handwheel y 5", Input::HandwheelAxis('Y', 5)),
            ("cycles 25", Input::Cycles(25)),
            ("power off", Input::Power(Switch::Off)),
            ("pause", Input::Pause(Switch::On)),
            ("speed 0.5", Input::Speed(0.5)),
            ("text L X+10 R0", Input::Text("L X+10 R0".to_owned())),
            ("lesson", Input::Lesson(None)),
            (
                "action fault drive X off",
                Input::Action("fault drive X off".to_owned()),
            ),
        ] {
            assert_eq!(
                read(line, &machine(), Language::English),
                Ok(vec![Order::Give(input)]),
                "{line}"
            );
        }
        assert_eq!(
            read("hold rapid", &machine(), Language::English),
            Ok(vec![Order::Hold("RAPID".to_owned())])
        );
        assert_eq!(read("q", &machine(), Language::English), Ok(vec![Order::Quit]));
        assert_eq!(read("", &machine(), Language::English), Ok(vec![]));
        for wrong in [
            "feed",
            "feed fast",
            "feed nan",
            "power maybe",
            "handwheel",
            "handwheel XY 3",
            "handwheel X fast",
            "handwheel X 3 4",
            "handwheel 500 3",
            "cycles 0.5",
            "cycles -3",
        ] {
            assert!(read(wrong, &machine(), Language::English).is_err(), "{wrong}");
        }
    }

    #[test]
    fn names_are_completed() {
        assert_eq!(completions("key cycl", &machine()), ["CYCL_DEF", "CYCL_CALL"]);
        assert_eq!(completions("spee", &machine()), ["speed"]);
        assert_eq!(completions("hold RA", &machine()), ["RAPID"]);
        assert!(completions("key ", &machine()).is_empty());
    }
}
