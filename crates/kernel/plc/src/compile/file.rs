//! One source file: every line checked and translated.

use bahn_parameters::conformance::Kind;
use bahn_parameters::equipment::{Equipment, Use as Wanted};

use super::chain::Chains;
use super::labels::{Definition, Labels, Use, is_internal, module_number};
use super::structure::Structure;
use super::{Options, Place, Reports};
use crate::program::{Condition, Field, Instruction, Op, Target};
use crate::syntax::{Command, Cost, LineError, Mnemonic, Operand, has_old_letters, parse};
use crate::{Module, PlcError};

/// Entries of a CASE table at most [000:14541].
const CASES_MAX: usize = 128;
/// Code of one file in bytes [000:14605].
const FILE_BYTES_MAX: u32 = 64 * 1024;

/// What a file is made into. Targets count from its own first instruction.
#[derive(Debug, Default)]
pub(super) struct FileCode {
    pub(super) code: Vec<Instruction>,
    pub(super) labels: Labels,
    pub(super) fields: Vec<Field>,
    pub(super) cases: Vec<Vec<Target>>,
    /// What must be replaced by the place of a label.
    pub(super) fixups: Vec<Fixup>,
    /// Names that other files may call.
    pub(super) globals: Vec<(usize, Place)>,
    /// Names that other files define.
    pub(super) externs: Vec<(usize, Place)>,
    /// Files that it links.
    pub(super) uses: Vec<(String, Place)>,
    /// Length of the code in bytes.
    pub(super) bytes: u32,
}

/// Something that refers to a label.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fixup {
    pub(super) slot: Slot,
    pub(super) name: usize,
    pub(super) line: u32,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Slot {
    Instruction(usize),
    CaseEntry { table: usize, entry: usize },
}

/// Translates the lines of a file; names of other files are left to the linker.
pub(super) fn translate(
    index: usize,
    name: &str,
    lines: &[String],
    options: Options,
    reports: &mut Reports,
) -> FileCode {
    let mut translator = Translator {
        out: FileCode::default(),
        chains: Chains::default(),
        structures: Vec::new(),
        opened: Vec::new(),
        table: None,
        block: None,
        linking: true,
        tnc355: false,
        file: (index, name),
        options,
        reports,
        place: Place::default(),
    };
    for (number, line) in lines.iter().enumerate() {
        translator.place.line = u32::try_from(number.saturating_add(1)).unwrap_or(u32::MAX);
        match parse(line, options.model) {
            Ok(None) => {}
            Ok(Some(command)) => translator.command(&command),
            Err(error) => translator.unreadable(&error),
        }
    }
    translator.finish()
}

/// A table that is open: only some commands may stand in it.
#[derive(Clone, Copy, Debug)]
enum Table {
    Case { table: usize, place: Place },
    Field { field: usize, place: Place },
}

/// Walks through the lines of a file.
pub(super) struct Translator<'a> {
    pub(super) out: FileCode,
    pub(super) chains: Chains,
    pub(super) structures: Vec<Structure>,
    /// The commands that opened the brackets, and where.
    pub(super) opened: Vec<(Mnemonic, Place)>,
    table: Option<Table>,
    /// Where the code began that is not closed by EM or JP yet.
    block: Option<Place>,
    /// Whether USES, GLOBAL and EXTERN may still stand here.
    linking: bool,
    /// Whether a command of the TNC 355 was read.
    tnc355: bool,
    /// Number and name of the file.
    file: (usize, &'a str),
    options: Options,
    reports: &'a mut Reports,
    pub(super) place: Place,
}

