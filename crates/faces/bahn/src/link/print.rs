//! `bahn link print`: a picture on a matrix printer, as the TNC 155 makes a hard copy of its graphics.

use std::path::PathBuf;

use bahn_host::files;
use bahn_link::{HardCopy, PrintOut, Protocol};
use bahn_parameters::equipment::Behaviour;
use bahn_picture::Image;
use clap::{Args, ValueHint};

use super::desk::{Answer, Desk, Until};
use super::port;
use super::transfer::talk;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

pub(super) const EXAMPLES: &str = "\
Examples:
  bahn test part.h --view plan --image part.png
  bahn link print part.png --machine mill155 --output part.prn
  bahn link print part.png --machine mill155 --port serial:/dev/ttyUSB0,mode=ext1,baud=9600

Machine parameters 226 to 233 of a TNC 155 say what sets the printer up and what stands before
each line; without them nothing is printed. A picture becomes 512 dots wide, what shines on the
screen is black. A TNC 151 has no graphics, and later controls make no hard copy. Exit codes: 0
printed, 1 the control makes no hard copy or the machine describes no printer, or the device is
not ready, 2 wrong use.";

/// Options of `bahn link print`.
#[derive(Args, Debug)]
pub(crate) struct PrintOptions {
    /// Picture to print, PNG.
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    picture: PathBuf,
    /// Folder of the machine whose printer it is.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    machine: PathBuf,
    /// Write what is printed into a file.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath, required_unless_present = "port",
          conflicts_with = "port")]
    output: Option<PathBuf>,
    /// Print at a port.
    #[arg(long, value_name = "SPEC")]
    port: Option<String>,
}

pub(super) fn command(options: &PrintOptions) -> Result<Outcome, UsageError> {
    let Some(machine) = port::machine(&options.machine)? else {
        return Ok(Outcome::ProgramError);
    };
    let model = machine.list.model();
    // MP226 to MP233, and a screen with graphics: the TNC 155 and its versions [001:2157].
    if !model.limits().has_old_numbers() || !model.has_graphics() {
        let why = match model.has_graphics() {
            true => "its machine parameters describe no printer",
            false => "it has no graphics",
        };
        diagnostics::print_line(&format!(
            "error: the {} makes no hard copy: {why}; a TNC 155 does",
            model.name()
        ));
        return Ok(Outcome::ProgramError);
    }
    let printer = HardCopy::of(&machine.list);
    if !printer.is_set_up() {
        diagnostics::print_line(
            "error: MP230 to MP233 of the machine describe no printer, as 1290, 6990, 2, 0 for a TI 850",
        );
        return Ok(Outcome::ProgramError);
    }
    let bytes = files::read_table(&options.picture)?;
    let image = Image::read_png(std::io::Cursor::new(bytes))
        .map_err(|error| UsageError::new(format!("{}: {error}", options.picture.display())))?;
    let (width, height) = (image.width() as usize, image.height() as usize);
    let pixels = image.pixels();
    let bytes = printer.print(width, height, |x, y| {
        let [red, green, blue] = pixels
            .get(y * width + x)
            .copied()
            .unwrap_or_default()
            .map(u32::from);
        // As bright as the eye finds it.
        ((red * 299 + green * 587 + blue * 114) / 1000) as u8
    });
    if let Some(output) = &options.output {
        files::write_whole(output, &bytes)?;
        console::print(&format!("{} bytes\n", bytes.len()))?;
        return Ok(Outcome::Fine);
    }
    let Ok(spec) = port::spec("--port", options.port.as_deref().unwrap_or_default()) else {
        return Ok(Outcome::ProgramError);
    };
    let mut settings = port::settings(&machine.list, &spec);
    // A hard copy has eight data bits, whatever MP222 says, from software level 08 on [001:2176-2180].
    if machine.list.equipment().does(Behaviour::HardCopyOf8Bits) {
        settings.characters.data_bits = 8;
    }
    let protocol: Box<dyn Protocol> = Box::new(PrintOut::new(bytes));
    let desk = Desk::new(settings.model, Answer::No, Format::Text, Until::Ended);
    talk(&spec, settings, vec![protocol], desk, None)
}
