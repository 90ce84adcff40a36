//! Expressions: numbers, parameters, variables, functions, and what is calculated with them.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::cursor::Cursor;
use crate::line::LineFault;
use crate::unit::{FunctionLetter, Variable, Variables};

/// A value that is found when its block is executed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    Number(f64),
    /// `P10`, `P[..]`: a parameter by its number.
    Parameter(Box<Expression>),
    Variable(Reference),
    Negative(Box<Expression>),
    Binary(Operator, Box<Expression>, Box<Expression>),
    Call(Function, Box<Expression>),
    /// `EXIST[M80]` (public).
    Exists(FunctionLetter, Box<Expression>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Plus,
    Minus,
    Times,
    Divided,
    Power,
}

/// A function of one argument; angles are in degrees (public).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Abs,
    Sqr,
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Int,
    Fract,
    Round,
}

/// The functions by their names (public).
const FUNCTIONS: [(&str, Function); 14] = [
    ("ABS", Function::Abs),
    ("SQR", Function::Sqr),
    ("SQRT", Function::Sqrt),
    ("EXP", Function::Exp),
    ("LN", Function::Ln),
    ("SIN", Function::Sin),
    ("COS", Function::Cos),
    ("TAN", Function::Tan),
    ("ASIN", Function::Asin),
    ("ACOS", Function::Acos),
    ("ATAN", Function::Atan),
    ("INT", Function::Int),
    ("FRACT", Function::Fract),
    ("ROUND", Function::Round),
];

/// A variable whose index is still to be found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reference {
    name: Arc<str>,
    index: Option<Box<Expression>>,
}

/// Variables that the manual names and those beside them (public), with their index as `[]` [004:54] [004:87] [004:123]
/// [004:201].
const VARIABLES: [&str; 8] = [
    "V.G.M_FCT[].SYNCH",
    "V.G.H_FCT[].SYNCH",
    "V.G.M_FCT[].PRE_OUTP_PATH",
    "V.G.H_FCT[].PRE_OUTP_PATH",
    "V.G.M_FCT[].PRE_OUTP_TIME",
    "V.G.H_FCT[].PRE_OUTP_TIME",
    "V.G.RW",
    "V.SPDL.M_FCT_FREE",
];

/// External variables have any name [004:126].
const EXTERNAL: &str = "V.E.";

/// Brackets in brackets end here.
const MAX_DEPTH: u32 = 64;

/// Whether a word is the name of a function.
pub(crate) fn is_function(word: &str) -> bool {
    word == "EXIST" || FUNCTIONS.iter().any(|(name, _)| *name == word)
}

/// Whether a variable begins here: `V.` and a letter, where an axis V would have a number.
pub(crate) fn variable_begins(cursor: &Cursor) -> bool {
    let mut ahead = cursor.clone();
    ahead.peek() == Some('V') && {
        ahead.advance(1);
        ahead.eat('.') && {
            ahead.skip_blanks();
            ahead.peek().is_some_and(char::is_alphabetic)
        }
    }
}

/// Reads an expression as far as it goes.
pub(crate) fn expression(cursor: &mut Cursor) -> Result<Expression, LineFault> {
    sum(cursor, 0)
}

/// Reads the number of a parameter after its letter: digits or an expression in brackets.
pub(crate) fn parameter_number(cursor: &mut Cursor) -> Result<Expression, LineFault> {
    number_of_parameter(cursor, 0)
}

fn sum(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mut left = product(cursor, depth)?;
    loop {
        let operator = if cursor.eat_operator('+')? {
            Operator::Plus
        } else if cursor.eat_operator('-')? {
            Operator::Minus
        } else {
            return Ok(left);
        };
        left = binary(operator, left, product(cursor, depth)?);
    }
}

fn product(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mut left = signed(cursor, depth)?;
    loop {
        let operator = if cursor.eat_operator('*')? {
            Operator::Times
        } else if cursor.eat_operator('/')? {
            Operator::Divided
        } else {
            return Ok(left);
        };
        left = binary(operator, left, signed(cursor, depth)?);
    }
}

fn binary(operator: Operator, left: Expression, right: Expression) -> Expression {
    Expression::Binary(operator, Box::new(left), Box::new(right))
}

fn signed(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mut negative = false;
    loop {
        if cursor.eat('-') {
            negative = !negative;
        } else if !cursor.eat('+') {
            break;
        }
    }
    let value = power(cursor, depth)?;
    Ok(if negative {
        Expression::Negative(Box::new(value))
    } else {
        value
    })
}

/// `2**3**2` is `2**9`, `-2**2` is -4 (inferred).
fn power(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let base = primary(cursor, depth)?;
    cursor.skip_blanks();
    if cursor.peek() != Some('*') || cursor.peek_at(1) != Some('*') {
        return Ok(base);
    }
    let mark = cursor.mark();
    cursor.advance(1);
    cursor.eat_operator('*')?;
    if depth >= MAX_DEPTH {
        return Err(cursor.fault(mark, "the expression is nested too deep"));
    }
    Ok(binary(Operator::Power, base, signed(cursor, depth + 1)?))
}

