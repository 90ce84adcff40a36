//! The part while the path runs: removes material, is touched by the probe, and is drawn at the end.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::{
    At, Axis, Blank, BlockRef, Curve, Function, OverrideLaw, PathElement, Position, SpindleOrder,
    TechnologyFunction, ToolShape, Touch,
};
use bahn_picture::{Image, ImageError};
use bahn_workpiece::{
    Colouring, Deviation, EventKind, MeshError, Page, Part, PlanView, Projection, Resolution, ThreePlanes,
    View3d, Workpiece,
};

use crate::files::NewFile;
use crate::options::{ColorOption, OutputOptions, View};
use crate::report::{Notice, Record};
use crate::{UsageError, diagnostics, files};

/// What columns the part is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Columns {
    /// As many as a picture needs.
    BySize,
    /// Of this side, mm.
    Millimetres(f64),
    /// About so many.
    About(f64),
}

impl Columns {
    fn resolution(self, blank: &Blank) -> Resolution {
        match self {
            Columns::BySize => Resolution::BySize,
            Columns::Millimetres(side) => Resolution::Millimetres(side),
            Columns::About(count) => {
                let side = |axis: Axis| {
                    let corner = |of: &[f64; 3]| of.get(axis.index()).copied().unwrap_or_default();
                    corner(&blank.max) - corner(&blank.min)
                };
                let area = side(blank.plane.first) * side(blank.plane.second);
                Resolution::Millimetres((area / count).sqrt())
            }
        }
    }
}

/// What a picture needs to know beside the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Memory {
    /// Which tool cut what.
    tools: bool,
    /// The way of the tool.
    path: bool,
}

impl Memory {
    pub fn of(options: &OutputOptions) -> Memory {
        Memory {
            tools: options.color == Some(ColorOption::Tool),
            path: options.toolpath,
        }
    }

    /// The same, and which tool cut what.
    pub fn and_tools(self) -> Memory {
        Memory { tools: true, ..self }
    }
}

/// The part, once BLK FORM gives a blank.
pub(crate) struct Cutting {
    columns: Columns,
    memory: Memory,
    workpiece: Option<(Blank, Workpiece)>,
    /// Tool in the spindle; `None` before the first TOOL CALL.
    tool: Option<u32>,
    shape: ToolShape,
    tool_axis: Axis,
    moved: bool,
    spindle: Spindle,
    /// How the spindle of a machine really turns: that counts, whatever the program says.
    seen: Option<Spindle>,
    /// Tools that cut with M4.
    left_hand: BTreeSet<u32>,
    /// What was said of a tool already.
    told: HashSet<(Option<u32>, EventKind)>,
    /// Where each tool was below the blank: first and last block, elements.
    below: BTreeMap<Option<u32>, (BlockRef, BlockRef, u64)>,
}

/// Slower than this the spindle of a machine stands still, rpm (inferred).
const STANDS_RPM: f64 = 1.0;

/// What the program did with the spindle, or the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spindle {
    turns: Option<Turn>,
    speed_rpm: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turn {
    Clockwise,
    CounterClockwise,
}

impl Spindle {
    /// Takes a function of the program.
    fn take(&mut self, function: &TechnologyFunction) {
        match function.spindle {
            Some(SpindleOrder::Clockwise) => self.turns = Some(Turn::Clockwise),
            Some(SpindleOrder::CounterClockwise) => self.turns = Some(Turn::CounterClockwise),
            Some(SpindleOrder::Stop | SpindleOrder::StopWithRun) => self.turns = None,
            None => {}
        }
        match &function.function {
            Function::Tool(call) => self.speed_rpm = call.speed_rpm,
            Function::SpindleSpeed(speed_rpm) => self.speed_rpm = *speed_rpm,
            _ => {}
        }
    }

    /// How the spindle of a machine turns, rpm, positive as M03; and whether it does not because its programmed speed
    /// is 0.
    pub fn seen(rpm: f64, without_speed: bool) -> Spindle {
        let turn = if rpm < 0.0 {
            Turn::CounterClockwise
        } else {
            Turn::Clockwise
        };
        let stands = rpm.abs() < STANDS_RPM;
        Spindle {
            turns: (!stands || without_speed).then_some(turn),
            speed_rpm: if stands { 0.0 } else { rpm.abs() },
        }
    }

