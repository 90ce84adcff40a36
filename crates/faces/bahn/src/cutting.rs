//! The part of a run: what is said of the cut, and the files of what is left.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_picture::{Image, ImageError};
use bahn_workpiece::{
    Colouring, Deviation, Memory, MeshError, Page, Part, PlanView, Projection, ThreePlanes, View3d,
};

use crate::files::NewFile;
use crate::options::{ColorOption, OutputOptions, View};
use crate::{UsageError, diagnostics, files};

/// What a picture needs to know beside the material.
pub(crate) fn memory(options: &OutputOptions) -> Memory {
    Memory {
        tools: options.color == Some(ColorOption::Tool),
        path: options.toolpath,
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
    let solid = bahn_report::solid::read(path, options.resolution)?;
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
