//! What the control's messages and the errors of the PLC mean; everything that mentions a word.

use bahn_parameters::equipment;
use bahn_parameters::{Advice, ControlModel, Definition, MessageCode, MessageId, chapters};
use bahn_plc::PlcError;
use bahn_system900::named_message;

use crate::paragraph::{labelled, labelled_lines};

/// Where the errors of the PLC are printed.
const PLC_ERRORS: &str = "[000:11915-12050]";

/// Explains a message or PLC error, lists what mentions some words, or, without any, all texts of a model. Empty where nothing
/// mentions them.
pub fn explained(wanted: &str, model: ControlModel) -> String {
    if wanted.trim().is_empty() {
        all(model)
    } else if wanted.trim().eq_ignore_ascii_case("software") {
        of_software(model)
    } else if let Some(error) = plc_error(wanted) {
        of_plc_error(error)
    } else if let Some(message) = of_system900(wanted) {
        message
    } else if let Some(found) = Found::of(wanted) {
        found.text(model)
    } else {
        mentions(wanted, model)
    }
}

fn all(model: ControlModel) -> String {
    let lines = MessageId::ALL
        .iter()
        .map(|id| format!("{:<32}{}\n", id.name(), id.text(model)));
    lines.collect()
}

/// What a model has from which release of its software on, or with which option, and where the manuals say it.
fn of_software(model: ControlModel) -> String {
    let rows = equipment::table(model);
    let width = |column: usize| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or_default()
    };
    let (what, takes) = (width(0), width(1));
    let line = |row: &[String; 3]| format!("  {:what$}  {:takes$}  {}\n", row[0], row[1], row[2]);
    let lines: String = rows.iter().map(line).collect();
    let heading = match lines.is_empty() {
        true => format!("No manual tells releases or options of the {}.\n", model.name()),
        false => format!(
            "{}: what takes an option or a release of the software\n",
            model.name()
        ),
    };
    heading + &lines
}

/// A message, with axis and code where they stand after its text.
struct Found {
    id: MessageId,
    axis: Option<String>,
    code: Option<&'static MessageCode>,
}

impl Found {
    /// The message of a name or text, whatever the case and punctuation.
    fn of(wanted: &str) -> Option<Found> {
        let name = wanted.trim();
        if let Some(id) = MessageId::ALL
            .iter()
            .find(|id| id.name().eq_ignore_ascii_case(name))
        {
            return Some(Found {
                id: *id,
                axis: None,
                code: None,
            });
        }
        let written = words(wanted);
        let texts = MessageId::ALL.iter().flat_map(|id| {
            let texts = ControlModel::FAMILIES.iter().map(|model| id.text(*model));
            texts.map(|text| (*id, text))
        });
        // The longest text wins: GROSS POSITIONING ERROR is no POSITIONING ERROR.
        texts
            .filter_map(|(id, text)| Some((text.len(), Found::after(id, text, &written)?)))
            .max_by_key(|(length, _)| *length)
            .map(|(_, found)| found)
    }

    /// Reads the words as this text: `#` is an axis or nothing, after it stand axis and code.
    fn after(id: MessageId, text: &str, written: &[String]) -> Option<Found> {
        let mut axis = None;
        let mut rest = written.iter().peekable();
        for word in words(text) {
            if word == "#" {
                axis = rest.next_if(|word| is_axis(word)).cloned();
                let _ = rest.next_if(|word| *word == "#");
            } else if rest.next()? != &word {
                return None;
            }
        }
        let mut code = None;
        for word in rest {
            let known = id.codes().iter().find(|code| code.code == word);
            match known {
                // The last word is the code: axes A, B and C have the same letters.
                Some(found) if word == written.last()? => code = Some(found),
                _ if axis.is_none() && is_axis(word) && !id.codes().is_empty() => axis = Some(word.clone()),
                _ => return None,
            }
        }
        Some(Found { id, axis, code })
    }

    fn text(&self, model: ControlModel) -> String {
        let axis = self.axis.as_deref().unwrap_or("#");
        let mut title = self.id.text(model).replace('#', axis);
        if let (Some(axis), false) = (&self.axis, self.id.text(model).contains('#')) {
            title += &format!(" {axis}");
        }
        if let Some(code) = self.code {
            title += &format!(" {}", code.code);
        }
        let mut text = format!("{title}\n");
        if let (MessageId::LimitSwitch, Some(axis)) = (self.id, &self.axis) {
            text += &labelled("which:", &limit(axis, model));
        }
        let (cause, remedy, source) = match self.code {
            Some(code) => (code.cause, code.remedy, code.source),
            None => (self.id.cause(), self.id.remedy(), self.id.source()),
        };
        text += &labelled("cause:", cause);
        text += &labelled("remedy:", remedy);
        if self.code.is_none() {
            for code in self.id.codes() {
                text += &labelled(&format!("code {}:", code.code), code.cause);
            }
        }
        text + &labelled_lines("source:", &chapters(source))
    }
}

