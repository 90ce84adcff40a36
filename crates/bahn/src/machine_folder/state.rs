//! What survives power-off: the journal of the PLC's memory, and what the control remembers.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File, TryLockError};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bahn_control::{Control, Position0, Remembered};
use bahn_exchange::Exchange;
use bahn_path::{Axis, Position};
use serde::Deserialize;

use crate::files::{self, NewFile};
use crate::{UsageError, plc};

/// The journal of retained markers and bytes.
const JOURNAL: &str = "plc.mem";
/// What the control remembers.
const CONTROL: &str = "control.toml";
/// Held while a control is on.
const LOCK: &str = "lock";
/// How often changes are looked for.
const PERIOD: Duration = Duration::from_millis(200);

/// The state folder of a machine that is switched on.
pub(crate) struct State {
    file: PathBuf,
    journal: plc::Retained,
    written: String,
    looked: Instant,
    /// Unlocked when the control is switched off.
    _lock: File,
}

/// What a control finds at power-on.
pub(crate) struct Found {
    pub state: State,
    /// `None` when nothing is there, or it is damaged.
    pub remembered: Option<Remembered>,
    pub exchange: Exchange,
    /// Why what is there cannot be used.
    pub damage: Option<String>,
}

impl State {
    /// Opens the folder; it is made when it is missing.
    ///
    /// # Errors
    /// When the folder cannot be used, or another control uses it.
    pub fn open(folder: &Path) -> Result<Found, UsageError> {
        fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
        let lock_path = folder.join(LOCK);
        let lock = File::create(&lock_path).map_err(|error| files::cannot("write", &lock_path, &error))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(UsageError::new(format!(
                    "{}: the machine is switched on already; --fresh runs beside it without its state",
                    folder.display()
                )));
            }
            Err(TryLockError::Error(error)) => return Err(files::cannot("lock", &lock_path, &error)),
        }
        let journal = plc::Retained::open(&folder.join(JOURNAL))?;
        let file = folder.join(CONTROL);
        let exchange = journal.restore();
        let (written, read) = match fs::read_to_string(&file) {
            Ok(text) => {
                let read = read(&text).map(Some);
                (text, read)
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => (String::new(), Ok(None)),
            Err(error) => (String::new(), Err(error.to_string())),
        };
        let (remembered, damage) = match read {
            Ok(remembered) => (remembered, None),
            Err(what) => (None, Some(format!("{}: {what}", file.display()))),
        };
        Ok(Found {
            state: State {
                file,
                journal,
                written,
                looked: Instant::now(),
                _lock: lock,
            },
            remembered,
            exchange,
            damage,
        })
    }

    /// Writes what changed, now and then.
    pub fn tick(&mut self, control: &Control) -> Result<(), UsageError> {
        if self.looked.elapsed() < PERIOD {
            return Ok(());
        }
        self.looked = Instant::now();
        self.journal.tick(control.exchange().plc())?;
        self.write(control)
    }

    /// Writes what changed at once: the control is switched off.
    pub fn flush(&mut self, control: &Control) -> Result<(), UsageError> {
        self.journal.flush(control.exchange().plc())?;
        self.write(control)
    }

    fn write(&mut self, control: &Control) -> Result<(), UsageError> {
        let text = text(&control.remember());
        if text == self.written {
            return Ok(());
        }
        let mut file = NewFile::create(&self.file)?;
        file.write_all(text.as_bytes())
            .map_err(|error| files::cannot("write", &self.file, &error))?;
        file.finish()?;
        self.written = text;
        Ok(())
    }
}

/// The form of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Form {
    tool: u32,
    tool_length: f64,
    tool_axis: Option<char>,
    program: Option<String>,
    offsets_volts: [f64; 5],
    datum: [BTreeMap<char, f64>; 3],
    #[serde(default)]
    q: BTreeMap<String, f64>,
}

