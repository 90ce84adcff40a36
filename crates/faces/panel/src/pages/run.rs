//! PROGRAM RUN, FULL SEQUENCE and SINGLE BLOCK [003:1537-1690].
//!
//! Decision: Graphics in program run: a TNC 415 and 425 draw what runs, a TNC 407 has them in TEST RUN only; a TNC
//! 360 and before draw what runs, and START simulates the program while nothing runs

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_graphics::Subject;
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::BlockRef;
use bahn_program::{Program, WordKind};
use bahn_screen::{Line, Window, WindowKind};
use bahn_tnc::{Command, Programs, RunState};

use crate::page::{Page, Turn, View};
use crate::pages::editing::numbered;
use crate::pages::files::{Directory, Purpose, selection};
use crate::pages::list;
use crate::pages::number::Number;
use crate::pages::q_parameters::QParameters;
use crate::pages::table;
use crate::site::Site;

/// A program is selected and runs.
#[derive(Default)]
pub(crate) struct ProgramRun {
    shown: Option<(String, Arc<Program>)>,
    /// The block that is executed, or with which NC START begins or goes on.
    cursor: BlockRef,
    /// The program that was called and has it.
    called: Option<Arc<Program>>,
    /// CALL LBL blocks of repeats that are under way, and how many are left.
    repeats: Vec<(BlockRef, u32)>,
    graphics: RunGraphics,
    /// The graphics show the simulation that START has begun, not the run.
    simulated: bool,
}

/// What graphics a control has in program run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum RunGraphics {
    /// None: the simulation of a TNC 407 belongs to TEST RUN [000:6370].
    #[default]
    None,
    /// What runs is drawn meanwhile.
    Parallel,
    /// The same, and START simulates the program before it runs [003:856-873].
    Simulated,
}

impl ProgramRun {
    /// The page of a control.
    pub fn new(model: ControlModel) -> ProgramRun {
        ProgramRun {
            graphics: if model.simulates_in_program_run() {
                RunGraphics::Simulated
            } else if model.draws_what_runs() {
                RunGraphics::Parallel
            } else {
                RunGraphics::None
            },
            ..ProgramRun::default()
        }
    }

    /// The key START simulates the selected program, as often as desired [003:870-874].
    fn simulate(&mut self, site: &mut Site) -> Turn {
        let program = site.control().selected_program().map(str::to_owned);
        let rests = site.control().run_state() == RunState::Idle;
        let Some(program) = program.filter(|_| rests) else {
            return Turn::Refused;
        };
        match site.command(Command::Test(program)) {
            true => {
                site.graphics.test(site.host.control());
                self.simulated = true;
                Turn::Done
            }
            false => Turn::Refused,
        }
    }

    /// The program that is selected.
    fn program(&self) -> Option<Arc<Program>> {
        self.shown.as_ref().map(|(_, program)| Arc::clone(program))
    }

    /// Finds the block that is executed or comes next; a program that was called is shown while it is the one
    /// [003:586] [003:3876].
    fn look(&mut self, site: &Site) {
        let run = site.control().first();
        let element = run.element();
        let rests = run.run_state() == RunState::Idle || run.is_broken();
        let at = match rests {
            true => run.next_start(),
            false => element.map(|element| element.block),
        };
        // While the program is read on another thread what was shown stays.
        let (Some(at), Some(reader)) = (at, run.reader()) else {
            self.called = self.called.take().filter(|_| at.is_none_or(|at| at.program != 0));
            self.cursor = at.filter(|at| at.program == 0).unwrap_or(self.cursor);
            return;
        };
        self.cursor = at;
        self.called = match at.program {
            0 => None,
            program => reader.program(program).cloned(),
        };
        self.repeats.clear();
        if let Some(element) = element.filter(|_| run.is_active())
            && let Some(interpreter) = run.interpreter()
        {
            self.repeats.extend(interpreter.repeats_at(element.sequence));
        }
    }

    /// REP n/m in CALL LBL: the number after the slash is how many repeats are left [003:3762].
    fn count_down(&self, window: &mut Window) {
        for (place, line) in window.lines.iter_mut().enumerate() {
            let block = BlockRef {
                program: self.cursor.program,
                block: u32::try_from(window.first + place).unwrap_or(u32::MAX),
            };
            let left = self.repeats.iter().rfind(|(call, _)| *call == block);
            let Some((_, left)) = left else { continue };
            if let Some(text) = counted(&line.text, *left) {
                line.text = text;
            }
        }
    }

