//! What the operator does at the terminal: events in, inputs out.

use std::time::Instant;

use bahn_panel::{EMERGENCY_STOP, Input, Key, KeyAction, Language, Press, Screen, around, filled, shortcut};
use ratatui::crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use ratatui::layout::{Position, Rect};

use crate::commands::{self, Order};
use crate::hold::{Change, Hand, Holds};
use crate::machine::{Machine, STOP_LETTER};

/// Characters that turn the knobs there as the real keys with Alt do everywhere.
const KNOBS: [(char, &str); 4] = [('+', "+"), ('-', "-"), ('*', "."), ('/', ",")];
/// Counting steps of one turn of the handwheel by a key (inferred).
const TURN: i64 = 1000;
/// The knobs go so far, %.
const KNOB_MAX: f64 = 150.0;

/// Something on the screen that can be clicked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// A key of the control.
    Key(Key),
    /// A key of the machine, held as long as the button of the mouse.
    Machine(String),
}

/// Where what can be clicked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Targets(pub Vec<(Rect, Target)>);

impl Targets {
    fn at(&self, column: u16, row: u16) -> Option<&Target> {
        let at = Position::new(column, row);
        let hit = self.0.iter().find(|(area, _)| area.contains(at));
        hit.map(|(_, target)| target)
    }
}

/// The desk in front of the terminal.
#[derive(Debug, Default)]
pub(crate) struct Desk {
    /// The machine in front of the operator.
    pub machine: Machine,
    /// The language of what is said.
    language: Language,
    /// The keys are those of the machine operating panel.
    pub at_the_machine: bool,
    /// The list of short cuts lies open, scrolled by so many lines.
    pub help: Option<u16>,
    /// What was typed after `:`.
    pub line: Option<String>,
    /// The line that was given last.
    last_line: String,
    /// What is to be said of the last thing that was done.
    pub notice: String,
    /// Keys of the machine that are held.
    pub holds: Holds,
    /// The operator leaves the panel.
    pub leaves: bool,
}

impl Desk {
    /// In front of a machine.
    pub fn new(machine: Machine) -> Desk {
        Desk {
            machine,
            ..Desk::default()
        }
    }

    /// Takes an event; what is to be given to the station.
    pub fn event(&mut self, event: &Event, screen: &Screen, targets: &Targets, now: Instant) -> Vec<Input> {
        self.language = screen.look.language;
        match event {
            Event::Key(key) => self.key(*key, screen, now),
            Event::Mouse(mouse) => self.mouse(*mouse, targets, now),
            Event::Paste(text) => self.paste(text),
            Event::FocusLost => changed(self.holds.release_hands()),
            Event::FocusGained | Event::Resize(..) => Vec::new(),
        }
    }

    /// What time alone brings.
    pub fn tick(&mut self, now: Instant) -> Vec<Input> {
        changed(self.holds.tick(now))
    }

    fn paste(&mut self, text: &str) -> Vec<Input> {
        match &mut self.line {
            Some(line) => {
                line.extend(text.chars().filter(|character| !character.is_control()));
                Vec::new()
            }
            // Terminals end the lines of what is pasted as the key Enter does.
            None => text
                .split(['\r', '\n'])
                .filter(|line| !line.is_empty())
                .map(|line| Input::Text(line.to_owned()))
                .collect(),
        }
    }

    fn mouse(&mut self, mouse: MouseEvent, targets: &Targets, now: Instant) -> Vec<Input> {
        match mouse.kind {
            MouseEventKind::Down(MouseButton::Left) => match targets.at(mouse.column, mouse.row) {
                Some(Target::Key(key)) => vec![Input::Key(*key)],
                Some(Target::Machine(name)) if name == EMERGENCY_STOP => vec![stop()],
                Some(Target::Machine(name)) => changed(self.holds.press(name, Hand::Mouse, now)),
                None => Vec::new(),
            },
            MouseEventKind::Up(MouseButton::Left) => changed(self.holds.release_mouse()),
            MouseEventKind::ScrollUp => vec![Input::Key(Key::Up)],
            MouseEventKind::ScrollDown => vec![Input::Key(Key::Down)],
            _ => Vec::new(),
        }
    }

