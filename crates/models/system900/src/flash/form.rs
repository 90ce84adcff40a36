//! The FLASH as bytes: a text with a check sum, whole or not there.
//!
//! Decision: Head, a line for each parameter with its four bytes as a number and its status, a line for each switch, each
//! program with its name, its length and its bytes as they are, and a check sum over all that stands before it. The programs
//! stand in it as people read them

use std::str::FromStr;

use super::{Flash, STORED_BYTES_MAX, STORED_MAX, Switches};
use crate::array::{Cell, PARAMETERS_MAX};
use crate::memory::Place;
use crate::numbers::{AXES, AXIS_OWN, CHANNELS_MAX};
use crate::programs::ProgramName;
use crate::status::Status;

/// The first line.
const HEAD: &[u8] = b"bahn flash 1\n";
/// Before the check sum.
const CHECK: &[u8] = b"check ";
/// Digits of the check sum.
const DIGITS: usize = 8;

/// Why bytes are no FLASH.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoFlash {
    /// They begin otherwise.
    #[error("it does not begin as the file of a FLASH")]
    Head,
    /// Something is missing or was changed: the check sum is another one.
    #[error("the file of the FLASH is not whole")]
    NotWhole,
    /// A line says nothing, though the check sum fits.
    #[error("line {0} of the file of the FLASH says nothing")]
    Line(usize),
}

impl Flash {
    /// As bytes; what the directory shows is not kept.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = HEAD.to_vec();
        let mut line = |text: String| bytes.extend_from_slice(text.as_bytes());
        for (place, cell) in &self.parameters {
            let name = match place {
                Place::Q(number) => format!("q{number}"),
                Place::OfChannel(channel, logical, offset) => format!("{channel}:{logical}:{offset}"),
            };
            line(format!("{name} {} {}\n", cell.mantissa, cell.status));
        }
        for (word, _) in words(self.switches).iter().filter(|(_, is_set)| *is_set) {
            line(format!("switch {word}\n"));
        }
        for (name, program) in self.programs.iter() {
            bytes.extend_from_slice(format!("program {name} {}\n", program.len()).as_bytes());
            bytes.extend_from_slice(program);
            bytes.push(b'\n');
        }
        let sum = crc32fast::hash(&bytes);
        bytes.extend_from_slice(CHECK);
        bytes.extend_from_slice(format!("{sum:08x}\n").as_bytes());
        bytes
    }

    /// Of bytes.
    ///
    /// # Errors
    /// When they are no FLASH, or not all of one.
    pub fn read(bytes: &[u8]) -> Result<Flash, NoFlash> {
        if !bytes.starts_with(HEAD) && !HEAD.starts_with(bytes) {
            return Err(NoFlash::Head);
        }
        let end = bytes.len().checked_sub(CHECK.len() + DIGITS + 1);
        let (content, check) = end
            .and_then(|end| bytes.split_at_checked(end))
            .ok_or(NoFlash::NotWhole)?;
        let mut wanted = CHECK.to_vec();
        wanted.extend_from_slice(format!("{:08x}\n", crc32fast::hash(content)).as_bytes());
        if check != wanted {
            return Err(NoFlash::NotWhole);
        }
        let mut flash = Flash::default();
        let mut rest = content.get(HEAD.len()..).ok_or(NoFlash::NotWhole)?;
        let mut number = 1;
        while !rest.is_empty() {
            number += 1;
            rest = flash.line(rest).ok_or(NoFlash::Line(number))?;
        }
        Ok(flash)
    }

    /// Reads what stands first; the bytes after it. `None` when it says nothing.
    fn line<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let end = bytes.iter().position(|byte| *byte == b'\n')?;
        let text = std::str::from_utf8(bytes.get(..end)?).ok()?;
        let rest = bytes.get(end + 1..)?;
        let words: Vec<&str> = text.split(' ').collect();
        match *words.as_slice() {
            ["program", name, length] => {
                let (program, after) = rest.split_at_checked(length.parse().ok()?)?;
                let name = ProgramName::from_str(name)
                    .ok()
                    .filter(|_| self.programs.bytes() + program.len() <= STORED_BYTES_MAX)?;
                let is_new = self.programs.get(name).is_none();
                self.programs.insert(name, program.to_vec());
                after.strip_prefix(b"\n").filter(|_| is_new)
            }
            ["switch", word] => {
                let switch = match word {
                    "no_dll" => &mut self.switches.no_dll,
                    "no_dma" => &mut self.switches.no_dma,
                    "plc_big" => &mut self.switches.plc_big,
                    _ => return None,
                };
                *switch = true;
                Some(rest)
            }
            [name, mantissa, status] if self.parameters.len() < STORED_MAX => {
                let (mantissa, status) = (mantissa.parse().ok()?, status.parse::<Status>().ok()?);
                let before = self.parameters.insert(place(name)?, Cell { mantissa, status });
                before.is_none().then_some(rest)
            }
            _ => None,
        }
    }
}

/// The switches by their words.
fn words(switches: Switches) -> [(&'static str, bool); 3] {
    [
        ("no_dll", switches.no_dll),
        ("no_dma", switches.no_dma),
        ("plc_big", switches.plc_big),
    ]
}

fn place(name: &str) -> Option<Place> {
    if let Some(number) = name.strip_prefix('q') {
        let number: u32 = number.parse().ok()?;
        return ((number as usize) < PARAMETERS_MAX).then_some(Place::Q(number));
    }
    let mut parts = name.split(':');
    let mut next = || parts.next()?.parse::<u32>().ok();
    let (channel, logical, offset) = (next()?, next()?, next()?);
    let is_there = (1..=u32::from(CHANNELS_MAX)).contains(&channel)
        && (1..=u32::from(AXES)).contains(&logical)
        && AXIS_OWN.contains(&offset)
        && parts.next().is_none();
    let place = Place::OfChannel(channel.try_into().ok()?, logical.try_into().ok()?, offset);
    is_there.then_some(place)
}
