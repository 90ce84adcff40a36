//! TRACE: the instruction list of the running program, with operands and accumulators of the latest scan [000:11414-11435].

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_plc::{CodeTrace, Executed, OperandContent, PlcProgram, code_of_line};
use bahn_screen::{Line, WindowKind};

use super::diagram::LogicDiagram;
use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

/// Its soft keys; while the display stands, the fifth lets it go on.
const SOFT_KEYS: [&str; 8] = [
    "LOGIC DIAGRAM",
    "FIND",
    "GOTO",
    "HEX/DECIMAL",
    "STOP DISPLAY",
    "PAGE UP",
    "PAGE DOWN",
    "END",
];
/// Those of the recording, in a row of their own [000:11428-11430].
const RECORDING: [&str; 4] = ["SELECT M/I/O/T/C", "START TRACE", "STOP TRACE", "END"];
/// Characters of a word to look for at most.
const WORD_MAX: usize = 32;
/// Digits of a line number at most.
const NUMBER_MAX: usize = 6;

/// TRACE IN CODE: the program with the operands of a scan beside its lines.
pub(super) struct Code {
    program: Arc<PlcProgram>,
    /// The scan that stands, while the display does not go on.
    frozen: Option<CodeTrace>,
    hexadecimal: bool,
    current: usize,
    find: Later,
    goto: Later,
}

impl Code {
    /// From the first instruction on.
    pub fn new(site: &mut Site) -> Code {
        site.plc.watch_code();
        Code {
            program: Arc::clone(site.control().plc().program()),
            frozen: None,
            hexadecimal: false,
            current: 0,
            find: Later::default(),
            goto: Later::default(),
        }
    }

    fn go(&mut self, lines: isize) -> Turn {
        self.current = list::moved(self.current, lines, self.program.code.len());
        Turn::Done
    }

    fn instruction(&self, at: usize) -> String {
        let instruction = self.program.code.get(at);
        instruction.map_or(String::new(), |own| code_of_line(self.program.line_text(own)))
    }

    fn search(&mut self, word: &str) -> bool {
        let (count, word) = (self.program.code.len(), word.to_uppercase());
        let wanted = code_of_line(&word);
        let mut order = (1..=count).map(|way| (self.current + way) % count);
        let found = order.find(|at| self.instruction(*at).to_uppercase().contains(&wanted));
        self.current = found.unwrap_or(self.current);
        found.is_some()
    }

    /// The instruction in a line of the file that is shown, or the next one there.
    fn line(&mut self, line: u32) -> bool {
        let Some(file) = self.program.code.get(self.current).map(|own| own.file) else {
            return false;
        };
        let code = &self.program.code;
        let at = code.iter().position(|own| own.file == file && own.line >= line);
        self.current = at.unwrap_or(self.current);
        at.is_some()
    }

    fn number(&self, value: i32) -> String {
        match self.hexadecimal {
            true => format!("${value:X}"),
            false => value.to_string(),
        }
    }

    fn columns(&self, executed: &Executed) -> String {
        let operand = match &executed.operand {
            None => String::new(),
            Some(OperandContent::Bit(bit)) => u8::from(*bit).to_string(),
            Some(OperandContent::Number(value)) => self.number(*value),
            Some(OperandContent::Text(text)) => {
                let letters: String = text.iter().map(|byte| char::from(*byte)).collect();
                format!("\"{letters}\"")
            }
        };
        let logic = u8::from(executed.logic);
        format!("{operand:>12} {logic:>2} {:>12}", self.number(executed.word))
    }

    /// Cursor, instruction, operand, logic and word accumulator; what was executed has a star.
    fn shown(&self, at: usize, code: &CodeTrace) -> Line {
        let line = self.program.code.get(at).map_or(0, |own| own.line);
        let executed = code.executed(at);
        let star = if executed.is_some() { '*' } else { ' ' };
        let columns = executed.map_or(String::new(), |executed| self.columns(executed));
        Line {
            text: format!("{star}{line:>5} {:<24}{columns}", self.instruction(at))
                .trim_end()
                .to_owned(),
            current: at == self.current,
            ..Line::default()
        }
    }
}

impl Page for Code {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines);
        }
        match key {
            Key::Goto => self.goto.ask(site.words("GOTO: LINE ="), NUMBER_MAX),
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let frozen = self.frozen.is_some();
        let names = SOFT_KEYS.map(|name| match name {
            "STOP DISPLAY" if frozen => site.words("START DISPLAY"),
            name => site.words(name),
        });
        vec![names.to_vec(), list::soft_keys(&RECORDING, site)]
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        let names = if row == 0 { &SOFT_KEYS[..] } else { &RECORDING };
        match list::name_at(names, place) {
            "START TRACE" if site.plc.rows.is_empty() => return Turn::Refused,
            "START TRACE" => site.plc.start(site.host.control()),
            "STOP TRACE" => site.plc.stop(),
            "LOGIC DIAGRAM" | "SELECT M/I/O/T/C" => return Turn::Open(Box::new(LogicDiagram::default())),
            "FIND" => return self.find.ask(site.words("FIND ="), WORD_MAX),
            "GOTO" => return self.goto.ask(site.words("GOTO: LINE ="), NUMBER_MAX),
            "HEX/DECIMAL" => self.hexadecimal = !self.hexadecimal,
            "STOP DISPLAY" => {
                self.frozen = match self.frozen.take() {
                    Some(_) => None,
                    None => Some(site.plc.code().clone()),
                };
            }
            name => return list::way_of(name).map_or(Turn::Close, |lines| self.go(lines)),
        }
        Turn::Done
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let code = self.frozen.as_ref().unwrap_or_else(|| site.plc.code());
        let file = self
            .program
            .code
            .get(self.current)
            .map(|own| self.program.file_name(own.file));
        let title = format!("{} {}", site.words("TRACE"), file.unwrap_or_default());
        let cursor = (self.current, self.program.code.len());
        let line = |at| self.shown(at, code);
        View::of(list::window(title, WindowKind::Table, cursor, lines, line))
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        // The control may have begun anew with another program.
        let running = site.control().plc().program();
        if !Arc::ptr_eq(&self.program, running) {
            self.program = Arc::clone(running);
            (self.frozen, self.current) = (None, 0);
        }
        if self.frozen.is_none() {
            site.plc.watch_code();
        }
        if self.find.take().is_some_and(|word| !self.search(&word)) {
            return Turn::Say(site.words("NOT FOUND"));
        }
        let wanted = self.goto.take();
        let found = wanted.is_none_or(|text| text.parse().is_ok_and(|line| self.line(line)));
        match found {
            true => Turn::Done,
            false => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
        }
    }
}
