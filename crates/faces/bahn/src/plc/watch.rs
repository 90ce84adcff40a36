//! `bahn plc watch`: the table of operands while the program runs or is stepped [000:11436-11460].

mod entry;
mod screen;
mod state;
#[cfg(test)]
mod tests;

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use bahn_exchange::Exchange;
use bahn_host::Retained;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use bahn_report::plc::{Breakpoints, Halt, Subject, Trend, operands as named_by};

use super::bench::set_operands;
use super::options::WatchOptions;
use super::subject;
use crate::{Outcome, UsageError};
use bahn_host::{Assignment, Content, Operand};
use entry::Entry;

use state::{LastInstruction, Watch};

/// Shows the table until the user ends it.
pub(super) fn command(options: &WatchOptions) -> Result<Outcome, UsageError> {
    if !std::io::stdout().is_terminal() || !std::io::stdin().is_terminal() {
        return Err(UsageError::new("bahn plc watch needs a terminal"));
    }
    let mut retained = None;
    let exchange = || {
        retained = super::retained(options.retain.as_deref())?;
        Ok(retained
            .as_ref()
            .map_or_else(Exchange::default, Retained::restore))
    };
    let open = subject::open(&options.program, &options.bench, &options.machine, exchange)?;
    let Some(subject) = open else {
        return Ok(Outcome::ProgramError);
    };
    if options.retain.is_some() && retained.is_none() {
        return Err(UsageError::new(
            "--retain is of the bench: the machine of a folder begins without what survived, and keeps nothing",
        ));
    }
    let mut operands = options.show.clone();
    if operands.is_empty() {
        let set = set_operands(&options.bench)?;
        operands.extend(set.iter().filter_map(|assignment| match assignment {
            Assignment::Operand(operand, _) => Some(*operand),
            Assignment::Parameter(_) => None,
        }));
        for operand in named_by(subject.script()) {
            if !operands.contains(&operand) {
                operands.push(operand);
            }
        }
    }
    let mut watch = Watch::new(subject, operands, retained);
    let mut terminal =
        ratatui::try_init().map_err(|error| UsageError::new(format!("no full screen: {error}")))?;
    let result = watch.show(&mut terminal);
    ratatui::restore();
    result?;
    if let (Some(retained), Some(bench)) = (&mut watch.retained, watch.subject.bench()) {
        retained.flush(bench.exchange.plc())?;
    }
    Ok(subject::finish(&watch.subject))
}

/// What is said of keys that a running machine does not have.
const ON_THE_BENCH: &str =
    "on a machine there are whole scans: lines and a new start are on the bench (bahn plc watch MAIN.PLC)";

impl Watch {
    fn new(subject: Subject, operands: Vec<Operand>, retained: Option<Retained>) -> Watch {
        Watch {
            subject,
            operands,
            chosen: 0,
            running: false,
            entry: None,
            message: String::new(),
            last: LastInstruction::default(),
            breakpoints: Breakpoints::default(),
            held: false,
            trend: Trend::default(),
            retained,
        }
    }

    fn show(&mut self, terminal: &mut DefaultTerminal) -> Result<(), UsageError> {
        let wrong = |error: std::io::Error| UsageError::new(format!("terminal: {error}"));
        let mut next = Instant::now();
        loop {
            if self.running && Instant::now() >= next {
                // A late cycle is not made up for.
                next = (next + self.subject.cycle_time()).max(Instant::now());
                self.cycle();
                if let (Some(retained), Some(bench)) = (&mut self.retained, self.subject.bench()) {
                    retained.tick(bench.exchange.plc())?;
                }
            }
            terminal.draw(|frame| screen::draw(frame, self)).map_err(wrong)?;
            let wait = if self.running {
                next.saturating_duration_since(Instant::now())
            } else {
                Duration::from_millis(250)
            };
            if event::poll(wait).map_err(wrong)?
                && let Event::Key(key) = event::read().map_err(wrong)?
                && key.kind != KeyEventKind::Release
            {
                let was_running = self.running;
                if !self.key(key) {
                    return Ok(());
                }
                if self.running && !was_running {
                    next = Instant::now();
                }
            }
        }
    }

