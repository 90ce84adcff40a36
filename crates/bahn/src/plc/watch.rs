//! `bahn plc watch`: the table of operands while the program runs or is stepped [000:11436-11460].

mod table;

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use bahn_exchange::Exchange;
use bahn_plc::{RuntimeError, TraceStep, Tracer};
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use super::bench::{Bench, set_operands};
use super::operand::{Assignment, Content, Operand};
use super::options::WatchOptions;
use super::source::Source;
use crate::{Outcome, UsageError};

/// Shows the table until the user ends it.
pub(super) fn command(options: &WatchOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let Some(program) = source.program() else {
        return Ok(Outcome::ProgramError);
    };
    if !std::io::stdout().is_terminal() || !std::io::stdin().is_terminal() {
        return Err(UsageError::new("bahn plc watch needs a terminal"));
    }
    let bench = Bench::new(
        program,
        options.program.model,
        &options.bench,
        Exchange::default(),
    )?;
    let mut operands = options.show.clone();
    if operands.is_empty() {
        let set = set_operands(&options.bench)?;
        operands.extend(set.iter().filter_map(|assignment| match assignment {
            Assignment::Operand(operand, _) => Some(*operand),
            Assignment::Parameter(_) => None,
        }));
        for operand in bench.script.operands() {
            if !operands.contains(&operand) {
                operands.push(operand);
            }
        }
    }
    let mut terminal =
        ratatui::try_init().map_err(|error| UsageError::new(format!("no full screen: {error}")))?;
    let result = Watch::new(bench, operands).show(&mut terminal);
    ratatui::restore();
    result.map_err(|error| UsageError::new(format!("terminal: {error}")))?;
    Ok(Outcome::Fine)
}

/// The view.
struct Watch {
    bench: Bench,
    operands: Vec<Operand>,
    chosen: usize,
    running: bool,
    /// Whether a cycle is being stepped line by line.
    inside: bool,
    entry: Option<Entry>,
    message: String,
    last_line: LastLine,
}

/// What is being typed.
struct Entry {
    text: String,
    /// A value of the chosen operand, or else a new operand.
    is_value: bool,
}

/// The line that was executed last.
#[derive(Default)]
struct LastLine(String);

impl Tracer for LastLine {
    fn executed(&mut self, step: &TraceStep<'_>) {
        self.0 = format!("{}:{} {}", step.file(), step.instruction.line, step.text().trim());
    }
}

impl Watch {
    fn new(bench: Bench, operands: Vec<Operand>) -> Watch {
        Watch {
            bench,
            operands,
            chosen: 0,
            running: false,
            inside: false,
            entry: None,
            message: String::new(),
            last_line: LastLine::default(),
        }
    }

