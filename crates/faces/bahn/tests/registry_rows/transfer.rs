//! Rows of the data interface: characters of the protocols, data format, hard copy.

use std::time::Duration;

use bahn_link::blockwise::{self, Want};
use bahn_link::{FileType, HardCopy, Memory, Mode, Protocol, Settings, standard};
use bahn_parameters::{ControlModel, ParameterList};

use crate::bench::{Probe, Row, Verdict, both, holds, same};

pub const ROWS: &[Row] = &[
    Row(71..=71, Probe::Acts(text_characters)),
    Row(218..=219, Probe::Acts(headers)),
    Row(220..=221, Probe::Acts(block_characters)),
    Row(222..=222, Probe::Acts(format)),
    Row(223..=223, Probe::Acts(mode)),
    Row(224..=224, Probe::Acts(end_of_transmission)),
    Row(226..=233, Probe::Acts(printer)),
];

const SOH: u8 = 1;
const STX: u8 = 2;
const ETX: u8 = 3;
const EOT: u8 = 4;
const ACK: u8 = 6;
const NAK: u8 = 0x15;
const ETB: u8 = 0x17;

/// The list of the manual's example with changes: blockwise, `% E`, `% A`, SOH ETB, ACK NAK, EOT [001:2075-2088].
pub fn list(mps: &str) -> ParameterList {
    let base = "71=515 92=1 218=17701 219=16677 220=279 221=5382 222=168 223=1 224=4";
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    for assignment in base.split_whitespace().chain(mps.split_whitespace()) {
        list.assign(assignment).unwrap();
    }
    list
}

/// A transfer in EXT: what the control says, while the other side answers each time with the next of what it has to say.
fn said(protocol: &mut dyn Protocol, answers: &[&[u8]]) -> Vec<u8> {
    let mut now = Duration::from_secs(1);
    let mut bytes = Vec::new();
    let mut answers = answers.iter();
    for _ in 0..40 {
        now += Duration::from_millis(10);
        protocol.clock(now);
        let before = bytes.len();
        while protocol.has_output() {
            protocol.send(16, now, &mut bytes);
        }
        if bytes.len() > before {
            for byte in answers.next().copied().unwrap_or_default() {
                protocol.receive(*byte, now);
            }
        }
    }
    bytes
}

fn settings(mps: &str) -> Settings {
    Settings::of(&list(mps), Mode::Ext1)
}

fn memory() -> Box<Memory> {
    let memory = Memory::default();
    memory.put("1.H", "0 BEGIN PGM 1 MM\n1 L X+1.5\n2 END PGM 1 MM\n");
    Box::new(memory)
}

/// The control sends program 1; the device acknowledges with a character.
fn written(mps: &str, answer: u8) -> Vec<u8> {
    let mut writing = blockwise::Writing::new(settings(mps), memory(), vec!["1.H".to_owned()], false);
    said(&mut writing, &[[answer].as_slice(); 6])
}

/// The control reads program 1.
fn read(mps: &str, answers: &[&[u8]]) -> Vec<u8> {
    let kind = FileType::of_code('H').unwrap();
    let want = Want::Selected("1.H".to_owned());
    let mut reading = blockwise::Reading::new(settings(mps), Box::new(Memory::default()), want, kind);
    said(&mut reading, answers)
}

/// Program 1 by the standard interface.
pub fn printed(mps: &str) -> Vec<u8> {
    let settings = settings(&format!("223=0 {mps}"));
    let mut writing = standard::Writing::new(settings, memory(), vec!["1.H".to_owned()], false);
    said(&mut writing, &[])
}

/// The header of a transfer and its check character.
fn header(before: u8, after: u8) -> Vec<u8> {
    let text = [SOH, before, b'1', after, ETB];
    let check = text.iter().fold(0, |check, byte| check ^ byte);
    text.into_iter().chain([check]).collect()
}

/// `% 1 E` asks for a program, `% 1 A` offers one; 0x4926 is `&` and `I` [001:2080-2083].
fn headers(number: u16) -> Verdict {
    let letter = if number == 218 { b'E' } else { b'A' };
    let seen = both(number, "18726", |mps| match number {
        218 => read(mps, &[]),
        _ => written(mps, 0),
    });
    let begins = [header(b'%', letter), header(b'&', b'I')];
    let found = [0, 1].map(|at: usize| seen[at].starts_with(&begins[at]));
    holds(found == [true; 2], || format!("{seen:02X?}"))
}

/// 14 + 256 · 13 in place of ETB and SOH, of ACK and NAK [001:2084-2087].
fn block_characters(number: u16) -> Verdict {
    let changed = [13_u8, 14];
    let value = "3342";
    if number == 220 {
        let seen = both(number, value, |mps| written(mps, 0));
        let frame = seen.map(|bytes| [bytes[0], bytes[4]]);
        return same(frame, [[SOH, ETB], changed]);
    }
    // ACK of the device lets the control send its first block; NAK lets it repeat the header.
    let seen = both(number, value, |mps| {
        let [nak, ack] = if mps.is_empty() { [NAK, ACK] } else { changed };
        let block = [STX, b'1', ETB, STX ^ b'1' ^ ETB];
        let acknowledged = written(mps, ack).contains(&STX);
        let headers = written(mps, nak).iter().filter(|byte| **byte == SOH).count();
        let own = read(mps, &[&block]).last().copied();
        (acknowledged, headers > 1, own)
    });
    same(seen, [(true, true, Some(ACK)), (true, true, Some(14))])
}

