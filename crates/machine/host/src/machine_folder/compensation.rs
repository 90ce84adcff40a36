//! The files of the axis-error compensation of a machine, and whether its parameters select what they hold.

use std::collections::BTreeSet;
use std::path::Path;

use bahn_machine::MachineFolder;
use bahn_parameters::operation::Station;
use bahn_parameters::{Inconsistency, ListText, PLC_AXIS_NAMES, ParameterId, ParameterList};
use bahn_text::{Diagnostic, Span, decode};
use bahn_tnc::{CompensationAssignment, CompensationError, CompensationTable, CorrectionTables, NcFiles};

use super::load::Loader;
use crate::files;

impl Loader<'_> {
    /// The assignment of the axis-error compensation with its tables.
    pub(super) fn compensation(&mut self, folder: &MachineFolder) -> Option<NcFiles> {
        let mut files = NcFiles::default();
        if let Some(name) = &folder.correction_tables {
            files.correction_tables = Some(self.correction_tables(name)?);
        }
        let Some(name) = &folder.compensation else {
            return Some(files);
        };
        if !self.stays_inside("compensation", name) {
            return None;
        }
        let (path, bytes) = self.read("compensation", name)?;
        let text = decode(&bytes);
        let assignment = CompensationAssignment::read(&text);
        let assignment = self.compensation_read(&path, &text, assignment)?;
        let names: BTreeSet<String> = assignment.lines.iter().flatten().flatten().cloned().collect();
        let beside = Path::new(name).parent().unwrap_or(Path::new(""));
        let mut complete = true;
        for table in names {
            if !self.stays_inside("compensation", &table) {
                complete = false;
                continue;
            }
            let file = beside.join(format!("{table}.COM"));
            let table_read = self.read("compensation", &file.display().to_string());
            let table_read = table_read.and_then(|(path, bytes)| {
                let text = decode(&bytes);
                let read = CompensationTable::read(&text);
                self.compensation_read(&path, &text, read)
            });
            match table_read {
                Some(read) => drop(files.compensation_tables.insert(table, read)),
                None => complete = false,
            }
        }
        if complete {
            let checked = assignment.check_active(&text, &files.compensation_tables);
            self.compensation_read(&path, &text, checked)?;
        }
        files.compensation = Some(assignment);
        complete.then_some(files)
    }

    fn compensation_read<T>(
        &mut self,
        path: &Path,
        text: &str,
        read: Result<T, CompensationError>,
    ) -> Option<T> {
        let fault = match read {
            Ok(read) => return Some(read),
            Err(fault) => fault,
        };
        let fault = Diagnostic::error(Span::line(fault.line), fault.what).under("the compensation is wrong");
        self.faults.push(fault.in_text(path, text));
        None
    }

    /// The correction tables of code number 105 296.
    fn correction_tables(&mut self, name: &str) -> Option<CorrectionTables> {
        if !self.stays_inside("correction_tables", name) {
            return None;
        }
        let (path, bytes) = self.read("correction_tables", name)?;
        let text = decode(&bytes);
        let read = CorrectionTables::read(&text);
        self.compensation_read(&path, &text, read)
    }

    /// Warns where MP730 selects tables that there are not, or tables are there that it does not select: MP720 does
    /// not act then, or they do not [000:3751-3758] [000:3887-3896]. `name` is the file of the list.
    pub(super) fn nonlinear(&mut self, name: &str, list: &ParameterList, files: &NcFiles) {
        if list.operation_parameters().station != Station::Machine {
            return;
        }
        let found = nonlinear(list, files);
        if found.is_empty() {
            return;
        }
        let path = self.root.join(name);
        let Ok(bytes) = files::read_table(&path) else {
            return;
        };
        let text = ListText::from_bytes(list.model(), &bytes);
        let warnings = found.iter().map(|found| found.diagnostic(&text, &path));
        self.warnings.extend(warnings);
    }
}

/// What MP730 and the files of the compensation do not agree in.
fn nonlinear(list: &ParameterList, files: &NcFiles) -> Vec<Inconsistency> {
    const SOURCE: &str = "000:3875-3896";
    let id = ParameterId {
        number: 730,
        index: None,
    };
    let found = |rule, detail| Inconsistency {
        id,
        rule,
        detail,
        impossible: false,
        source: SOURCE,
    };
    let old = files.correction_tables.as_ref();
    if let (Some(_), Some(_)) = (&files.compensation, old) {
        let detail = "there is an assignment (.CMA), so the correction tables do not apply".to_owned();
        return vec![found("the correction tables have no effect", detail)];
    }
    if files.compensation.is_some() {
        return Vec::new();
    }
    let mut all = Vec::new();
    for (index, name) in (0..list.model().limits().axes_max).zip(PLC_AXIS_NAMES) {
        let axis = list.axis_parameters(index);
        let table = old.is_some_and(|old| old.driving(index.into()).is_some());
        let nonlinear = axis.active && axis.compensation.nonlinear;
        if nonlinear && !table {
            let detail =
                format!("axis {name}: neither an assignment (.CMA) nor a correction table; MP720 is off");
            all.push(found(
                "non-linear compensation is selected, but there is no table",
                detail,
            ));
        } else if table && !nonlinear {
            let detail = format!("axis {name}: its correction table has no effect");
            all.push(found("a correction table is not selected", detail));
        }
    }
    all
}
