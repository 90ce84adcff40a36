//! Memory of the PLC by its addresses, and the system parameters that say where it is.
//!
//! Decision: By LSV/2 a word of the PLC has its low byte first, as clients expect it; a block of two or four bytes is
//! one operand, a longer one words

use super::session::{Answer, Session};
use super::{Area, Device, ErrorNumber, Telegram, tcp};

/// Where the areas begin. The addresses of a real control are known to nobody here: clients ask for them by `R_PR`
/// (inferred).
const MARKERS: u32 = 0x0000_0000;
const INPUTS: u32 = 0x0001_0000;
const OUTPUTS: u32 = 0x0002_0000;
const COUNTERS: u32 = 0x0003_0000;
const TIMERS: u32 = 0x0004_0000;
const WORDS: u32 = 0x0005_0000;
const STRINGS: u32 = 0x0006_0000;
const INPUT_WORDS: u32 = 0x0007_0000;
const OUTPUT_WORDS: u32 = 0x0008_0000;
/// Bytes from one area to the next.
const AREA: u32 = 0x0001_0000;

/// Bytes of a string [000:14054].
const STRING: u32 = 128;
/// Bits of an input or output word.
const WORD_BITS: u32 = 16;

/// Version of LSV/2, and the formats of programs: not reported (inferred).
const LSV2_VERSION: u8 = 1;

/// `R_PR`: 120 bytes, where what memory begins, and how large a telegram may be (public).
pub(super) fn parameters(session: &mut Session, telegram: &Telegram) -> Answer {
    let device = &session.site.device;
    let number = |area| device.elements(area);
    let answer = [
        (MARKERS, number(Area::Markers)),
        (INPUTS, number(Area::Inputs)),
        (OUTPUTS, number(Area::Outputs)),
        (COUNTERS, number(Area::Counters)),
        (TIMERS, number(Area::Timers)),
        (WORDS, number(Area::Bytes) / 2),
        (STRINGS, number(Area::Strings)),
    ]
    .iter()
    .fold(
        Telegram::new(telegram.command.answer()),
        |answer, (start, count)| answer.long(*start).long(*count),
    );
    let block = u16::try_from(tcp::DATA_MAX).unwrap_or(u16::MAX);
    Ok(answer
        .byte(u8::try_from(STRING).unwrap_or(u8::MAX))
        .raw(&[0; 7])
        .long(INPUT_WORDS)
        .long(number(Area::Inputs) / WORD_BITS)
        .long(OUTPUT_WORDS)
        .long(number(Area::Outputs) / WORD_BITS)
        .raw(&[0; 16])
        .byte(LSV2_VERSION)
        .byte(0)
        .word(block)
        .raw(&[0; 4])
        .long(0)
        .long(0)
        .word(0)
        .word(0)
        .long(0))
}

/// `R_MB`: bytes from an address on. Markers and their like have a byte each.
pub(super) fn block(session: &mut Session, telegram: &Telegram) -> Answer {
    let mut fields = telegram.fields();
    let address = fields.long().ok_or(ErrorNumber::BAD_FORMAT)?;
    let count = u32::from(fields.byte().ok_or(ErrorNumber::BAD_FORMAT)?);
    let device = session.site.device.as_ref();
    let (start, first) = (address / AREA * AREA, address % AREA);
    let bits = |area| device.memory(area, first, count);
    let bytes = match start {
        MARKERS => bits(Area::Markers),
        INPUTS => bits(Area::Inputs),
        OUTPUTS => bits(Area::Outputs),
        COUNTERS => bits(Area::Counters),
        TIMERS => bits(Area::Timers),
        WORDS => device
            .memory(Area::Bytes, first, count)
            .map(|bytes| numbers(first, bytes)),
        STRINGS => string(device, first, count),
        INPUT_WORDS => packed(device, Area::Inputs, first, count),
        OUTPUT_WORDS => packed(device, Area::Outputs, first, count),
        _ => Err(ErrorNumber::BAD_ADDRESS),
    }?;
    Ok(Telegram::with(telegram.command.answer(), bytes))
}