impl Translator<'_> {
    fn command(&mut self, command: &Command) {
        self.place.column = command.column;
        self.notes(command);
        self.lacking(command);
        if self.table.is_some() && self.table_line(command) {
            return;
        }
        match (command.mnemonic, &command.operand) {
            (Mnemonic::Uses, Operand::File(name)) => {
                self.link_command();
                self.out.uses.push((name.clone(), self.place));
            }
            (Mnemonic::Global, Operand::Label(name)) => self.global(name),
            (Mnemonic::Extern, Operand::Label(name)) => {
                self.link_command();
                let error = self.out.labels.define(name, Definition::Extern, self.place);
                self.report(error, name);
                let index = self.out.labels.refer(name, Use::Call, self.place);
                self.out.externs.push((index, self.place));
            }
            _ => {
                self.linking = false;
                self.code(command);
            }
        }
    }

    /// Everything but linking and the content of tables.
    fn code(&mut self, command: &Command) {
        match (command.mnemonic, &command.operand) {
            (Mnemonic::Label, Operand::Label(name)) => {
                let error = self.chains.label();
                self.report(error, name);
                let at = Definition::Code(self.out.code.len());
                let error = self.out.labels.define(name, at, self.place);
                self.report(error, name);
                self.block.get_or_insert(self.place);
            }
            (Mnemonic::Field, Operand::Label(name)) => self.open_field(name),
            (Mnemonic::Case, Operand::Number(number)) => {
                let table = self.out.cases.len();
                self.out.cases.push(Vec::new());
                let error = self.chains.jump();
                self.report(error, "");
                self.emit(
                    Op::Case {
                        number: *number,
                        table,
                    },
                    command,
                );
                self.chains.called();
                self.table = Some(Table::Case {
                    table,
                    place: self.place,
                });
            }
            (Mnemonic::EndCase, _) => self.report(Some(PlcError::EndOutsideTable), "no CASE is open"),
            (Mnemonic::EndField, _) => self.report(Some(PlcError::EndOutsideTable), "no KFIELD is open"),
            (Mnemonic::Constant, _) => {
                self.report(Some(PlcError::NotACommand), "constants stand in a KFIELD");
            }
            (Mnemonic::Jump | Mnemonic::JumpTrue | Mnemonic::JumpFalse, Operand::Label(name)) => {
                self.jump(command, name);
            }
            (Mnemonic::Call | Mnemonic::CallTrue | Mnemonic::CallFalse, Operand::Label(name)) => {
                self.call(command, name);
            }
            (Mnemonic::Submit, Operand::Label(name)) => {
                let error = self.chains.jump().or(self.chains.load_word());
                self.report(error, "");
                self.refer(name, Use::Submit);
                self.emit(
                    Op::Submit {
                        target: Target::Code(0),
                    },
                    command,
                );
            }
            _ => {
                self.chain_command(command);
            }
        }
    }

    /// Emits an instruction with the cost of its form.
    pub(super) fn emit(&mut self, op: Op, command: &Command) {
        let cost = super::cost::cost_of(command);
        self.emit_with(op, cost);
    }

    /// Emits an instruction with a given cost.
    pub(super) fn emit_with(&mut self, op: Op, cost: Cost) {
        let ends = matches!(
            op,
            Op::Return {
                condition: Condition::Always
            } | Op::Jump {
                condition: Condition::Always,
                ..
            }
        );
        self.out.bytes = self.out.bytes.saturating_add(cost.bytes.into());
        self.out.code.push(Instruction {
            op,
            file: u16::try_from(self.file.0).unwrap_or(u16::MAX),
            line: self.place.line,
            time: cost.time,
            time_skipped: cost.skipped,
        });
        if ends {
            self.block = None;
        } else {
            self.block.get_or_insert(self.place);
        }
    }

    /// The code goes on after a jump that was emitted by a structure.
    pub(super) fn goes_on(&mut self) {
        self.block.get_or_insert(self.place);
    }

    /// Reports an error of the current line.
    pub(super) fn report(&mut self, error: Option<PlcError>, detail: &str) {
        if let Some(error) = error {
            self.report_at(self.place, error, detail);
            if let Some(place) = self.opening(error) {
                self.reports.opened_at(place);
            }
        }
    }

    /// Reports an error of the current line, and where that was opened which it does not fit.
    pub(super) fn report_opened(&mut self, error: Option<PlcError>, detail: &str, opened: Option<Place>) {
        self.report(error, detail);
        if let (Some(_), Some(place)) = (error, opened) {
            self.reports.opened_at(place);
        }
    }

    /// What is open while an error of this kind is reported: a bracket or a table.
    fn opening(&self, error: PlcError) -> Option<Place> {
        match error {
            PlcError::AssignmentInBracket
            | PlcError::BracketsTooDeep
            | PlcError::LabelInBracket
            | PlcError::JumpInBracket
            | PlcError::BracketOpenAtEnd
            | PlcError::StringInBracket => self.opened.last().map(|(_, place)| *place),
            PlcError::WrongCommandInTable => self.table.map(|table| match table {
                Table::Case { place, .. } | Table::Field { place, .. } => place,
            }),
            _ => None,
        }
    }

    /// Reports an error of another line: that which opened what is wrong.
    pub(super) fn report_at(&mut self, place: Place, error: PlcError, detail: &str) {
        self.reports.error(self.file, place, error, detail);
    }

    fn unreadable(&mut self, error: &LineError) {
        self.place.column = error.column;
        self.report(Some(error.error), &error.detail);
        // The line stood for something: do not report what follows from its absence.
        self.chains.called();
    }

    /// A marker or word of the NC that this control does not have yet, or without an option.
    fn lacking(&mut self, command: &Command) {
        // Most controls lack nothing: no name is written for them.
        if self.options.equipment == Equipment::default() {
            return;
        }
        let name = match &command.operand {
            Operand::Bit(operand) => operand.bit.to_string(),
            Operand::Number(operand) => operand.number.to_string(),
            _ => return,
        };
        self.refuse_lacking(Kind::Marker, &name, &name);
    }

    fn refuse_lacking(&mut self, kind: Kind, object: &str, name: &str) {
        let Options { model, equipment, .. } = self.options;
        if let Some(why) = equipment.lacks(model, Wanted::of(kind, object)) {
            self.report(Some(PlcError::OperandOutOfRange), &format!("{name} is {why}"));
        }
    }

    /// Deviations from the editor's spelling: too long a line is an error, the rest warnings.
    fn notes(&mut self, command: &Command) {
        for note in &command.notes {
            let place = Place {
                column: note.column,
                ..self.place
            };
            let is_error = note.error == PlcError::NoEndOfLine || self.options.strict && !command.tnc355;
            let file = self.file;
            if is_error {
                self.reports.error(file, place, note.error, &note.detail);
            } else {
                self.reports.warning(file, place, note.error, &note.detail);
            }
        }
        self.tnc355 |= command.tnc355;
    }

    fn link_command(&mut self) {
        if !self.linking {
            self.report(Some(PlcError::LinkNotAtStart), "");
        }
    }

    fn global(&mut self, name: &str) {
        self.link_command();
        if self.file.0 == 0 {
            self.report(Some(PlcError::GlobalInMain), name);
            return;
        }
        let index = self.out.labels.refer(name, Use::Global, self.place);
        self.out.globals.push((index, self.place));
    }

    /// Refers to a label from the instruction that is emitted next.
    fn refer(&mut self, name: &str, usage: Use) {
        let slot = Slot::Instruction(self.out.code.len());
        self.refer_from(slot, name, usage);
    }

    fn refer_from(&mut self, slot: Slot, name: &str, usage: Use) {
        let name = self.out.labels.refer(name, usage, self.place);
        let line = self.place.line;
        self.out.fixups.push(Fixup { slot, name, line });
    }

    fn jump(&mut self, command: &Command, name: &str) {
        let condition = match command.mnemonic {
            Mnemonic::JumpTrue => Condition::IfTrue,
            Mnemonic::JumpFalse => Condition::IfFalse,
            _ => Condition::Always,
        };
        let error = match condition {
            Condition::Always => self.chains.jump_always(),
            _ => self.chains.condition(),
        };
        self.report(error, "");
        self.refer(name, Use::Jump);
        self.emit(Op::Jump { condition, target: 0 }, command);
    }

    fn call(&mut self, command: &Command, name: &str) {
        let condition = match command.mnemonic {
            Mnemonic::CallTrue => Condition::IfTrue,
            Mnemonic::CallFalse => Condition::IfFalse,
            _ => Condition::Always,
        };
        let error = match condition {
            Condition::Always => self.chains.jump(),
            _ => self.chains.condition(),
        };
        self.report(error, "");
        let slot = Slot::Instruction(self.out.code.len());
        let target = self.target(slot, name, Use::Call);
        self.emit(Op::Call { condition, target }, command);
        self.chains.called();
    }

    /// An internal module, or a label that is resolved later.
    fn target(&mut self, slot: Slot, name: &str, usage: Use) -> Target {
        match module_number(name) {
            Some(number) => {
                if Module::find(number).is_none() {
                    self.report(
                        Some(PlcError::LabelNotDefined),
                        &format!("there is no module {number}"),
                    );
                }
                self.refuse_lacking(Kind::Module, &number.to_string(), &format!("module {number}"));
                Target::Module(number)
            }
            None => {
                self.refer_from(slot, name, usage);
                Target::Code(0)
            }
        }
    }

    fn open_field(&mut self, name: &str) {
        let error = self.chains.label();
        self.report(error, name);
        if let Some(block) = self.block.take() {
            let detail = format!("KFIELD {name} follows without EM or JP");
            self.report_at(block, PlcError::NoEndOfBlock, &detail);
        }
        let field = self.out.fields.len();
        self.out.fields.push(Field {
            name: name.to_owned(),
            values: Vec::new(),
        });
        let error = self.out.labels.define(name, Definition::Field(field), self.place);
        self.report(error, name);
        self.table = Some(Table::Field {
            field,
            place: self.place,
        });
    }

    /// A line inside CASE or KFIELD. Tells whether it belongs to the table; a command that ends a block
    /// shows that the table was never closed.
    fn table_line(&mut self, command: &Command) -> bool {
        match (self.table, command.mnemonic, &command.operand) {
            (Some(Table::Case { table, .. }), Mnemonic::Call, Operand::Label(name)) => {
                let entry = self.out.cases.get(table).map_or(0, Vec::len);
                let target = self.target(Slot::CaseEntry { table, entry }, name, Use::Case);
                if let Some(entries) = self.out.cases.get_mut(table) {
                    entries.push(target);
                }
                self.out.bytes = self
                    .out
                    .bytes
                    .saturating_add(crate::syntax::CASE_ENTRY_BYTES.into());
            }
            (Some(Table::Field { field, .. }), Mnemonic::Constant, Operand::Constant(value)) => {
                if let Some(field) = self.out.fields.get_mut(field) {
                    field.values.push(*value);
                }
                self.out.bytes = self
                    .out
                    .bytes
                    .saturating_add(super::cost::cost_of(command).bytes.into());
            }
            (Some(Table::Case { table, place }), Mnemonic::EndCase, _) => {
                let entries = self.out.cases.get(table).map_or(0, Vec::len);
                self.close_table(place, entries, "CASE");
            }
            (Some(Table::Field { field, place }), Mnemonic::EndField, _) => {
                let constants = self.out.fields.get(field).map_or(0, |field| field.values.len());
                self.close_table(place, constants, "KFIELD");
            }
            (Some(table), mnemonic, _) => {
                let inside = match table {
                    Table::Case { .. } => "only CM may stand in CASE",
                    Table::Field { .. } => "only K may stand in KFIELD",
                };
                self.report(Some(PlcError::WrongCommandInTable), inside);
                if matches!(
                    mnemonic,
                    Mnemonic::End | Mnemonic::Label | Mnemonic::Field | Mnemonic::Case
                ) {
                    self.table = None;
                    return false;
                }
            }
            (None, ..) => return false,
        }
        true
    }

    fn close_table(&mut self, place: Place, entries: usize, name: &str) {
        if entries == 0 {
            self.report_at(place, PlcError::EmptyTable, name);
        } else if entries > CASES_MAX && name == "CASE" {
            self.report_at(
                place,
                PlcError::TooManyCases,
                &format!("{entries} entries, {CASES_MAX} are allowed"),
            );
        }
        self.table = None;
    }

    /// What only the end of the file shows.
    fn finish(mut self) -> FileCode {
        match self.table {
            Some(Table::Case { place, .. }) => {
                self.report_at(place, PlcError::StructureOpen, "CASE without ENDC")
            }
            Some(Table::Field { place, .. }) => {
                self.report_at(place, PlcError::StructureOpen, "KFIELD without ENDK")
            }
            None => {}
        }
        for structure in std::mem::take(&mut self.structures) {
            self.report_at(structure.place, PlcError::StructureOpen, "");
        }
        if let Some(block) = self.block {
            if self.tnc355 {
                // An EM is appended when a program of the TNC 355 is read [000:16199]; the old controls know none.
                if !has_old_letters(self.options.model) {
                    let detail = "EM appended, as for a program of the TNC 355";
                    self.reports
                        .warning(self.file, block, PlcError::NoEndOfBlock, detail);
                }
                self.emit_with(
                    Op::Return {
                        condition: Condition::Always,
                    },
                    super::cost::end_cost(),
                );
            } else {
                self.report_at(
                    block,
                    PlcError::NoEndOfBlock,
                    "the code from here to the end of the file",
                );
            }
        }
        let start = Place { line: 1, column: 1 };
        if self.out.labels.too_many() {
            self.report_at(start, PlcError::TooManyLabels, "a file may have 1000");
        }
        if self.out.bytes > FILE_BYTES_MAX {
            let detail = format!("{} bytes of code, {FILE_BYTES_MAX} are allowed", self.out.bytes);
            self.report_at(start, PlcError::FileTooLong, &detail);
        }
        let references = std::mem::take(&mut self.out.labels.references);
        for reference in &references {
            let name = self
                .out
                .labels
                .names
                .get(reference.name)
                .map_or(String::new(), |name| name.text.clone());
            let internal = reference.usage != Use::Global && is_internal(&name);
            if let Some(error) = self.out.labels.check(reference) {
                let detail = if internal {
                    format!("{name} is an internal module")
                } else {
                    name
                };
                self.report_at(reference.place, error, &detail);
            }
        }
        self.out
    }
}

impl Translator<'_> {
    /// `L KF name[X]`: loads a constant of a field.
    pub(super) fn load_field(&mut self, name: &str, command: &Command) {
        let error = self.chains.load_word();
        self.report(error, "");
        self.refer(name, Use::Field);
        self.emit(Op::LoadField { field: 0 }, command);
    }
}