    fn key(&mut self, key: KeyEvent, screen: &Screen, now: Instant) -> Vec<Input> {
        let control = key.modifiers.contains(KeyModifiers::CONTROL);
        if key.kind == KeyEventKind::Release {
            return self.released(key);
        }
        self.notice.clear();
        match key.code {
            KeyCode::Char('c') if control => {
                self.leaves = true;
                return Vec::new();
            }
            _ if control => return Vec::new(),
            _ => {}
        }
        if self.line.is_some() {
            return self.type_line(key.code, now);
        }
        if let Some(scrolled) = self.help {
            self.help = turned(scrolled, key.code);
            return Vec::new();
        }
        let alt = key.modifiers.contains(KeyModifiers::ALT);
        match key.code {
            KeyCode::F(9) | KeyCode::Char('?') if !alt => self.help = Some(0),
            KeyCode::Char(':') if !alt => self.line = Some(String::new()),
            KeyCode::Tab => self.at_the_machine = !self.at_the_machine,
            KeyCode::Char(character) if self.at_the_machine && !alt => {
                return self.at_the_machine(character, screen, now);
            }
            code => {
                let press = real(code).and_then(|real| shortcut(&real, alt));
                return press.map_or_else(Vec::new, |press| self.press(press, screen, now));
            }
        }
        Vec::new()
    }

    /// A short cut of the table.
    fn press(&mut self, press: Press, screen: &Screen, now: Instant) -> Vec<Input> {
        match press {
            Press::Key(key) => vec![Input::Key(key)],
            Press::Machine(EMERGENCY_STOP) => self.emergency_stop(now),
            Press::Machine(name) => match self.machine.key(name) {
                Some(name) => changed(self.holds.press(&name, Hand::Keyboard, now)),
                None => {
                    self.say("the machine has no key {1}", name);
                    Vec::new()
                }
            },
            Press::Feed(step) => vec![Input::FeedOverride(turn(screen.machine.knobs[0], step))],
            Press::Spindle(step) => vec![Input::SpindleOverride(turn(screen.machine.knobs[1], step))],
        }
    }

    fn say(&mut self, english: &'static str, value: &str) {
        self.notice = filled(around(self.language, english), &[value]);
    }

    fn emergency_stop(&mut self, now: Instant) -> Vec<Input> {
        match self.holds.strikes(EMERGENCY_STOP, now) {
            true => vec![stop()],
            false => Vec::new(),
        }
    }

    /// A character while the keys are those of the machine: a small letter holds a key, a capital one leaves it down.
    fn at_the_machine(&mut self, character: char, screen: &Screen, now: Instant) -> Vec<Input> {
        match character {
            STOP_LETTER => return self.emergency_stop(now),
            '>' => return vec![Input::Handwheel(TURN)],
            '<' => return vec![Input::Handwheel(-TURN)],
            _ => {}
        }
        let knob = KNOBS.iter().find(|(typed, _)| *typed == character);
        if let Some(press) = knob.and_then(|(_, real)| shortcut(real, true)) {
            return self.press(press, screen, now);
        }
        let Some(name) = self.machine.lettered(character) else {
            self.say("no key of the machine has the letter {1}", &character.to_string());
            return Vec::new();
        };
        changed(match character.is_ascii_uppercase() {
            true => self.holds.latch(&name, now),
            false => self.holds.press(&name, Hand::Letter, now),
        })
    }

