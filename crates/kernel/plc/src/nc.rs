//! What PLC modules need from the control.

mod files;
mod interface;
mod motion;
mod status;
mod table;
#[cfg(feature = "desk")]
mod test;
mod window;

pub use bahn_parameters::compensation::{CompensationExcess, CompensationSize};
pub use files::{LineFault, NotSaved, PalletLine, ParameterFault, ParameterFileFault, TextFile};
pub use interface::{DataInterface, HostLink, HostMessage, InterfaceUser};
pub use motion::{OrientationDirection, PlcAxisCommand, PlcAxisStatus, SpindleOrientation, ToolCallBlock};
pub use status::{ControlledSpindle, CoordinateKind, JogLimit, SpindlePosition, StatusChange, StatusItem};
pub use table::{Column, MemoryTable, TableFile, TableKind};
#[cfg(feature = "desk")]
pub use test::{TestAxis, TestNc};
pub use window::{Bar, Cell, PlcWindow, WindowView};

use bahn_exchange::{Exchange, signal};
use bahn_parameters::{ParameterList, PerPlcAxis};

/// The control as the PLC sees it beside the exchanged operands, by concern. Modules check arguments and machine
/// parameters before they call; an implementation may rely on the ranges that are given here.
pub trait Nc: NcParameters + NcStatus + NcScreen + NcMemory + NcInterfaces + NcMotion {}

impl<T: NcParameters + NcStatus + NcScreen + NcMemory + NcInterfaces + NcMotion> Nc for T {}

/// The machine parameters, as PLC modules read and change them.
pub trait NcParameters {
    /// The machine parameters in force. Presets of timers (MP4110) and counters (MP4120) come from here.
    fn parameters(&self) -> &ParameterList;

    /// A value of the machine parameter list that is edited, whatever 9031 changed (9032).
    ///
    /// # Errors
    /// When the list does not have it, or not as it must be.
    fn editable_parameter(&self, number: u16, index: u8) -> Result<f64, ParameterFault>;

    /// Changes a machine parameter in the run-time memory; the value is within its range. It lasts until
    /// the list is edited and left, or power-off (9031).
    ///
    /// # Errors
    /// When the value cannot be stored.
    fn change_parameter(&mut self, number: u16, index: u8, value: f64) -> Result<(), NotSaved>;

    /// Selects a list of machine parameters by name and extension. When another one was selected, the
    /// control is reset (9033).
    ///
    /// # Errors
    /// When there is no such file in the RAM, or it is faulty.
    fn select_parameter_file(&mut self, name: &str) -> Result<(), ParameterFileFault>;

    /// Whether the control is being reset: 9033 does not return then, and no job goes on [000:14893].
    fn resets(&self) -> bool;
}

/// What the NC does, and where the axes and the spindle are. Axes count from 0: X, Y, Z, 4, 5.
pub trait NcStatus {
    /// Whether an NC program was started.
    fn program_running(&self) -> bool;

    /// Value of an item of status (9035).
    fn status(&self, item: StatusItem) -> i32;

    /// Changes status (9036). A subdivision is limited silently by the rapid traverse of its axis.
    fn change_status(&mut self, change: StatusChange);

    /// Coordinates of all axes in mm or degrees; those of axes that are not active or not referenced may
    /// be anything (9040, 9041).
    fn coordinates(&self, kind: CoordinateKind) -> PerPlcAxis<f64>;

    /// Where the spindle is (9042).
    fn spindle_position(&self) -> SpindlePosition;
}

/// The PLC window, and the texts of the machine.
pub trait NcScreen {
    /// A line of the PLC's message or dialogue file, in the selected language; `None` when it has none.
    fn text_line(&self, file: TextFile, line: u16) -> Option<Vec<u8>>;

    /// The PLC window to write into (9080, 9082, 9083).
    fn window(&mut self) -> &mut PlcWindow;

    /// Whether the PLC window is to be seen (9081).
    fn window_view(&self) -> WindowView;
}

/// Files and tables of the NC memory.
pub trait NcMemory {
    /// Whether the NC memory has a file of this name with extension.
    fn has_file(&self, name: &str) -> bool;

    /// A line of the pallet file with M status (9090).
    ///
    /// # Errors
    /// When there is no such file or line.
    fn pallet_line(&self, line: i32) -> Result<PalletLine, LineFault>;

    /// Selects an existing NC program and perhaps an existing datum table for execution, as a line of the
    /// pallet file says (9090).
    fn select_program(&mut self, line: i32, program: &str, datum_table: Option<&str>);

