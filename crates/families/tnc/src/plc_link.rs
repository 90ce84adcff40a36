//! What the modules of the PLC read of the control and ask from it.
//!
//! What a scan reads is put here before it starts; what it asks is taken from here after it. So the modules
//! see one consistent state, and nothing happens in the middle of a scan.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use bahn_interpreter::{DatumTable, MachineTexts, NO_DATUM_TABLE};
use bahn_parameters::compensation::{CompensationAssignment, CompensationTable, CorrectionTables};
use bahn_parameters::{ParameterId, ParameterList, PerPlcAxis};
use bahn_path::{Axis, Position};
use bahn_plc::{
    CompensationSize, CoordinateKind, DataInterface, DataLines, HostLink, JogLimit, LineFault, MemoryTable,
    NcInterfaces, NcMemory, NcMotion, NcParameters, NcScreen, NcStatus, NotSaved, PalletLine, ParameterFault,
    ParameterFileFault, PlcAxisCommand, PlcAxisStatus, PlcWindow, SpindleOrientation, SpindlePosition,
    StatusChange, StatusItem, TableFile, TableKind, TextFile, ToolCallBlock, WindowView,
};

use crate::markers::AXES;
use crate::screen_command::ScreenCommand;

/// Files and tables of the NC memory that modules read.
#[derive(Clone, Debug, Default)]
pub struct NcFiles {
    /// Names of all files, with extension.
    pub names: BTreeSet<String>,
    /// Lines of the pallet file with M status by their number.
    pub pallet: Option<BTreeMap<i32, PalletLine>>,
    /// Tool and pocket table with M status.
    pub tables: BTreeMap<TableKind, MemoryTable>,
    /// What the pocket table says of the pockets themselves, by their numbers.
    pub pockets: BTreeMap<u16, Pocket>,
    /// The datum tables by their name with extension.
    pub datum_tables: BTreeMap<String, MemoryTable>,
    /// The datum table with M status until module 9090 selects another one.
    pub datum_table: Option<String>,
    /// Why datum tables that are there cannot be used, by their name with extension.
    pub faulty: BTreeMap<String, String>,
    /// Machine parameter lists by name; `None` for a faulty one.
    pub parameter_lists: BTreeMap<String, Option<ParameterList>>,
    /// The compensation assignment (.CMA).
    pub compensation: Option<CompensationAssignment>,
    /// The compensation tables (.COM) by name.
    pub compensation_tables: BTreeMap<String, CompensationTable>,
    /// The correction tables of code number 105 296: they apply where there is no assignment.
    pub correction_tables: Option<CorrectionTables>,
}

impl NcFiles {
    /// The datum table of this name.
    ///
    /// # Errors
    /// Why there is none, in words.
    pub fn datum_table_of(&self, name: Option<&String>) -> Result<&MemoryTable, String> {
        let name = name.ok_or(NO_DATUM_TABLE)?;
        let table = self.datum_tables.get(name);
        table.ok_or_else(|| match self.faulty.get(name) {
            Some(why) => format!("the datum table {name} is faulty: {why}"),
            None => format!("the datum table {name}, which is selected, is missing"),
        })
    }
}

/// A pocket of the magazine as the pocket table has it, beside the tool in it [000:9076-9082].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pocket {
    /// F: the tool in it returns here.
    pub fixed: bool,
    /// L: no tool may be in it.
    pub locked: bool,
    /// PLC: eight bits for the PLC.
    pub plc: u8,
}

/// What module 9036 changed; the last change of an item counts.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StatusChanges {
    /// Handwheel subdivision of each axis.
    pub factors: PerPlcAxis<Option<u8>>,
    pub handwheel_axis: Option<usize>,
    pub jog_limit: Option<JogLimit>,
}

impl StatusChanges {
    fn take(&mut self, change: StatusChange) {
        match change {
            StatusChange::Subdivision {
                axis: Some(axis),
                factor,
            } => {
                if let Some(slot) = self.factors.get_mut(axis) {
                    *slot = Some(factor);
                }
            }
            StatusChange::Subdivision { axis: None, factor } => {
                self.factors = PerPlcAxis::splat(Some(factor))
            }
            StatusChange::HandwheelAxis(axis) => self.handwheel_axis = Some(axis),
            StatusChange::JogLimit(limit) => self.jog_limit = Some(limit),
        }
    }
}

