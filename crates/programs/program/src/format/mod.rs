//! The normalised listing: numbered blocks, one in a line, with signs and spacing as the manual prints them.

mod cycle;
mod formula;
mod listing;
pub(crate) mod number;
mod options;
mod path;

use crate::parse::rest_of_word;
use crate::{
    Block, Calculation, Condition, Coordinates, Expression, Feed, Header, MFunctions, Operation, Unit, Value,
};
use number::{push_integer, push_signed, push_unsigned};

pub use options::FormatOptions;

pub use listing::format_program;

/// A block as the listing shows it in plain language, without number and line end.
pub fn format_block(block: &Block, options: FormatOptions) -> String {
    let mut text = String::new();
    write_block(block, options, &mut text);
    text
}

/// [`format_block`] after other text.
pub(crate) fn write_block(block: &Block, options: FormatOptions, text: &mut String) {
    let mut out = Output {
        text: std::mem::take(text),
        options,
    };
    out.block(block);
    *text = out.text;
}

/// A formula as listings show it.
pub(crate) fn formula_text(expression: &Expression, decimal_comma: bool) -> String {
    let mut out = Output {
        text: String::new(),
        options: FormatOptions {
            decimal_comma,
            ..FormatOptions::default()
        },
    };
    out.expression(expression);
    out.text
}

/// Text being written. Words other than the first begin with a blank.
struct Output {
    text: String,
    options: FormatOptions,
}

