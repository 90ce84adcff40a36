//! What a screen shows, as module 9035 tells it to the PLC [000:14899-14916].

use std::fmt;

use bahn_plc::StatusItem;

/// `screen EDITING MACHINE WINDOWS FILE UNITS`: items 2 to 5 and 17 of module 9035, in its numbers. Without a screen all are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenCommand {
    /// Mode over the editing screen: 0 none, 1 mode, 2 directory, 3 machine parameters, 4 PLC.
    pub editing: u8,
    /// Mode over the machine screen: 0 none, 1 mode, 2 directory, 3 tool table.
    pub machine: u8,
    /// Windows of both screens, bit by bit.
    pub windows: u16,
    /// File in editing or test run: 0 none, 1 .H, 2 .I, 3 .T, 4 .D, 5 .P, 6 .A, 7 .S.
    pub file: u8,
    /// The display is in inches.
    pub inch: bool,
}

/// The greatest number of each word.
const GREATEST: [u16; 5] = [4, 3, u16::MAX, 7, 1];

impl ScreenCommand {
    /// What stands after `screen`.
    pub(crate) fn parse(text: &str) -> Result<ScreenCommand, String> {
        let wrong = || "`screen` takes five numbers: items 2, 3, 4, 5 and 17 of module 9035".to_owned();
        let mut words = text.split_whitespace();
        let mut numbers = GREATEST.map(|_| 0);
        for (number, greatest) in numbers.iter_mut().zip(GREATEST) {
            let word = words.next().and_then(|word| word.parse().ok());
            *number = word.filter(|number| *number <= greatest).ok_or_else(wrong)?;
        }
        let [editing, machine, windows, file, inch] = numbers;
        match words.next() {
            None => Ok(ScreenCommand {
                editing: editing as u8,
                machine: machine as u8,
                windows,
                file: file as u8,
                inch: inch == 1,
            }),
            Some(_) => Err(wrong()),
        }
    }

    /// The items of module 9035.
    pub(crate) fn items(&self) -> [(StatusItem, i32); 5] {
        [
            (StatusItem::EditingOverlay, self.editing.into()),
            (StatusItem::MachineOverlay, self.machine.into()),
            (StatusItem::Windows, self.windows.into()),
            (StatusItem::EditedFile, self.file.into()),
            (StatusItem::Units, self.inch.into()),
        ]
    }
}

impl fmt::Display for ScreenCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [(_, first), rest @ ..] = self.items();
        write!(f, "{first}")?;
        rest.iter().try_for_each(|(_, number)| write!(f, " {number}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_screen() {
        for text in ["0 0 0 0 0", "4 3 65535 7 1", "2 0 257 3 0"] {
            assert_eq!(
                ScreenCommand::parse(text).map(|screen| screen.to_string()),
                Ok(text.to_owned())
            );
        }
        for wrong in [
            "",
            "0 0 0 0",
            "5 0 0 0 0",
            "0 4 0 0 0",
            "0 0 65536 0 0",
            "0 0 0 8 0",
            "0 0 0 0 2",
            "0 0 0 0 0 0",
        ] {
            assert!(ScreenCommand::parse(wrong).is_err(), "{wrong}");
        }
    }
}
