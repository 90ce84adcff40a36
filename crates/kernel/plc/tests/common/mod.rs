//! Examples that read like the manual's: operands before, listing with accumulator per line, operands after.
#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests, each test uses some"
)]

use bahn_exchange::{Bit, Exchange, Image, Number};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{
    Compilation, Machine, MemoryFiles, OperandContent, Options, RuntimeError, ScanReport, Start, TestNc,
    TraceStep, Tracer, mirror_parameters,
};

/// A PLC on a desk.
pub struct Bench {
    pub machine: Machine,
    pub exchange: Exchange,
    pub nc: TestNc,
}

impl Bench {
    /// Compiles a program; it must be free of errors.
    pub fn new(program: &str) -> Bench {
        let compilation = compile(program);
        assert_eq!(compilation.errors, [], "{program}");
        let program = compilation.program.unwrap();
        Bench {
            machine: Machine::new(program.into(), Start::PowerOn),
            exchange: Exchange::default(),
            nc: TestNc::new(ParameterList::reference(ControlModel::Tnc415b)),
        }
    }

    /// Sets operands from the outside: `I4=1 B5=2Ah W8=-3 S0="OIL" MP4110.1=9`.
    pub fn set(&mut self, assignments: &str) {
        for (operand, value) in pairs(assignments) {
            if let Some(parameter) = operand.strip_prefix("MP") {
                self.nc
                    .parameters
                    .assign(&format!("{parameter}={value}"))
                    .unwrap();
                mirror_parameters(&self.nc.parameters, &mut self.exchange);
            } else if let Some(string) = operand.strip_prefix('S') {
                let text = value.trim_matches('"');
                self.exchange
                    .plc_mut()
                    .set_text(string.parse().unwrap(), text.as_bytes());
            } else if let Ok(bit) = operand.parse::<Bit>() {
                self.exchange.nc_set(bit, number(&value) != 0);
            } else {
                let operand: Number = operand.parse().unwrap();
                self.exchange.nc_set_number(operand, number(&value) as u32 as i32);
            }
        }
    }

    /// Runs a scan.
    pub fn scan(&mut self) -> Result<ScanReport, RuntimeError> {
        self.machine.scan(&mut self.exchange, &mut self.nc)
    }

    /// Runs some scans, none of which may fail.
    pub fn scans(&mut self, count: usize) {
        for _ in 0..count {
            self.scan().unwrap();
        }
    }

    /// Checks operands of the PLC: same spelling as [`Bench::set`].
    pub fn expect(&self, expectations: &str) {
        for (operand, value) in pairs(expectations) {
            check(self.exchange.plc(), &operand, &value, "");
        }
    }

    /// The content of an operand in the PLC's image.
    pub fn get(&self, operand: &str) -> i64 {
        content(self.exchange.plc(), operand)
    }
}

/// Lines of a program from text with a chain in each line, its commands separated by `|`.
pub fn lines(chains: &str) -> String {
    let commands = chains.lines().flat_map(|chain| chain.split('|'));
    commands.map(|command| format!("{}\n", command.trim())).collect()
}

/// Compiles one file.
pub fn compile(program: &str) -> Compilation {
    Compilation::compile(
        &MemoryFiles::from([("MAIN.PLC", program)]),
        "MAIN.PLC",
        Options::default(),
    )
}