fn text(remembered: &Remembered) -> String {
    let mut text = String::from("# What the control remembers over power-off. It writes this file itself.\n");
    // Writing to a string cannot fail.
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("tool", remembered.tool.to_string());
    line("tool_length", number(remembered.tool_length));
    if let Some(axis) = remembered.tool_axis {
        line("tool_axis", format!("\"{}\"", axis.letter()));
    }
    if let Some(program) = &remembered.program {
        line("program", toml::Value::from(program.as_str()).to_string());
    }
    line("offsets_volts", list(remembered.offsets_volts.map(number)));
    let datum = |Position0(datum): &Position0| {
        let known = Axis::ALL.into_iter().filter_map(|axis| {
            let value = datum.get(axis).filter(|value| value.is_finite())?;
            Some(format!("{} = {}", axis.letter(), number(value)))
        });
        format!("{{ {} }}", known.collect::<Vec<_>>().join(", "))
    };
    line(
        "# Workpiece datum of each traverse range, machine coordinates\ndatum",
        list([0, 1, 2].map(|range| remembered.datums.get(range).map(datum).unwrap_or_default())),
    );
    if !remembered.q.is_empty() {
        text.push_str("\n[q]\n");
        for (q, value) in remembered.q.iter().filter(|(_, value)| value.is_finite()) {
            let _ = writeln!(text, "{q} = {}", number(*value));
        }
    }
    text
}

fn list<const N: usize>(values: [String; N]) -> String {
    format!("[{}]", values.join(", "))
}

/// A number that reads back as the same one, with a point.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn read(text: &str) -> Result<Remembered, String> {
    let form: Form = toml::from_str(text).map_err(|error| {
        let line = error.span().map_or(1, |span| {
            text.get(..span.start)
                .map_or(1, |before| before.matches('\n').count() + 1)
        });
        format!("line {line}: {}", error.message())
    })?;
    let axis = |letter: char| {
        u8::try_from(letter)
            .ok()
            .and_then(Axis::from_letter)
            .ok_or_else(|| format!("`{letter}` is no axis"))
    };
    let mut datums = [Position0::default(); 3];
    for (datum, values) in datums.iter_mut().zip(&form.datum) {
        let mut position = Position::ZERO;
        for (letter, value) in values {
            position[axis(*letter)?] = finite(*value)?;
        }
        *datum = Position0(position);
    }
    let mut q = Vec::new();
    for (name, value) in &form.q {
        let number = name.parse().map_err(|_| format!("`{name}` is no Q parameter"))?;
        q.push((number, finite(*value)?));
    }
    q.sort_by_key(|(number, _)| *number);
    for volts in form.offsets_volts {
        finite(volts)?;
    }
    Ok(Remembered {
        datums,
        tool: form.tool,
        tool_length: finite(form.tool_length)?,
        tool_axis: form.tool_axis.map(axis).transpose()?,
        q,
        offsets_volts: form.offsets_volts,
        program: form.program,
    })
}

fn finite(value: f64) -> Result<f64, String> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("{value} is no value"))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_is_written_is_read(
            tool in 0..99u32,
            values in prop::array::uniform5(-1e5..1e5f64),
            axis in prop::option::of(0..Axis::COUNT),
            program in prop::option::of(".{0,12}"),
            q in prop::collection::btree_map(0..300u16, -1e9..1e9f64, 0..5),
        ) {
            let mut position = Position::ZERO;
            position[Axis::X] = values[0];
            position[Axis::C] = values[1];
            let remembered = Remembered {
                datums: [Position0(position), Position0::default(), Position0(position)],
                tool,
                tool_length: values[2],
                tool_axis: axis.and_then(|axis| Axis::ALL.get(axis).copied()),
                q: q.into_iter().collect(),
                offsets_volts: values,
                program,
            };
            prop_assert_eq!(read(&text(&remembered)), Ok(remembered));
        }

        #[test]
        fn any_text_is_read_or_refused(text in ".{0,80}") {
            let _ = read(&text);
        }
    }

    #[test]
    fn damage_is_named_with_its_line() {
        let whole = text(&Remembered::default());
        let damaged = whole.replace("tool_length = 0.0", "tool_length = O.0");
        assert!(
            read(&damaged).unwrap_err().starts_with("line 3: "),
            "{:?}",
            read(&damaged)
        );
        let half = whole.split_at(whole.len() / 2).0;
        assert!(read(half).is_err());
    }
}