    /// What is wrong when a tool cuts now.
    fn fault(&self, left_hand: bool) -> Option<EventKind> {
        let right = if left_hand {
            Turn::CounterClockwise
        } else {
            Turn::Clockwise
        };
        match self.turns {
            None => Some(EventKind::SpindleStopped),
            Some(_) if self.speed_rpm == 0.0 => Some(EventKind::SpindleWithoutSpeed),
            Some(turn) if turn != right => Some(EventKind::SpindleWrongWay),
            Some(_) => None,
        }
    }
}

impl Cutting {
    /// For tools of which some cut with M4.
    pub fn new(columns: Columns, memory: Memory, left_hand: BTreeSet<u32>) -> Cutting {
        Cutting {
            columns,
            memory,
            workpiece: None,
            tool: None,
            shape: ToolShape::default(),
            tool_axis: Axis::Z,
            moved: false,
            spindle: Spindle::default(),
            seen: None,
            left_hand,
            told: HashSet::new(),
            below: BTreeMap::new(),
        }
    }

    /// How the spindle of the machine turned on the next element.
    pub fn see(&mut self, spindle: Spindle) {
        if self.seen.replace(spindle) != Some(spindle) {
            self.watch();
        }
    }

    /// Takes an element that was executed. A blank that the wanted resolution does not fit is wrong use.
    #[inline]
    pub fn element(&mut self, element: &PathElement, record: &mut Record) -> Result<(), UsageError> {
        if element.functions.is_some() {
            self.functions(element, false, record)?;
        }
        if element.curve != Curve::Hold {
            self.moved = true;
            if let Some((_, workpiece)) = &mut self.workpiece {
                // The spindle of rigid tapping is turned by the cycle itself [003:5106].
                let tapping = matches!(element.override_law, OverrideLaw::Spindle(_));
                if tapping {
                    workpiece.note_cut(None);
                }
                workpiece.cut(element, &self.shape, self.tool_axis);
                if tapping {
                    self.watch();
                }
            }
        }
        if element.functions.is_some() {
            self.functions(element, true, record)?;
        }
        Ok(())
    }

    /// Takes the functions at the end of an element, or all others.
    fn functions(
        &mut self,
        element: &PathElement,
        at_end: bool,
        record: &mut Record,
    ) -> Result<(), UsageError> {
        let before = self.spindle;
        for function in element.functions() {
            // What is output before the end, as M05 in tapping, acts on the way to the end and not before.
            if matches!(function.at, At::End | At::BeforeEnd(_)) != at_end {
                continue;
            }
            self.spindle.take(function);
            match &function.function {
                Function::Tool(call) => {
                    self.take_events(record);
                    (self.tool, self.shape, self.tool_axis) = (Some(call.tool), call.shape, call.axis);
                    if let Some((_, workpiece)) = &mut self.workpiece {
                        workpiece.take_tool(self.tool);
                    }
                    self.watch();
                }
                Function::Blank(blank) => self.blank(blank, element.block, record)?,
                _ => {}
            }
        }
        if self.spindle != before {
            self.watch();
        }
        Ok(())
    }

    /// Lets the workpiece note the first cut of the tool with which something is wrong.
    fn watch(&mut self) {
        let left_hand = self.tool.is_some_and(|tool| self.left_hand.contains(&tool));
        let fault = self
            .seen
            .unwrap_or(self.spindle)
            .fault(left_hand)
            .filter(|kind| !self.told.contains(&(self.tool, *kind)));
        if let Some((_, workpiece)) = &mut self.workpiece {
            workpiece.note_cut(fault);
        }
    }

