//! The files that take the tool path.

use bahn_reader::Reader;
use std::io::Write;
use std::path::{Path, PathBuf};

use bahn_path::{BlockRef, Function, PathElement};

use crate::ReportError;
use crate::path_csv::PathTable;
use crate::path_svg::PathDrawing;
use crate::record::{Notice, Record};
use bahn_host::files::{self, NewFile};
use bahn_text::printable;

/// A file for the tool path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathFile {
    /// A table with a line for each element.
    Csv(PathBuf),
    /// A drawing in plan view.
    Svg(PathBuf),
}

/// The files that take the tool path.
#[derive(Default)]
pub struct Outputs {
    tables: Vec<(PathTable, PathBuf)>,
    drawings: Vec<(PathDrawing, NewFile)>,
    /// What FN15 puts out.
    print: Option<(NewFile, PathBuf)>,
    /// Short names of the programs of the run by number, with nothing in them that steers a terminal.
    names: Vec<String>,
    /// The block of the last element, and what reports call it.
    last: Option<(BlockRef, u32)>,
}

impl Outputs {
    /// Begins the files: tables and drawings of the path, and a text file for what FN15 puts out.
    ///
    /// # Errors
    /// When one cannot be created.
    pub fn create(paths: &[PathFile], print: Option<&Path>) -> Result<Outputs, ReportError> {
        let mut outputs = Outputs::default();
        if let Some(path) = print {
            outputs.print = Some((NewFile::create(path)?, path.to_owned()));
        }
        for file in paths {
            match file {
                PathFile::Csv(path) => {
                    let table = PathTable::new(NewFile::create(path)?);
                    outputs
                        .tables
                        .push((table.map_err(|e| files::cannot("write", path, &e))?, path.clone()));
                }
                PathFile::Svg(path) => outputs
                    .drawings
                    .push((PathDrawing::default(), NewFile::create(path)?)),
            }
        }
        Ok(outputs)
    }

    /// No file is to be written.
    pub fn is_empty(&self) -> bool {
        self.tables.is_empty() && self.drawings.is_empty() && self.print.is_none()
    }

    /// Takes an element of a run.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn element(
        &mut self,
        element: &PathElement,
        run: &dyn Reader,
        record: &mut Record,
    ) -> Result<(), ReportError> {
        let number = element.block.program;
        while self.names.len() <= usize::from(number) {
            let program = run.program(self.names.len() as u16);
            self.names.push(
                program
                    .map(|program| printable(files::short_name(program)))
                    .unwrap_or_default(),
            );
        }
        if let Some((file, path)) = &mut self.print {
            for output in element.functions() {
                if let Function::Print(line) = &output.function {
                    writeln!(file, "{line}").map_err(|error| files::cannot("write", path, &error))?;
                }
            }
        }
        let name = self.names.get(usize::from(number)).map_or("", String::as_str);
        // A table that is wanted asks for the number of a block once for all of its elements.
        if !self.tables.is_empty() && self.last.is_none_or(|(last, _)| last != element.block) {
            let program = run.program(number);
            let called = program.map_or(element.block.block, |of| of.number_of(element.block.block));
            self.last = Some((element.block, called));
        }
        let block = self.last.map_or(element.block.block, |(_, called)| called);
        for (table, path) in &mut self.tables {
            table
                .element(element, name, block)
                .map_err(|error| files::cannot("write", path, &error))?;
        }
        for (drawing, _) in &mut self.drawings {
            if !drawing.element(element) {
                record.warn(element.block, Notice::DrawingIncomplete, 1);
            }
        }
        Ok(())
    }

    /// Completes all files, also after one that cannot be written.
    ///
    /// # Errors
    /// The first of those.
    pub fn finish(&mut self) -> Result<(), ReportError> {
        let mut written = Ok(());
        for (table, _) in self.tables.drain(..) {
            written = written.and(table.into_file().finish().map_err(ReportError::from));
        }
        if let Some((file, _)) = self.print.take() {
            written = written.and(file.finish().map_err(ReportError::from));
        }
        let title = self.names.first().cloned().unwrap_or_default();
        for (drawing, mut file) in self.drawings.drain(..) {
            let drawn = drawing.write(&title, &mut file);
            written = written.and(drawn.and_then(|()| Ok(file.finish()?)));
        }
        written
    }
}