    /// A key was let go, where the terminal reports it.
    fn released(&mut self, key: KeyEvent) -> Vec<Input> {
        let alt = key.modifiers.contains(KeyModifiers::ALT);
        let of_letter = match key.code {
            KeyCode::Char(letter) if self.at_the_machine && letter.is_ascii_lowercase() => {
                self.machine.lettered(letter)
            }
            _ => None,
        };
        let of_table = match real(key.code).and_then(|real| shortcut(&real, alt)) {
            Some(Press::Machine(name)) => self.machine.key(name),
            _ => None,
        };
        let name = of_letter.or(of_table);
        changed(name.and_then(|name| self.holds.release(&name)))
    }

    /// A key while a command is typed.
    fn type_line(&mut self, code: KeyCode, now: Instant) -> Vec<Input> {
        let Some(mut line) = self.line.take() else {
            return Vec::new();
        };
        match code {
            KeyCode::Esc => return Vec::new(),
            KeyCode::Enter => return self.give_line(line, now),
            KeyCode::Backspace if line.pop().is_none() => return Vec::new(),
            KeyCode::Backspace => {}
            KeyCode::Up => line.clone_from(&self.last_line),
            KeyCode::Tab => self.complete(&mut line),
            KeyCode::Char(character) => line.push(character),
            _ => {}
        }
        self.line = Some(line);
        Vec::new()
    }

    fn complete(&mut self, line: &mut String) {
        let found = commands::completions(line, &self.machine);
        match found.as_slice() {
            [] => {}
            [name] => {
                let begin = line.trim_end().rfind(char::is_whitespace).map_or(0, |at| at + 1);
                line.truncate(begin);
                line.push_str(name);
                line.push(' ');
            }
            several => self.notice = several.join("  "),
        }
    }

    fn give_line(&mut self, line: String, now: Instant) -> Vec<Input> {
        let mut inputs = Vec::new();
        match commands::read(&line, &self.machine, self.language) {
            Err(wrong) => self.notice = wrong,
            Ok(orders) => {
                for order in orders {
                    match order {
                        Order::Give(input) => inputs.push(input),
                        Order::Hold(name) if name == EMERGENCY_STOP => {
                            inputs.push(Input::Machine(name, KeyAction::Press));
                        }
                        Order::Release(name) if name == EMERGENCY_STOP => {
                            inputs.push(Input::Machine(name, KeyAction::Release));
                        }
                        Order::Hold(name) => {
                            inputs.extend(changed(self.holds.press(&name, Hand::Latch, now)))
                        }
                        Order::Release(name) => match self.holds.release(&name) {
                            Some(change) => inputs.extend(changed([change])),
                            None => self.say("{1} is not held", &name),
                        },
                        Order::Help => self.help = Some(0),
                        Order::Quit => self.leaves = true,
                    }
                }
            }
        }
        self.last_line = line;
        inputs
    }
}

/// EMERGENCY STOP is pressed, or released when it was in.
fn stop() -> Input {
    Input::Machine(EMERGENCY_STOP.to_owned(), KeyAction::Tap)
}

fn turn(knob: f64, step: f64) -> f64 {
    (knob + step).clamp(0.0, KNOB_MAX)
}

/// How far the help is scrolled after a key; `None` closes it.
fn turned(scrolled: u16, code: KeyCode) -> Option<u16> {
    Some(match code {
        KeyCode::Up => scrolled.saturating_sub(1),
        KeyCode::Down => scrolled.saturating_add(1),
        KeyCode::PageUp => scrolled.saturating_sub(10),
        KeyCode::PageDown | KeyCode::Char(' ') => scrolled.saturating_add(10),
        KeyCode::Home => 0,
        _ => return None,
    })
}

/// Presses and releases as inputs.
fn changed(changes: impl IntoIterator<Item = Change>) -> Vec<Input> {
    let input = |change| match change {
        Change::Press(name) => Input::Machine(name, KeyAction::Press),
        Change::Release(name) => Input::Machine(name, KeyAction::Release),
    };
    changes.into_iter().map(input).collect()
}

