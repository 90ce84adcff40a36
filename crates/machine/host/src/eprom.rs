//! What is put into an EPROM: the list of OUTPUT BINARY CODE 0001 and the image that it makes [000:11388-11412].
//!
//! How the control lays out its EPROM no manual says: here it is a directory in the words of the list, with the size of each
//! file, an empty line, and the files one after the other (inferred).
//!
//! Decision: What lies where in an EPROM no manual says: `bahn oem export` writes a directory in the words of the
//! LOAD list and the files after it, 1 Mbit or with SIZE 2MB 2 Mbit

use std::path::{Path, PathBuf};

use bahn_text::{Diagnostic, Span};

use crate::s_records::Image;
use crate::{HostError, LoadedMachine, files, oem_cycles};

/// Bytes of an EPROM without SIZE 2MB, and with it: 1 and 2 Mbit (inferred).
const SIZES: [usize; 2] = [1 << 17, 1 << 18];
/// Longest name of a file [000:6834-6905].
const NAME_MAX: usize = 20;

/// A list of files for an EPROM.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadList {
    /// Id number of the EPROM: eight digits.
    pub ident: String,
    /// SIZE 2MB.
    pub is_large: bool,
    /// The files in their order.
    pub files: Vec<ListedFile>,
}

/// A file of the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListedFile {
    /// Its name, without blanks.
    pub name: String,
    /// It is the main file of the PLC program: /M.
    pub is_main: bool,
    /// Its line in the list, from 1.
    pub line: u32,
}