fn primary(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    cursor.skip_blanks();
    let mark = cursor.mark();
    match cursor.peek() {
        Some('0'..='9' | '.') => number(cursor),
        Some('[') => bracket(cursor, depth),
        Some('\'') => based(cursor),
        Some('P') if cursor.letters() == "P" => {
            cursor.advance(1);
            Ok(Expression::Parameter(Box::new(number_of_parameter(
                cursor, depth,
            )?)))
        }
        Some('V') if variable_begins(cursor) => Ok(Expression::Variable(reference_within(cursor, depth)?)),
        Some(letter) if letter.is_ascii_alphabetic() => {
            let name = cursor.letters();
            let function = FUNCTIONS.iter().find(|(known, _)| *known == name);
            if function.is_none() && name != "EXIST" {
                return Err(cursor.unknown(mark, "word"));
            }
            cursor.advance(name.len());
            cursor.skip_blanks();
            match function {
                Some((_, function)) if cursor.peek() == Some('[') => {
                    Ok(Expression::Call(*function, Box::new(bracket(cursor, depth)?)))
                }
                None if cursor.peek() == Some('[') => existing(cursor, depth),
                _ => Err(cursor.fault(mark, format!("{name} needs its argument in [ ]"))),
            }
        }
        Some(_) => {
            let word = cursor.word();
            Err(cursor.fault(mark, format!("a number is missing before {word}")))
        }
        None => Err(cursor.fault(mark, "a number is missing")),
    }
}

fn bracket(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mark = cursor.mark();
    if depth >= MAX_DEPTH {
        return Err(cursor.fault(mark, "the expression is nested too deep"));
    }
    cursor.advance(1);
    let inner = sum(cursor, depth + 1)?;
    close(cursor, mark)?;
    Ok(inner)
}

fn close(cursor: &mut Cursor, mark: usize) -> Result<(), LineFault> {
    if cursor.eat(']') {
        return Ok(());
    }
    Err(match cursor.peek() {
        Some(_) => {
            let here = cursor.mark();
            let word = cursor.word();
            cursor.fault(here, format!("{word} does not belong into the brackets"))
        }
        None => cursor.fault(mark, "bracket [ is not closed"),
    })
}

/// `EXIST[M80]`: whether a function has a type (public).
fn existing(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    cursor.skip_blanks();
    let word = cursor.mark();
    let Some(letter) = cursor.peek().and_then(FunctionLetter::of) else {
        return Err(cursor.unknown(word, "operand of EXIST:"));
    };
    cursor.advance(1);
    if depth >= MAX_DEPTH {
        return Err(cursor.fault(mark, "the expression is nested too deep"));
    }
    let number = sum(cursor, depth + 1)?;
    close(cursor, mark)?;
    Ok(Expression::Exists(letter, Box::new(number)))
}

/// A decimal number without sign.
fn number(cursor: &mut Cursor) -> Result<Expression, LineFault> {
    let mark = cursor.mark();
    let digits = cursor.take_while(|c| c.is_ascii_digit() || c == '.');
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Expression::Number(value)),
        _ => Err(cursor.fault(mark, format!("{digits} is no number"))),
    }
}

/// A number of another base in quotes: `'16#1F'` [004:105].
fn based(cursor: &mut Cursor) -> Result<Expression, LineFault> {
    let mark = cursor.mark();
    cursor.advance(1);
    let text = cursor.take_while(|c| c != '\'');
    if !cursor.eat('\'') {
        return Err(cursor.fault(mark, "quote ' is not closed"));
    }
    let value = text.split_once('#').and_then(|(base, digits)| {
        let base = base
            .trim()
            .parse()
            .ok()
            .filter(|base| [2, 8, 10, 16].contains(base))?;
        let digits = digits.trim();
        let plain = digits.chars().all(|c| c.is_ascii_alphanumeric());
        u32::from_str_radix(digits, base).ok().filter(|_| plain)
    });
    match value {
        Some(value) => Ok(Expression::Number(value.into())),
        None => Err(cursor.fault(mark, format!("'{text}' is no number"))),
    }
}

fn number_of_parameter(cursor: &mut Cursor, depth: u32) -> Result<Expression, LineFault> {
    let mark = cursor.mark();
    cursor.skip_blanks();
    match cursor.peek() {
        Some('[') => bracket(cursor, depth),
        Some('0'..='9') => {
            let digits = cursor.take_while(|c| c.is_ascii_digit());
            match digits.parse::<u32>() {
                Ok(number) => Ok(Expression::Number(number.into())),
                Err(_) => Err(cursor.fault(mark, format!("P{digits} is no parameter"))),
            }
        }
        _ => Err(cursor.fault(mark, "P needs its number")),
    }
}

/// Reads the name of a variable.
pub(crate) fn reference(cursor: &mut Cursor) -> Result<Reference, LineFault> {
    reference_within(cursor, 0)
}