    /// Says what happened with the tool in the spindle.
    fn take_events(&mut self, record: &mut Record) {
        let Some((_, workpiece)) = &mut self.workpiece else {
            return;
        };
        for event in workpiece.take_events() {
            match event.kind {
                EventKind::BelowBlank => {
                    let (_, last, count) =
                        self.below
                            .entry(self.tool)
                            .or_insert((event.block, event.block, 0));
                    *last = event.block.max(*last);
                    *count += event.count;
                }
                EventKind::SpindleStopped
                | EventKind::SpindleWithoutSpeed
                | EventKind::SpindleWrongWay
                | EventKind::NoRadius => {
                    if self.told.insert((self.tool, event.kind)) {
                        let tool = self.tool;
                        record.warn(
                            event.block,
                            Notice::Tool {
                                tool,
                                kind: event.kind,
                            },
                            1,
                        );
                    }
                }
                kind => record.warn(event.block, Notice::Cut(kind), event.count),
            }
        }
    }

    /// BLK FORM: counts until something moves; the same again, in a repeat, changes nothing.
    fn blank(&mut self, blank: &Blank, block: BlockRef, record: &mut Record) -> Result<(), UsageError> {
        match &self.workpiece {
            Some((first, _)) if first == blank => return Ok(()),
            Some(_) if self.moved => {
                record.warn(block, Notice::BlankRedefined, 1);
                return Ok(());
            }
            _ => {}
        }
        let mut workpiece = Workpiece::new(blank, self.columns.resolution(blank))
            .map_err(|error| UsageError::new(format!("--resolution: {error}")))?;
        if self.memory.tools {
            workpiece.remember_tools();
            workpiece.take_tool(self.tool);
        }
        if self.memory.path {
            workpiece.remember_path();
        }
        self.workpiece = Some((*blank, workpiece));
        self.watch();
        Ok(())
    }

    /// Where a probing movement touches the part as machined so far.
    pub fn touch(&mut self, from: &Position, to: &Position, stylus_radius: f64) -> Option<Touch> {
        let (_, workpiece) = self.workpiece.as_mut()?;
        let position = workpiece.part().touch(from, to, stylus_radius)?;
        Some(Touch { position })
    }

    /// The part as it is now; `None` without a blank.
    pub fn part(&mut self) -> Option<&Part> {
        self.workpiece.as_mut().map(|(_, workpiece)| workpiece.part())
    }

    /// Whether there is a blank.
    pub fn has_part(&self) -> bool {
        self.workpiece.is_some()
    }

    /// The part at the end of the run; `None` without a blank.
    pub fn finish(mut self, record: &mut Record) -> Option<Part> {
        self.take_events(record);
        for (tool, (first, last, count)) in std::mem::take(&mut self.below) {
            record.warn(first, Notice::BelowBlank { tool, last }, count);
        }
        self.workpiece.map(|(_, workpiece)| workpiece.finished())
    }
}

/// A deviation that is shown in full colour, mm (inferred).
const FULL_MM: f64 = 0.1;

/// Whether all files were written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Written {
    All,
    /// Ctrl-C ended the work.
    Interrupted,
}

/// Writes picture and mesh as wanted, until `stop` is set.
pub(crate) fn write(
    part: Option<&Part>,
    options: &OutputOptions,
    title: &str,
    projection: Projection,
    stop: &Arc<AtomicBool>,
) -> Result<Written, UsageError> {
    let is_stopped = |path: &Path| {
        let is_stopped = stop.load(Ordering::Relaxed);
        if is_stopped {
            diagnostics::print_line(&format!("interrupted: {} is not written", path.display()));
        }
        is_stopped
    };
    let part_for = |option: &str| {
        part.ok_or_else(|| {
            UsageError::new(format!(
                "{option}: the program has no BLK FORM, so there is no part"
            ))
        })
    };
    let deviation = match &options.compare {
        Some(path) => Some(compare(part_for("--compare")?, path, options)?),
        None => None,
    };
    if let Some(path) = &options.image {
        let part = part_for("--image")?;
        let image = match &deviation {
            Some(deviation) if options.color == Some(ColorOption::Deviation) => {
                draw_deviation(part, deviation, options, title, stop)?
            }
            None if options.color == Some(ColorOption::Deviation) => {
                return Err(UsageError::new("--color deviation needs --compare".to_owned()));
            }
            _ => draw(part, options, title, projection, stop)?,
        };
        if is_stopped(path) {
            return Ok(Written::Interrupted);
        }
        let mut file = NewFile::create(path)?;
        match image.write_png_until(&mut file, stop) {
            Ok(()) => file.finish()?,
            Err(ImageError::Stopped) => {
                is_stopped(path);
                return Ok(Written::Interrupted);
            }
            Err(error) => return Err(files::cannot("write", path, &std::io::Error::other(error)).into()),
        }
    }
    if let Some(path) = &options.mesh {
        let part = part_for("--mesh")?;
        let mut file = NewFile::create(path)?;
        match part.write_stl(&mut file, stop) {
            Ok(()) => file.finish()?,
            Err(MeshError::Stopped) => {
                is_stopped(path);
                return Ok(Written::Interrupted);
            }
            Err(MeshError::Io(error)) => return Err(files::cannot("write", path, &error).into()),
            Err(error) => return Err(UsageError::new(format!("--mesh: {error}"))),
        }
    }
    Ok(Written::All)
}

