//! PROGRAM RUN, FULL SEQUENCE and SINGLE BLOCK [003:1537-1690].

use std::sync::Arc;

use bahn_control::{Command, Programs, RunState};
use bahn_dialogue::Key;
use bahn_program::Program;

use crate::graphics::Subject;
use crate::page::{Page, Turn, View};
use crate::pages::editing::NUMBER;
use crate::pages::files::{Directory, Purpose};
use crate::pages::list;
use crate::pages::number::Number;
use crate::pages::q_parameters::QParameters;
use crate::pages::table;
use crate::screen::{Line, Window, WindowKind};
use crate::site::Site;

/// A program is selected and runs.
#[derive(Default)]
pub(crate) struct ProgramRun {
    shown: Option<(String, Arc<Program>)>,
    /// The block the operator looks at while nothing runs.
    cursor: u32,
}

impl ProgramRun {
    fn move_cursor(&mut self, down: bool, site: &mut Site) -> Turn {
        let last = self
            .shown
            .as_ref()
            .map_or(0, |(_, program)| program.block_count().saturating_sub(1));
        let next = match down {
            true => self.cursor.saturating_add(1).min(last),
            false => self.cursor.saturating_sub(1),
        };
        if site.control().run_state() == RunState::Idle && site.command(Command::Goto(next)) {
            self.cursor = next;
            return Turn::Done;
        }
        Turn::Refused
    }
}

impl Page for ProgramRun {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if site.graphics.key(Subject::Run, key) {
            return Turn::Done;
        }
        match key {
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Run, site))),
            Key::Goto => Turn::Open(Number::ask(site.words("GOTO: NUMBER ="), |value, site| {
                value >= 0.0 && value.fract() == 0.0 && site.command(Command::Goto(value as u32))
            })),
            Key::Q => q_parameters(site),
            Key::Down => self.move_cursor(true, site),
            Key::Up => self.move_cursor(false, site),
            Key::Stop => match site.command(Command::InternalStop) {
                true => Turn::Done,
                false => Turn::Refused,
            },
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let there = |there: bool, text: String| if there { text } else { String::new() };
        let rules = site.parameters().operation_parameters().restart;
        // Out of a thread MANUAL OPERATION leads the tool in any case.
        let by_hand = rules.return_to_contour || site.control().first().is_in_thread();
        let keys = match site.control().run_state() {
            RunState::Idle => vec![
                there(rules.block_scan, site.words("RESTORE POS. AT N")),
                String::new(),
                String::new(),
                "Q".to_owned(),
                tool_table(site),
            ],
            RunState::Running => Vec::new(),
            _ => vec![
                there(by_hand, site.words("MANUAL OPERATION")),
                there(by_hand || rules.block_scan, site.words("RESTORE POSITION")),
                site.words("INTERNAL STOP"),
                "Q".to_owned(),
                tool_table(site),
            ],
        };
        vec![keys]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        let done = match (site.control().run_state(), place) {
            (RunState::Idle, 0) => {
                return Turn::Open(Number::ask(
                    site.words("RESTORE POSITION AT N ="),
                    |value, site| {
                        value >= 0.0 && value.fract() == 0.0 && site.command(Command::RestoreAt(value as u32))
                    },
                ));
            }
            (_, 3) => return q_parameters(site),
            (_, 4) => return table::tools(site),
            (_, 0) => site.command(Command::ManualOperation),
            (_, 1) => site.command(Command::RestorePosition),
            _ => site.command(Command::InternalStop),
        };
        if done { Turn::Done } else { Turn::Refused }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        match &self.shown {
            Some((name, program)) => View::of(listing(name, program, self.cursor, lines)),
            None => super::no_program(site),
        }
    }

    fn subject(&self) -> Option<Subject> {
        Some(Subject::Run)
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let selected = site.control().selected_program();
        let shown = self.shown.as_ref().map(|(name, _)| name.as_str());
        if shown != selected {
            let program = selected.and_then(|name| {
                let program = site.programs.open(name, "").ok().flatten()?;
                Some((name.to_owned(), program))
            });
            self.cursor = 0;
            self.shown = program;
        }
        if let Some(block) = running_block(site) {
            self.cursor = block;
        }
        Turn::Done
    }
}

/// The soft key of the tool table, when the machine has one [000:9002-9008].
fn tool_table(site: &Site) -> String {
    match table::has_tools(site) {
        true => site.words("TOOL TABLE"),
        false => String::new(),
    }
}

/// Q parameters, while nothing runs.
fn q_parameters(site: &Site) -> Turn {
    match site.control().run_state() {
        RunState::Running => Turn::Refused,
        _ => Turn::Open(Box::new(QParameters::default())),
    }
}

/// The block of the main program that is executed, or at which the next run starts.
fn running_block(site: &Site) -> Option<u32> {
    let control = site.control();
    if control.run_state() == RunState::Idle {
        return Some(control.start_block());
    }
    let block = control.element()?.block;
    (block.program == 0).then_some(block.block)
}

/// A block as it stands in the file, without the number that it has there.
fn without_number(text: &str) -> &str {
    let rest = text.trim_start().trim_start_matches(|c: char| c.is_ascii_digit());
    match rest.starts_with(char::is_whitespace) {
        true => rest.trim_start(),
        false => text,
    }
}

/// A program around a block.
pub(crate) fn listing(name: &str, program: &Program, current: u32, lines: usize) -> Window {
    let cursor = (current as usize, program.block_count() as usize);
    let line = |block: usize| Line {
        text: format!(
            "{block:<NUMBER$}{}",
            without_number(&program.text_of(block as u32))
        ),
        current: block == current as usize,
        ..Line::default()
    };
    list::window(name.to_owned(), WindowKind::Program, cursor, lines, line)
}
