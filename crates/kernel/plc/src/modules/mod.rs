//! Internal modules 9000 to 9255: called with CM, arguments and results on the data stack
//! [000:14733-16160].

mod address;
mod axes;
mod call;
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

use bahn_exchange::signal;

use crate::PlcError;
pub(crate) use call::Call;
use call::{Outcome, string_number};

/// A module of the control.
#[derive(Clone, Copy)]
pub struct Module {
    /// The number after CM.
    pub number: u16,
    /// What it does, in a few words for lists.
    pub name: &'static str,
    run: Run,
}

/// The work of a module: pulls its arguments, does its work, pushes its results.
type Run = fn(&mut Call<'_>) -> Result<Outcome, PlcError>;

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
    /// The module that CM calls by this number; `None` where the control has none.
    pub fn find(number: u16) -> Option<&'static Module> {
        MODULES.iter().find(|module| module.number == number)
    }
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
}

impl std::fmt::Debug for Module {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.number, self.name)
    }
}
