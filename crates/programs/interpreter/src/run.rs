//! The state of a run: its parts.

use bahn_parameters::MessageId;
use bahn_path::{Axis, Blank, LiveData, ScanJob, Scanned};
use bahn_program::{Compensation, InputSteps, Unit, Value};

use crate::context::Context;
use crate::cycles::{self, ContourJob, Halt, Watch};
use crate::definition::RunningOem;
use crate::digitize;
use crate::error::{Fault, WarningKind};
use crate::flow;
use crate::modal::Modal;
use crate::numbers::Numbers;
use crate::pen::Pen;
use crate::probe::{self, Probing};
use crate::reported::Reported;
use crate::settings::Settings;
use crate::status::Status;
use crate::tilting;
use crate::tools::Tools;

/// Everything that changes while a program runs. A copy of it is a checkpoint.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub at: flow::Position,
    pub modal: Modal,
    pub numbers: Numbers,
    pub pen: Pen,
    pub reported: Reported,
    pub tools: Tools,
    /// The first BLK FORM of the main program.
    pub blank: Option<Blank>,
    /// Probing that waits for its touch.
    pub probing: Option<Probing>,
    /// Cycles of the machine builder that run, each within the one before.
    pub oem: Vec<RunningOem>,
}

impl Run {
    pub fn new(settings: &Settings, unit: Unit) -> Run {
        let mut run = Run {
            at: flow::Position::at(0, 0),
            modal: Modal::new(settings.start, settings.tool_length_mm),
            numbers: Numbers::new(settings, unit),
            pen: Pen::new(settings),
            reported: Reported::default(),
            tools: Tools::default(),
            blank: None,
            probing: None,
            oem: Vec::new(),
        };
        run.take_status(&settings.status, settings);
        let basic = settings.basic_rotation;
        run.modal.frame.basic_rotation_deg = basic.angle_deg;
        if basic.angle_deg != 0.0 {
            run.modal.take_plane(basic.plane);
        }
        run
    }

    /// What a block may touch.
    #[inline]
    pub fn context<'a>(&'a mut self, settings: &'a Settings) -> Context<'a> {
        self.parts(settings).0
    }

    /// What a block may touch; beside it tools and blank.
    #[inline]
    pub fn parts<'a>(
        &'a mut self,
        settings: &'a Settings,
    ) -> (Context<'a>, &'a mut Tools, &'a mut Option<Blank>) {
        let context = Context {
            modal: &mut self.modal,
            numbers: &mut self.numbers,
            pen: &mut self.pen,
            reported: &mut self.reported,
            at: &self.at,
            settings,
        };
        (context, &mut self.tools, &mut self.blank)
    }

    /// Runs cycle 6, 15 or 16 on the contours of cycle 14.
    pub fn contour_cycle(
        &mut self,
        job: &ContourJob,
        settings: &Settings,
        watch: &Watch<'_>,
    ) -> Result<(), Halt> {
        cycles::contour_cycle(&mut self.context(settings), job, watch)
    }

    /// Begins with what the run before has left in force.
    fn take_status(&mut self, status: &Status, settings: &Settings) {
        if let Some((frame, feed)) = status.programmed() {
            self.modal.frame = frame;
            self.modal.feed_mm_min = feed;
            self.modal.take_plane(frame.plane);
        }
        self.modal.tilting.plane = status.plane();
        if let Some((spindle, speed_rpm)) = status.spindle() {
            self.modal.speed_rpm = speed_rpm;
            self.modal.set_spindle(spindle, &mut self.numbers.q);
        }
        if let Some(tool) = status.tool_data() {
            self.modal.tool = Some(tool);
            self.numbers.preassign_tool(tool.shape.length, tool.radius);
            self.numbers.preassign_tool_axis(tool.axis);
        }
        tilting::place(&mut self.context(settings));
    }

    /// Whether a tool is in the spindle and works on no contour with radius compensation.
    pub fn is_between_contours(&self, tool: u32) -> bool {
        let modal = &self.modal;
        modal.tool.is_some_and(|in_spindle| in_spindle.number == tool)
            && modal.compensation == Compensation::Off
            && modal.paraxial == Compensation::Off
            && self.pen.contour.is_between_contours()
            && (modal.corner_arcs.is_none() || self.pen.contour.is_empty())
            && self.pen.out.queue.is_empty()
            && self.tools.comes_back.is_none()
            && self.probing.is_none()
            && self.pen.recording.is_none()
    }

    /// The block has numbers that were rounded: the user is told at the first of each program.
    ///
    /// # Errors
    /// ENTRY VALUE INCORRECT where checking is strict.
    #[cold]
    pub(crate) fn tell_rounded(&mut self, settings: &Settings) -> Result<(), Fault> {
        let steps = InputSteps::of(settings.model, self.numbers.unit)
            .not_finer(settings.rules.input_step_mm, settings.model);
        let unit = match self.numbers.unit {
            Unit::Mm => "mm",
            Unit::Inch => "inch",
        };
        let step = format!("{} {unit} and {}°", steps.length(), steps.angle());
        let first = self.reported.said.is_first_rounded(self.pen.block.program);
        // A rehearsal goes on after an error, and says this one once, too.
        if settings.strict && (first || !self.pen.rehearsal) {
            let detail = format!("the input step of this control is {step}");
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        if first {
            self.reported.warn(self.pen.block, WarningKind::Rounded { step });
        }
        Ok(())
    }

    /// TOOL CALL, see [`Tools::call`].
    pub fn tool_call(
        &mut self,
        tool: Option<Value>,
        axis: Option<Axis>,
        speed: Option<Value>,
        oversize: [Option<Value>; 2],
        settings: &Settings,
    ) -> Result<(), Fault> {
        let (mut c, tools, blank) = self.parts(settings);
        tools.call(&mut c, blank.as_ref(), tool, axis, speed, oversize)
    }

    /// See [`Tools::replace`].
    pub fn replace_tool(&mut self, number: u32, settings: &Settings) -> Result<(), Fault> {
        let (mut c, tools, blank) = self.parts(settings);
        tools.replace(&mut c, blank.as_ref(), number)
    }

    /// See [`Tools::come_back`].
    pub fn come_back(&mut self) {
        self.tools.come_back(&mut self.modal, &mut self.pen);
    }

    /// See [`digitize::begin_scan`].
    pub fn begin_scan(&mut self, job: ScanJob, settings: &Settings) -> Result<(), Fault> {
        digitize::begin_scan(&mut self.context(settings), job)
    }

    /// See [`digitize::finish_scan`].
    pub fn finish_scan(&mut self, scanned: Option<Scanned>, settings: &Settings) -> Result<(), Fault> {
        digitize::finish_scan(&mut self.context(settings), scanned)
    }

    /// See [`probe::finish_probing`].
    pub fn finish_probing(&mut self, live: &LiveData, settings: &Settings) -> Result<(), Fault> {
        let Some(probing) = self.probing.take() else {
            return Ok(());
        };
        probe::finish_probing(&mut self.context(settings), &probing, live)
    }

    /// The tool in the spindle was measured: its length and radius count at once, in Q108 and Q114, too
    /// [000:8025] (inferred: as with TOOL CALL).
    pub fn take_measured(&mut self, [longer, greater]: [f64; 2]) {
        let Some(tool) = &mut self.modal.tool else {
            return;
        };
        tool.shape.length += longer;
        tool.shape.radius += greater;
        tool.radius += greater;
        // Where the axes stand the driver has said already.
        self.modal.length_mm = Some(tool.shape.length);
        self.numbers.preassign_tool(tool.shape.length, tool.radius);
    }
}