/// Everything that is held comes up.
pub(crate) fn let_go(desk: &mut Desk) -> Vec<Input> {
    changed(desk.holds.release_all())
}

/// The name of a real key in the table of short cuts.
fn real(code: KeyCode) -> Option<String> {
    Some(match code {
        KeyCode::Char(character) => character.to_string(),
        KeyCode::F(number) => format!("F{number}"),
        KeyCode::Enter => "Enter".to_owned(),
        KeyCode::Esc => "Escape".to_owned(),
        KeyCode::Backspace => "Backspace".to_owned(),
        KeyCode::Delete => "Delete".to_owned(),
        KeyCode::Insert => "Insert".to_owned(),
        KeyCode::End => "End".to_owned(),
        KeyCode::PageUp => "PageUp".to_owned(),
        KeyCode::PageDown => "PageDown".to_owned(),
        KeyCode::Up => "ArrowUp".to_owned(),
        KeyCode::Down => "ArrowDown".to_owned(),
        KeyCode::Left => "ArrowLeft".to_owned(),
        KeyCode::Right => "ArrowRight".to_owned(),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn desk() -> Desk {
        Desk::new(Machine::of_keys(&["X-", "X+", "NC_START", "RAPID"]))
    }

    fn key(desk: &mut Desk, code: KeyCode, modifiers: KeyModifiers, now: Instant) -> Vec<Input> {
        let event = Event::Key(KeyEvent::new(code, modifiers));
        desk.event(&event, &Screen::default(), &Targets::default(), now)
    }

    fn plain(desk: &mut Desk, code: KeyCode) -> Vec<Input> {
        key(desk, code, KeyModifiers::NONE, Instant::now())
    }

    #[test]
    fn keys_are_those_of_the_table() {
        let mut desk = desk();
        for (code, expected) in [
            (KeyCode::Enter, Key::Ent),
            (KeyCode::F(3), Key::Sk3),
            (KeyCode::Char('l'), Key::L),
            (KeyCode::Char('7'), Key::Digit7),
            (KeyCode::Char('['), Key::Rl),
            (KeyCode::Insert, Key::NoEnt),
        ] {
            assert_eq!(plain(&mut desk, code), [Input::Key(expected)], "{code:?}");
        }
        let now = Instant::now();
        let pressed = key(&mut desk, KeyCode::Char('d'), KeyModifiers::ALT, now);
        assert_eq!(pressed, [Input::Key(Key::CyclDef)]);
        assert_eq!(
            key(&mut desk, KeyCode::Char('-'), KeyModifiers::ALT, now),
            [Input::FeedOverride(0.0)]
        );
        assert_eq!(plain(&mut desk, KeyCode::F(12)), []);
    }

    #[test]
    fn machine_keys_are_held_by_letters_and_stay_down_by_capitals() {
        let (mut desk, now) = (desk(), Instant::now());
        let down = |name: &str| vec![Input::Machine(name.to_owned(), KeyAction::Press)];
        let up = |name: &str| vec![Input::Machine(name.to_owned(), KeyAction::Release)];
        plain(&mut desk, KeyCode::Tab);
        assert_eq!(
            key(&mut desk, KeyCode::Char('b'), KeyModifiers::NONE, now),
            down("X+")
        );
        assert_eq!(
            key(&mut desk, KeyCode::Char('D'), KeyModifiers::SHIFT, now),
            down("RAPID")
        );
        assert_eq!(desk.tick(now + Duration::from_secs(1)), up("X+"));
        assert_eq!(let_go(&mut desk), up("RAPID"));
        // EMERGENCY STOP is turned over once, however long its key is held.
        let struck = |desk: &mut Desk, ms| {
            let at = now + Duration::from_millis(ms);
            key(desk, KeyCode::Char(STOP_LETTER), KeyModifiers::NONE, at).len()
        };
        assert_eq!(
            [0, 500, 540, 580, 2000].map(|ms| struck(&mut desk, ms)),
            [1, 0, 0, 0, 1]
        );
        // A key that the machine does not have is said.
        plain(&mut desk, KeyCode::Tab);
        assert_eq!(key(&mut desk, KeyCode::Up, KeyModifiers::ALT, now), []);
        assert!(desk.notice.contains("Y+"));
        // So is a letter that presses none.
        plain(&mut desk, KeyCode::Tab);
        assert_eq!(plain(&mut desk, KeyCode::Char('z')), []);
        assert!(desk.notice.contains("letter z"), "{}", desk.notice);
    }

    /// Terminals end pasted lines by CR, some by LF or both.
    #[test]
    fn pasted_lines_are_typed_one_after_the_other() {
        let mut desk = desk();
        let mut paste = |text: &str| {
            let event = Event::Paste(text.to_owned());
            desk.event(&event, &Screen::default(), &Targets::default(), Instant::now())
        };
        let typed = ["L X+1", "L Y+2"].map(|line| Input::Text(line.to_owned()));
        for text in ["L X+1\rL Y+2\r", "L X+1\nL Y+2", "L X+1\r\n\r\nL Y+2\r\n"] {
            assert_eq!(paste(text), typed, "{text:?}");
        }
    }

    #[test]
    fn the_mouse_presses_what_it_points_at() {
        let (mut desk, now) = (desk(), Instant::now());
        let targets = Targets(vec![
            (Rect::new(0, 20, 8, 2), Target::Key(Key::Sk1)),
            (Rect::new(0, 22, 4, 1), Target::Machine("X-".to_owned())),
        ]);
        let mut mouse = |kind, column, row| {
            let event = Event::Mouse(MouseEvent {
                kind,
                column,
                row,
                modifiers: KeyModifiers::NONE,
            });
            desk.event(&event, &Screen::default(), &targets, now)
        };
        let down = MouseEventKind::Down(MouseButton::Left);
        let up = MouseEventKind::Up(MouseButton::Left);
        assert_eq!(mouse(down, 7, 21), [Input::Key(Key::Sk1)]);
        assert_eq!(mouse(up, 7, 21), []);
        assert_eq!(mouse(down, 8, 21), []);
        assert_eq!(
            mouse(down, 0, 22),
            [Input::Machine("X-".to_owned(), KeyAction::Press)]
        );
        // Let go wherever the pointer is then.
        assert_eq!(
            mouse(up, 70, 3),
            [Input::Machine("X-".to_owned(), KeyAction::Release)]
        );
    }

    #[test]
    fn commands_are_typed_completed_and_repeated() {
        let mut desk = desk();
        let mut typed = |text: &str| {
            let mut inputs = Vec::new();
            for character in text.chars() {
                inputs = plain(
                    &mut desk,
                    match character {
                        '\n' => KeyCode::Enter,
                        '\t' => KeyCode::Tab,
                        '^' => KeyCode::Up,
                        character => KeyCode::Char(character),
                    },
                );
            }
            (inputs, desk.line.clone(), desk.notice.clone(), desk.leaves)
        };
        let start = Input::Machine("NC_START".to_owned(), KeyAction::Tap);
        for line in [":key nc\t\n", ":^\n"] {
            assert_eq!(typed(line).0, std::slice::from_ref(&start));
        }
        let (_, line, notice, _) = typed(":key cycl\t");
        assert_eq!(
            (line.as_deref(), notice.as_str()),
            (Some("key cycl"), "CYCL_DEF  CYCL_CALL")
        );
        let (inputs, line, notice, _) = typed("x\n");
        assert_eq!((inputs.len(), line), (0, None));
        assert!(notice.contains("cyclx"), "{notice}");
        let (inputs, _, notice, _) = typed(":release rapid\n");
        assert_eq!((inputs.len(), notice.as_str()), (0, "RAPID is not held"));
        assert!(typed(":quit\n").3);
    }
}