    /// A line of the compensation assignment (.CMA): the size of each table that it names, `None` for a
    /// table that does not exist (9095).
    ///
    /// # Errors
    /// When there is no such file or line.
    fn compensation_line(&self, line: i32) -> Result<Vec<Option<CompensationSize>>, LineFault>;

    /// Makes an existing line of the compensation assignment the active one, also after a restart (9095).
    fn activate_compensation(&mut self, line: i32);

    /// The table of a kind that has M status; `None` when there is none (9092 to 9094).
    fn table(&mut self, kind: TableKind) -> Option<&mut dyn TableFile>;

    /// Initialises the geometry anew, after a table was written (9094).
    fn initialise_geometry(&mut self);
}

/// The serial interfaces of the control, as modules reach them.
pub trait NcInterfaces {
    /// A data interface: 0 RS-232-C/V.24, any other number RS-422/V.11 (9100 to 9107).
    fn data_interface(&mut self, number: usize) -> &mut DataInterface;

    /// The connection to a host by LSV/2; `None` when there is none (9110, 9111).
    fn host(&mut self) -> Option<&mut HostLink>;
}

/// What modules move and call: PLC axes, spindle, tools. Axes count from 0: X, Y, Z, 4, 5.
pub trait NcMotion {
    /// What a PLC axis was doing when the scan started; commands of the scan show in the next one (9122).
    fn plc_axis_status(&self, axis: usize) -> PlcAxisStatus;

    /// Gives a command to a PLC axis; the last one of a scan is executed after it (9120, 9121, 9123).
    fn command_plc_axis(&mut self, axis: usize, command: PlcAxisCommand);

    /// Sets the override of a PLC axis in percent, 0 to 100; effective after the commands of the scan.
    /// 100 after a restart and an interruption of the PLC (9124).
    fn override_plc_axis(&mut self, axis: usize, percent: f64);

    /// Outputs a voltage from -10 V to 10 V at the spindle's analogue output after the scan (9130).
    fn output_spindle_voltage(&mut self, volts: f64);

    /// Inserts a TOOL CALL: executed when the strobe is acknowledged, at once without a program. The last
    /// one of a strobe is executed (9150).
    fn insert_tool_call(&mut self, block: ToolCallBlock);

    /// Whether the spindle is still being oriented from an earlier scan (9171).
    fn spindle_orienting(&self) -> bool;

    /// Orients the spindle after the scan; the last call of a scan holds. A turning spindle keeps its
    /// direction (9171).
    fn orient_spindle(&mut self, orientation: SpindleOrientation);
}

/// Puts the machine parameters that are meant for the PLC into its words and markers: MP4210 (in 1/10 000),
/// MP4220 and MP4310, the last also as markers M2192-M2239 and M3200-M3263 [000:11665-11742]; TNC 151/155 their
/// MP126-156, MP163-166 and MP158, 249, 250. What the model does not have is 0.
pub fn mirror_parameters(parameters: &ParameterList, exchange: &mut Exchange) {
    let plc_parameters = parameters.plc_parameters();
    let numbers = signal::all().iter().filter_map(|signal| match signal.operand {
        signal::SignalOperand::Number(number) => Some((parameter_of(signal.name)?, number)),
        _ => None,
    });
    for ((parameter, index), number) in numbers {
        let index = usize::from(index);
        let value = match parameter {
            4210 => {
                let position = plc_parameters.positions_mm.get(index);
                position.map(|position| position * 10_000.0)
            }
            4220 => plc_parameters.feeds_mm_min.get(index).copied(),
            4310 => plc_parameters.words.get(index).map(|word| f64::from(*word)),
            _ => None,
        };
        if let Some(value) = value {
            exchange.nc_set_number(number, value.round() as i32);
        }
    }
    let markers = signal::MP4310_0_TO_2_BITS
        .iter()
        .chain(signal::MP4310_3_TO_6_BITS.iter());
    for (position, marker) in markers.enumerate() {
        if let Some(word) = plc_parameters.words.get(position / 16) {
            exchange.nc_set(marker, word >> (position % 16) & 1 != 0);
        }
    }
}

/// `MP4210_3` names machine parameter 4210.3.
fn parameter_of(name: &str) -> Option<(u16, u8)> {
    let (parameter, index) = name.strip_prefix("MP")?.split_once('_')?;
    Some((parameter.parse().ok()?, index.parse().ok()?))
}
