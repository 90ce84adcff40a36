//! The part programs of a System 900: `P1000.900` in the folder of programs, by their numbers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_control900::Language;
use bahn_reader::Reader;

use crate::files::{self, NcFolder};

/// Where programs are.
#[derive(Clone, Debug, Default)]
pub struct Programs900 {
    folder: PathBuf,
    /// Programs elsewhere, by their numbers.
    named: Vec<(i64, PathBuf)>,
}

impl Programs900 {
    /// Those of a folder.
    pub fn of_folder(folder: &Path) -> Programs900 {
        Programs900 {
            folder: folder.to_owned(),
            named: Vec::new(),
        }
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The number of a program by the name of its file: 1000 of `P1000.900`.
    ///
    /// ```
    /// use bahn_host::Programs900;
    /// assert_eq!(Programs900::number("parts/P1000.900".as_ref()), Some(1000));
    /// assert_eq!(Programs900::number("Z6.900".as_ref()), None);
    /// ```
    pub fn number(file: &Path) -> Option<i64> {
        let stem = file.file_stem()?.to_str()?;
        let digits = stem.strip_prefix(['P', 'p']).unwrap_or(stem);
        let all = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
        all.then(|| digits.parse().ok()).flatten()
    }

    /// Takes a file that somebody names: a path, or the name of one in the folder. Its number.
    ///
    /// # Errors
    /// In words, when there is none, or its name has no number.
    pub fn add(&mut self, file: &Path) -> Result<i64, String> {
        let there = [file.to_owned(), self.folder.join(file)];
        let found = there.into_iter().find(|path| path.is_file());
        let found = found.ok_or_else(|| format!("{}: there is no such program", file.display()))?;
        let number = Programs900::number(&found).ok_or_else(|| {
            format!(
                "{}: the name of a program is its number, as P1000.900",
                found.display()
            )
        })?;
        let same = self
            .named
            .iter()
            .find(|(of, path)| *of == number && *path != found);
        if let Some((_, other)) = same {
            return Err(format!(
                "{} and {} have the same number, {number}",
                other.display(),
                found.display()
            ));
        }
        self.named.push((number, found));
        Ok(number)
    }

    /// The file of a program.
    pub fn file(&self, number: i64) -> PathBuf {
        let named = self.named.iter().rfind(|(of, _)| *of == number);
        named.map_or_else(
            || self.folder.join(format!("P{number}.900")),
            |(_, path)| path.clone(),
        )
    }

    /// Reads a program for a channel, from 1 on.
    ///
    /// # Errors
    /// In words, when it cannot be read.
    pub fn read(&self, number: i64, channel: u8, language: Language) -> Result<Box<dyn Reader>, String> {
        let path = self.file(number);
        let bytes = files::read_program(&path).map_err(|error| error.to_string())?;
        let bytes = bytes.ok_or_else(|| format!("{}: {}", path.display(), files::TOO_LARGE))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let beside = Arc::new(NcFolder::of(&path));
        Ok((language.open)(&name, &bytes, channel, beside))
    }
}