/// After ETX of the device the control ends the transmission; 13 in place of EOT [001:2088].
fn end_of_transmission(number: u16) -> Verdict {
    let seen = both(number, "13", |mps| {
        let block = |text: &[u8]| {
            let bytes: Vec<u8> = [STX]
                .into_iter()
                .chain(text.iter().copied())
                .chain([ETB])
                .collect();
            let check = bytes.iter().fold(0, |check, byte| check ^ byte);
            bytes.into_iter().chain([check]).collect::<Vec<u8>>()
        };
        let first = [[ACK].as_slice(), &block(b"0 BEGIN PGM 1 MM")].concat();
        let last = block(b"1 END PGM 1 MM");
        read(mps, &[&first, &last, &[ETX]]).last().copied()
    });
    same(seen, [Some(EOT), Some(13)])
}

/// Standard interface: 26 + 256 · 25 in place of ETX and STX [001:1897-1921].
fn text_characters(number: u16) -> Verdict {
    let [before, after] = both(number, "6426", printed);
    let replaced: Vec<u8> = before
        .iter()
        .map(|byte| match *byte {
            ETX => 26,
            STX => 25,
            other => other,
        })
        .collect();
    holds(before.contains(&ETX) && replaced == after, || {
        format!("{before:02X?} {after:02X?}")
    })
}

/// 1 is the transfer in blocks, which begins with a header; 0 the program as text [001:1924-1932].
fn mode(number: u16) -> Verdict {
    let found = [0, 1].map(|value: u8| settings(&format!("{number}={value}")).blockwise);
    same(found, [false, true])
}

/// 168: 7 data bits, DC3, even parity, 1 stop bit. Bit 0: 8 data bits; bit 1: a check character is no control character, a
/// blank before ETB makes it one that is printed; bit 2: stop by RTS; bit 3: stop by DC3; bit 4: odd parity; bit 5: parity; bits
/// 6 and 7: stop bits [001:1934-1940] [001:2054-2058].
fn format(number: u16) -> Verdict {
    use bahn_link::Parity::{Even, Odd};
    let frame = |value: u8| {
        let settings = settings(&format!("223=0 {number}={value}"));
        let characters = settings.characters;
        let bits = (characters.data_bits, characters.parity, characters.half_stop_bits);
        (bits, settings.stop_by_rts, settings.with_dc1)
    };
    same(
        [168, 169, 172, 160, 184, 136, 40, 104].map(frame),
        [
            ((7, Some(Even), 2), false, true),
            ((8, Some(Even), 2), false, true),
            ((7, Some(Even), 2), true, true),
            ((7, Some(Even), 2), false, false),
            ((7, Some(Odd), 2), false, true),
            ((7, None, 2), false, true),
            ((7, Some(Even), 3), false, true),
            ((7, Some(Even), 4), false, true),
        ],
    )?;
    // `0 BEGIN PGM 1 MM`: the bytes between STX and the check character; a blank before ETB changes it by 0x20.
    let checks = both(number, "170", |mps| {
        let bytes = written(mps, ACK);
        let blocks = bytes.split(|byte| *byte == ETB).skip(1);
        blocks
            .filter_map(|block| block.first().copied())
            .collect::<Vec<u8>>()
    });
    let control = |checks: &Vec<u8>| checks.iter().any(|check| *check < 0x20);
    holds(
        [control(&checks[0]), control(&checks[1])] == [true, false],
        || format!("{checks:02X?}"),
    )
}

/// MP226 to MP229 set the printer up, MP230 to MP233 stand before each line; the first byte of each four is the number of the
/// others, and the high byte goes first [001:2157-2171].
fn printer(number: u16) -> Verdict {
    let base = "226=1857 227=16963 228=17477 229=17991 230=1889 231=25187 232=25701 233=26215";
    let [before, after] = both(number, "1584", |mps| {
        let printer = HardCopy::of(&list(&format!("{base} {mps}")));
        let bytes = printer.print(512, 8, |_, _| 0);
        bytes.into_iter().take(14).collect::<Vec<u8>>()
    });
    let first = b"ABCDEFGabcdefg".to_vec();
    same(&before, &first)?;
    // 1584 is 6 and `0`: in the first word six characters, elsewhere two others.
    let mut wanted = first;
    match number {
        226 => {
            wanted[0] = b'0';
            wanted.remove(6);
            wanted.push(0);
        }
        230 => {
            wanted[7] = b'0';
            wanted[13] = 0;
        }
        227..=229 => wanted[usize::from(number - 227) * 2 + 1..][..2].copy_from_slice(&[6, b'0']),
        _ => wanted[usize::from(number - 231) * 2 + 8..][..2].copy_from_slice(&[6, b'0']),
    }
    same(after, wanted)
}
