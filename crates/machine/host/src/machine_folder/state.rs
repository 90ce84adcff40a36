//! What survives power-off: the journal of the PLC's memory, what the control remembers, and where the mechanics stand.
//!
//! Decision: What the first channel remembers stands in control.toml with what concerns the machine, that of the
//! second in control-2.toml; a change is on the medium of all before its strobe falls

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bahn_exchange::{Exchange, image_of, retained_memory};
use bahn_machine::Mechanics;
use bahn_tnc::{Control, Remembered};

use super::mechanics::{Found as Place, Moment, Part, bytes, digits, sum_of_text};
use super::remembered;
use crate::files::{self, NewFile};
use crate::operable::Operable;
use crate::retained::Retained;
use crate::{HostError, kept};

/// Where the mechanics stand.
const MECHANICS: &str = "mechanics.toml";
/// The journal of retained markers and bytes.
const JOURNAL: &str = "plc.mem";
/// What the control remembers, of the first channel and of a further one.
pub(super) fn control_file(channel: usize) -> String {
    match channel {
        0 => "control.toml".to_owned(),
        further => format!("control-{}.toml", further + 1),
    }
}
/// Held while a control is on.
pub(super) const LOCK: &str = "lock";
/// How often changes are looked for that nothing waits for.
const PERIOD: Duration = Duration::from_millis(200);
/// How often it is written where axes and spindles stand while nothing else changes.
const MOVES_PERIOD: Duration = Duration::from_secs(1);

/// A control is on that uses a state folder; nothing is made where there is none.
pub(super) fn is_in_use(folder: &Path) -> bool {
    let lock = folder.join(LOCK);
    let file = kept::open(&lock).ok().flatten();
    file.is_some_and(|file| kept::lock(&file, &lock) == Ok(false))
}

/// The state folder of a machine that is switched on.
pub struct State {
    journal: Retained,
    /// The file of each channel, and what stands in it.
    files: Vec<(PathBuf, String)>,
    /// Where everything stands, and what is written of it.
    mechanics: PathBuf,
    moment: Option<Moment>,
    /// Check sum of the pockets of the tables.
    pockets: u32,
    /// What the journal holds.
    memory: Vec<u8>,
    looked: Instant,
    moved: Instant,
    /// Unlocked when the control is switched off.
    _lock: File,
}

/// What a control finds at power-on.
pub struct Found {
    /// Where it keeps what changes.
    pub state: State,
    /// `None` when nothing is there yet.
    pub remembered: Option<Remembered>,
    /// That of the channels beside the first one.
    pub others: Vec<Option<Remembered>>,
    /// Both images with the retained markers and bytes.
    pub exchange: Exchange,
    /// Where the mechanics stand.
    pub mechanics: Option<FoundMechanics>,
    /// What was lost, in words.
    pub warnings: Vec<String>,
}

/// Where the mechanics stand, and whether the rest is of the same moment.
pub struct FoundMechanics {
    /// Where axes, spindle and tools of the simulated machine stand.
    pub mechanics: Mechanics,
    /// The pockets of the tables have changed since: who changed them has put the tools there.
    pub loaded_anew: bool,
    /// The files that were changed, or put in their place, since.
    pub others: Vec<PathBuf>,
}

impl State {
    /// Opens the folder of a machine with so many channels, and tables with this check sum of pockets; it is made when it
    /// is missing.
    ///
    /// # Errors
    /// When the folder cannot be used, another control uses it, or what the control remembered cannot be
    /// read: a machine does not start with another datum than it had.
    pub fn open(folder: &Path, channels: usize, pockets: u32) -> Result<Found, HostError> {
        fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
        let [lock_path, journal, mechanics] = [LOCK, JOURNAL, MECHANICS].map(|name| folder.join(name));
        let paths: Vec<PathBuf> = (0..channels.max(1))
            .map(|channel| folder.join(control_file(channel)))
            .collect();
        for path in [folder, &lock_path, &journal, &mechanics]
            .into_iter()
            .chain(paths.iter().map(PathBuf::as_path))
        {
            kept::refuse_link(path)?;
        }
        let lock = kept::open(&lock_path)?.map_or_else(|| kept::make(&lock_path), Ok)?;
        if !kept::lock(&lock, &lock_path)? {
            return Err(HostError::SwitchedOn(folder.display().to_string()));
        }
        files::sweep(folder);
        let mut warnings = Vec::new();
        let moment = moment_in(&mechanics, &mut warnings)?;
        let mut others = match &moment {
            Some(moment) => finish_control(moment, &paths)?,
            None => Vec::new(),
        };
        let (mut files, mut found) = (Vec::new(), Vec::new());
        for path in paths {
            let (written, remembered) = remembered_in(&path)?.unzip();
            files.push((path, written.unwrap_or_default()));
            found.push(remembered);
        }
        let further = found.split_off(1);
        let remembered = found.pop().flatten();
        let journal_is_missing = kept::open(&journal)?.is_none();
        if remembered.is_some() && journal_is_missing {
            warnings.push(format!(
                "{} is missing: all retained markers and bytes begin with 0",
                journal.display()
            ));
        }
        if remembered.is_some() && moment.is_none() && warnings.is_empty() {
            warnings.push(format!(
                "{} is missing: the machine stands as at its start, its tools lie where the control remembers them; \
                 look whether they do before a tool is changed",
                mechanics.display()
            ));
        }
        let path = journal;
        let mut journal = Retained::open(&path)?;
        warnings.extend(journal.damage().map(str::to_owned));
        if let Some(moment) = &moment
            && !finish_journal(moment, &mut journal)?
        {
            others.push(path);
        }
        let exchange = journal.restore();
        let memory = retained_memory(exchange.plc());
        let found_mechanics = moment.as_ref().map(|moment| FoundMechanics {
            mechanics: moment.mechanics.clone(),
            loaded_anew: moment.pockets != pockets,
            others,
        });
        Ok(Found {
            state: State {
                journal,
                files,
                mechanics,
                // What is there now may be something else: it is written anew.
                moment: None,
                pockets,
                memory,
                looked: Instant::now(),
                moved: Instant::now(),
                _lock: lock,
            },
            remembered,
            others: further,
            exchange,
            mechanics: found_mechanics,
            warnings,
        })
    }

