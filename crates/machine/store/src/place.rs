//! Where a file is, as clients write it.

use std::fmt;

use super::StoreError;

/// Drive of the part programs.
pub const TNC: &str = "TNC";
/// Drive of the PLC's files.
pub const PLC: &str = "PLC";
/// Characters of a name at most.
pub const NAME_MAX: usize = 40;
/// What stands between folders.
const SEPARATORS: [char; 2] = ['\\', '/'];
/// Characters of a path at most, which is more than the 80 of LSV/2.
const PATH_MAX: usize = 255;
/// Folders in each other at most.
const DEPTH_MAX: usize = 12;

/// Where a file or folder is: a drive and names. What it was made of is checked: it leads nowhere else.
///
/// ```
/// use bahn_store::Place;
///
/// let programs = Place::root("TNC");
/// let part = programs.join(r"PARTS\15.H")?;
/// assert_eq!(part.to_string(), r"TNC:\PARTS\15.H");
/// assert_eq!(part.join(r"PLC:\MAIN.PLC")?.drive(), "PLC");
/// assert!(programs.join(r"..\machine.toml").is_err());
/// # Ok::<(), bahn_store::StoreError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    drive: String,
    names: Vec<String>,
}

impl Place {
    /// The root of a drive, named without its colon; a disk has one without a name.
    pub fn root(drive: &str) -> Place {
        Place {
            drive: drive.to_ascii_uppercase(),
            names: Vec::new(),
        }
    }

    /// What a path leads to that begins here; one with a drive begins at its root. Folders have `\` or `/` between them,
    /// one may stand at the end.
    ///
    /// # Errors
    /// When it is no path: `..`, an absolute path without a drive, the name of a device, characters that no name has.
    pub fn join(&self, path: &str) -> Result<Place, StoreError> {
        let refused = || StoreError::BadName(path.chars().take(PATH_MAX).collect());
        if path.len() > PATH_MAX {
            return Err(refused());
        }
        let (mut place, rest) = match path.split_once(':') {
            Some((drive, rest)) if is_drive(drive) => {
                (Place::root(drive), rest.strip_prefix(SEPARATORS).unwrap_or(rest))
            }
            Some(_) => return Err(refused()),
            None => (self.clone(), path),
        };
        // Hosts write `\\\\` between folders and after them, too: it is one.
        let rest = rest.trim_end_matches(SEPARATORS);
        if rest.is_empty() {
            // A drive alone; nothing at all is no path.
            return if path.contains(':') {
                Ok(place)
            } else {
                Err(refused())
            };
        }
        if rest.starts_with(SEPARATORS) {
            return Err(refused());
        }
        for name in rest.split(SEPARATORS).filter(|name| !name.is_empty()) {
            if !is_name(name) {
                return Err(refused());
            }
            place.names.push(name.to_owned());
        }
        if place.names.len() > DEPTH_MAX {
            return Err(refused());
        }
        Ok(place)
    }

    /// It is this place, or a folder that leads there.
    pub fn holds(&self, other: &Place) -> bool {
        let same = |(own, other): (&String, &String)| own.eq_ignore_ascii_case(other);
        self.drive == other.drive
            && self.names.len() <= other.names.len()
            && self.names.iter().zip(&other.names).all(same)
    }

    /// The drive, in capitals and without its colon.
    pub fn drive(&self) -> &str {
        &self.drive
    }

    /// Names of the folders that lead there, and its own.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Its own name; a drive has none.
    pub fn name(&self) -> Option<&str> {
        self.names.last().map(String::as_str)
    }

    /// The folder in which it is; a drive is in none.
    pub fn folder(&self) -> Option<Place> {
        let (_, folders) = self.names.split_last()?;
        Some(Place {
            drive: self.drive.clone(),
            names: folders.to_vec(),
        })
    }
}

impl fmt::Display for Place {
    /// As the control shows it: `TNC:\PARTS\15.H`; a drive ends with its stroke.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.drive.is_empty() {
            write!(f, "{}:\\", self.drive)?;
        }
        f.write_str(&self.names.join("\\"))
    }
}

