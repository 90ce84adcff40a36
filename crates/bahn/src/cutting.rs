//! The part while the path runs: removes material, is touched by the probe, and is drawn at the end.

use std::path::Path;

use bahn_path::{Axis, Blank, BlockRef, Curve, Function, PathElement, Position, ToolShape, Touch};
use bahn_picture::Image;
use bahn_workpiece::{Page, Part, PlanView, Projection, Resolution, ThreePlanes, View3d, Workpiece};

use crate::cli::{OutputOptions, View};
use crate::files::NewFile;
use crate::report::{Notice, Record};
use crate::{UsageError, files};

/// The part, once BLK FORM gives a blank.
pub(crate) struct Cutting {
    resolution: Resolution,
    workpiece: Option<(Blank, Workpiece)>,
    tool: ToolShape,
    tool_axis: Axis,
    moved: bool,
}

impl Cutting {
    pub fn new(resolution_mm: Option<f64>) -> Cutting {
        Cutting {
            resolution: resolution_mm.map_or(Resolution::BySize, Resolution::Millimetres),
            workpiece: None,
            tool: ToolShape::default(),
            tool_axis: Axis::Z,
            moved: false,
        }
    }

    /// Takes an element that was executed. A blank that the wanted resolution does not fit is wrong use.
    #[inline]
    pub fn element(&mut self, element: &PathElement, record: &mut Record) -> Result<(), UsageError> {
        for function in element.functions() {
            match &function.function {
                Function::Tool(call) => (self.tool, self.tool_axis) = (call.shape, call.axis),
                Function::Blank(blank) => self.blank(blank, element.block, record)?,
                _ => {}
            }
        }
        if element.curve != Curve::Hold {
            self.moved = true;
            if let Some((_, workpiece)) = &mut self.workpiece {
                workpiece.cut(element, &self.tool, self.tool_axis);
            }
        }
        Ok(())
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
        let workpiece = Workpiece::new(blank, self.resolution)
            .map_err(|error| UsageError::new(format!("--resolution: {error}")))?;
        self.workpiece = Some((*blank, workpiece));
        Ok(())
    }

    /// Where a probing movement touches the part as machined so far.
    pub fn touch(&mut self, from: &Position, to: &Position, stylus_radius: f64) -> Option<Touch> {
        let (_, workpiece) = self.workpiece.as_mut()?;
        let position = workpiece.part().touch(from, to, stylus_radius)?;
        Some(Touch { position })
    }

    /// Whether there is a blank.
    pub fn has_part(&self) -> bool {
        self.workpiece.is_some()
    }

    /// The part at the end of the run; `None` without a blank.
    pub fn finish(self, record: &mut Record) -> Option<Part> {
        let (_, mut workpiece) = self.workpiece?;
        for event in workpiece.take_events() {
            record.warn(event.block, Notice::Cut(event.kind), event.count);
        }
        Some(workpiece.finished())
    }
}

/// Writes picture and mesh as wanted.
pub(crate) fn write(
    part: Option<&Part>,
    options: &OutputOptions,
    title: &str,
    projection: Projection,
) -> Result<(), UsageError> {
    let part_for = |option: &str| {
        part.ok_or_else(|| {
            UsageError::new(format!(
                "{option}: the program has no BLK FORM, so there is no part"
            ))
        })
    };
    if let Some(path) = &options.image {
        let image = draw(part_for("--image")?, options, title, projection)?;
        write_with(path, |file| image.write_png(file).map_err(std::io::Error::other))?;
    }
    if let Some(path) = &options.mesh {
        let part = part_for("--mesh")?;
        write_with(path, |file| part.write_stl(file))?;
    }
    Ok(())
}

fn write_with(
    path: &Path,
    write: impl FnOnce(&mut NewFile) -> std::io::Result<()>,
) -> Result<(), UsageError> {
    let mut file = NewFile::create(path)?;
    write(&mut file).map_err(|error| files::cannot("write", path, &error))?;
    file.finish()
}

fn draw(
    part: &Part,
    options: &OutputOptions,
    title: &str,
    projection: Projection,
) -> Result<Image, UsageError> {
    let (width, height) = options.size;
    let page = |note: &str| {
        Page::new(width, height, title, note).map_err(|error| UsageError::new(format!("--size: {error}")))
    };
    Ok(match options.view {
        View::Plan => part.plan_view(&page("plan view")?, &PlanView::default()),
        View::ThreePlanes => {
            let sections = sections(part, &options.section)?;
            let view = ThreePlanes {
                projection,
                sections,
                ..ThreePlanes::default()
            };
            part.three_planes(&page("projection in 3 planes")?, &view)
        }
        View::ThreeD => {
            let view = View3d {
                azimuth_deg: options.angle,
                elevation_deg: options.elevation,
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