/// Checks an example. `listing` has lines `command | accumulator | operand`: `LA` stands for the logic
/// accumulator (`LA=1`), `WA` for the word accumulator (`WA=36h`, `WA=-15`), `SA` for the string
/// accumulator; `-` marks a line that is not executed. An EM is added at the end.
pub fn example(source: &str, before: &str, listing: &str, after: &str) {
    let rows: Vec<Vec<&str>> = listing
        .lines()
        .map(|line| line.split('|').map(str::trim).collect::<Vec<_>>())
        .filter(|row| !row[0].is_empty())
        .collect();
    let mut program: String = rows.iter().map(|row| format!("{}\n", row[0])).collect();
    program.push_str("EM\n");
    let mut bench = Bench::new(&program);
    bench.set(before);
    let mut trace = Lines::default();
    bench
        .machine
        .scan_traced(&mut bench.exchange, &mut bench.nc, &mut trace)
        .unwrap_or_else(|error| panic!("{source}: {error}"));
    for (index, row) in rows.iter().enumerate() {
        let line = index as u32 + 1;
        let executed = trace
            .lines
            .iter()
            .find(|(number, _)| *number == line)
            .map(|(_, state)| state);
        let place = format!("{source} line {line} `{}`", row[0]);
        if row.get(1) == Some(&"-") {
            assert!(executed.is_none(), "{place} must be skipped");
            continue;
        }
        for (register, value) in row.get(1).into_iter().flat_map(|expected| pairs(expected)) {
            let state = executed.unwrap_or_else(|| panic!("{place} must be executed"));
            match register.as_str() {
                "LA" => assert_eq!(i64::from(state.logic), number(&value), "{place}: LA"),
                "WA" => assert_eq!(state.word, number(&value) as u32 as i32, "{place}: WA"),
                "SA" => assert_eq!(state.text, value.trim_matches('"'), "{place}: SA"),
                _ => panic!("{place}: {register}"),
            }
        }
        if let Some(operand) = row.get(2).filter(|operand| !operand.is_empty()) {
            let state = executed.unwrap_or_else(|| panic!("{place} must be executed"));
            match state.operand.clone().unwrap() {
                OperandContent::Bit(bit) => assert_eq!(i64::from(bit), number(operand), "{place}: operand"),
                OperandContent::Number(value) => {
                    assert_eq!(value, number(operand) as u32 as i32, "{place}: operand");
                }
                OperandContent::Text(text) => assert_eq!(text, operand.as_bytes(), "{place}: operand"),
            }
        }
    }
    for (operand, value) in pairs(after) {
        check(bench.exchange.plc(), &operand, &value, source);
    }
}

fn check(image: &Image, operand: &str, value: &str, source: &str) {
    if let Some(string) = operand.strip_prefix('S') {
        let text = String::from_utf8_lossy(image.text(string.parse().unwrap())).into_owned();
        assert_eq!(text, value.trim_matches('"'), "{source} {operand}");
        return;
    }
    let expected = number(value);
    let found = content(image, operand);
    // A pattern such as B6h may be meant for a signed operand.
    let bits = operand.chars().next().map_or(64, |letter| match letter {
        'B' => 8,
        'W' => 16,
        'D' => 32,
        _ => 64,
    });
    let mask = if bits == 64 { !0 } else { (1_i64 << bits) - 1 };
    assert_eq!(
        found & mask,
        expected & mask,
        "{source} {operand} is {found}, not {value}"
    );
}

fn content(image: &Image, operand: &str) -> i64 {
    match operand.parse::<Bit>() {
        Ok(bit) => image.bit(bit).into(),
        Err(_) => image.number(operand.parse().unwrap()).into(),
    }
}

/// `2Ah` is hexadecimal, `-15` decimal.
fn number(text: &str) -> i64 {
    match text.strip_suffix('h') {
        Some(digits) => i64::from_str_radix(digits, 16).unwrap(),
        None => text.parse().unwrap_or_else(|_| panic!("`{text}` is no number")),
    }
}

/// Splits `A=1 B="x y"`.
fn pairs(text: &str) -> Vec<(String, String)> {
    let mut pairs = Vec::new();
    let mut rest = text.trim();
    while let Some((name, value)) = rest.split_once('=') {
        let end = if let Some(quoted) = value.strip_prefix('"') {
            quoted.find('"').unwrap() + 2
        } else {
            value.find(char::is_whitespace).unwrap_or(value.len())
        };
        pairs.push((name.trim().to_owned(), value[..end].to_owned()));
        rest = value[end..].trim();
    }
    pairs
}

#[derive(Default)]
struct Lines {
    lines: Vec<(u32, State)>,
}

struct State {
    logic: bool,
    word: i32,
    text: String,
    operand: Option<OperandContent>,
}

impl Tracer for Lines {
    fn executed(&mut self, step: &TraceStep<'_>) {
        let state = State {
            logic: step.registers.logic,
            word: step.registers.word,
            text: String::from_utf8_lossy(step.registers.text()).into_owned(),
            operand: step.operand(),
        };
        self.lines.push((step.instruction.line, state));
    }
}