/// What modules asked for since it was taken.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requests {
    pub plc_axes: PerPlcAxis<Option<PlcAxisCommand>>,
    pub plc_axis_override: PerPlcAxis<Option<f64>>,
    pub spindle_volts: Option<f64>,
    pub tool_call: Option<ToolCallBlock>,
    pub orientation: Option<SpindleOrientation>,
    pub geometry: bool,
    pub restart: bool,
    pub compensation_line: Option<i32>,
    pub pallet: Option<PalletRequest>,
    pub status: StatusChanges,
    pub parameters_changed: bool,
}

/// What module 9090 has selected beside the program.
#[derive(Clone, Debug, Default)]
pub(crate) struct PalletSelection {
    /// The line of the pallet file.
    pub line: Option<i32>,
    /// The datum table of that line, or of one before it [000:15338].
    pub datum_table: Option<String>,
}

/// A line of the pallet file that module 9090 wants.
#[derive(Clone, Debug)]
pub(crate) struct PalletRequest {
    pub line: i32,
    pub program: String,
    pub datum_table: Option<String>,
}

/// Kinds of coordinates that modules read.
const KINDS: usize = CoordinateKind::ALL.len();
/// Items of status that modules read.
const ITEMS: usize = StatusItem::ALL.len();

/// The control as its PLC sees it.
#[derive(Clone, Debug)]
pub(crate) struct PlcLink {
    /// The list in force, with what 9031 changed.
    parameters: ParameterList,
    /// The list as its editor has it, without what 9031 changed.
    edited: ParameterList,
    messages: Vec<String>,
    dialogues: Vec<String>,
    texts: MachineTexts,
    pub files: NcFiles,
    pub window: PlcWindow,
    pub window_view: WindowView,
    pub lines: DataLines,
    pub program_running: bool,
    pub coordinates: [PerPlcAxis<f64>; KINDS],
    pub spindle: SpindlePosition,
    pub status: [i32; ITEMS],
    pub plc_axes: PerPlcAxis<PlcAxisStatus>,
    screen: Option<ScreenCommand>,
    pub orienting: bool,
    pub requests: Requests,
    /// The list that module 9033 has selected.
    pub selected_list: Option<String>,
    /// What module 9090 has selected.
    pub pallet: PalletSelection,
}

fn texts(messages: &[String], dialogues: &[String]) -> MachineTexts {
    MachineTexts {
        messages: messages.into(),
        dialogues: dialogues.into(),
    }
}

impl PlcLink {
    pub fn new(
        parameters: ParameterList,
        messages: Vec<String>,
        dialogues: Vec<String>,
        files: NcFiles,
    ) -> PlcLink {
        PlcLink {
            edited: parameters.clone(),
            parameters,
            texts: texts(&messages, &dialogues),
            messages,
            dialogues,
            files,
            window: PlcWindow::default(),
            window_view: WindowView::default(),
            lines: DataLines::default(),
            program_running: false,
            coordinates: [PerPlcAxis::splat(0.0); KINDS],
            spindle: SpindlePosition::default(),
            status: [0; ITEMS],
            plc_axes: PerPlcAxis::splat(PlcAxisStatus::default()),
            screen: None,
            orienting: false,
            requests: Requests::default(),
            selected_list: None,
            pallet: PalletSelection::default(),
        }
    }

    /// Other texts of messages and dialogues.
    pub fn take_texts(&mut self, messages: Vec<String>, dialogues: Vec<String>) {
        self.texts = texts(&messages, &dialogues);
        self.messages = messages;
        self.dialogues = dialogues;
    }

    /// Texts of the PLC dialogues.
    pub fn dialogues(&self) -> &[String] {
        &self.dialogues
    }

    /// Texts that FN14 and FN15 take by their numbers.
    pub fn machine_texts(&self) -> &MachineTexts {
        &self.texts
    }

    /// Texts of the PLC messages.
    pub fn messages(&self) -> &[String] {
        &self.messages
    }

    pub fn list(&self) -> &ParameterList {
        &self.parameters
    }

    /// The list as its editor has it, without what module 9031 changed.
    pub fn edited_list(&self) -> &ParameterList {
        &self.edited
    }

    /// Takes a value of a list into the edited one and the one in force.
    pub fn edit(&mut self, list: &ParameterList, id: ParameterId) {
        let index = id.index.unwrap_or(0);
        let value = list.get(id.number, index).unwrap_or_default();
        for own in [&mut self.edited, &mut self.parameters] {
            // It was checked for the list.
            let _ = own.set(id.number, index, value);
        }
    }