impl LoadList {
    /// Reads a list: `IDENT 123 456 99` first, then `SIZE 2MB` and `LOAD name`.
    ///
    /// # Errors
    /// All faults of all lines.
    pub fn parse(text: &str) -> Result<LoadList, Vec<Diagnostic>> {
        let mut list = LoadList::default();
        let mut faults = Vec::new();
        let lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty());
        for (place, (line, words)) in lines.enumerate() {
            if let Err((column, message)) = list.take(place == 0, line, words) {
                faults.push(Diagnostic::error(
                    Span::new(line as usize, column, rest(words, column)),
                    message,
                ));
            }
        }
        if list.files.is_empty() && faults.is_empty() {
            let message = "the list names no file: LOAD name";
            faults.push(Diagnostic::error(Span::FILE, message));
        }
        if faults.is_empty() { Ok(list) } else { Err(faults) }
    }

    fn take(&mut self, is_first: bool, line: u32, text: &str) -> Result<(), (usize, String)> {
        let begin = text.len() - text.trim_start().len();
        let (word, rest) = text
            .trim()
            .split_once(char::is_whitespace)
            .unwrap_or((text.trim(), ""));
        let at = |offset: usize| {
            text.get(..begin + offset)
                .map_or(1, |before| before.chars().count() + 1)
        };
        let after = at(text.trim().len() - rest.trim_start().len());
        let fault = |column: usize, message: &str| Err((column, message.to_owned()));
        let name: String = rest.chars().filter(|c| !c.is_whitespace()).collect();
        match word.to_ascii_uppercase().as_str() {
            "IDENT" if !is_first => fault(at(0), "IDENT is the first line"),
            "IDENT" if name.len() == 8 && name.bytes().all(|c| c.is_ascii_digit()) => {
                self.ident = name;
                Ok(())
            }
            "IDENT" => fault(after, "the id number of an EPROM has eight digits: 123 456 99"),
            _ if is_first => fault(at(0), "the first line is IDENT with the id number of the EPROM"),
            "SIZE" if name.eq_ignore_ascii_case("2MB") => {
                self.is_large = true;
                Ok(())
            }
            "SIZE" => fault(after, "the size is 2MB"),
            "LOAD" => self.load(line, &name).map_err(|message| (after, message)),
            _ => fault(at(0), "a line is IDENT, SIZE or LOAD"),
        }
    }

    fn load(&mut self, line: u32, name: &str) -> Result<(), String> {
        let (name, is_main) = match name.strip_suffix("/M").or(name.strip_suffix("/m")) {
            Some(name) => (name, true),
            None => (name, false),
        };
        let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
        if name.is_empty() || name.len() > NAME_MAX || !name.chars().all(fits) || name.starts_with('.') {
            return Err("this is no name of a file of the control".into());
        }
        if self.files.iter().any(|file| file.name.eq_ignore_ascii_case(name)) {
            return Err(format!("{name} is loaded twice"));
        }
        if is_main && self.files.iter().any(|file| file.is_main) {
            return Err("there is one main file of the PLC program".into());
        }
        self.files.push(ListedFile {
            name: name.to_owned(),
            is_main,
            line,
        });
        Ok(())
    }

    /// The image of the files, whose contents are in the order of the list.
    ///
    /// # Errors
    /// When they do not fit into the EPROM.
    pub fn image(&self, contents: &[Vec<u8>]) -> Result<Image, String> {
        let mut bytes = format!("IDENT {}\n", self.ident).into_bytes();
        if self.is_large {
            bytes.extend_from_slice(b"SIZE 2MB\n");
        }
        for (file, content) in self.files.iter().zip(contents) {
            let main = if file.is_main { "/M" } else { "" };
            bytes.extend_from_slice(format!("LOAD {}{main} {}\n", file.name, content.len()).as_bytes());
        }
        bytes.push(b'\n');
        contents
            .iter()
            .for_each(|content| bytes.extend_from_slice(content));
        let room = SIZES[usize::from(self.is_large)];
        if bytes.len() > room {
            let size = bytes.len();
            return Err(match self.is_large {
                false => {
                    format!("{size} bytes do not fit into {room}; SIZE 2MB takes an EPROM twice as large")
                }
                true => format!("{size} bytes do not fit into {room}"),
            });
        }
        Ok(Image {
            title: self.ident.clone(),
            bytes,
        })
    }

    /// The list of an image, and what is in its files.
    ///
    /// # Errors
    /// When the image is none of this kind, or not whole.
    pub fn of_image(image: &Image) -> Result<(LoadList, Vec<Vec<u8>>), String> {
        let end = image.bytes.windows(2).position(|two| two == b"\n\n");
        let end = end.ok_or("the image has no directory")?;
        let (directory, mut rest) = image.bytes.split_at(end + 2);
        let directory = std::str::from_utf8(directory).map_err(|_| "the directory is no text")?;
        let (mut text, mut contents) = (String::new(), Vec::new());
        for line in directory.lines() {
            let listed = match line.strip_prefix("LOAD ").and_then(|rest| rest.rsplit_once(' ')) {
                Some((name, size)) => {
                    let size = size.parse::<usize>().ok().filter(|size| *size <= rest.len());
                    let (content, after) = rest.split_at(size.ok_or_else(|| format!("{name} is not whole"))?);
                    rest = after;
                    contents.push(content.to_vec());
                    format!("LOAD {name}")
                }
                None => line.to_owned(),
            };
            text.push_str(&(listed + "\n"));
        }
        if !rest.is_empty() {
            return Err(format!("{} bytes belong to no file", rest.len()));
        }
        let list = LoadList::parse(&text).map_err(|faults| {
            let first = faults.into_iter().next();
            first.map_or_else(String::new, |fault| fault.message)
        })?;
        Ok((list, contents))
    }
}

/// What is in the files of the list, and which of them are not there or not as they should be.
///
/// # Errors
/// When a file that is there cannot be read.
pub fn contents(
    machine: &LoadedMachine,
    list: &LoadList,
) -> Result<(Vec<Vec<u8>>, Vec<Diagnostic>), HostError> {
    let cycles = oem_cycles::find(&machine.programs(0), &machine.plc_dialogues, &machine.parameters)?;
    let (mut contents, mut faults) = (Vec::new(), Vec::new());
    for file in &list.files {
        let mut fault = |message: String| {
            faults.push(Diagnostic::error(Span::line(file.line as usize), message));
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

/// Characters of a line from a column on, at least the one that is missing.
fn rest(line: &str, column: usize) -> usize {
    let count = line.chars().skip(column.saturating_sub(1)).count();
    count.max(1)
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
