//! What the PLC mode keeps while other pages are shown: the diagram that is recorded, the scan that is traced.
//!
//! Decision: A logic diagram with several triggers waits for the first edge of any; it goes on recording while other
//! pages are shown. TRACE looks at every scan in the reference interpreter as long as its page lies open
//!
//! Decision: The window of the PLC is displayed and in the foreground all the time, since the screen shows it beside
//! every mode: what module 9081 tells follows from no screen that is chosen

use std::sync::{Arc, Weak};

use bahn_exchange::{Content, Operand};
use bahn_host::logic_diagram::{Diagram, DiagramRecorder, Trigger};
use bahn_host::{AnyPlant, Host};
use bahn_plc::{CodeTrace, PlcProgram, WindowView};
use bahn_tnc::{Control, ServoSampler};

/// Scans of a diagram, and those before its event [000:11461-11472].
const DIAGRAM_SCANS: usize = 1024;
const SCANS_BEFORE: usize = 512;

/// A row of the diagram's table: an operand, and the edge that triggers.
pub(crate) type DiagramRow = (Operand, Option<bool>);

/// The PLC mode of a station.
#[derive(Default)]
pub(crate) struct PlcMode {
    /// The code number was entered since power-on.
    pub entered: bool,
    /// The help file that lies open, and whether the PLC knows its line.
    pub help: Weak<()>,
    pub help_reported: bool,
    /// The file that was edited last.
    pub edited: Option<String>,
    /// The program that was compiled, for the next power-on.
    pub compiled: Option<Arc<PlcProgram>>,
    /// The table of the diagram.
    pub rows: Vec<DiagramRow>,
    recorder: Option<DiagramRecorder>,
    records: bool,
    /// Scans of the control that is on.
    scans: u64,
    code: CodeTrace,
    code_wanted: bool,
}

impl PlcMode {
    /// The page of the diagram has START TRACE.
    pub fn start(&mut self, control: &Control) {
        let operands = self.rows.iter().map(|(operand, _)| *operand).collect();
        let edges = self.rows.iter();
        let edges: Vec<(Operand, Content)> = edges
            .filter_map(|(operand, edge)| Some((*operand, Content::Number(i32::from((*edge)?)))))
            .collect();
        let trigger = match edges.is_empty() {
            true => Trigger::Never,
            false => Trigger::Edge(edges),
        };
        let image = control.exchange().plc();
        let extent = (SCANS_BEFORE, DIAGRAM_SCANS);
        let recorder = DiagramRecorder::new(operands, trigger, extent, |operand| operand.read(image));
        self.recorder = Some(recorder);
        self.records = true;
    }

    /// STOP TRACE: no more scans are recorded; those that were stay.
    pub fn stop(&mut self) {
        self.records = false;
    }

    /// The table has changed: what was recorded belongs to another one.
    pub fn forget_diagram(&mut self) {
        self.recorder = None;
        self.records = false;
    }

    /// PCTR stands in the status window.
    pub fn records(&self) -> bool {
        self.records
    }

    /// What is recorded so far.
    pub fn diagram(&self) -> Option<&Diagram> {
        self.recorder.as_ref().map(DiagramRecorder::diagram)
    }

    /// The next scan is traced.
    pub fn watch_code(&mut self) {
        self.code_wanted = true;
    }

    /// The scan that was traced last.
    pub fn code(&self) -> &CodeTrace {
        &self.code
    }

    /// One contour cycle of the machine, with what somebody wants to see in it, and who looks at its servo steps.
    pub fn cycle(
        &mut self,
        host: &mut Host<AnyPlant>,
        sampler: Option<&mut dyn ServoSampler>,
    ) -> Result<(), bahn_host::HostError> {
        host.show_plc_window(IN_SIGHT);
        host.begin()?;
        let cycled = match std::mem::take(&mut self.code_wanted) {
            true => host.cycle_watched(Some(&mut self.code), sampler),
            false => host.cycle_watched(None, sampler),
        };
        self.follow(host.control());
        cycled
    }

    fn follow(&mut self, control: &Control) {
        let scans = control.plc_scans();
        let is_new = std::mem::replace(&mut self.scans, scans) != scans && scans > 0;
        let Some(recorder) = self.recorder.as_mut().filter(|_| is_new && self.records) else {
            return;
        };
        let image = control.exchange().plc();
        recorder.scan(|operand| operand.read(image));
        self.records = !recorder.is_over();
    }

    /// The control was switched off.
    pub fn power_off(&mut self) {
        self.entered = false;
        self.compiled = None;
        self.stop();
    }
}

/// The panel shows the window of the PLC beside whatever is in front.
const IN_SIGHT: WindowView = WindowView {
    displayed: true,
    in_foreground: true,
};
