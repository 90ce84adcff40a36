//! A control on a desk.

use std::collections::{BTreeMap, BTreeSet};

use bahn_parameters::{ParameterList, PerPlcAxis};

use super::{
    CompensationSize, CoordinateKind, DataInterface, HostLink, LineFault, MemoryTable, NcInterfaces,
    NcMemory, NcMotion, NcParameters, NcScreen, NcStatus, NotSaved, PalletLine, ParameterFault,
    ParameterFileFault, PlcAxisCommand, PlcAxisStatus, PlcWindow, SpindleOrientation, SpindlePosition,
    StatusChange, StatusItem, TableFile, TableKind, TextFile, ToolCallBlock, WindowView,
};

/// A stand-in for the control on a desk: what modules read is set in its fields, what they do is found
/// there. [`TestNc::end_scan`] passes the commands of a scan on to the axes, [`TestNc::travel`] moves them.
#[derive(Clone, Debug)]
pub struct TestNc {
    /// The machine parameter list, as it is edited.
    pub parameters: ParameterList,
    /// The list with what 9031 changed.
    changed_parameters: Option<ParameterList>,
    /// Lines of the list that are faulty, for 9032.
    pub parameter_faults: BTreeMap<(u16, u8), ParameterFault>,
    /// 9031 fails to save.
    pub saving_fails: bool,
    /// Machine parameter lists in the RAM; `None` for a faulty one.
    pub parameter_files: BTreeMap<String, Option<ParameterList>>,
    /// The selected machine parameter list.
    pub parameter_file: String,
    /// How often the control was reset by 9033.
    pub restarts: u32,
    /// It was in this scan.
    pub resets: bool,
    /// An NC program was started.
    pub program_running: bool,
    /// Lines of the PLC error messages.
    pub messages: Vec<String>,
    /// Lines of the PLC dialogues.
    pub dialogues: Vec<String>,
    /// Status; 0 where nothing is set.
    pub status: BTreeMap<StatusItem, i32>,
    /// What 9036 changed, in this order.
    pub status_changes: Vec<StatusChange>,
    /// Coordinates in mm or degrees; those of [`TestNc::axes`] where nothing is set.
    pub coordinates: BTreeMap<CoordinateKind, PerPlcAxis<f64>>,
    /// Angles of the spindle.
    pub spindle: SpindlePosition,
    /// What the PLC has written into its window.
    pub window: PlcWindow,
    /// Whether the PLC window is to be seen.
    pub window_view: WindowView,
    /// Files of the NC memory.
    pub files: BTreeSet<String>,
    /// Lines of the pallet file with M status.
    pub pallet: Option<Vec<PalletLine>>,
    /// The selected NC program.
    pub program: Option<String>,
    /// The selected datum table.
    pub datum_table: Option<String>,
    /// Lines of the compensation assignment: names of tables.
    pub compensation: Option<Vec<Vec<String>>>,
    /// Sizes of the compensation tables, by their names.
    pub compensation_tables: BTreeMap<String, CompensationSize>,
    /// The active line of the compensation assignment.
    pub compensation_line: i32,
    /// Tables with M status.
    pub tables: BTreeMap<TableKind, MemoryTable>,
    /// How often the geometry was initialised.
    pub geometry_initialised: u32,
    /// The two interfaces: RS-232-C/V.24 and RS-422/V.11.
    pub interfaces: [DataInterface; 2],
    /// The connection to a host.
    pub host: Option<HostLink>,
    /// The axes X, Y, Z, 4, 5.
    pub axes: PerPlcAxis<TestAxis>,
    /// Output at the spindle's analogue output in V.
    pub spindle_voltage: f64,
    /// The TOOL CALL that was inserted last.
    pub tool_call: Option<ToolCallBlock>,
    /// The spindle is being oriented from an earlier scan.
    pub orienting: bool,
    /// The orientation that was asked for last.
    pub orientation: Option<SpindleOrientation>,
}

/// An axis of [`TestNc`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestAxis {
    /// Where it is in mm or degrees.
    pub position: f64,
    /// What modules read of it.
    pub status: PlcAxisStatus,
    /// Override that acts on it, %.
    pub override_percent: f64,
    /// The command that is executed.
    pub command: Option<PlcAxisCommand>,
    /// The last command of this scan.
    pub next_command: Option<PlcAxisCommand>,
    /// Where the movement leads to in mm or degrees.
    pub destination: f64,
}

impl Default for TestAxis {
    fn default() -> TestAxis {
        TestAxis {
            position: 0.0,
            status: PlcAxisStatus::default(),
            override_percent: 100.0,
            command: None,
            next_command: None,
            destination: 0.0,
        }
    }
}

impl TestAxis {
    /// How far away the next reference mark is, in mm or degrees.
    const REFERENCE_MARK: f64 = 1.0;

