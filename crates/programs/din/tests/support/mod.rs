//! What tests of the decoder have in common: variables in a table, subroutines in another one, and short ways to say
//! what a unit orders.

#![allow(dead_code, reason = "no test uses all of it")]
#![allow(
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

use std::collections::HashMap;
use std::sync::Arc;

use bahn_din::{
    BlockFault, Decoder, Function, FunctionLetter, Kind, Program, Step, Target, Unit, Variable, Variables,
};
use bahn_path::{Axis, Position};
use bahn_text::MemoryFiles;

/// Variables that keep what is written, and functions that exist.
#[derive(Clone, Debug, Default)]
pub struct Bench {
    pub values: HashMap<Variable, f64>,
    /// What was asked, in its order: `read V.G.RW`, `write V.G.RW 5`.
    pub log: Vec<String>,
    pub m: Vec<u16>,
    pub h: Vec<u16>,
}

pub fn variable(name: &str, index: Option<u32>) -> Variable {
    Variable {
        name: name.into(),
        index,
    }
}

fn shown(variable: &Variable) -> String {
    let index = variable
        .index
        .map(|index| format!("[{index}]"))
        .unwrap_or_default();
    variable.name.replace("[]", &index)
}

impl Variables for Bench {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        self.log.push(format!("read {}", shown(variable)));
        let value = self.values.get(variable).copied();
        value.ok_or_else(|| format!("{} was not written", shown(variable)))
    }

    fn write(&mut self, variable: &Variable, value: f64) -> Result<(), String> {
        self.log.push(format!("write {} {value}", shown(variable)));
        if value < 0.0 {
            return Err(format!("{} takes no {value}", shown(variable)));
        }
        self.values.insert(variable.clone(), value);
        Ok(())
    }

    fn exists(&self, letter: FunctionLetter, number: u16) -> bool {
        let known = match letter {
            FunctionLetter::M => &self.m,
            FunctionLetter::H => &self.h,
        };
        known.contains(&number)
    }
}

/// A decoder of the first program of a text.
pub fn decoder_with(text: &str, beside: MemoryFiles) -> Decoder {
    let program = Arc::new(Program::from_bytes("test.nc", text.as_bytes()));
    let main = program.mains().next().expect("a program").clone();
    let mut start = Position::UNKNOWN;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        start[axis] = 0.0;
    }
    Decoder::new(program, &main, start, Arc::new(beside))
}

/// All units of a text, and the fault that ended it.
pub fn run_with(text: &str, bench: &mut Bench, beside: MemoryFiles) -> (Vec<Unit>, Option<BlockFault>) {
    let mut decoder = decoder_with(text, beside);
    let mut units = Vec::new();
    loop {
        match decoder.next(bench) {
            Step::Unit(unit) => units.push(*unit),
            Step::Fault(fault) => return (units, Some(fault)),
            Step::End => return (units, None),
        }
    }
}

/// All units of a text without faults.
pub fn run(text: &str) -> Vec<Unit> {
    let faults = Program::from_bytes("test.nc", text.as_bytes()).faults();
    assert_eq!(faults, [], "{text}");
    let (units, fault) = run_with(text, &mut Bench::default(), MemoryFiles::default());
    assert_eq!(fault, None, "{text}");
    units
}

/// The fault of a text: block, column and message.
pub fn refused(text: &str) -> (String, u32, String) {
    let (_, fault) = run_with(text, &mut Bench::default(), MemoryFiles::default());
    let fault = fault.unwrap_or_else(|| panic!("nothing is wrong with {text}"));
    (fault.place.block.to_string(), fault.column, fault.message)
}

/// A function as it would be written, with its target and additive value: `X[M54=567]`, `H5`.
pub fn written(function: &Function) -> String {
    let kind = match function.kind {
        Kind::M(number) => format!("M{number}"),
        Kind::H(number) => format!("H{number}"),
        Kind::S(speed) => format!("S{speed}"),
    };
    let value = function
        .value
        .map(|value| format!("={value}"))
        .unwrap_or_default();
    match &function.target {
        None => format!("{kind}{value}"),
        Some(Target::Axis(axis)) => format!("{axis}[{kind}{value}]"),
        Some(Target::Spindle(name)) => format!("{name}[{kind}{value}]"),
    }
}

/// What a unit orders: block, functions, end of its motion in X and Y, rapid or feed.
pub fn reported(unit: &Unit) -> String {
    let mut words = vec![unit.place.block.to_string()];
    words.extend(unit.functions.iter().map(written));
    if let Some(motion) = &unit.motion {
        let way = match motion.rapid {
            true => "rapid".to_owned(),
            false => format!("F{}", motion.feed_mm_min),
        };
        words.push(format!(
            "to X{} Y{} {way}",
            motion.end[Axis::X],
            motion.end[Axis::Y]
        ));
    }
    if unit.ends {
        words.push("end".into());
    }
    words.join(" ")
}

pub fn reported_all(units: &[Unit]) -> Vec<String> {
    units.iter().map(reported).collect()
}