    /// Sets what a module will read.
    pub fn set_coordinates(&mut self, kind: CoordinateKind, values: PerPlcAxis<f64>) {
        if let Some(row) = self.coordinates.get_mut(kind as usize) {
            *row = values;
        }
    }

    /// What the screen shows, once somebody has said it.
    pub fn screen(&self) -> Option<ScreenCommand> {
        self.screen
    }

    /// A screen shows something else.
    pub fn show(&mut self, screen: ScreenCommand) -> bool {
        self.screen = Some(screen);
        for (item, value) in screen.items() {
            self.set_status(item, value);
        }
        true
    }

    /// Sets what 9035 will read.
    pub fn set_status(&mut self, item: StatusItem, value: i32) {
        if let Some(cell) = self.status.get_mut(item as usize) {
            *cell = value;
        }
    }

    /// The datums of `CYCL DEF 7.1 #n` for the axes of a list of machine parameters, or why there are none.
    pub fn datums(&self, list: &ParameterList) -> Result<Arc<DatumTable>, String> {
        let table = self.files.datum_table_of(self.datum_table_name())?;
        Ok(Arc::new(datum_shifts(table, list)))
    }

    /// The datum table with M status: modules see what 9090 has selected in the same scan, too [000:15375].
    pub fn datum_table_name(&self) -> Option<&String> {
        let requested = self
            .requests
            .pallet
            .as_ref()
            .and_then(|pallet| pallet.datum_table.as_ref());
        requested
            .or(self.pallet.datum_table.as_ref())
            .or(self.files.datum_table.as_ref())
    }

    /// Writes an element of a table as module 9094 does, with the next scan; `false` when there is no such line, or the
    /// value does not fit.
    pub fn write_element(&mut self, kind: TableKind, line: i32, element: usize, value: f64) -> bool {
        let column = kind.columns().get(element).and_then(Option::as_ref);
        let fits = column.is_some_and(|column| (column.min..=column.max).contains(&value));
        let table = self.selected_table(kind).filter(|_| fits);
        let Some(table) = table.filter(|table| table.value(line, element).is_some()) else {
            return false;
        };
        table.set_value(line, element, value);
        self.requests.geometry = true;
        true
    }

    /// The tables that modules 9092 to 9094 see.
    pub fn selected_table(&mut self, kind: TableKind) -> Option<&mut MemoryTable> {
        if kind != TableKind::Datum {
            return self.files.tables.get_mut(&kind);
        }
        let name = self.datum_table_name()?.clone();
        self.files.datum_tables.get_mut(&name)
    }
}

/// An element of a table that the PLC has written with module 9094.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenElement {
    /// The table that was written to.
    pub table: TableKind,
    /// Number of tool, vector or pocket.
    pub line: i32,
    /// Number of the element [000:15414-15454].
    pub element: usize,
    /// What the PLC wrote.
    pub value: f64,
    /// Its value in the file of the table. Where that says another one, the file counts.
    pub file: f64,
}

/// The elements of a table that are not as they were loaded.
pub(crate) fn differences(loaded: &MemoryTable, table: &MemoryTable) -> impl Iterator<Item = WrittenElement> {
    table.elements().filter_map(|(line, element, value)| {
        let file = loaded.value(line, element).filter(|file| *file != value)?;
        Some(WrittenElement {
            table: loaded.kind(),
            line,
            element,
            value,
            file,
        })
    })
}

/// The lines of a datum table as shifts of the axes that a list of machine parameters has [000:15414-15420].
pub fn datum_shifts(table: &MemoryTable, list: &ParameterList) -> DatumTable {
    let axes: Vec<(Axis, usize)> = list
        .axes()
        .iter()
        .filter_map(|axis| Some((axis, usize::from(list.axis_index(axis)?))))
        .filter(|(_, element)| *element < AXES)
        .collect();
    let mut shifts = DatumTable::new();
    let mut line = table.next_line(0);
    while let Some(number) = line {
        let mut datum = Position::UNKNOWN;
        for (axis, element) in &axes {
            datum[*axis] = table.value(number, *element).unwrap_or_default();
        }
        shifts.insert(number, datum);
        line = number.checked_add(1).and_then(|next| table.next_line(next));
    }
    shifts
}

impl NcParameters for PlcLink {
    fn parameters(&self) -> &ParameterList {
        &self.parameters
    }

    fn editable_parameter(&self, number: u16, index: u8) -> Result<f64, ParameterFault> {
        self.edited.get(number, index).ok_or(ParameterFault::NoSuchNumber)
    }