    /// Executes the last command of a scan.
    fn end_scan(&mut self) {
        let Some(command) = self.next_command.take() else {
            return;
        };
        self.command = Some(command);
        match command {
            PlcAxisCommand::Start {
                target, incremental, ..
            } => {
                let distance = if incremental {
                    target
                } else {
                    target - self.position
                };
                self.destination = self.position + distance;
                self.status.positioning = true;
                self.status.negative = distance < 0.0;
            }
            PlcAxisCommand::Stop => self.stop(),
            PlcAxisCommand::TraverseReferenceMarks { negative, .. } => {
                let direction = if negative { -1.0 } else { 1.0 };
                self.destination = self.position + direction * TestAxis::REFERENCE_MARK;
                self.status = PlcAxisStatus {
                    positioning: true,
                    negative,
                    ..PlcAxisStatus::default()
                };
            }
        }
    }

    /// Ends the movement where it leads to: at the target, or at the reference mark.
    pub fn arrive(&mut self) {
        if let Some(command) = self.command {
            self.position = self.destination;
            self.status.referenced |= matches!(command, PlcAxisCommand::TraverseReferenceMarks { .. });
        }
        self.stop();
    }

    /// Moves on for some time in s, with feed rate and override; a reference traverse knows no override
    /// [000:15975].
    fn travel(&mut self, seconds: f64) {
        let feed = match self.command {
            Some(PlcAxisCommand::Start { feed, .. }) => feed * self.override_percent / 100.0,
            Some(PlcAxisCommand::TraverseReferenceMarks { feed, .. }) => feed,
            Some(PlcAxisCommand::Stop) | None => return,
        };
        let way = feed.abs() / 60.0 * seconds;
        let left = self.destination - self.position;
        if way >= left.abs() {
            self.arrive();
        } else {
            self.position += way.copysign(left);
        }
    }

    fn distance_to_go(&self) -> f64 {
        self.command.map_or(0.0, |_| self.destination - self.position)
    }

    fn stop(&mut self) {
        self.command = None;
        self.status.positioning = false;
        self.status.negative = false;
    }
}

impl TestNc {
    /// With the machine parameters of a list, and nothing else.
    pub fn new(parameters: ParameterList) -> TestNc {
        TestNc {
            parameters,
            changed_parameters: None,
            parameter_faults: BTreeMap::new(),
            saving_fails: false,
            parameter_files: BTreeMap::new(),
            parameter_file: String::new(),
            restarts: 0,
            resets: false,
            program_running: false,
            messages: Vec::new(),
            dialogues: Vec::new(),
            status: BTreeMap::new(),
            status_changes: Vec::new(),
            coordinates: BTreeMap::new(),
            spindle: SpindlePosition::default(),
            window: PlcWindow::default(),
            window_view: WindowView::default(),
            files: BTreeSet::new(),
            pallet: None,
            program: None,
            datum_table: None,
            compensation: None,
            compensation_tables: BTreeMap::new(),
            compensation_line: 0,
            tables: BTreeMap::new(),
            geometry_initialised: 0,
            interfaces: Default::default(),
            host: None,
            axes: PerPlcAxis::splat(TestAxis::default()),
            spindle_voltage: 0.0,
            tool_call: None,
            orienting: false,
            orientation: None,
        }
    }

    /// What the control does between two scans: passes the commands of modules on to the axes.
    pub fn end_scan(&mut self) {
        for axis in &mut self.axes {
            axis.end_scan();
        }
    }

    /// Lets the PLC axes move on for some time in s.
    pub fn travel(&mut self, seconds: f64) {
        for axis in &mut self.axes {
            axis.travel(seconds);
        }
    }

    /// Leaves the editor of machine parameters: what 9031 changed is restored.
    pub fn leave_parameter_editor(&mut self) {
        self.changed_parameters = None;
    }
}

impl NcParameters for TestNc {
    fn parameters(&self) -> &ParameterList {
        self.changed_parameters.as_ref().unwrap_or(&self.parameters)
    }

    fn editable_parameter(&self, number: u16, index: u8) -> Result<f64, ParameterFault> {
        match self.parameter_faults.get(&(number, index)) {
            Some(fault) => Err(*fault),
            None => self
                .parameters
                .get(number, index)
                .ok_or(ParameterFault::NoSuchNumber),
        }
    }

    fn change_parameter(&mut self, number: u16, index: u8, value: f64) -> Result<(), NotSaved> {
        if self.saving_fails {
            return Err(NotSaved);
        }
        self.changed_parameters
            .get_or_insert_with(|| self.parameters.clone())
            .set(number, index, value)
            .map_err(|_| NotSaved)
    }