fn is_drive(name: &str) -> bool {
    (1..=8).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_alphanumeric())
}

/// A name of the store: letters, digits and what controls know, nothing hidden, and no device of any system.
pub(super) fn is_name(name: &str) -> bool {
    let fits = |character: char| character.is_ascii_alphanumeric() || "$_#-.%+".contains(character);
    (1..=NAME_MAX).contains(&name.len())
        && !name.starts_with('.')
        && !name.ends_with('.')
        && name.chars().all(fits)
        && !is_device(name)
}

/// What some systems take for a device whatever its extension is.
fn is_device(name: &str) -> bool {
    const DEVICES: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];
    let stem = name.split('.').next().unwrap_or(name).to_ascii_uppercase();
    let port = stem.strip_prefix("COM").or_else(|| stem.strip_prefix("LPT"));
    let is_port = port.is_some_and(|number| matches!(number.as_bytes(), [b'0'..=b'9']));
    is_port || DEVICES.contains(&stem.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn tricks_lead_nowhere() {
        let root = Place::root("TNC");
        for path in [
            "",
            "..",
            ".",
            "..\\1.H",
            "A\\..\\..\\1.H",
            "A/../1.H",
            "\\1.H",
            "/etc/passwd",
            "C:1.H:2",
            "1.H\0",
            "1.H\0.TXT",
            "\\\\server\\share",
            "\\\\?\\C:\\1.H",
            "file://1.H",
            "CON",
            "con.h",
            "A\\NUL.H",
            "COM1",
            "lpt9.a",
            "1.H.",
            ".1.H",
            "1.H:stream",
            "ä.H",
            "a b.H",
            "~\\1.H",
            "TNC:\\..",
            "TNC:..",
            ":1.H",
            "//",
            "\\",
            "TNC://1.H",
            "*.H",
            "?",
            "\u{202e}h.1",
            "1\n.H",
        ] {
            assert!(root.join(path).is_err(), "{path:?}");
        }
        assert!(root.join(&"A".repeat(NAME_MAX)).is_ok());
        assert!(root.join(&"A".repeat(NAME_MAX + 1)).is_err());
        assert!(root.join(&"A\\".repeat(DEPTH_MAX)).is_ok());
        assert!(root.join(&"A\\".repeat(DEPTH_MAX + 1)).is_err());
    }

    #[test]
    fn paths_lead_where_they_say() {
        let here = Place::root("TNC").join("PARTS").unwrap();
        for (path, place) in [
            ("15.H", "TNC:\\PARTS\\15.H"),
            ("A/b.H", "TNC:\\PARTS\\A\\b.H"),
            ("A\\", "TNC:\\PARTS\\A"),
            ("A\\\\", "TNC:\\PARTS\\A"),
            ("TNC:\\A\\\\b.H", "TNC:\\A\\b.H"),
            ("tnc:", "TNC:\\"),
            ("TNC:\\", "TNC:\\"),
            ("TNC:/", "TNC:\\"),
            ("plc:/MAIN.PLC", "PLC:\\MAIN.PLC"),
            ("TNC:1.H", "TNC:\\1.H"),
            ("COM.A", "TNC:\\PARTS\\COM.A"),
            ("$MDI.H", "TNC:\\PARTS\\$MDI.H"),
        ] {
            assert_eq!(here.join(path).unwrap().to_string(), place, "{path}");
        }
        assert_eq!(here.folder().unwrap().to_string(), "TNC:\\");
        assert_eq!(here.folder().unwrap().folder(), None);
        assert_eq!(Place::root("").join("1.H").unwrap().to_string(), "1.H");
    }

    proptest! {
        /// Whatever is sent: a place that is one has only names, and reads back as itself.
        #[test]
        fn every_place_is_made_of_names(path in "\\PC{0,40}|[A-C./\\\\:%0]{0,30}") {
            if let Ok(place) = Place::root("TNC").join(&path) {
                prop_assert!(place.names().iter().all(|name| is_name(name)));
                prop_assert_eq!(Place::root("PLC").join(&place.to_string()), Ok(place));
            }
        }
    }
}