fn reference_within(cursor: &mut Cursor, depth: u32) -> Result<Reference, LineFault> {
    let mark = cursor.mark();
    let mut name = String::new();
    let mut index = None;
    loop {
        let part = cursor.take_while(|c| c.is_ascii_alphanumeric() || c == '_');
        if part.is_empty() {
            let word = cursor.mark();
            let found = cursor.word();
            return Err(cursor.fault(word, format!("a name is missing in {name}{found}")));
        }
        name += &part;
        cursor.skip_blanks();
        while cursor.peek() == Some('[') {
            // No variable here has more than one.
            name += "[]";
            index = Some(Box::new(bracket(cursor, depth)?));
        }
        if !cursor.eat('.') {
            break;
        }
        cursor.skip_blanks();
        name.push('.');
    }
    if name.starts_with(EXTERNAL) && !name.contains("[][]") || VARIABLES.contains(&name.as_str()) {
        return Ok(Reference {
            name: name.into(),
            index,
        });
    }
    Err(cursor.fault(mark, format!("unknown variable {}", cursor.text(mark).trim())))
}

/// What expressions are made of when a block is executed.
pub(crate) struct Values<'a> {
    pub parameters: &'a BTreeMap<u32, f64>,
    pub variables: &'a mut dyn Variables,
}

impl Expression {
    /// What it comes to with these values; the error names what has none.
    pub fn value(&self, values: &mut Values) -> Result<f64, String> {
        let value = match self {
            Expression::Number(number) => *number,
            Expression::Parameter(number) => {
                let number = whole(number.value(values)?, "number of P")?;
                let value = values.parameters.get(&number);
                *value.ok_or_else(|| format!("P{number} has no value"))?
            }
            Expression::Variable(reference) => {
                let variable = reference.variable(values)?;
                values.variables.read(&variable)?
            }
            Expression::Negative(value) => -value.value(values)?,
            Expression::Binary(operator, left, right) => {
                let (left, right) = (left.value(values)?, right.value(values)?);
                match operator {
                    Operator::Plus => left + right,
                    Operator::Minus => left - right,
                    Operator::Times => left * right,
                    Operator::Divided if right == 0.0 => return Err("division by 0".into()),
                    Operator::Divided => left / right,
                    Operator::Power => left.powf(right),
                }
            }
            Expression::Call(function, argument) => function.value(argument.value(values)?),
            Expression::Exists(letter, number) => {
                let number = function_number(number.value(values)?)?;
                f64::from(u8::from(values.variables.exists(*letter, number)))
            }
        };
        match value.is_finite() {
            true => Ok(value),
            false => Err("the expression has no value".into()),
        }
    }

    /// Whether a V.E. variable is read, before which everything is executed [004:126].
    pub fn reads_external(&self) -> bool {
        match self {
            Expression::Number(_) => false,
            Expression::Variable(reference) => {
                reference.name.starts_with(EXTERNAL) || reference.index_reads_external()
            }
            Expression::Binary(_, left, right) => left.reads_external() || right.reads_external(),
            Expression::Parameter(inner)
            | Expression::Negative(inner)
            | Expression::Call(_, inner)
            | Expression::Exists(_, inner) => inner.reads_external(),
        }
    }
}

impl Reference {
    /// The variable that is meant.
    pub fn variable(&self, values: &mut Values) -> Result<Variable, String> {
        let index = match &self.index {
            Some(index) => Some(whole(index.value(values)?, "index")?),
            None => None,
        };
        Ok(Variable {
            name: Arc::clone(&self.name),
            index,
        })
    }

    pub fn index_reads_external(&self) -> bool {
        self.index.as_ref().is_some_and(|index| index.reads_external())
    }
}

impl Function {
    fn value(self, x: f64) -> f64 {
        match self {
            Function::Abs => x.abs(),
            Function::Sqr => x * x,
            Function::Sqrt => x.sqrt(),
            Function::Exp => x.exp(),
            Function::Ln => x.ln(),
            Function::Sin => x.to_radians().sin(),
            Function::Cos => x.to_radians().cos(),
            Function::Tan => x.to_radians().tan(),
            Function::Asin => x.asin().to_degrees(),
            Function::Acos => x.acos().to_degrees(),
            Function::Atan => x.atan().to_degrees(),
            Function::Int => x.trunc(),
            Function::Fract => x.fract(),
            Function::Round => x.round(),
        }
    }
}

/// A number as an index.
pub(crate) fn whole(value: f64, what: &str) -> Result<u32, String> {
    let rounded = value.round();
    if (0.0..=f64::from(u32::MAX)).contains(&rounded) {
        return Ok(rounded as u32);
    }
    Err(format!("{value} is no {what}"))
}

/// The number of an M or H function: rounded, not negative (public), 0 to 65535 [004:45].
pub(crate) fn function_number(value: f64) -> Result<u16, String> {
    let rounded = value.round();
    if (0.0..=f64::from(u16::MAX)).contains(&rounded) {
        return Ok(rounded as u16);
    }
    Err(format!("{value} is no number of a function: 0 to {}", u16::MAX))
}
