//! What is wrong with a list, at its place, in the words of the control.

use std::path::Path;

use bahn_text::{Diagnostic, Related, Severity, Span};

use crate::{Definition, Inconsistency, ListError, ListText, ParameterError, ParameterList, chapters};

impl ListError {
    /// For people and for programs: number and text of the control, and what the parameter is.
    pub fn diagnostic(&self, text: &ListText, file: &Path) -> Diagnostic {
        let number = self.error.number();
        let first = match self.error {
            ParameterError::DoublyDefined { first_line, .. } => Some(Related {
                file: file.to_owned(),
                span: Span::line(first_line),
                message: "it is defined here first".to_owned(),
                source: text.line(first_line),
            }),
            _ => None,
        };
        Diagnostic {
            related: first.into_iter().collect(),
            ..Diagnostic::error(self.span, format!("{number} {}", self.error.control_text()))
                .with_code(number.to_string())
                .with_detail(self.error.to_string())
                .with_help(self.help(text))
                .at(file, text.line(self.span.line as usize))
        }
    }

    /// What the parameter is, for someone who has to enter another value.
    fn help(&self, text: &ListText) -> Option<String> {
        let id = self.error.id()?;
        let definition = Definition::named(text.model(), id).ok()?;
        let choices: Vec<&str> = definition.choices().take(6).collect();
        let unit = match definition.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        let range = definition
            .range_text()
            .map(|[min, max]| format!(", {min} to {max}{unit}"));
        let mut help = format!("{id} is {}{}", definition.name, range.unwrap_or_default());
        if !choices.is_empty() {
            help += &format!(" ({})", choices.join("; "));
        }
        Some(help)
    }
}

impl ListText {
    /// All faults of the list of a machine; where it has none, what does not go together in the values `list` that are made
    /// of it. What the text does not name keeps its value of the reference list.
    pub fn diagnostics(&self, list: &ParameterList, file: &Path) -> Vec<Diagnostic> {
        let faults = self.faults();
        if !faults.is_empty() {
            return faults.iter().map(|found| found.diagnostic(self, file)).collect();
        }
        let found = list.inconsistencies();
        found.iter().map(|found| found.diagnostic(self, file)).collect()
    }

    /// What the control of a list lacks for values of this text: an option, or a later software. A parameter with the value
    /// that the control gives it by itself asks for nothing.
    pub fn lacking(&self, list: &ParameterList, file: &Path) -> Vec<Diagnostic> {
        let lacking = self.entries().iter().filter_map(|entry| {
            let why = list.lacks(entry.id, entry.value)?;
            let span = self.span_of(entry);
            let fault = Diagnostic::error(span, format!("{} = {} is {why}", entry.id, entry.value));
            Some(
                fault
                    .with_code(entry.id.to_string())
                    .at(file, self.line(span.line as usize)),
            )
        });
        lacking.collect()
    }
}

impl Inconsistency {
    /// At the value that is wrong, or one of them; at the first line where the list names none. An error where no machine
    /// can be so.
    pub fn diagnostic(&self, text: &ListText, file: &Path) -> Diagnostic {
        let entry = text.entries().iter().find(|entry| entry.id == self.id);
        let span = entry.map_or(Span::line(1), |entry| text.span_of(entry));
        let severity = match self.impossible {
            true => Severity::Error,
            false => Severity::Warning,
        };
        let detail = format!("{} ({})", self.detail, chapters(self.source).join("; "));
        Diagnostic {
            severity,
            ..Diagnostic::error(span, self.rule)
                .with_code(self.id.to_string())
                .with_detail(detail)
                .at(file, text.line(span.line as usize))
        }
    }
}
