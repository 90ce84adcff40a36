//! Internal modules 9000 to 9255: called with CM, arguments and results on the data stack
//! [000:14733-16160].

mod axes;
mod coordinates;
mod files;
mod host;
mod interface;
mod memory;
mod numbers;
mod parameters;
mod spindle;
mod status;
mod strings;
mod tables;
mod window;

use bahn_exchange::{Image, Number, Size, signal};

use crate::run::{DataStack, Text};
use crate::{Nc, PlcError, TextFile};

/// A module of the control.
#[derive(Clone, Copy)]
pub struct Module {
    /// The number behind CM.
    pub number: u16,
    /// What it does.
    pub name: &'static str,
    run: Run,
}

/// The work of a module: pulls its arguments, does its work, pushes its results.
type Run = fn(&mut Call<'_>) -> Result<Outcome, PlcError>;

/// How a call ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// M3171 becomes 0.
    Done,
    /// M3171 becomes 1.
    Failed,
    /// M3171 keeps its value.
    Untouched,
}

impl Outcome {
    /// Done or failed.
    fn of(done: bool) -> Outcome {
        if done { Outcome::Done } else { Outcome::Failed }
    }
}

/// All modules by number.
pub fn modules() -> &'static [Module] {
    MODULES
}

const MODULES: &[Module] = &[
    row(9000, "copy in marker range", memory::copy_markers),
    row(9001, "copy in word range", memory::copy_bytes),
    row(9010, "read byte", memory::read_byte),
    row(9011, "read word", memory::read_word),
    row(9012, "read doubleword", memory::read_double),
    row(9020, "write byte", memory::write_byte),
    row(9021, "write word", memory::write_word),
    row(9022, "write doubleword", memory::write_double),
    row(9031, "overwrite machine parameter", parameters::overwrite),
    row(9032, "read machine parameter", parameters::read),
    row(9033, "select machine parameter file", parameters::select_file),
    row(9035, "read status information", status::read),
    row(9036, "write status information", status::write),
    row(
        9040,
        "read coordinates in 1/1000 mm",
        coordinates::read_thousandths,
    ),
    row(
        9041,
        "read coordinates in 1/10000 mm",
        coordinates::read_ten_thousandths,
    ),
    row(9042, "read spindle coordinates", coordinates::read_spindle),
    row(9050, "binary to ASCII with exponent", numbers::to_text),
    row(9051, "binary to ASCII with format", numbers::to_formatted_text),
    row(9052, "ASCII to binary", numbers::from_text),
    row(9053, "binary to ASCII hexadecimal", numbers::to_hexadecimal),
    row(9054, "ASCII hexadecimal to binary", numbers::from_hexadecimal),
    row(9070, "copy number from string", strings::copy_number),
    row(9071, "string length", strings::length),
    row(9080, "delete PLC window", window::clear),
    row(9081, "interrogate PLC window", window::status),
    row(9082, "display string", window::show_text),
    row(9083, "display bar chart", window::show_bar),
    row(9090, "execute pallet program", files::execute_pallet_program),
    row(9092, "search in table", tables::search),
    row(9093, "read table data", tables::read),
    row(9094, "write table data", tables::write),
    row(9095, "select axis error compensation", files::select_compensation),
    row(9100, "assign data interface", interface::assign),
    row(9101, "release data interface", interface::release),
    row(9102, "status of data interface", interface::status),
    row(9103, "transmit string", interface::transmit_text),
    row(9104, "receive string", interface::receive_text),
    row(9105, "transmit binary data", interface::transmit_bytes),
    row(9106, "receive binary data", interface::receive_bytes),
    row(9107, "read from receive buffer", interface::peek),
    row(9110, "transmit message by LSV/2", host::transmit),
    row(9111, "read message by LSV/2", host::receive),
    row(9120, "start PLC axis", axes::start),
    row(9121, "stop PLC axis", axes::stop),
    row(9122, "status of PLC axis", axes::status),
    row(
        9123,
        "traverse reference marks of PLC axis",
        axes::traverse_reference_marks,
    ),
    row(9124, "override of PLC axis", axes::set_override),
    row(9130, "output analogue voltage", spindle::output_voltage),
    row(9150, "insert NC block", spindle::insert_block),
    row(9171, "orient spindle", spindle::orient),
];