impl Output {
    fn block(&mut self, block: &Block) {
        if block.skip {
            self.text.push_str("/ ");
        }
        self.operation(&block.operation);
        if let Some(comment) = &block.comment {
            self.text.push_str(" ; ");
            self.text.push_str(comment);
        }
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each kind of block")]
    fn operation(&mut self, operation: &Operation) {
        match operation {
            Operation::Begin(header) => self.header("BEGIN PGM", header),
            Operation::End(header) => self.header("END PGM", header),
            Operation::BlankMin(corner, axis) => {
                self.text.push_str("BLK FORM 0.1");
                if let Some(axis) = axis {
                    self.word("");
                    self.text.push(axis.letter());
                }
                self.coordinates(corner);
            }
            Operation::BlankMax(corner) => {
                self.text.push_str("BLK FORM 0.2");
                self.coordinates(corner);
            }
            Operation::ToolDefinition { tool, length, radius } => {
                self.text.push_str("TOOL DEF ");
                self.unsigned(*tool);
                self.signed_word("L", *length);
                self.signed_word("R", *radius);
            }
            Operation::ToolCall {
                tool,
                axis,
                speed,
                delta_length,
                delta_radius,
            } => {
                self.text.push_str("TOOL CALL");
                self.unsigned_word("", *tool);
                if let Some(axis) = axis {
                    self.word("");
                    self.text.push(axis.letter());
                }
                self.unsigned_word("S", *speed);
                self.signed_word("DL", *delta_length);
                self.signed_word("DR", *delta_radius);
            }
            Operation::Motion(motion) => self.motion(motion),
            Operation::CircleCentre(centre) => {
                self.text.push_str("CC");
                self.coordinates(centre);
            }
            Operation::Rounding { radius, feed } => {
                self.text.push_str("RND R");
                self.unsigned(*radius);
                self.unsigned_word("F", *feed);
            }
            Operation::Chamfer { length, feed } => {
                self.text.push('L');
                self.unsigned(*length);
                self.unsigned_word("F", *feed);
            }
            Operation::Stop(m) => {
                self.text.push_str("STOP");
                self.m_functions(m);
            }
            Operation::Miscellaneous(m) if m.is_empty() => self.text.push('M'),
            Operation::Miscellaneous(m) => {
                let start = self.text.len();
                self.m_functions(m);
                // Here the first word opens the block.
                self.text.remove(start);
            }
            Operation::Label(label) => {
                self.text.push_str("LBL ");
                self.integer(u32::from(*label));
            }
            Operation::CallLabel { label, repeats } => {
                self.text.push_str("CALL LBL ");
                self.integer(u32::from(*label));
                if let Some(repeats) = repeats {
                    self.text.push_str(" REP ");
                    self.unsigned(*repeats);
                    self.text.push('/');
                    self.unsigned(*repeats);
                }
            }
            Operation::CallProgram(name) => {
                self.text.push_str("CALL PGM ");
                self.text.push_str(name);
            }
            Operation::Calculate {
                function,
                target,
                a,
                b,
            } => self.calculation(*function, *target, *a, *b),
            Operation::Jump {
                condition,
                a,
                b,
                label,
            } => self.jump(*condition, *a, *b, *label),
            Operation::ErrorNumber(number) => {
                self.text.push_str("FN14: ERROR = ");
                self.unsigned(*number);
            }
            Operation::Print(items) => {
                self.text.push_str("FN15: PRINT ");
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        self.text.push('/');
                    }
                    self.unsigned(*item);
                }
            }
            Operation::Plc { a, b } => {
                self.text.push_str("FN19: PLC = ");
                self.signed(*a);
                if let Some(b) = b {
                    self.text.push('/');
                    self.signed(*b);
                }
            }
            Operation::Formula { target, expression } => {
                self.text.push('Q');
                self.integer(u32::from(*target));
                self.text.push_str(" = ");
                self.expression(expression);
            }
            Operation::Cycle(block) => self.cycle(block),
            Operation::CycleCall(m) => {
                self.text.push_str("CYCL CALL");
                self.m_functions(m);
            }
            Operation::Probe(block) => self.probe(block),
            Operation::Dialog(dialog) => {
                self.text
                    .push_str(if dialog.call { "DLG-CALL" } else { "DLG-DEF" });
                for (i, text) in dialog.texts.iter().enumerate() {
                    self.text.push(if i == 0 { ' ' } else { '/' });
                    self.integer(u32::from(*text));
                }
            }
            // Only languages with G functions have such blocks.
            Operation::Modal(block) => {
                for (i, part) in block.operations.iter().enumerate() {
                    self.text.push_str(if i == 0 { "" } else { " " });
                    self.operation(part);
                }
            }
            Operation::Comment(text) if text.starts_with('*') => self.text.push_str(text),
            Operation::Comment(text) => {
                self.text.push(';');
                if !text.is_empty() {
                    self.text.push(' ');
                    self.text.push_str(text);
                }
            }
            Operation::Invalid(invalid) => self.text.push_str(&invalid.text),
        }
    }

    fn header(&mut self, keyword: &str, header: &Header) {
        self.text.push_str(keyword);
        if !header.name.is_empty() {
            self.word(&header.name);
        }
        match header.unit {
            Some(Unit::Mm) => self.word("MM"),
            Some(Unit::Inch) => self.word("INCH"),
            None => {}
        }
        if header.protected {
            self.word("P");
        }
    }

    fn calculation(&mut self, function: Calculation, target: u16, a: Value, b: Value) {
        let (number, operator) = match function {
            Calculation::Assign => ("0", ""),
            Calculation::Add => ("1", "+"),
            Calculation::Subtract => ("2", "-"),
            Calculation::Multiply => ("3", "*"),
            Calculation::Divide => ("4", "DIV"),
            Calculation::SquareRoot => ("5", "SQRT"),
            Calculation::Sine => ("6", "SIN"),
            Calculation::Cosine => ("7", "COS"),
            Calculation::Length => ("8", "LEN"),
            Calculation::Angle => ("13", "ANG"),
        };
        self.text.push_str("FN");
        self.text.push_str(number);
        self.text.push_str(": Q");
        self.integer(u32::from(target));
        self.text.push_str(" = ");
        match function {
            Calculation::Assign => self.signed(a),
            Calculation::SquareRoot | Calculation::Sine | Calculation::Cosine => {
                self.text.push_str(operator);
                self.text.push(' ');
                self.signed(a);
            }
            _ => {
                self.signed(a);
                self.word(operator);
                self.text.push(' ');
                self.signed(b);
            }
        }
    }

    fn jump(&mut self, condition: Condition, a: Value, b: Value, label: u16) {
        let (number, word) = match condition {
            Condition::Equal => ("9", "EQU"),
            Condition::NotEqual => ("10", "NE"),
            Condition::Greater => ("11", "GT"),
            Condition::Less => ("12", "LT"),
        };
        self.text.push_str("FN");
        self.text.push_str(number);
        self.text.push_str(": IF ");
        self.signed(a);
        self.word(word);
        self.text.push(' ');
        self.signed(b);
        self.text.push_str(" GOTO LBL ");
        self.integer(u32::from(label));
    }

    /// The M functions, each with its words.
    fn m_functions(&mut self, m: &MFunctions) {
        for &code in m.codes() {
            self.word("M");
            self.integer(u32::from(code));
            for argument in m
                .arguments
                .iter()
                .flatten()
                .filter(|argument| argument.code == code)
            {
                self.word("");
                self.text.push(argument.letter);
                self.text.push_str(rest_of_word(code, argument.letter));
                self.unsigned(argument.value);
            }
        }
    }

    fn coordinates(&mut self, coordinates: &Coordinates) {
        for (axis, word) in coordinates.iter() {
            self.word(if word.incremental { "I" } else { "" });
            self.text.push(axis.letter());
            self.signed(word.value);
        }
    }

    fn feed_word(&mut self, feed: Feed) {
        match feed {
            Feed::Max => self.word("FMAX"),
            Feed::Value(value) => self.unsigned_word("F", Some(value)),
        }
    }

    /// A blank and a word.
    fn word(&mut self, word: &str) {
        self.text.push(' ');
        self.text.push_str(word);
    }

    fn signed_word(&mut self, address: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.word(address);
            self.signed(value);
        }
    }

    fn unsigned_word(&mut self, address: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.word(address);
            self.unsigned(value);
        }
    }

    /// A value with its sign, also `+`.
    fn signed(&mut self, value: Value) {
        push_signed(&mut self.text, value, self.options.decimal_comma);
    }

    /// A value with `-` only.
    fn unsigned(&mut self, value: Value) {
        push_unsigned(&mut self.text, value, self.options.decimal_comma);
    }

    fn integer(&mut self, number: u32) {
        push_integer(&mut self.text, u64::from(number), 1);
    }
}
