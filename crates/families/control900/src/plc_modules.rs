//! What modules of the PLC would ask of a TNC: a System 900 has none, and programs that call them are refused before they run.

use std::sync::Arc;

use bahn_parameters::{ControlModel, ParameterList, PerPlcAxis};
use bahn_plc::{
    CompensationSize, CoordinateKind, DataInterface, HostLink, LineFault, NcInterfaces, NcMemory, NcMotion,
    NcParameters, NcScreen, NcStatus, NotSaved, PalletLine, ParameterFault, ParameterFileFault,
    PlcAxisCommand, PlcAxisStatus, PlcWindow, SpindleOrientation, SpindlePosition, StatusChange, StatusItem,
    TableFile, TableKind, TextFile, ToolCallBlock, WindowView,
};

/// A control without modules.
#[derive(Clone)]
pub(crate) struct NoModules {
    /// Nothing of it is looked at: timers and counters, which have their presets there, are refused, too.
    parameters: Arc<ParameterList>,
    window: PlcWindow,
    interface: DataInterface,
}

impl Default for NoModules {
    fn default() -> NoModules {
        NoModules {
            parameters: Arc::new(ParameterList::reference(ControlModel::default())),
            window: PlcWindow::default(),
            interface: DataInterface::default(),
        }
    }
}

impl NcParameters for NoModules {
    fn parameters(&self) -> &ParameterList {
        &self.parameters
    }

    fn editable_parameter(&self, _: u16, _: u8) -> Result<f64, ParameterFault> {
        Err(ParameterFault::NoSuchNumber)
    }

    fn change_parameter(&mut self, _: u16, _: u8, _: f64) -> Result<(), NotSaved> {
        Err(NotSaved)
    }

    fn select_parameter_file(&mut self, _: &str) -> Result<(), ParameterFileFault> {
        Err(ParameterFileFault::NotFound)
    }

    fn resets(&self) -> bool {
        false
    }
}

impl NcStatus for NoModules {
    fn program_running(&self) -> bool {
        false
    }

    fn status(&self, _: StatusItem) -> i32 {
        0
    }

    fn change_status(&mut self, _: StatusChange) {}

    fn coordinates(&self, _: CoordinateKind) -> PerPlcAxis<f64> {
        PerPlcAxis::default()
    }

    fn spindle_position(&self) -> SpindlePosition {
        SpindlePosition::default()
    }
}

impl NcScreen for NoModules {
    fn text_line(&self, _: TextFile, _: u16) -> Option<Vec<u8>> {
        None
    }

    fn window(&mut self) -> &mut PlcWindow {
        &mut self.window
    }

    fn window_view(&self) -> WindowView {
        WindowView::default()
    }
}

impl NcMemory for NoModules {
    fn has_file(&self, _: &str) -> bool {
        false
    }

    fn pallet_line(&self, _: i32) -> Result<PalletLine, LineFault> {
        Err(LineFault::NoFile)
    }

    fn select_program(&mut self, _: i32, _: &str, _: Option<&str>) {}

    fn compensation_line(&self, _: i32) -> Result<Vec<Option<CompensationSize>>, LineFault> {
        Err(LineFault::NoFile)
    }

    fn activate_compensation(&mut self, _: i32) {}

    fn table(&mut self, _: TableKind) -> Option<&mut dyn TableFile> {
        None
    }

    fn initialise_geometry(&mut self) {}
}

impl NcInterfaces for NoModules {
    fn data_interface(&mut self, _: usize) -> &mut DataInterface {
        &mut self.interface
    }

    fn host(&mut self) -> Option<&mut HostLink> {
        None
    }
}

impl NcMotion for NoModules {
    fn plc_axis_status(&self, _: usize) -> PlcAxisStatus {
        PlcAxisStatus::default()
    }

    fn command_plc_axis(&mut self, _: usize, _: PlcAxisCommand) {}

    fn override_plc_axis(&mut self, _: usize, _: f64) {}

    fn output_spindle_voltage(&mut self, _: f64) {}

    fn insert_tool_call(&mut self, _: ToolCallBlock) {}

    fn spindle_orienting(&self) -> bool {
        false
    }

    fn orient_spindle(&mut self, _: SpindleOrientation) {}
}