    /// It is time to look for changes.
    pub fn is_due(&self) -> bool {
        self.looked.elapsed() >= PERIOD
    }

    /// Where the mechanics stand is kept here.
    pub(crate) fn mechanics_file(&self) -> &Path {
        &self.mechanics
    }

    /// Writes what changed: at once what the control waits for, everything else now and then.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep<P: Operable>(&mut self, control: &mut Control, plant: &P) -> Result<(), HostError> {
        if control.unsaved().is_some() {
            self.flush(control, plant)?;
            control.stored();
            return Ok(());
        }
        if !self.is_due() {
            return Ok(());
        }
        self.looked = Instant::now();
        let moves = self.moved.elapsed() >= MOVES_PERIOD;
        self.write(control, plant, moves)
    }

    /// Writes what changed at once: the control is switched off.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn flush<P: Operable>(&mut self, control: &Control, plant: &P) -> Result<(), HostError> {
        self.write(control, plant, true)
    }

    /// Writes a moment of the machine, where it has changed; movement alone is none when it is not said so.
    fn write<P: Operable>(&mut self, control: &Control, plant: &P, moves: bool) -> Result<(), HostError> {
        let image = control.exchange().plc();
        let memory = retained_memory(image);
        let texts: Vec<String> = (0..self.files.len())
            .map(|number| {
                let further = control.channel(number).filter(|_| number > 0);
                let remembered = further.map_or_else(|| control.remember(), |channel| channel.remember());
                remembered::write(&remembered)
            })
            .collect();
        if let Some(mechanics) = plant.mechanics() {
            let sums = [&self.memory, &memory].map(|memory| crc32fast::hash(memory));
            let part = |(text, (_, written)): (&String, &(PathBuf, String))| {
                Part::new([written, text].map(|text| sum_of_text(text)), text.clone())
            };
            let control = texts.iter().zip(&self.files).map(part).collect();
            let moment = Moment::new(self.pockets, Part::new(sums, digits(&memory)), control, mechanics);
            let same = self.moment.as_ref().is_some_and(|last| match moves {
                true => moment.says_the_same(last),
                false => moment.differs_only_in_movement(last),
            });
            if !same {
                let text = moment.write().map_err(HostError::new)?;
                put(&self.mechanics, &text)?;
                self.moment = Some(moment);
                self.moved = Instant::now();
            }
        }
        // First what the PLC did when it acknowledged, then what follows from it.
        self.journal.flush(image)?;
        self.memory = memory;
        for ((path, written), text) in self.files.iter_mut().zip(texts) {
            if text != *written {
                put(path, &text)?;
                *written = text;
            }
        }
        Ok(())
    }
}

/// Replaces a file by a text, in one step.
fn put(path: &Path, text: &str) -> Result<(), HostError> {
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| files::cannot("write", path, &error))?;
    file.finish()
}

