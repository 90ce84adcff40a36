//! Colours, where the terminal has them.

use ratatui::style::{Color, Modifier, Style};

/// What the terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Palette {
    /// No colours: bold, dim and reverse video only.
    Plain,
    /// The 16 colours of the terminal's own scheme, and 216 for pictures.
    Indexed,
    /// The same with all colours for pictures.
    True,
}

/// Why something is drawn as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// The operating mode that has the keys.
    Active,
    /// The other operating mode, beside the active one.
    Beside,
    /// The question of the dialogue.
    Prompt,
    /// What is being typed, and the word that is overwritten.
    Entry,
    /// A message: reverse video.
    Message,
    /// A message that CE does not clear.
    Flashing,
    /// Frames of the windows, and lines between them.
    Frame,
    /// The current block or row.
    Current,
    /// The line that is chosen of a list.
    Chosen,
    /// Part of a marked section.
    Section,
    /// It is wrong, or a fault.
    Fault,
    /// Text of less importance.
    Quiet,
    /// A value that is looked for.
    Value,
    /// A soft key, or a key of the machine.
    Button,
    /// A key that is held.
    Held,
    /// A lamp that is lit.
    Lit,
    /// The done part of a bar.
    Bar,
    /// The letter that presses a key.
    Letter,
}

impl Palette {
    /// What this terminal says of itself: `NO_COLOR`, `TERM`, `COLORTERM`.
    pub fn of_the_terminal() -> Palette {
        let variable = |name: &str| std::env::var(name).unwrap_or_default();
        Palette::from(&variable("NO_COLOR"), &variable("TERM"), &variable("COLORTERM"))
    }

    fn from(no_color: &str, term: &str, colorterm: &str) -> Palette {
        if !no_color.is_empty() || term == "dumb" || term.starts_with("vt") {
            return Palette::Plain;
        }
        match colorterm {
            "truecolor" | "24bit" => Palette::True,
            _ => Palette::Indexed,
        }
    }

    /// How something is drawn.
    pub fn style(self, role: Role) -> Style {
        let (modifier, colour) = match role {
            Role::Active => (Modifier::BOLD | Modifier::REVERSED, Some(Color::Cyan)),
            Role::Beside | Role::Frame => (Modifier::empty(), Some(Color::Cyan)),
            Role::Prompt => (Modifier::BOLD, Some(Color::Yellow)),
            Role::Entry => (Modifier::REVERSED, Some(Color::Yellow)),
            Role::Message => (Modifier::BOLD | Modifier::REVERSED, Some(Color::Yellow)),
            Role::Flashing => (
                Modifier::BOLD | Modifier::REVERSED | Modifier::SLOW_BLINK,
                Some(Color::Red),
            ),
            Role::Current => (Modifier::BOLD, None),
            Role::Chosen => (Modifier::BOLD | Modifier::REVERSED, None),
            Role::Section => (Modifier::UNDERLINED, Some(Color::Magenta)),
            Role::Fault => (Modifier::BOLD | Modifier::UNDERLINED, Some(Color::Red)),
            Role::Quiet => (Modifier::DIM, None),
            Role::Value => (Modifier::BOLD, Some(Color::Green)),
            Role::Button => (Modifier::empty(), Some(Color::Blue)),
            Role::Held => (Modifier::REVERSED, None),
            Role::Lit => (Modifier::BOLD, Some(Color::Yellow)),
            Role::Bar => (Modifier::empty(), Some(Color::Green)),
            Role::Letter => (Modifier::BOLD | Modifier::UNDERLINED, Some(Color::Cyan)),
        };
        let style = Style::new().add_modifier(modifier);
        match (self, colour) {
            (Palette::Plain, _) | (_, None) => style,
            (_, Some(colour)) => style.fg(colour),
        }
    }

    /// A colour of a picture; none where there are no colours.
    pub(crate) fn picture(self, [red, green, blue]: [u8; 3]) -> Option<Color> {
        match self {
            Palette::Plain => None,
            Palette::True => Some(Color::Rgb(red, green, blue)),
            Palette::Indexed => {
                // The cube of 6 x 6 x 6 colours begins at 16; its steps are 0, 95, 135, 175, 215, 255.
                let step = |part: u8| match part {
                    0..48 => 0,
                    48..115 => 1,
                    _ => (part - 35) / 40,
                };
                Some(Color::Indexed(16 + 36 * step(red) + 6 * step(green) + step(blue)))
            }
        }
    }

    /// A colour of the PLC window, 0 to 15: those of the page.
    pub(crate) fn plc(self, colour: u8) -> Style {
        let style = Style::new();
        match (self, colour % 8) {
            (Palette::Plain, _) => style,
            (_, 1) => style.fg(Color::Blue),
            (_, 2) => style.fg(Color::Green),
            (_, 3) => style.fg(Color::Cyan),
            (_, 4) => style.fg(Color::Red),
            (_, 5) => style.fg(Color::Magenta),
            (_, 6) => style.fg(Color::Yellow),
            _ => style,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_terminal() {
        assert_eq!(Palette::from("", "xterm", ""), Palette::Indexed);
        assert_eq!(Palette::from("", "xterm", "truecolor"), Palette::True);
        assert_eq!(Palette::from("1", "xterm", "truecolor"), Palette::Plain);
        assert_eq!(Palette::from("", "dumb", ""), Palette::Plain);
        for role in [Role::Active, Role::Fault, Role::Quiet, Role::Lit] {
            assert_eq!(Palette::Plain.style(role).fg, None);
        }
    }

    #[test]
    fn a_colour_becomes_the_nearest_of_the_cube() {
        let steps = [0_u8, 95, 135, 175, 215, 255];
        for part in 0..=255_u8 {
            let nearest = (0..6).min_by_key(|step| steps[*step].abs_diff(part)).unwrap();
            let Some(Color::Indexed(index)) = Palette::Indexed.picture([part; 3]) else {
                panic!("{part}");
            };
            let found = steps[usize::from((index - 16) / 43)];
            assert_eq!(found.abs_diff(part), steps[nearest].abs_diff(part), "{part}");
            assert_eq!((index - 16) % 43, 0);
        }
    }
}