    fn select_parameter_file(&mut self, name: &str) -> Result<(), ParameterFileFault> {
        let list = self
            .parameter_files
            .get(name)
            .ok_or(ParameterFileFault::NotFound)?;
        let list = list.clone().ok_or(ParameterFileFault::Faulty)?;
        if self.parameter_file != name {
            name.clone_into(&mut self.parameter_file);
            self.parameters = list;
            self.changed_parameters = None;
            self.restarts = self.restarts.saturating_add(1);
            self.resets = true;
        }
        Ok(())
    }

    fn resets(&self) -> bool {
        self.resets
    }
}

impl NcStatus for TestNc {
    fn program_running(&self) -> bool {
        self.program_running
    }

    fn status(&self, item: StatusItem) -> i32 {
        self.status.get(&item).copied().unwrap_or(0)
    }

    fn change_status(&mut self, change: StatusChange) {
        self.status_changes.push(change);
    }

    fn coordinates(&self, kind: CoordinateKind) -> PerPlcAxis<f64> {
        self.coordinates
            .get(&kind)
            .copied()
            .unwrap_or_else(|| match kind {
                CoordinateKind::Actual
                | CoordinateKind::Nominal
                | CoordinateKind::Reference
                | CoordinateKind::ShiftedDatum => self.axes.map(|axis| axis.position),
                CoordinateKind::DistanceToGo => self.axes.map(|axis| axis.distance_to_go()),
                CoordinateKind::TrailingError | CoordinateKind::Deflection => PerPlcAxis::splat(0.0),
            })
    }

    fn spindle_position(&self) -> SpindlePosition {
        self.spindle
    }
}

impl NcScreen for TestNc {
    fn text_line(&self, file: TextFile, line: u16) -> Option<Vec<u8>> {
        let lines = match file {
            TextFile::Messages => &self.messages,
            TextFile::Dialogues => &self.dialogues,
        };
        Some(lines.get(usize::from(line))?.clone().into_bytes())
    }

    fn window(&mut self) -> &mut PlcWindow {
        &mut self.window
    }

    fn window_view(&self) -> WindowView {
        self.window_view
    }
}

impl NcMemory for TestNc {
    fn has_file(&self, name: &str) -> bool {
        self.files.contains(name)
    }

    fn pallet_line(&self, line: i32) -> Result<PalletLine, LineFault> {
        let lines = self.pallet.as_ref().ok_or(LineFault::NoFile)?;
        nth(lines, line).cloned().ok_or(LineFault::NoLine)
    }

    fn select_program(&mut self, _line: i32, program: &str, datum_table: Option<&str>) {
        self.program = Some(program.to_owned());
        if let Some(name) = datum_table {
            self.datum_table = Some(name.to_owned());
        }
    }

    fn compensation_line(&self, line: i32) -> Result<Vec<Option<CompensationSize>>, LineFault> {
        let lines = self.compensation.as_ref().ok_or(LineFault::NoFile)?;
        let tables = nth(lines, line).ok_or(LineFault::NoLine)?;
        let size = |name| self.compensation_tables.get(name).copied();
        Ok(tables.iter().map(size).collect())
    }

    fn activate_compensation(&mut self, line: i32) {
        self.compensation_line = line;
    }

    fn table(&mut self, kind: TableKind) -> Option<&mut dyn TableFile> {
        let table = self.tables.get_mut(&kind)?;
        Some(table)
    }

    fn initialise_geometry(&mut self) {
        self.geometry_initialised = self.geometry_initialised.saturating_add(1);
    }
}

impl NcInterfaces for TestNc {
    fn data_interface(&mut self, number: usize) -> &mut DataInterface {
        let [rs232, rs422] = &mut self.interfaces;
        if number == 0 { rs232 } else { rs422 }
    }

    fn host(&mut self) -> Option<&mut HostLink> {
        self.host.as_mut()
    }
}

impl NcMotion for TestNc {
    fn plc_axis_status(&self, axis: usize) -> PlcAxisStatus {
        self.axes.get(axis).map(|axis| axis.status).unwrap_or_default()
    }

    fn command_plc_axis(&mut self, axis: usize, command: PlcAxisCommand) {
        if let Some(axis) = self.axes.get_mut(axis) {
            axis.next_command = Some(command);
        }
    }

    fn override_plc_axis(&mut self, axis: usize, percent: f64) {
        if let Some(axis) = self.axes.get_mut(axis) {
            axis.override_percent = percent;
        }
    }

    fn output_spindle_voltage(&mut self, volts: f64) {
        self.spindle_voltage = volts;
    }

    fn insert_tool_call(&mut self, block: ToolCallBlock) {
        self.tool_call = Some(block);
    }

    fn spindle_orienting(&self) -> bool {
        self.orienting
    }

    fn orient_spindle(&mut self, orientation: SpindleOrientation) {
        self.orientation = Some(orientation);
    }
}

fn nth<T>(lines: &[T], line: i32) -> Option<&T> {
    lines.get(usize::try_from(line).ok()?)
}
