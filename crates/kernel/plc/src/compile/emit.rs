//! The commands of chains and structures: rule of the chain, and the instruction that they become.

use super::chain::{Accumulator, Result};
use super::cost::cost_of;
use super::file::Translator;
use super::structure::{Closer, Kind, NESTING_MAX, Structure, close};
use crate::PlcError;
use crate::operand::{NumberOperand, TextOperand, Value};
use crate::program::{Arithmetic, BitOperation, Comparison, Condition, Gate, Op, Transform};
use crate::syntax::{Class, Command, Mnemonic, Operand};

impl Translator<'_> {
    /// Translates a command that is no label, jump, call, table or link.
    pub(super) fn chain_command(&mut self, command: &Command) {
        if command.mnemonic.opens_bracket() {
            self.open_bracket(command);
            return;
        }
        match &command.operand {
            Operand::None => self.plain(command),
            Operand::Bit(bit) => {
                let (op, error) = self.bit_op(command.mnemonic, *bit);
                self.report(error, "");
                self.emit(op, command);
            }
            Operand::Number(number) => self.word(command, Value::Number(*number), Some(*number)),
            Operand::Constant(value) => self.word(command, Value::Constant(*value), None),
            Operand::Text(text) => self.text(command, text),
            Operand::Field(name) => self.load_field(name, command),
            // The table of commands gives labels and files to none that arrives here.
            Operand::Label(_) | Operand::File(_) => {}
        }
    }

    fn bit_op(&mut self, mnemonic: Mnemonic, bit: crate::BitOperand) -> (Op, Option<PlcError>) {
        let set = |value, when| Op::SetBit { bit, value, when };
        match mnemonic {
            Mnemonic::Load => (Op::LoadBit { bit, invert: false }, self.chains.load_logic()),
            Mnemonic::LoadNot => (Op::LoadBit { bit, invert: true }, self.chains.load_logic()),
            Mnemonic::Assign => (Op::AssignBit { bit, invert: false }, self.chains.assign_logic()),
            Mnemonic::AssignNot => (Op::AssignBit { bit, invert: true }, self.chains.assign_logic()),
            Mnemonic::Set => (set(true, true), self.chains.assign_logic()),
            Mnemonic::Reset => (set(false, true), self.chains.assign_logic()),
            Mnemonic::SetNot => (set(true, false), self.chains.assign_logic()),
            Mnemonic::ResetNot => (set(false, false), self.chains.assign_logic()),
            Mnemonic::LoadByte | Mnemonic::LoadWord | Mnemonic::LoadDouble => {
                let count = width(mnemonic);
                (Op::LoadBits { first: bit, count }, self.chains.load_word())
            }
            Mnemonic::AssignByte | Mnemonic::AssignWord | Mnemonic::AssignDouble => {
                let count = width(mnemonic);
                (Op::AssignBits { first: bit, count }, self.chains.assign_word())
            }
            Mnemonic::Push => (Op::PushBit { bit }, None),
            Mnemonic::Pull => (Op::PullBit { bit }, None),
            _ => {
                let gate = gate(mnemonic).unwrap_or(Gate::And);
                // At the start of a chain a gate acts as a load [000:12070].
                let op = if self.chains.gate_logic() {
                    let invert = matches!(gate, Gate::AndNot | Gate::OrNot | Gate::XorNot);
                    Op::LoadBit { bit, invert }
                } else {
                    Op::GateBit { gate, bit }
                };
                (op, None)
            }
        }
    }

    fn word(&mut self, command: &Command, value: Value, number: Option<NumberOperand>) {
        let (op, error) = match (command.mnemonic, number) {
            (Mnemonic::Load, _) => self.load(value, Transform::Plain),
            (Mnemonic::LoadNot, _) => self.load(value, Transform::Not),
            (Mnemonic::LoadMinus, _) => self.load(value, Transform::Minus),
            (Mnemonic::Assign, Some(number)) => self.assign(number, Transform::Plain),
            (Mnemonic::AssignNot, Some(number)) => self.assign(number, Transform::Not),
            (Mnemonic::AssignMinus, Some(number)) => self.assign(number, Transform::Minus),
            (Mnemonic::Increment, Some(number)) => (Op::StepNumber { number, by: 1 }, None),
            (Mnemonic::Decrement, Some(number)) => (Op::StepNumber { number, by: -1 }, None),
            (Mnemonic::Push, _) => (Op::Push { value }, None),
            (Mnemonic::Pull, Some(number)) => (Op::Pull { number }, None),
            (Mnemonic::Reply, Some(number)) => (Op::Reply { number }, self.chains.load_word()),
            (Mnemonic::Cancel, Some(number)) => (Op::Cancel { number }, None),
            (Mnemonic::BitTest, _) => (Op::TestBit { value }, self.chains.compare_word()),
            (mnemonic, _) => {
                if let Some(comparison) = comparison(mnemonic) {
                    (Op::Compare { comparison, value }, self.chains.compare_word())
                } else if let Some(operation) = arithmetic(mnemonic) {
                    (Op::Arithmetic { operation, value }, self.chains.gate_word())
                } else if let Some(operation) = bit_operation(mnemonic) {
                    (Op::BitOperation { operation, value }, self.chains.gate_word())
                } else {
                    let gate = gate(mnemonic).unwrap_or(Gate::And);
                    (Op::GateWord { gate, value }, self.chains.gate_word())
                }
            }
        };
        self.report(error, "");
        self.emit(op, command);
    }

    fn load(&mut self, value: Value, transform: Transform) -> (Op, Option<PlcError>) {
        (Op::Load { value, transform }, self.chains.load_word())
    }

    fn assign(&mut self, number: NumberOperand, transform: Transform) -> (Op, Option<PlcError>) {
        (Op::Assign { number, transform }, self.chains.assign_word())
    }

    fn text(&mut self, command: &Command, text: &TextOperand) {
        let memory = match text {
            TextOperand::Memory { string, indexed } => (*string, *indexed),
            _ => (0, false),
        };
        let (op, error) = match command.mnemonic {
            Mnemonic::Load => (Op::LoadText { text: text.clone() }, self.chains.load_text()),
            Mnemonic::Plus => (Op::AppendText { text: text.clone() }, self.chains.append_text()),
            Mnemonic::Assign => {
                let (string, indexed) = memory;
                (Op::AssignText { string, indexed }, self.chains.assign_text())
            }
            Mnemonic::Overwrite => {
                let (string, indexed) = memory;
                (Op::OverwriteText { string, indexed }, self.chains.assign_text())
            }
            mnemonic => {
                let comparison = comparison(mnemonic).unwrap_or(Comparison::Equal);
                (
                    Op::CompareText {
                        comparison,
                        text: text.clone(),
                    },
                    self.chains.compare_text(),
                )
            }
        };
        self.report(error, "");
        self.emit(op, command);
    }

    /// Translates commands that have no operand.
    fn plain(&mut self, command: &Command) {
        let (op, error) = match command.mnemonic {
            Mnemonic::IncrementWord => (Op::StepWord { by: 1 }, self.chains.gate_word()),
            Mnemonic::DecrementWord => (Op::StepWord { by: -1 }, self.chains.gate_word()),
            Mnemonic::IncrementIndex => (Op::StepIndex { by: 1 }, None),
            Mnemonic::DecrementIndex => (Op::StepIndex { by: -1 }, None),
            Mnemonic::LoadIndex => (Op::LoadIndex, self.chains.load_word()),
            Mnemonic::StoreIndex => (Op::StoreIndex, self.chains.use_word()),
            Mnemonic::PushLogic => (Op::PushLogic, self.chains.use_logic()),
            Mnemonic::PushWord => (Op::PushWord, self.chains.use_word()),
            Mnemonic::PushIndex => (Op::PushIndex, None),
            Mnemonic::PullLogic => (Op::PullLogic, self.chains.load_logic()),
            Mnemonic::PullWord => (Op::PullWord, self.chains.load_word()),
            Mnemonic::PullIndex => (Op::PullIndex, None),
            Mnemonic::End => (
                Op::Return {
                    condition: Condition::Always,
                },
                self.chains.end(),
            ),
            Mnemonic::EndTrue => (
                Op::Return {
                    condition: Condition::IfTrue,
                },
                self.chains.end_if(),
            ),
            Mnemonic::EndFalse => (
                Op::Return {
                    condition: Condition::IfFalse,
                },
                self.chains.end_if(),
            ),
            Mnemonic::Close => {
                self.close_bracket(command);
                return;
            }
            _ => {
                self.structure(command);
                return;
            }
        };
        self.report(error, "");
        self.emit(op, command);
    }

    fn open_bracket(&mut self, command: &Command) {
        let level = self.chains.level();
        let (accumulator, error) = if gate(command.mnemonic).is_some() {
            self.chains.open_gate()
        } else {
            let result = match comparison(command.mnemonic) {
                Some(_) => Result::Compared,
                None => Result::Word,
            };
            (Accumulator::Word, self.chains.open_on_word(result))
        };
        self.report(error, "");
        self.opened.truncate(level.into());
        self.opened.push((command.mnemonic, self.place));
        let (op, class) = match accumulator {
            Accumulator::Logic => (Op::OpenLogic { level }, Class::Bit),
            Accumulator::Word => (Op::OpenWord { level }, Class::Byte),
        };
        let cost = command.mnemonic.cost(class).unwrap_or_else(|| cost_of(command));
        self.emit_with(op, cost);
    }

    fn close_bracket(&mut self, command: &Command) {
        let (result, error) = self.chains.close();
        let opened = result.and_then(|result| Some((result, self.opened.pop()?)));
        self.report_opened(error, "", opened.map(|(_, (_, place))| place));
        let Some((result, (opened, _))) = opened else {
            return;
        };
        let level = self.chains.level();
        let op = match (result, gate(opened), arithmetic(opened), comparison(opened)) {
            (Result::Logic, Some(gate), ..) => Op::CloseLogic { level, gate },
            (Result::Word, Some(gate), ..) => Op::CloseWord { level, gate },
            (_, _, Some(operation), _) => Op::CloseArithmetic { level, operation },
            (_, _, _, Some(comparison)) => Op::CloseCompare { level, comparison },
            _ => return,
        };
        self.emit(op, command);
    }

    fn structure(&mut self, command: &Command) {
        let here = self.out.code.len();
        let taken_if = |mnemonic| match mnemonic {
            Mnemonic::IfTrue | Mnemonic::WhileTrue | Mnemonic::UntilTrue => Condition::IfFalse,
            _ => Condition::IfTrue,
        };
        let condition = taken_if(command.mnemonic);
        match command.mnemonic {
            Mnemonic::IfTrue | Mnemonic::IfFalse => {
                self.condition(command, condition);
                self.open_structure(
                    Kind::If {
                        jump: here,
                        has_else: false,
                    },
                    2,
                );
            }
            Mnemonic::WhileTrue | Mnemonic::WhileFalse => {
                self.condition(command, condition);
                self.open_structure(Kind::While { test: here }, 2);
            }
            Mnemonic::Repeat => {
                self.place_of_structure(command);
                self.open_structure(Kind::Repeat { start: here }, 1);
            }
            Mnemonic::Else => self.otherwise(command),
            Mnemonic::EndIf => {
                self.place_of_structure(command);
                if let Some(Structure {
                    kind: Kind::If { jump, .. },
                    ..
                }) = self.close_structure(Closer::EndIf)
                {
                    self.land(jump, here);
                }
            }
            Mnemonic::UntilTrue | Mnemonic::UntilFalse => {
                self.condition(command, condition);
                if let Some(Structure {
                    kind: Kind::Repeat { start },
                    ..
                }) = self.close_structure(Closer::Until)
                {
                    self.land(here, start);
                }
            }
            _ => {
                let error = self.chains.condition();
                self.report(error, "");
                self.jump_always(command);
                if let Some(Structure {
                    kind: Kind::While { test },
                    ..
                }) = self.close_structure(Closer::EndWhile)
                {
                    self.land(here, test);
                    self.land(test, here + 1);
                }
            }
        }
    }

    /// ELSE: the branch before it jumps over the one that begins here.
    fn otherwise(&mut self, command: &Command) {
        let here = self.out.code.len();
        let error = self.chains.label();
        self.report(error, "");
        let Some(open) = self.close_structure(Closer::Else) else {
            return;
        };
        self.jump_always(command);
        if let Kind::If { jump, .. } = open.kind {
            self.land(jump, here + 1);
        }
        let kind = Kind::If {
            jump: here,
            has_else: true,
        };
        self.structures.push(Structure { kind, ..open });
    }

    /// A jump whose target is set when the structure is closed.
    fn jump_always(&mut self, command: &Command) {
        let condition = Condition::Always;
        self.emit(Op::Jump { condition, target: 0 }, command);
        self.goes_on();
    }

    /// A conditional jump whose target is set when the structure is closed.
    fn condition(&mut self, command: &Command, condition: Condition) {
        let error = self.chains.condition();
        self.report(error, "");
        self.emit(Op::Jump { condition, target: 0 }, command);
    }

    /// REPEAT and ENDI: a place where all chains are ended.
    fn place_of_structure(&mut self, command: &Command) {
        let error = self.chains.label();
        self.report(error, "");
        self.emit(Op::Nop, command);
    }

    fn open_structure(&mut self, kind: Kind, labels: usize) {
        if self.structures.len() >= NESTING_MAX {
            // The number is inferred: the manual gives the limit, not its error [000:14438].
            self.report(
                Some(PlcError::WrongStructure),
                "structures are nested at most 16 deep",
            );
        }
        self.out.labels.count_invisible(labels);
        self.structures.push(Structure {
            kind,
            place: self.place,
        });
    }

    fn close_structure(&mut self, closer: Closer) -> Option<Structure> {
        let closed = close(&mut self.structures, closer);
        match closed {
            Some((structure, true)) => Some(structure),
            Some((structure, false)) => {
                let inner = self.structures.last().map(|structure| structure.place);
                let detail = "another structure is still open";
                self.report_opened(Some(PlcError::WrongStructure), detail, inner);
                Some(structure)
            }
            None => {
                self.report(Some(PlcError::WrongStructure), "no such structure is open");
                None
            }
        }
    }

    /// Sets the target of a jump.
    fn land(&mut self, jump: usize, at: usize) {
        if let Some(Op::Jump { target, .. }) = self.out.code.get_mut(jump).map(|jump| &mut jump.op) {
            *target = at;
        }
    }
}