const fn row(number: u16, name: &'static str, run: Run) -> Module {
    Module { number, name, run }
}

impl Module {
    /// The module of a number.
    pub fn find(number: u16) -> Option<&'static Module> {
        MODULES.iter().find(|module| module.number == number)
    }
}

impl std::fmt::Debug for Module {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.number, self.name)
    }
}

/// A call of a module: what it may reach.
pub(crate) struct Call<'a> {
    pub(crate) image: &'a mut Image,
    pub(crate) stack: &'a mut DataStack,
    pub(crate) nc: &'a mut dyn Nc,
    /// Whether a submit job calls; many modules may be called from there only.
    pub(crate) from_submit: bool,
}

impl Call<'_> {
    /// Runs a module and sets the error status M3171 [000:14739].
    pub(crate) fn run(&mut self, number: u16) -> Result<(), PlcError> {
        let module = Module::find(number).ok_or(PlcError::ModuleNotDefined)?;
        match (module.run)(self)? {
            Outcome::Done => self.image.set_bit(signal::MODULE_ERROR, false),
            Outcome::Failed => self.image.set_bit(signal::MODULE_ERROR, true),
            Outcome::Untouched => {}
        }
        Ok(())
    }

    /// Pulls the arguments; they are given in the order of the manual, in which the program pushed them.
    fn arguments<const N: usize>(&mut self) -> Result<[i32; N], PlcError> {
        let mut arguments = [0; N];
        for argument in arguments.iter_mut().rev() {
            *argument = self.stack.pull()?;
        }
        Ok(arguments)
    }

    /// Pushes a result. With several, the one that the program pulls first is pushed last. A module that
    /// failed pushes its results all the same, so that the program's PL find something: 0 (inferred).
    fn result(&mut self, value: i32) -> Result<(), PlcError> {
        self.stack.push(value)
    }

    /// Pushes the result of a module, 0 when it failed.
    fn result_or_failed(&mut self, value: Option<i32>) -> Result<Outcome, PlcError> {
        self.result(value.unwrap_or(0))?;
        Ok(Outcome::of(value.is_some()))
    }

    /// Pushes an error code; 0 means done.
    fn code(&mut self, code: i32) -> Result<Outcome, PlcError> {
        self.result(code)?;
        Ok(Outcome::of(code == 0))
    }

    /// Whether an NC program runs and no strobe is active: some modules work during the strobes only,
    /// once a program was started [000:14897][000:15556].
    fn runs_without_strobe(&self) -> bool {
        const STROBES: [bahn_exchange::Bit; 6] = [
            signal::M_FUNCTION_STROBE,
            signal::GEAR_STROBE,
            signal::S_STROBE,
            signal::TOOL_CALL_STROBE,
            signal::TOOL_DEF_STROBE,
            signal::FN19_STROBE,
        ];
        self.nc.program_running() && !STROBES.iter().any(|strobe| self.image.bit(*strobe))
    }

    /// A machine parameter in force; 0 when the model does not have it (inferred).
    fn parameter(&self, number: u16, index: u8) -> f64 {
        self.nc.parameters().get(number, index).unwrap_or(0.0)
    }

    /// A string with its end found; `None` for a wrong number and for a memory without end character.
    fn text(&self, string: i32) -> Option<Text> {
        let string = usize::try_from(string).ok()?;
        self.image.string(string).contains(&0).then_some(())?;
        self.image.text(string).try_into().ok()
    }

    /// Stores a string; false for a wrong number and for a text of more than 127 characters.
    fn set_text(&mut self, string: i32, text: &[u8]) -> bool {
        match string_number(string) {
            Some(string) if text.len() < bahn_exchange::STRING_LENGTH => {
                self.image.set_text(string, text);
                true
            }
            _ => false,
        }
    }

    /// A text as it is shown and sent: references to lines of the message and dialogue files are replaced.
    /// A line that the file does not have becomes `@` [000:14079-14084].
    fn resolved(&self, text: &[u8]) -> Vec<u8> {
        let mut resolved = Vec::new();
        let mut rest = text;
        while let Some((&first, behind)) = rest.split_first() {
            rest = behind;
            match reference(first, behind) {
                Some((file, line, length)) => {
                    let text = self.nc.text_line(file, line);
                    resolved.extend(text.unwrap_or_else(|| b"@".to_vec()));
                    rest = behind.get(length..).unwrap_or_default();
                }
                None => resolved.push(first),
            }
        }
        resolved
    }

    /// Bytes of the word memory; `None` when they do not lie inside it, the first address does not, or they
    /// are more than a string has characters.
    fn bytes(&self, first: i32, length: i32) -> Option<Text> {
        let inside = first < memory::BYTES && memory::fits(first, length, memory::BYTES);
        let few = usize::try_from(length).is_ok_and(|length| length <= bahn_exchange::STRING_LENGTH);
        (inside && few).then_some(())?;
        let byte = |address| Some(self.image.number(memory::operand(Size::Byte, address)?) as u8);
        (first..first + length).map(byte).collect()
    }

    /// Writes bytes into the word memory; false when there is no room, or the first address is outside.
    fn set_bytes(&mut self, first: i32, bytes: &[u8]) -> bool {
        let length = i32::try_from(bytes.len()).unwrap_or(i32::MAX);
        if first >= memory::BYTES || !memory::fits(first, length, memory::BYTES) {
            return false;
        }
        for (address, byte) in (first..).zip(bytes) {
            if let Some(number) = memory::operand(Size::Byte, address) {
                self.image.set_number(number, i32::from(*byte));
            }
        }
        true
    }

    /// Writes doublewords one behind the other; false when the first address is not divisible by 4 or
    /// there is no room for all.
    fn set_doubles(&mut self, first: i32, values: &[i32]) -> bool {
        let length = i32::try_from(4 * values.len()).unwrap_or(i32::MAX);
        let fits = first < memory::BYTES && memory::fits(first, length, memory::BYTES);
        if first % 4 != 0 || !fits {
            return false;
        }
        for (address, value) in (first..).step_by(4).zip(values) {
            if let Some(number) = self.double(address) {
                self.image.set_number(number, *value);
            }
        }
        true
    }

    /// A doubleword by its address.
    fn double(&self, address: i32) -> Option<Number> {
        memory::operand(Size::Double, address)
    }
}

/// The number of a string memory.
fn string_number(string: i32) -> Option<usize> {
    usize::try_from(string)
        .ok()
        .filter(|string| *string < bahn_exchange::STRINGS)
}

/// The reference that begins here: file, line, and characters behind its first one. Line numbers have
/// three digits, from 1000 on four; so four are taken unless the first one is 0 (inferred).
fn reference(first: u8, behind: &[u8]) -> Option<(TextFile, u16, usize)> {
    const SUBSTITUTE: u8 = 0x1a;
    let (SUBSTITUTE, [letter, digits @ ..]) = (first, behind) else {
        return None;
    };
    let file = match letter {
        b'E' => TextFile::Messages,
        b'D' => TextFile::Dialogues,
        _ => return None,
    };
    let most = if digits.first() == Some(&b'0') { 3 } else { 4 };
    let count = digits
        .iter()
        .take(most)
        .take_while(|digit| digit.is_ascii_digit())
        .count();
    let line = std::str::from_utf8(digits.get(..count)?).ok()?.parse().ok()?;
    (count >= 3).then_some((file, line, count + 1))
}