    fn move_cursor(&mut self, down: bool, site: &mut Site) -> Turn {
        let last = self
            .shown
            .as_ref()
            .map_or(0, |(_, program)| program.block_count().saturating_sub(1));
        // GOTO counts in the main program: out of one that was called there is GOTO alone (inferred).
        if self.cursor.program != 0 || site.control().run_state() != RunState::Idle {
            return Turn::Refused;
        }
        let block = self.cursor.block;
        let next = match down {
            true => block.saturating_add(1).min(last),
            false => block.saturating_sub(1),
        };
        match site.command(Command::Goto(next)) {
            true => {
                self.look(site);
                Turn::Done
            }
            false => Turn::Refused,
        }
    }
}

impl Page for ProgramRun {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(subject) = self.subject()
            && site.graphics.key(subject, key)
        {
            return Turn::Done;
        }
        match key {
            Key::Start if self.graphics == RunGraphics::Simulated => self.simulate(site),
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Run, site))),
            Key::Goto => {
                let program = self.program();
                Turn::Open(Number::ask(site.words("GOTO: NUMBER ="), move |value, site| {
                    let block = block_of(program.as_deref(), value);
                    block.is_some_and(|block| site.command(Command::Goto(block)))
                }))
            }
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
                there(rules.block_scan, site.words("RESTORE AT N")),
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
                let Some(program) = self.program() else {
                    return Turn::Say(site.message(MessageId::ProgramNotFound));
                };
                return Turn::Open(Number::turning(
                    site.words("RESTORE POSITION AT N ="),
                    move |value, site| restore_at(&program, value, site),
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
            Some((name, program)) => {
                let (name, program) = match &self.called {
                    Some(called) => (own_name(called), called),
                    None => (name.as_str(), program),
                };
                let mut window = listing(name, program, self.cursor.block, lines);
                self.count_down(&mut window);
                View::of(window)
            }
            None => super::no_program(site),
        }
    }

    fn subject(&self) -> Option<Subject> {
        match self.graphics {
            RunGraphics::None => None,
            _ if self.simulated => Some(Subject::Test),
            _ => Some(Subject::Run),
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let selected = site.control().selected_program();
        let shown = self.shown.as_ref().map(|(name, _)| name.as_str());
        if shown != selected {
            let program = selected.and_then(|name| {
                let program = site.programs.open(name, "").ok().flatten()?;
                Some((name.to_owned(), program))
            });
            self.cursor = BlockRef::default();
            self.called = None;
            self.shown = program;
        }
        self.look(site);
        if site.control().run_state() != RunState::Idle {
            self.simulated = false;
        }
        match self.simulated && site.graphics.cannot_be_shown() {
            true => Turn::Say(site.message(MessageId::PgmSectionCannotBeShown)),
            false => Turn::Done,
        }
    }
}

/// The name of a program as it was selected: without its folder and type.
fn own_name(program: &Program) -> &str {
    let name = program.name();
    selection(name.rsplit_once('/').map_or(name, |(_, name)| name))
}

/// A CALL LBL block with the number of repeats that are left behind its slash.
fn counted(text: &str, left: u32) -> Option<String> {
    let (before, count) = text.split_once("REP ")?;
    let (total, rest) = count.split_once('/')?;
    let after = rest.trim_start_matches(|character: char| character.is_ascii_digit());
    Some(format!("{before}REP {total}/{left}{after}"))
}

/// The block of the number that was entered: in DIN/ISO that which it is programmed with.
pub(crate) fn block_of(program: Option<&Program>, value: f64) -> Option<u32> {
    let number = (value >= 0.0 && value.fract() == 0.0).then_some(value as u32)?;
    match program {
        Some(program) => program.block_of(number),
        None => Some(number),
    }
}

/// The block scan begins, unless the control is not ready for it.
fn restore_at(program: &Program, value: f64, site: &mut Site) -> Turn {
    let Some(block) = block_of(Some(program), value) else {
        return Turn::Say(site.message(MessageId::EntryValueIncorrect));
    };
    match site.command(Command::RestoreAt(block)) {
        true => Turn::Close,
        false => Turn::CloseSaying(site.message(MessageId::KeyNonFunctional)),
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

/// A block as it stands in the file, without the number that it has there.
fn without_number(program: &Program, block: u32) -> String {
    let text = program.text_of(block);
    let words = program.language().parse_block(&text).words;
    let number = words.iter().find(|word| word.kind == WordKind::Number);
    let parts = number.and_then(|word| Some((text.get(..word.span.start)?, text.get(word.span.end..)?)));
    match parts {
        // A `/` may stand before it.
        Some((before, after)) => format!("{}{}", before.trim_start(), after.trim_start()),
        None => text,
    }
}

/// A program around a block.
pub(crate) fn listing(name: &str, program: &Program, current: u32, lines: usize) -> Window {
    let cursor = (current as usize, program.block_count() as usize);
    let line = |block: usize| Line {
        text: numbered(&program.shown_number(block as u32), program) + &without_number(program, block as u32),
        current: block == current as usize,
        ..Line::default()
    };
    list::window(name.to_owned(), WindowKind::Program, cursor, lines, line)
}