    fn change_parameter(&mut self, number: u16, index: u8, value: f64) -> Result<(), NotSaved> {
        self.parameters.set(number, index, value).map_err(|_| NotSaved)?;
        self.requests.parameters_changed = true;
        Ok(())
    }

    fn select_parameter_file(&mut self, name: &str) -> Result<(), ParameterFileFault> {
        let list = self
            .files
            .parameter_lists
            .get(name)
            .ok_or(ParameterFileFault::NotFound)?;
        let list = list.clone().ok_or(ParameterFileFault::Faulty)?;
        if self.selected_list.as_deref() != Some(name) {
            self.selected_list = Some(name.to_owned());
            self.edited = list.clone();
            self.parameters = list;
            self.requests.restart = true;
        }
        Ok(())
    }

    fn resets(&self) -> bool {
        self.requests.restart
    }
}

impl NcStatus for PlcLink {
    fn program_running(&self) -> bool {
        self.program_running
    }

    fn status(&self, item: StatusItem) -> i32 {
        self.status.get(item as usize).copied().unwrap_or(0)
    }

    fn change_status(&mut self, change: StatusChange) {
        self.requests.status.take(change);
    }

    fn coordinates(&self, kind: CoordinateKind) -> PerPlcAxis<f64> {
        self.coordinates.get(kind as usize).copied().unwrap_or_default()
    }

    fn spindle_position(&self) -> SpindlePosition {
        self.spindle
    }
}

impl NcScreen for PlcLink {
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

impl NcMemory for PlcLink {
    fn has_file(&self, name: &str) -> bool {
        self.files.names.contains(name)
    }

    fn pallet_line(&self, line: i32) -> Result<PalletLine, LineFault> {
        let lines = self.files.pallet.as_ref().ok_or(LineFault::NoFile)?;
        lines.get(&line).cloned().ok_or(LineFault::NoLine)
    }

    fn select_program(&mut self, line: i32, program: &str, datum_table: Option<&str>) {
        self.requests.pallet = Some(PalletRequest {
            line,
            program: program.to_owned(),
            datum_table: datum_table.map(str::to_owned),
        });
    }

    fn compensation_line(&self, line: i32) -> Result<Vec<Option<CompensationSize>>, LineFault> {
        let file = self.files.compensation.as_ref().ok_or(LineFault::NoFile)?;
        let tables = nth(&file.lines, line).ok_or(LineFault::NoLine)?;
        let size = |name| {
            let table = self.files.compensation_tables.get(name)?;
            Some(table.size())
        };
        Ok(tables.iter().flatten().map(size).collect())
    }

    fn activate_compensation(&mut self, line: i32) {
        self.requests.compensation_line = Some(line);
    }

    fn table(&mut self, kind: TableKind) -> Option<&mut dyn TableFile> {
        let table = self.selected_table(kind)?;
        Some(table)
    }

    fn initialise_geometry(&mut self) {
        self.requests.geometry = true;
    }
}

impl NcInterfaces for PlcLink {
    fn data_interface(&mut self, number: usize) -> &mut DataInterface {
        let [rs232, rs422] = &mut self.lines.interfaces;
        if number == 0 { rs232 } else { rs422 }
    }

    fn host(&mut self) -> Option<&mut HostLink> {
        self.lines.host.as_mut()
    }
}

impl NcMotion for PlcLink {
    fn plc_axis_status(&self, axis: usize) -> PlcAxisStatus {
        self.plc_axes.get(axis).copied().unwrap_or_default()
    }

    fn command_plc_axis(&mut self, axis: usize, command: PlcAxisCommand) {
        if let Some(request) = self.requests.plc_axes.get_mut(axis) {
            *request = Some(command);
        }
    }

    fn override_plc_axis(&mut self, axis: usize, percent: f64) {
        if let Some(request) = self.requests.plc_axis_override.get_mut(axis) {
            *request = Some(percent);
        }
    }

    fn output_spindle_voltage(&mut self, volts: f64) {
        self.requests.spindle_volts = Some(volts);
    }

    fn insert_tool_call(&mut self, block: ToolCallBlock) {
        self.requests.tool_call = Some(block);
    }

    fn spindle_orienting(&self) -> bool {
        self.orienting
    }

    fn orient_spindle(&mut self, orientation: SpindleOrientation) {
        self.requests.orientation = Some(orientation);
    }
}

fn nth<T>(lines: &[T], line: i32) -> Option<&T> {
    lines.get(usize::try_from(line).ok()?)
}