/// Which parameters hold the limit of an axis and sign, `X+`.
fn limit(axis: &str, model: ControlModel) -> String {
    let [plus, minus] = model.limit_parameters(axis);
    let letter = axis.trim_end_matches(['+', '-']);
    let (end, numbers) = match axis.chars().last() {
        Some('+') => ("positive end", plus),
        Some('-') => ("negative end", minus),
        _ => ("one of the ends", [plus, minus].concat()),
    };
    let ranges = if numbers.len() > 2 {
        " (by traverse range)"
    } else {
        ""
    };
    format!("{end} of axis {letter}: {}{ranges}", numbers.join(", "))
}

/// The words of a message as they are compared: capitals, hyphens between letters as blanks; `X+` and `#` stay.
fn words(text: &str) -> Vec<String> {
    let upper = text.to_uppercase();
    let words = upper.split(|c: char| c.is_whitespace() || matches!(c, '.' | ',' | ':' | '/' | '\''));
    let parts = words.flat_map(|word| match word.strip_suffix('-') {
        // The sign of a limit switch.
        Some(letter) if letter.chars().count() <= 2 => vec![word],
        _ => word.split('-').collect(),
    });
    parts.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// `X`, `IV` or `C+`.
fn is_axis(word: &str) -> bool {
    let letter = word.trim_end_matches(['+', '-']);
    matches!(letter, "X" | "Y" | "Z" | "IV" | "A" | "B" | "C" | "U" | "V" | "W")
}

/// `plc error 16`, `INPUT ERROR 16`, `ERROR IN PLC-PROGRAM 53` [000:11919].
fn plc_error(wanted: &str) -> Option<PlcError> {
    let words = words(wanted);
    let (number, before) = words.split_last()?;
    let number: u8 = number.parse().ok()?;
    let is_meant = ["PLC ERROR", "INPUT ERROR", "ERROR IN PLC PROGRAM"].contains(&before.join(" ").as_str());
    let mut all = PlcError::ALL.iter();
    all.find(|error| is_meant && error.number() == number).copied()
}

fn of_plc_error(error: PlcError) -> String {
    let runtime = error.number() >= 50;
    let when = if runtime {
        "while the PLC program runs: it stops, the message flashes"
    } else {
        "when the PLC program is compiled"
    };
    let mut text = format!("PLC error {error}\n");
    text += &labelled("found:", when);
    text += &labelled("cause:", error.cause());
    text += &labelled("remedy:", error.cure());
    text += &labelled(
        "note:",
        &format!(
            "`PLC: ERROR {}` on the screen is a message of the machine's own PLC program: see its documents.",
            error.number()
        ),
    );
    text + &labelled_lines("source:", &chapters(PLC_ERRORS))
}

/// A message of a System 900 by its number: `M1237`.
fn of_system900(wanted: &str) -> Option<String> {
    let has_letter = wanted.trim().starts_with(['M', 'm']);
    let message = named_message(wanted).filter(|_| has_letter)?;
    let mut text = format!("M{} {}\n", message.number, message.title);
    text += &labelled("control:", "System 900");
    text += &labelled(
        "kind:",
        &format!("{} (inferred): it {}", message.kind.id(), message.kind.words()),
    );
    text += &labelled("cause:", message.cause);
    text += &labelled("remedy:", message.remedy);
    Some(text + &labelled_lines("source:", &[message.source.to_owned()]))
}

/// Messages, PLC errors and machine parameters that mention all words.
fn mentions(wanted: &str, model: ControlModel) -> String {
    let wanted: Vec<String> = wanted
        .to_lowercase()
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    let mentioned = |texts: &[&str]| {
        let text = texts.join(" ").to_lowercase();
        wanted.iter().all(|word| text.contains(word.as_str()))
    };
    let messages = MessageId::ALL.iter().filter_map(|id| {
        let codes = id.codes().iter().map(|code| code.cause).collect::<String>();
        let found = mentioned(&[id.text(model), id.cause(), id.remedy(), &codes]);
        found.then(|| format!("  {}\n", id.text(model)))
    });
    let errors = PlcError::ALL.iter().filter_map(|error| {
        let found = mentioned(&[error.text(), error.cause(), error.cure()]);
        found.then(|| format!("  PLC error {error}\n"))
    });
    let parameters = Advice::all(model).iter().filter_map(|advice| {
        let mut own = Definition::all(model)
            .iter()
            .filter(|row| row.id.number == advice.number);
        let name = own.next()?.name;
        let names = own.map(|row| row.name).collect::<String>();
        let number = format!("MP{}", advice.number);
        let texts = [
            &number,
            name,
            &names,
            advice.does,
            advice.too_small,
            advice.too_large,
        ];
        mentioned(&texts).then(|| format!("  {number:<7} {name}\n"))
    });
    let rows = equipment::table(model)
        .into_iter()
        .filter_map(|[what, takes, _]| mentioned(&[&what, &takes]).then(|| format!("  {what}: {takes}\n")));
    let section = |title: &str, lines: &mut dyn Iterator<Item = String>| {
        let lines: String = lines.collect();
        match lines.is_empty() {
            true => String::new(),
            false => format!("{title}\n{lines}"),
        }
    };
    [
        section("Messages (bahn explain TEXT)", &mut { messages }),
        section("Errors of the PLC (bahn explain plc error N)", &mut { errors }),
        section("Machine parameters (bahn mp explain N)", &mut { parameters }),
        section("Software and options (bahn explain software)", &mut { rows }),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Option<(MessageId, Option<String>, Option<&'static str>)> {
        let found = Found::of(text)?;
        Some((found.id, found.axis, found.code.map(|code| code.code)))
    }

    #[test]
    fn messages_are_read_with_axis_sign_and_code() {
        use MessageId::{
            ErrorInPlcProgram, GrossPositioningError, LimitSwitch, MeasuringSystemDefective, PositioningError,
        };
        let axis = |letter: &str| Some(letter.to_owned());
        let cases = [
            (
                "GROSS POSITIONING ERROR A",
                (GrossPositioningError, None, Some("A")),
            ),
            (
                "gross positioning error x a",
                (GrossPositioningError, axis("X"), Some("A")),
            ),
            (
                "GROSS POSITIONING ERROR C A",
                (GrossPositioningError, axis("C"), Some("A")),
            ),
            (
                "GROSS POSITIONING ERROR 3F",
                (GrossPositioningError, None, Some("3F")),
            ),
            (
                "GROSS POSITIONING ERROR Z",
                (GrossPositioningError, axis("Z"), None),
            ),
            ("POSITIONING ERROR Y", (PositioningError, axis("Y"), None)),
            ("LIMIT SWITCH X+", (LimitSwitch, axis("X+"), None)),
            ("limit switch iv-", (LimitSwitch, axis("IV-"), None)),
            ("LIMIT SWITCH", (LimitSwitch, None, None)),
            (
                "MEASURING SYSTEM Z DEFECTIVE B",
                (MeasuringSystemDefective, axis("Z"), Some("B")),
            ),
            ("ERROR IN PLC-PROGRAM 1Q", (ErrorInPlcProgram, None, Some("1Q"))),
            ("error in plc program 2a", (ErrorInPlcProgram, None, Some("2A"))),
        ];
        for (text, expected) in cases {
            assert_eq!(found(text), Some(expected), "{text}");
        }
        for text in [
            "GROSS ERROR",
            "LIMIT SWITCH X+ A",
            "POSITIONING ERROR 1Q",
            "X",
            "",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }

    /// Every text of every model finds a message with this text, every name its own.
    #[test]
    fn every_message_is_found() {
        for id in MessageId::ALL {
            assert_eq!(found(id.name()).map(|found| found.0), Some(*id));
            for model in ControlModel::FAMILIES {
                let text = id.text(model);
                let shown = found(text).map(|found| found.0);
                let shown = shown.map(|id| ControlModel::FAMILIES.map(|model| id.text(model)));
                assert!(shown.is_some_and(|texts| texts.contains(&text)), "{text}");
            }
        }
    }

    #[test]
    fn messages_of_a_system900_are_found_by_number() {
        for text in ["M1237", " m1237 "] {
            let found = explained(text, ControlModel::Tnc415b);
            assert!(found.starts_with("M1237 circle dynamics P8852"), "{found}");
            assert!(
                found.contains("System 900") && found.contains("aborts the channel"),
                "{found}"
            );
            assert!(found.contains("[002:4586-4589]"), "{found}");
        }
        for text in ["1237", "M1239", "M"] {
            assert_eq!(of_system900(text), None, "{text}");
        }
    }

    #[test]
    fn plc_errors_are_found_by_number() {
        for text in ["plc error 16", "INPUT ERROR 16", "Error in PLC-Program 16"] {
            assert_eq!(plc_error(text), Some(PlcError::JumpInBracket), "{text}");
        }
        assert_eq!(plc_error("plc error 46"), None, "spare");
        assert_eq!(plc_error("error 16"), None);
    }

    #[test]
    fn words_find_what_mentions_them() {
        let text = mentions("tapping", ControlModel::Tnc415b);
        assert!(
            text.contains("MP7110 ") && text.contains("MP7120 ") && text.contains("MP3410 "),
            "{text}"
        );
        assert!(!text.contains("MP1010"), "{text}");
        assert!(mentions("bracket jump", ControlModel::Tnc415b).contains("PLC error 16 "));
        assert!(mentions("stylus", ControlModel::Tnc155).contains("STYLUS DEFLECTED\n"));
        assert_eq!(mentions("coffee", ControlModel::Tnc415b), "");
    }

    #[test]
    fn limits_name_their_parameters() {
        assert_eq!(limit("Y+", ControlModel::Tnc155), "positive end of axis Y: MP46");
        assert_eq!(
            limit("IV-", ControlModel::Tnc151),
            "negative end of axis IV: MP51"
        );
        assert_eq!(
            limit("X+", ControlModel::Tnc415b),
            "positive end of axis X: MP910.0, MP911.0, MP912.0 (by traverse range)"
        );
    }
}