/// The moment that the file holds; `None` when there is none, or it is damaged: it is kept aside then, and that is said.
fn moment_in(file: &Path, warnings: &mut Vec<String>) -> Result<Option<Moment>, HostError> {
    if kept::open(file)?.is_none() {
        return Ok(None);
    }
    let bytes = files::read_table(file)?;
    match Moment::read(&bytes) {
        Ok(moment) => Ok(Some(moment)),
        Err(what) => {
            let aside = kept::set_aside(file, &bytes).map_err(|error| files::cannot("keep", file, &error))?;
            fs::remove_file(file).map_err(|error| files::cannot("put aside", file, &error))?;
            files::sync_folder(file);
            warnings.push(format!(
                "{}: {what}\n  the machine stands as at its start, its tools lie where the control remembers them; look \
                 whether they do before a tool is changed\n  the file is kept: {}",
                file.display(),
                aside.display()
            ));
            Ok(None)
        }
    }
}

/// Finishes the files of the control that were to be written with the moment; those that are something else.
fn finish_control(moment: &Moment, paths: &[PathBuf]) -> Result<Vec<PathBuf>, HostError> {
    let mut others = Vec::new();
    for (path, part) in paths.iter().zip(&moment.control) {
        let is_there = kept::open(path)?.is_some();
        let bytes = if is_there {
            files::read_table(path)?
        } else {
            Vec::new()
        };
        match part.find(sum_of_text(&String::from_utf8_lossy(&bytes))) {
            Place::Same => {}
            Place::Before => put(path, &part.content)?,
            Place::Other => others.push(path.clone()),
        }
    }
    Ok(others)
}

/// Finishes the journal that was to be written with the moment; `false` when it holds something else.
fn finish_journal(moment: &Moment, journal: &mut Retained) -> Result<bool, HostError> {
    let memory = retained_memory(journal.restore().plc());
    match moment.plc.find(crc32fast::hash(&memory)) {
        Place::Same => Ok(true),
        Place::Other => Ok(false),
        Place::Before => {
            let image = bytes(&moment.plc.content).and_then(|memory| image_of(&memory));
            image.map_or(Ok(false), |image| journal.flush(&image).map(|()| true))
        }
    }
}

/// The text of the file and what it says; `None` when nothing was kept yet. A damaged file is put aside.
fn remembered_in(file: &Path) -> Result<Option<(String, Remembered)>, HostError> {
    if kept::open(file)?.is_none() {
        return match kept::found_aside(file) {
            None => Ok(None),
            Some(aside) => Err(unknown(file, &aside, "it was found damaged")),
        };
    }
    let bytes = files::read_table(file)?;
    match remembered::read(&bytes) {
        Ok(remembered) => Ok(Some((String::from_utf8_lossy(&bytes).into_owned(), remembered))),
        Err(what) => {
            let aside = kept::set_aside(file, &bytes).map_err(|error| files::cannot("keep", file, &error))?;
            fs::remove_file(file).map_err(|error| files::cannot("put aside", file, &error))?;
            files::sync_folder(file);
            Err(unknown(file, &aside, &what))
        }
    }
}

/// Nobody but the operator knows datum and tool now.
fn unknown(file: &Path, aside: &Path, what: &str) -> HostError {
    HostError::new(format!(
        "{}: {what}\ndatums, tool in the spindle, pockets, offsets and Q parameters are not known: the machine is not \
         started\nthe damaged file is kept: {}\nto go on with it, mend it, end it with the line `{}` and give it \
         its name back\nto begin with the datum of machine.toml, remove it",
        file.display(),
        aside.display(),
        remembered::MENDED
    ))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("bahn-state-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    fn with_tool(tool: u32) -> String {
        remembered::write(&Remembered {
            tool,
            q: vec![(1, 12.5), (100, -3.0)],
            ..Remembered::default()
        })
    }

    /// The supply goes after any byte of the new file, before its name changes: the machine begins with what was
    /// remembered before, and what is half written goes.
    #[test]
    fn a_power_failure_inside_a_write_keeps_what_was_remembered() {
        let folder = folder("torn");
        drop(State::open(&folder, 1, 0).unwrap());
        let (old, new) = (with_tool(3), with_tool(4));
        fs::write(folder.join("control.toml"), &old).unwrap();
        for written in 0..=new.len() {
            let half = folder.join(".control.toml.4711.tmp");
            fs::write(&half, &new.as_bytes()[..written]).unwrap();
            let found = State::open(&folder, 1, 0).unwrap();
            assert_eq!(found.remembered.unwrap().tool, 3, "{written} bytes");
            assert!(!half.exists(), "{written} bytes");
            // Nobody has written where the mechanics stand.
            let said = found.warnings.join("\n");
            assert!(
                said.contains("mechanics.toml is missing") && found.warnings.len() == 1,
                "{said}"
            );
        }
        // The name changes in one step.
        fs::write(folder.join(".control.toml.4711.tmp"), &new).unwrap();
        fs::rename(folder.join(".control.toml.4711.tmp"), folder.join("control.toml")).unwrap();
        assert_eq!(State::open(&folder, 1, 0).unwrap().remembered.unwrap().tool, 4);
        fs::remove_dir_all(&folder).unwrap();
    }
}