fn width(mnemonic: Mnemonic) -> u8 {
    match mnemonic {
        Mnemonic::LoadByte | Mnemonic::AssignByte => 8,
        Mnemonic::LoadWord | Mnemonic::AssignWord => 16,
        _ => 32,
    }
}

fn gate(mnemonic: Mnemonic) -> Option<Gate> {
    Some(match mnemonic {
        Mnemonic::And | Mnemonic::OpenAnd => Gate::And,
        Mnemonic::AndNot | Mnemonic::OpenAndNot => Gate::AndNot,
        Mnemonic::Or | Mnemonic::OpenOr => Gate::Or,
        Mnemonic::OrNot | Mnemonic::OpenOrNot => Gate::OrNot,
        Mnemonic::Xor | Mnemonic::OpenXor => Gate::Xor,
        Mnemonic::XorNot | Mnemonic::OpenXorNot => Gate::XorNot,
        _ => return None,
    })
}

fn arithmetic(mnemonic: Mnemonic) -> Option<Arithmetic> {
    Some(match mnemonic {
        Mnemonic::Plus | Mnemonic::OpenPlus => Arithmetic::Plus,
        Mnemonic::Minus | Mnemonic::OpenMinus => Arithmetic::Minus,
        Mnemonic::Multiply | Mnemonic::OpenMultiply => Arithmetic::Multiply,
        Mnemonic::Divide | Mnemonic::OpenDivide => Arithmetic::Divide,
        Mnemonic::Modulo | Mnemonic::OpenModulo => Arithmetic::Modulo,
        _ => return None,
    })
}

fn comparison(mnemonic: Mnemonic) -> Option<Comparison> {
    Some(match mnemonic {
        Mnemonic::Equal | Mnemonic::OpenEqual => Comparison::Equal,
        Mnemonic::Less | Mnemonic::OpenLess => Comparison::Less,
        Mnemonic::Greater | Mnemonic::OpenGreater => Comparison::Greater,
        Mnemonic::LessEqual | Mnemonic::OpenLessEqual => Comparison::LessEqual,
        Mnemonic::GreaterEqual | Mnemonic::OpenGreaterEqual => Comparison::GreaterEqual,
        Mnemonic::NotEqual | Mnemonic::OpenNotEqual => Comparison::NotEqual,
        _ => return None,
    })
}

fn bit_operation(mnemonic: Mnemonic) -> Option<BitOperation> {
    Some(match mnemonic {
        Mnemonic::ShiftLeft => BitOperation::ShiftLeft,
        Mnemonic::ShiftRight => BitOperation::ShiftRight,
        Mnemonic::BitSet => BitOperation::Set,
        Mnemonic::BitClear => BitOperation::Clear,
        _ => return None,
    })
}