    /// Does what a key says; `false` ends the view.
    fn key(&mut self, key: KeyEvent) -> bool {
        if key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL) {
            return false;
        }
        if self.entry.is_some() {
            self.type_entry(key.code);
            return true;
        }
        match key.code {
            KeyCode::Char('q') | KeyCode::Esc => return false,
            KeyCode::Char('r') => {
                self.message.clear();
                self.running = true;
            }
            KeyCode::Char('s') => self.running = false,
            KeyCode::Char('c') => {
                self.message.clear();
                self.running = false;
                self.cycle();
            }
            KeyCode::Char('l') => {
                self.message.clear();
                self.running = false;
                self.line();
            }
            KeyCode::Char('n') => self.restart(),
            KeyCode::Up => self.chosen = self.chosen.saturating_sub(1),
            KeyCode::Down => self.chosen = (self.chosen + 1).min(self.operands.len().saturating_sub(1)),
            KeyCode::Home => self.chosen = 0,
            KeyCode::End => self.chosen = self.operands.len().saturating_sub(1),
            KeyCode::Char(' ') => self.turn_over(),
            KeyCode::Enter => {
                if let Some(operand) = self.operands.get(self.chosen) {
                    self.entry = Some(Entry::value(*operand));
                }
            }
            KeyCode::Char('a') => self.entry = Some(Entry::operands()),
            KeyCode::Char('b') if self.subject.bench().is_none() => {
                ON_THE_BENCH.clone_into(&mut self.message)
            }
            KeyCode::Char('b') => self.entry = Some(Entry::breakpoint()),
            KeyCode::Char('x') => {
                if let Some(operand) = self.operands.get(self.chosen) {
                    let content = self.subject.read(*operand);
                    let stops = self.breakpoints.turn_over(*operand, content);
                    let what = if stops { "stops" } else { "does not stop" };
                    self.message = format!("a change of {operand} {what} the program");
                }
            }
            KeyCode::Char('t') => self.trend.turn_over(),
            KeyCode::Char('d') if self.chosen < self.operands.len() => {
                self.operands.remove(self.chosen);
                self.chosen = self.chosen.min(self.operands.len().saturating_sub(1));
            }
            _ => {}
        }
        true
    }

    /// Starts program and script anew.
    fn restart(&mut self) {
        let Some(bench) = self.subject.bench() else {
            ON_THE_BENCH.clone_into(&mut self.message);
            return;
        };
        bench.restart();
        self.last = LastInstruction::default();
        self.trend.clear();
        self.message = "started anew; operands keep their values".to_owned();
    }

    /// Runs a cycle, or the rest of one that was begun. A breakpoint in a line ends it before that line.
    fn cycle(&mut self) {
        let result = if self.subject.is_inside() || self.breakpoints.has_lines() {
            self.lines()
        } else {
            // While the program runs there is no time to look at lines.
            self.last = LastInstruction::default();
            self.subject.scan(None).map(|()| true)
        };
        match result {
            Ok(false) => {}
            Ok(true) => self.cycle_ended(Ok(())),
            Err(error) => self.cycle_ended(Err(error)),
        }
    }

    /// Executes lines to the end of the cycle, or to a breakpoint: tells whether the cycle is over.
    fn lines(&mut self) -> Result<bool, Halt> {
        if !self.subject.is_inside() && !self.held && self.breaks_before(0) {
            self.held = true;
            return Ok(false);
        }
        self.held = false;
        loop {
            if self.step()? {
                return Ok(true);
            }
            if self.breaks_before(self.subject.plc().registers().next) {
                return Ok(false);
            }
        }
    }

    /// Stops before an instruction whose line has a breakpoint.
    fn breaks_before(&mut self, next: usize) -> bool {
        let next = self.subject.plc().program().code.get(next);
        let place = next.map(|next| (next.file, next.line));
        let line = place.and_then(|place| self.breakpoints.at(place));
        if let Some(line) = line {
            self.running = false;
            self.message = format!("stopped before line {line}");
        }
        line.is_some()
    }

    /// Executes the next line of a cycle; tells whether it is over.
    fn step(&mut self) -> Result<bool, Halt> {
        match self.subject.bench() {
            Some(bench) => Ok(bench.step(&mut self.last)?),
            None => Ok(false),
        }
    }

    /// Executes the next line, on a bench only.
    fn line(&mut self) {
        if self.subject.bench().is_none() {
            ON_THE_BENCH.clone_into(&mut self.message);
            return;
        }
        match self.step() {
            Ok(false) => {}
            Ok(true) => self.cycle_ended(Ok(())),
            Err(error) => self.cycle_ended(Err(error)),
        }
    }

    fn cycle_ended(&mut self, result: Result<(), Halt>) {
        match result {
            Err(halt) => {
                self.running = false;
                self.message = match self.subject.bench() {
                    Some(_) => format!("{halt}  (n starts anew)"),
                    None => halt.to_string(),
                };
            }
            Ok(()) => {
                let contents = self.operands.iter().map(|operand| self.subject.read(*operand));
                self.trend.take(&self.operands, contents);
                let subject = &self.subject;
                if let Some(change) = self.breakpoints.changed(|operand| subject.read(operand)) {
                    self.running = false;
                    self.message = change;
                }
                if let Some(failure) = self.subject.take_failures().first() {
                    self.message.clone_from(failure);
                }
            }
        }
    }

    fn turn_over(&mut self) {
        if let Some(operand @ Operand::Bit(_)) = self.operands.get(self.chosen).copied() {
            let value = i32::from(self.subject.read(operand) == Content::Number(0));
            self.set(operand, &Content::Number(value));
        }
    }

    /// Sets an operand for the next cycle.
    fn set(&mut self, operand: Operand, content: &Content) {
        if let Err(error) = self.subject.set(operand, content) {
            self.message = error;
        }
    }

    fn type_entry(&mut self, code: KeyCode) {
        let Some(mut entry) = self.entry.take() else {
            return;
        };
        self.message.clear();
        match code {
            KeyCode::Esc => return,
            KeyCode::Enter => match entry.accept() {
                Ok(entry::Accepted::Value(operand, content)) => return self.set(operand, &content),
                Ok(entry::Accepted::Operands(operands)) => {
                    self.operands.extend(operands);
                    self.chosen = self.operands.len().saturating_sub(1);
                    return;
                }
                Ok(entry::Accepted::Line(line)) => {
                    let set = self.breakpoints.turn_over_line(line);
                    let what = if set { "set" } else { "cleared" };
                    self.message = format!("breakpoint at line {line} of the main file {what}");
                    return;
                }
                // The text stays to be corrected.
                Err(error) => self.message = error,
            },
            code => entry.type_key(code),
        }
        self.entry = Some(entry);
    }
}
