//! Where the mechanics of the machine stood when it was written, as a file: with all that the control kept at that moment.
//!
//! Mechanics, PLC and control only make sense together: an arm that is half way, and a PLC that knows of no change, are a
//! crash. So this file is written first, in one step, with the memory of the PLC and what the control remembers in it, and then
//! the files of these. Who finds one of them as it was before finishes what was begun: whenever the process ends, everything is as
//! it was at one moment. Whatever else is found there was changed from outside, and is said.
//!
//! Decision: Mechanics, PLC and control are kept as they were at one moment: `mechanics.toml` holds all of it and is
//! written first, in one step; who finds the other files as they were before finishes them. Where they are otherwise
//! each counts for its own, and that is said with the tools that are elsewhere (also `host/src/power_on.rs`)

use bahn_machine::Mechanics;
use serde::{Deserialize, Serialize};

use super::remembered;

/// The form of the file.
const VERSION: u32 = 1;

/// Comment of the first lines.
const HEAD: &str = "\
# Where the mechanics of the simulated machine stand over power-off, with the memory of the PLC and what the control
# remembers at that moment. It is written by itself. Without it everything stands as at the start of the plant, and tools
# where the control remembers them.
";

/// A moment of the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Moment {
    version: u32,
    /// Check sum of the pockets of tool and pocket table.
    pub pockets: u32,
    /// The retained memory of the PLC.
    pub plc: Part,
    /// What the control remembers, of each channel.
    pub control: Vec<Part>,
    /// Where axes, spindle and tools of the simulated machine stand.
    pub mechanics: Mechanics,
}

/// A file that goes with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Part {
    /// Check sums of what it held before, and holds now.
    before: u32,
    now: u32,
    /// What it holds now: text, or bytes as hexadecimal digits.
    pub content: String,
}

/// How a file is found beside the moment that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// As it was written.
    Same,
    /// As it was before: the process ended before it was written.
    Before,
    /// Somebody has written it since.
    Other,
}

impl Part {
    /// A file that held content with the one check sum, and holds this with the other one now.
    pub fn new([before, now]: [u32; 2], content: String) -> Part {
        Part { before, now, content }
    }

    /// How its file is found, by the content.
    pub fn find(&self, sum: u32) -> Found {
        match sum {
            sum if sum == self.now => Found::Same,
            sum if sum == self.before => Found::Before,
            _ => Found::Other,
        }
    }
}

impl Moment {
    pub fn new(pockets: u32, plc: Part, control: Vec<Part>, mechanics: Mechanics) -> Moment {
        Moment {
            version: VERSION,
            pockets,
            plc,
            control,
            mechanics,
        }
    }

    /// The same moment but for what moves all the time, axes and spindles.
    pub fn differs_only_in_movement(&self, other: &Moment) -> bool {
        let contents = |moment: &Moment| {
            let control = moment.control.iter().map(|part| part.content.clone());
            control.chain([moment.plc.content.clone()]).collect::<Vec<_>>()
        };
        let rest = |moment: &Moment| Mechanics {
            axis: Vec::new(),
            spindle: Vec::new(),
            ..moment.mechanics.clone()
        };
        contents(self) == contents(other) && rest(self) == rest(other)
    }

    /// Everything is as in another moment, whatever was before.
    pub fn says_the_same(&self, other: &Moment) -> bool {
        self.differs_only_in_movement(other) && self.mechanics == other.mechanics
    }

    /// As a file, with its end mark.
    ///
    /// # Errors
    /// When it cannot be said as text.
    pub fn write(&self) -> Result<String, String> {
        let text = toml::to_string(self).map_err(|error| error.to_string())?;
        Ok(remembered::with_end(format!("{HEAD}{text}")))
    }

    /// What a file says.
    ///
    /// # Errors
    /// What of it is damaged.
    pub fn read(file: &[u8]) -> Result<Moment, String> {
        #[derive(Deserialize)]
        struct Version {
            version: u32,
        }
        let text = remembered::whole(file)?;
        let Version { version } = toml::from_str(text).map_err(|error| error.message().to_owned())?;
        if version != VERSION {
            return Err(format!("it has the form {version}, this program reads {VERSION}"));
        }
        toml::from_str(text).map_err(|error| error.message().to_owned())
    }
}

/// Check sum of what the control remembers, without the last line, which says how the file ends.
pub(super) fn sum_of_text(text: &str) -> u32 {
    crc32fast::hash(remembered::split_end(text.as_bytes()).0)
}

/// Bytes as hexadecimal digits.
pub(super) fn digits(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The bytes of hexadecimal digits; `None` when they are something else.
pub(super) fn bytes(digits: &str) -> Option<Vec<u8>> {
    let pairs = digits.as_bytes().chunks(2).map(|pair| {
        let text = str::from_utf8(pair).ok().filter(|text| text.len() == 2)?;
        u8::from_str_radix(text, 16).ok()
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    fn moment() -> Moment {
        let mechanics = Mechanics {
            axis: vec![bahn_machine::AxisPlace {
                letter: 'X',
                table: 0.1 + 0.2,
                motor: -1e-9,
            }],
            spindle: Vec::new(),
            device: Vec::new(),
            magazine: None,
            by_hand: [1, 2],
            probe_deg: Some(12.5),
        };
        let control = Part::new([7, 8], "tool = 3\n# end, check 1\n".to_owned());
        Moment::new(
            3,
            Part::new([4, 5], digits(&[0, 255, 16])),
            vec![control],
            mechanics,
        )
    }

    #[test]
    fn what_is_written_is_read_again() {
        let text = moment().write().unwrap();
        assert_eq!(Moment::read(text.as_bytes()), Ok(moment()), "{text}");
        assert_eq!(bytes(&digits(&[0, 255, 16])), Some(vec![0, 255, 16]));
        assert_eq!(bytes("0"), None);
    }

    /// No part is taken for the whole, and no other form for this one.
    #[test]
    fn a_damaged_file_is_not_half_taken() {
        let text = moment().write().unwrap();
        for end in 0..text.len() - 1 {
            assert!(Moment::read(&text.as_bytes()[..end]).is_err(), "{end}");
        }
        let edited = text.replace("table = 0.3", "table = 0.4");
        assert_eq!(
            Moment::read(edited.as_bytes()),
            Err("its check sum is wrong".to_owned())
        );
        let mended = |text: &str| {
            let content = &text[..text.rfind("# end").unwrap()];
            format!("{content}{}\n", remembered::MENDED)
        };
        assert!(Moment::read(mended(&edited).as_bytes()).is_ok());
        let newer = mended(&text.replace("version = 1", "version = 2\nnew = 1"));
        assert_eq!(
            Moment::read(newer.as_bytes()),
            Err("it has the form 2, this program reads 1".to_owned())
        );
        let more = mended(&text.replace("by_hand", "with_hand"));
        assert!(Moment::read(more.as_bytes()).is_err());
    }
}