    fn show(mut self, terminal: &mut DefaultTerminal) -> std::io::Result<()> {
        let mut next = Instant::now();
        loop {
            terminal.draw(|frame| table::draw(frame, &self))?;
            if self.running && Instant::now() >= next {
                next = Instant::now() + self.bench.cycle_time();
                self.cycle();
            }
            let wait = if self.running {
                next.saturating_duration_since(Instant::now())
            } else {
                Duration::from_millis(250)
            };
            if event::poll(wait)?
                && let Event::Key(key) = event::read()?
                && key.kind != KeyEventKind::Release
                && !self.key(key)
            {
                return Ok(());
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
        self.message.clear();
        match key.code {
            KeyCode::Char('q') | KeyCode::Esc => return false,
            KeyCode::Char('r') => self.running = true,
            KeyCode::Char('s') => self.running = false,
            KeyCode::Char('c') => {
                self.running = false;
                self.cycle();
            }
            KeyCode::Char('l') => {
                self.running = false;
                self.line();
            }
            KeyCode::Up => self.chosen = self.chosen.saturating_sub(1),
            KeyCode::Down => self.chosen = (self.chosen + 1).min(self.operands.len().saturating_sub(1)),
            KeyCode::Char(' ') => self.turn_over(),
            KeyCode::Enter if !self.operands.is_empty() => self.begin_entry(true),
            KeyCode::Char('a') => self.begin_entry(false),
            KeyCode::Char('d') if self.chosen < self.operands.len() => {
                self.operands.remove(self.chosen);
                self.chosen = self.chosen.min(self.operands.len().saturating_sub(1));
            }
            _ => {}
        }
        true
    }

    /// Runs a cycle, or the rest of one that was begun.
    fn cycle(&mut self) {
        let result = if self.inside {
            self.inside = false;
            let mut result = Ok(None);
            while let Ok(None) = result {
                result = self.step();
            }
            result.map(|_| ())
        } else {
            self.bench.scan(Some(&mut self.last_line))
        };
        self.finish_cycle(result);
    }

    /// Executes one line.
    fn line(&mut self) {
        if !self.inside {
            self.bench.stimulate();
            if let Err(error) = self
                .bench
                .machine
                .begin(&mut self.bench.exchange, &mut self.bench.nc)
            {
                return self.finish_cycle(Err(error));
            }
            self.inside = true;
        }
        match self.step() {
            Ok(None) => {}
            Ok(Some(())) => {
                self.inside = false;
                self.finish_cycle(Ok(()));
            }
            Err(error) => {
                self.inside = false;
                self.finish_cycle(Err(error));
            }
        }
    }

    fn step(&mut self) -> Result<Option<()>, RuntimeError> {
        let bench = &mut self.bench;
        let tracer = Some(&mut self.last_line as &mut dyn Tracer);
        let report = bench.machine.step(&mut bench.exchange, &mut bench.nc, tracer)?;
        Ok(report.map(|_| ()))
    }

    fn finish_cycle(&mut self, result: Result<(), RuntimeError>) {
        match result {
            Err(error) => {
                self.running = false;
                self.message = error.to_string();
            }
            Ok(()) => {
                if let Some(failure) = self.bench.failures().first() {
                    self.message = format!(
                        "cycle {}: {} expected {}, found {}",
                        failure.cycle, failure.operand, failure.expected, failure.found
                    );
                }
            }
        }
    }

    fn turn_over(&mut self) {
        if let Some(operand @ Operand::Bit(_)) = self.operands.get(self.chosen).copied() {
            let value = i32::from(self.bench.read(operand) == Content::Number(0));
            self.set(operand, &Content::Number(value));
        }
    }

    /// Sets an operand for the next cycle, and at once so that the table shows it.
    fn set(&mut self, operand: Operand, content: &Content) {
        operand.write(&mut self.bench.exchange, content);
        let image = self.bench.exchange.plc_mut();
        match (operand, content) {
            (Operand::Bit(bit), Content::Number(value)) => image.set_bit(bit, *value != 0),
            (Operand::Number(number), Content::Number(value)) => image.set_number(number, *value),
            _ => {}
        }
    }

    fn begin_entry(&mut self, is_value: bool) {
        self.entry = Some(Entry {
            text: String::new(),
            is_value,
        });
    }

    fn type_entry(&mut self, code: KeyCode) {
        let Some(mut entry) = self.entry.take() else {
            return;
        };
        match code {
            KeyCode::Esc => return,
            KeyCode::Enter => return self.accept(&entry),
            KeyCode::Backspace => {
                entry.text.pop();
            }
            KeyCode::Char(character) => entry.text.push(character),
            _ => {}
        }
        self.entry = Some(entry);
    }

    fn accept(&mut self, entry: &Entry) {
        let result = if entry.is_value {
            self.operands.get(self.chosen).copied().map_or(Ok(()), |operand| {
                operand
                    .content(&entry.text)
                    .map(|content| self.set(operand, &content))
            })
        } else {
            entry.text.parse().map(|operand| {
                self.operands.push(operand);
                self.chosen = self.operands.len() - 1;
            })
        };
        self.message = result.err().unwrap_or_default();
    }
}