/// Says how far the part is from a solid.
fn compare(part: &Part, path: &Path, options: &OutputOptions) -> Result<Deviation, UsageError> {
    let solid = crate::solid::read(path, options.resolution)?;
    let deviation = part.deviation(&solid);
    let Some(mean) = deviation.mean_mm() else {
        return Err(UsageError::new(format!(
            "--compare {}: the solid lies nowhere over the part",
            path.display()
        )));
    };
    let [left, missing] = deviation.greatest_mm();
    diagnostics::print_line(&format!(
        "compared with {}: {mean:.4} mm off in the mean, {left:.3} mm left and {missing:.3} mm missing at most, \
         {:.1} % of the surface within {FULL_MM} mm",
        path.display(),
        100.0 * deviation.share_within(FULL_MM)
    ));
    Ok(deviation)
}

fn draw_deviation(
    part: &Part,
    deviation: &Deviation,
    options: &OutputOptions,
    title: &str,
    stop: &Arc<AtomicBool>,
) -> Result<Image, UsageError> {
    let (width, height) = options.size;
    let page = Page::new(width, height, title, "deviation")
        .map_err(|error| UsageError::new(format!("--size: {error}")))?;
    Ok(part.deviation_view(&page.stopped_by(stop.clone()), deviation, FULL_MM))
}

fn draw(
    part: &Part,
    options: &OutputOptions,
    title: &str,
    projection: Projection,
    stop: &Arc<AtomicBool>,
) -> Result<Image, UsageError> {
    let (width, height) = options.size;
    let page = |note: &str| {
        Page::new(width, height, title, note)
            .map(|page| page.stopped_by(stop.clone()))
            .map_err(|error| UsageError::new(format!("--size: {error}")))
    };
    let colouring = options.color.map(Colouring::from);
    Ok(match options.view {
        View::Plan => {
            let mut view = PlanView {
                tool_path: options.toolpath,
                ..PlanView::default()
            };
            view.colouring = colouring.unwrap_or(view.colouring);
            part.plan_view(&page("plan view")?, &view)
        }
        View::ThreePlanes => {
            let sections = sections(part, &options.section)?;
            let mut view = ThreePlanes {
                projection,
                sections,
                tool_path: options.toolpath,
                ..ThreePlanes::default()
            };
            view.colouring = colouring.unwrap_or(view.colouring);
            part.three_planes(&page("projection in 3 planes")?, &view)
        }
        View::ThreeD => {
            let view = View3d {
                azimuth_deg: options.angle,
                elevation_deg: options.elevation,
                colouring: colouring.unwrap_or_default(),
                tool_path: options.toolpath,
                ..View3d::default()
            };
            part.view_3d(&page("3D view")?, &view)
        }
    })
}

/// `--section X30,Y20`: coordinates on the axes of the working plane.
fn sections(part: &Part, words: &[String]) -> Result<[Option<f64>; 2], UsageError> {
    let model = bahn_parameters::ControlModel::default();
    let at = crate::settings::position("--section", words, model)?;
    let [first, second, _] = part.axes();
    if let Some(axis) = at.known().iter().find(|axis| ![first, second].contains(axis)) {
        return Err(UsageError::new(format!(
            "--section: sections lie on {first} and {second}, not on {axis}"
        )));
    }
    Ok([at.get(first), at.get(second)])
}
