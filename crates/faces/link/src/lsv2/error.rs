//! Numbers of errors.

use std::fmt;

use super::{Command, Telegram};
use bahn_store::StoreError;

/// Class of the errors that a telegram may have, the first byte of `T_ER`.
const CLASS: u8 = 1;

/// The number of an error in `T_ER` and `T_BD` (public).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ErrorNumber(pub u8);

macro_rules! numbers {
    ($($name:ident $number:literal $text:literal;)+) => {
        impl ErrorNumber {
            $(
                #[doc = concat!("`", stringify!($number), "`: ", $text, ".")]
                pub const $name: ErrorNumber = ErrorNumber($number);
            )+

            /// The meaning of an error number; `None` where no source gives it.
            pub fn meaning(self) -> Option<&'static str> {
                match self.0 {
                    $($number => Some($text),)+
                    _ => None,
                }
            }
        }
    };
}

numbers! {
    BAD_FORMAT 20 "the telegram has another form";
    UNEXPECTED 21 "the telegram is not expected here";
    UNKNOWN 22 "the telegram is unknown";
    NO_PRIVILEGE 23 "the login does not allow it";
    WRONG_PARAMETER 24 "a parameter is wrong";
    WRONG_PASSWORD 30 "the password is wrong";
    BAD_NAME 31 "that is no name of a file";
    NO_FILE 32 "there is no such file";
    CANNOT_OPEN 33 "the file cannot be opened";
    FILE_EXISTS 34 "there is such a file";
    BAD_FILE 35 "such a file is not allowed";
    NO_DELETE 36 "the file cannot be deleted";
    NO_NEW_FILE 37 "the file cannot be made";
    NO_ATTRIBUTE 38 "the attribute cannot be changed";
    KEY_REFUSED 39 "the key is refused";
    NO_PARAMETER 40 "there is no such machine parameter";
    FILE_ACCESS 45 "the file is in use";
    WRONG_DNC_STATE 46 "not in this state of the transfer";
    NO_RENAME 48 "the file cannot be renamed";
    NO_LOGIN 49 "there is no login";
    BAD_VALUE 50 "the value is not allowed";
    BAD_NUMBER 51 "that is no number";
    BAD_ADDRESS 52 "there is no such address";
    NO_SPACE 53 "there is no room";
    FOLDER_NOT_EMPTY 54 "the folder cannot be removed";
    NO_FOLDER 55 "there is no such folder";
    WRONG_MODE 56 "not in this operating mode";
    NO_NEXT_ERROR 57 "there is no further message";
    NO_WRITE 59 "it cannot be written";
    REFERENCE_NEEDED 61 "the axes have to pass their reference marks first";
    BUFFER_FULL 62 "the buffer of the PLC is full";
    TOO_MANY 80 "there are too many connections";
    BLOCK_NO_FILE 100 "the file of the blocks cannot be made";
    BLOCK_NO_SPACE 101 "there is no room for the block";
    BLOCK_BAD_FORMAT 103 "the block has another form";
    BLOCK_BAD 104 "the block cannot be taken";
}

impl fmt::Display for ErrorNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.meaning() {
            Some(meaning) => write!(f, "{meaning} (error {})", self.0),
            None => write!(f, "error {}", self.0),
        }
    }
}

impl ErrorNumber {
    /// The telegram that says so.
    pub fn telegram(self) -> Telegram {
        Telegram::new(Command::T_ER).byte(CLASS).byte(self.0)
    }

    /// The telegram that says so of a block of a file.
    pub fn of_block(self) -> Telegram {
        Telegram::new(Command::T_BD).byte(CLASS).byte(self.0)
    }

    /// The number in a telegram that says so.
    pub fn of(telegram: &Telegram) -> Option<ErrorNumber> {
        let says_so = [Command::T_ER, Command::T_BD].contains(&telegram.command);
        let number = telegram.data.last().copied().unwrap_or_default();
        says_so.then_some(ErrorNumber(number))
    }
}

impl From<&StoreError> for ErrorNumber {
    fn from(error: &StoreError) -> ErrorNumber {
        match error {
            StoreError::BadName(_) => ErrorNumber::BAD_NAME,
            StoreError::NoFile(_) => ErrorNumber::NO_FILE,
            StoreError::NoFolder(_) => ErrorNumber::NO_FOLDER,
            StoreError::Exists(_) => ErrorNumber::FILE_EXISTS,
            StoreError::Protected(_) => ErrorNumber::NO_WRITE,
            StoreError::Busy(_) | StoreError::InUse(_) => ErrorNumber::FILE_ACCESS,
            StoreError::NotEmpty(_) => ErrorNumber::FOLDER_NOT_EMPTY,
            StoreError::DirectoryFull | StoreError::DiskFull => ErrorNumber::NO_SPACE,
            StoreError::Medium(_) => ErrorNumber::CANNOT_OPEN,
        }
    }
}
