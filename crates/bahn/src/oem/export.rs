//! `bahn oem export`: S records for an EPROM.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_host::eprom::{ListFault, ListedFile, LoadList};
use bahn_host::files::{self, NewFile};
use bahn_host::s_records::Image;
use bahn_host::{FileFault, LoadedMachine, Marked, Severity, decode, oem_cycles};

use super::options::ExportOptions;
use crate::{Outcome, UsageError, console, diagnostics};

/// Writes the records, or prints what is wrong.
pub(super) fn command(options: &ExportOptions) -> Result<Outcome, UsageError> {
    let Some(machine) = super::machine(&options.machine)? else {
        return Ok(Outcome::ProgramError);
    };
    if let Some(output) = &options.output {
        crate::files::keep_inputs(&[&options.list], &[("--output", output)])?;
    }
    let text = decode(&files::read_table(&options.list)?);
    let fault = |fault: ListFault| of_list(&options.list, &text, fault);
    let list = match LoadList::parse(&text) {
        Ok(list) => list,
        Err(faults) => return Ok(print(faults.into_iter().map(fault).collect())),
    };
    let (contents, faults) = contents(&machine, &list)?;
    if !faults.is_empty() {
        return Ok(print(faults.into_iter().map(fault).collect()));
    }
    let whole = |message| {
        fault(ListFault {
            line: 0,
            column: 1,
            message,
        })
    };
    let image = match list.image(&contents) {
        Ok(image) => image,
        Err(message) => return Ok(print(vec![whole(message)])),
    };
    let records = image.to_records();
    // What is written is what was meant.
    if Image::from_records(&records).as_ref() != Ok(&image) {
        return Ok(print(vec![whole(
            "the records do not read back as the image".into(),
        )]));
    }
    match &options.output {
        None => console::print(&records)?,
        Some(path) => {
            let mut file = NewFile::create(path)?;
            let written = file.write_all(records.as_bytes());
            written.map_err(|error| files::cannot("write", path, &error))?;
            file.finish()?;
            let (count, size) = (list.files.len(), image.bytes.len());
            console::print(&format!("{}: {count} files, {size} bytes\n", path.display()))?;
        }
    }
    Ok(Outcome::Fine)
}

/// What is in the files of the list, and which of them are not there or not as they should be.
fn contents(machine: &LoadedMachine, list: &LoadList) -> Result<(Vec<Vec<u8>>, Vec<ListFault>), UsageError> {
    let cycles = oem_cycles::find(&machine.programs(0), &machine.plc_dialogues, &machine.parameters)?;
    let (mut contents, mut faults) = (Vec::new(), Vec::new());
    for file in &list.files {
        let mut fault = |message: String| {
            faults.push(ListFault {
                line: file.line,
                column: 1,
                message,
            });
        };
        let Some(path) = find(machine, file) else {
            fault(format!("there is no file {}", file.name));
            continue;
        };
        let own = cycles.iter().find(|cycle| cycle.path == path);
        own.into_iter()
            .flat_map(|cycle| cycle.faults(true))
            .for_each(&mut fault);
        contents.push(files::read_description(&path)?);
    }
    Ok((contents, faults))
}

/// Where a file of the control is.
fn find(machine: &LoadedMachine, file: &ListedFile) -> Option<PathBuf> {
    let plc = machine.root.join(&machine.folder.plc);
    let programs = machine.programs(0);
    let folders = [
        plc.parent().map(Path::to_path_buf),
        Some(programs.clone()),
        Some(programs.join("eprom")),
        Some(machine.root.clone()),
    ];
    folders.into_iter().flatten().find_map(|folder| {
        let mut entries = std::fs::read_dir(folder).ok()?.flatten();
        let entry = entries.find(|entry| entry.file_name().eq_ignore_ascii_case(&file.name))?;
        entry.path().is_file().then(|| entry.path())
    })
}

fn of_list(path: &Path, text: &str, fault: ListFault) -> FileFault {
    let line = text
        .lines()
        .nth((fault.line as usize).saturating_sub(1))
        .unwrap_or_default();
    let rest = line
        .chars()
        .skip((fault.column as usize).saturating_sub(1))
        .count();
    let length = u32::try_from(rest).unwrap_or(1).max(1);
    FileFault {
        severity: Severity::Error,
        title: "the EPROM cannot be written".into(),
        path: path.to_owned(),
        marked: Marked {
            line: fault.line,
            text: line.to_owned(),
            columns: (fault.line > 0).then_some((fault.column, length)),
        },
        label: fault.message,
        help: None,
        opened: None,
    }
}

fn print(faults: Vec<FileFault>) -> Outcome {
    diagnostics::print_faults(&faults);
    Outcome::ProgramError
}
