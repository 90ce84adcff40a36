//! The PLC program of a machine with a System 900: compiled, and looked at for what is of a TNC.
//!
//! Decision: A System 900 runs the PLC language of the house without what belongs to a TNC: modules, timers and counters, whose presets
//! are its machine parameters, and the markers of its interface from M2000 on, but M2180, the first cycle after power-on

use std::path::Path;
use std::sync::Arc;

use bahn_control900::Plc900;
use bahn_exchange::BitArea;
use bahn_machine::Folder900;
use bahn_plc::{Access, Instruction, Op, Options, PlcProgram, Subject, Target, accesses};
use bahn_system900::Memory;
use bahn_text::{Diagnostic, Severity, Span};

use super::window::{self, Given, is_of_interface};
use crate::files;
use crate::plc_source::PlcSource;

/// What there is of a PLC.
pub(super) struct Found {
    pub plc: Option<Plc900>,
    pub warnings: Vec<Diagnostic>,
}

/// Compiles the program and reads the window; all faults are added to those that there are.
pub(super) fn load(
    root: &Path,
    folder: &Folder900,
    memory: &Memory,
    text: &str,
    faults: &mut Vec<Diagnostic>,
) -> Found {
    let described = root.join(Folder900::FILE);
    let (window, given, wrong) = window::read(&folder.window, memory);
    faults.extend(wrong.into_iter().map(|fault| fault.in_text(&described, text)));
    let nothing = Found {
        plc: None,
        warnings: Vec::new(),
    };
    let Some(main) = &folder.plc else {
        return nothing;
    };
    let path = root.join(&main.text);
    let bytes = match files::read_table(&path) {
        Ok(bytes) => bytes,
        Err(error) => {
            faults.push(Diagnostic::error(main.span, error.to_string()).in_text(&described, text));
            return nothing;
        }
    };
    let mut source = PlcSource::compile(&path, Some(bytes), Options::default());
    let (errors, mut warnings): (Vec<Diagnostic>, Vec<Diagnostic>) = source
        .faults()
        .into_iter()
        .partition(|fault| fault.severity == Severity::Error);
    faults.extend(errors);
    let Some(program) = source.compilation.program.take() else {
        return Found { plc: None, warnings };
    };
    let of_a_tnc = foreign(&program)
        .into_iter()
        .chain(contradictions(&program, &given));
    let folder = path.parent().unwrap_or(root);
    faults.extend(of_a_tnc.map(|(instruction, message)| placed(&program, folder, instruction, message)));
    let unused = given.iter().filter(|given| !is_used(&program, given));
    warnings.extend(unused.map(|given| {
        let message = format!("the PLC program does not name {}", given.operand());
        Diagnostic::warning(given.span, message).in_text(&described, text)
    }));
    let program = Arc::new(program);
    Found {
        plc: Some(Plc900 { program, window }),
        warnings,
    }
}

/// What a System 900 has not.
fn foreign(program: &PlcProgram) -> Vec<(&Instruction, String)> {
    let mut found = Vec::new();
    for instruction in &program.code {
        if let Op::Call {
            target: Target::Module(number),
            ..
        }
        | Op::Submit {
            target: Target::Module(number),
        } = &instruction.op
        {
            found.push((
                instruction,
                format!("module {number} asks a TNC: a System 900 has none"),
            ));
        }
        for (subject, _) in accesses(&instruction.op) {
            let Subject::Bit { bit, .. } = subject else {
                continue;
            };
            let message = match bit.area() {
                BitArea::T | BitArea::C => format!(
                    "{bit}: timers and counters have their presets in machine parameters of a TNC; count the cycles in a word"
                ),
                BitArea::M if is_of_interface(bit) => format!(
                    "{bit} is a marker of the interface of a TNC; here `window` says which markers are which parameters"
                ),
                _ => continue,
            };
            found.push((instruction, message));
        }
    }
    for target in program.cases.iter().flatten() {
        if let (Target::Module(number), Some(first)) = (target, program.code.first()) {
            found.push((
                first,
                format!("module {number} asks a TNC: a System 900 has none"),
            ));
        }
    }
    found
}

/// Where the program sets what the control gives.
fn contradictions<'p>(program: &'p PlcProgram, given: &[Given]) -> Vec<(&'p Instruction, String)> {
    let mut found = Vec::new();
    for instruction in &program.code {
        for (subject, access) in accesses(&instruction.op) {
            let sets = access != Access::Read && !subject.is_indexed();
            let of = given
                .iter()
                .find(|given| sets && given.by_control && given.subject.meets(subject));
            if let Some(of) = of {
                let message = format!(
                    "{subject} is {}, which the control gives: the PLC reads it alone",
                    of.name
                );
                found.push((instruction, message));
            }
        }
    }
    found
}

fn is_used(program: &PlcProgram, given: &Given) -> bool {
    // A range is there for whoever needs one of it.
    given.of_range
        || program
            .code
            .iter()
            .flat_map(|instruction| accesses(&instruction.op))
            .any(|(subject, _)| subject.meets(given.subject))
}

/// A fault at the operand of a line.
fn placed(program: &PlcProgram, folder: &Path, instruction: &Instruction, message: String) -> Diagnostic {
    let line = program.line_text(instruction);
    let number = instruction.line as usize;
    // The operand is the second word.
    let from = line.len() - line.trim_start().len();
    let rest = line.get(from..).unwrap_or_default();
    let word = rest.find(char::is_whitespace).unwrap_or(0);
    let blank = rest.get(word..).unwrap_or_default();
    let column = from + word + (blank.len() - blank.trim_start().len()) + 1;
    let file = folder.join(program.file_name(instruction.file));
    Diagnostic::error(Span::word(number, column, line), message).at(file, line)
}