/// The PLC has the high byte of a word at its address [000:12099], clients expect the low one there (public): two bytes are
/// turned as a word, four as a doubleword, longer blocks word by word; a single byte is itself, and so are blocks that
/// begin or end within a word (inferred).
fn numbers(first: u32, mut bytes: Vec<u8>) -> Vec<u8> {
    match bytes.len() {
        _ if !first.is_multiple_of(2) => {}
        4 if first.is_multiple_of(4) => bytes.reverse(),
        length if length.is_multiple_of(2) => {
            for word in bytes.chunks_exact_mut(2) {
                word.reverse();
            }
        }
        _ => {}
    }
    bytes
}

/// A string, or part of one.
fn string(device: &dyn Device, first: u32, count: u32) -> Result<Vec<u8>, ErrorNumber> {
    let (number, from) = (first / STRING, (first % STRING) as usize);
    let bytes = device.memory(Area::Strings, number, 1)?;
    let part = bytes.get(from..).unwrap_or_default();
    Ok(part.iter().copied().take(count as usize).collect())
}

/// Bits eight to a byte, the lowest one first.
fn packed(device: &dyn Device, area: Area, first: u32, count: u32) -> Result<Vec<u8>, ErrorNumber> {
    let bits = device.memory(area, first.saturating_mul(8), count * 8)?;
    let byte = |bits: &[u8]| {
        bits.iter()
            .rev()
            .fold(0, |byte, bit| byte << 1 | u8::from(*bit != 0))
    };
    Ok(bits.chunks(8).map(byte).collect())
}

/// Types of values in `S_DP` (public).
const WORD: u32 = 2;
const DOUBLE_WORD: u32 = 3;
const REAL: u32 = 5;
const TEXT: u32 = 8;
const BIT: u32 = 11;
const BYTE: u32 = 16;

/// `R_DP`: a value by its path (public): `\PLC\memory\W\2`, with M, I, O, T, C, B, W, D, S and the constant K, and
/// `\TABLE\TOOL\T\1\L`, column L of tool 1.
pub(super) fn data_path(session: &mut Session, telegram: &Telegram) -> Answer {
    let mut fields = telegram.fields();
    fields.long().ok_or(ErrorNumber::BAD_FORMAT)?;
    let path = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
    let parts: Vec<String> = path
        .split('\\')
        .filter(|part| !part.is_empty())
        .map(str::to_ascii_uppercase)
        .collect();
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    let device = session.site.device.as_ref();
    let number = |text: &str| text.parse().map_err(|_| ErrorNumber::BAD_NUMBER);
    let (value_type, value) = match parts[..] {
        ["PLC", "MEMORY", kind, place] => operand(device, kind, number(place)?)?,
        ["TABLE", "TOOL", "T", tool, column] => {
            let value = device.tool_value(number(tool)?, column);
            let text = value.ok_or(ErrorNumber::WRONG_PARAMETER)?;
            match text.parse::<f64>() {
                Ok(value) => (REAL, value.to_le_bytes().to_vec()),
                Err(_) => (TEXT, Telegram::new(telegram.command).string(&text).data),
            }
        }
        _ => return Err(ErrorNumber::WRONG_PARAMETER),
    };
    Ok(Telegram::new(telegram.command.answer())
        .long(value_type)
        .raw(&value))
}

/// An operand of the PLC: type and bytes of its value.
fn operand(device: &dyn Device, kind: &str, number: u32) -> Result<(u32, Vec<u8>), ErrorNumber> {
    let read = |area, count| device.memory(area, number, count);
    Ok(match kind {
        "M" => (BIT, read(Area::Markers, 1)?),
        "I" => (BIT, read(Area::Inputs, 1)?),
        "O" => (BIT, read(Area::Outputs, 1)?),
        "T" => (BIT, read(Area::Timers, 1)?),
        "C" => (BIT, read(Area::Counters, 1)?),
        "B" => (BYTE, read(Area::Bytes, 1)?),
        "W" if number.is_multiple_of(2) => (WORD, read(Area::Bytes, 2)?),
        "D" if number.is_multiple_of(4) => (DOUBLE_WORD, read(Area::Bytes, 4)?),
        "K" => (DOUBLE_WORD, number.to_be_bytes().to_vec()),
        "S" => {
            let mut text = read(Area::Strings, 1)?;
            let end = text.iter().position(|byte| *byte == 0);
            text.truncate(end.unwrap_or(text.len()));
            text.push(0);
            (TEXT, text)
        }
        _ => return Err(ErrorNumber::BAD_ADDRESS),
    })
}
