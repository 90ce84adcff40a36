//! `bahn conformance`: what each function of a control does here, from the registry of the control models.

use bahn_parameters::ControlModel;
use bahn_parameters::conformance::{Effect, Entry, Kind, all};
use bahn_report::text;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::options::model_parser;
use crate::{Outcome, UsageError, console};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn conformance                              everything, for all control models
  bahn conformance --model tnc360 --kind m      the M functions of a TNC 360
  bahn conformance --effect none --kind parameter
      Machine parameters that are read and have no effect.
  bahn conformance --format json

acts: all that the manual says; partly: without what is named; none: read and passed over. Programs that use
what moves differently on the control (`moves`) are refused unless --skip-unknown is given.
JSON: totals (kind, model, acts, partly, none) and entries (kind, name, controls, effect, moves, missing,
source, proof).";

/// Options of `bahn conformance`.
#[derive(Args, Debug)]
pub(crate) struct ConformanceOptions {
    /// Control model; all of them without it.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// Only one kind of functions.
    #[arg(long, value_name = "KIND", value_parser = kind_parser())]
    pub kind: Option<Kind>,
    /// Only what acts, acts partly or has no effect.
    #[arg(long, value_name = "EFFECT", value_parser = effect_parser())]
    pub effect: Option<Effect>,
    /// How the table is written.
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub format: TableFormat,
}

/// How the table is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Lines for people.
    #[default]
    Text,
    /// JSON for programs.
    Json,
    /// For docs/conformance.md.
    Markdown,
}

fn kind_parser() -> impl clap::builder::TypedValueParser<Value = Kind> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let named = |id: String| Kind::ALL.into_iter().find(|kind| kind.id() == id);
    PossibleValuesParser::new(Kind::ALL.map(Kind::id)).try_map(move |id| named(id).ok_or("unknown kind"))
}

fn effect_parser() -> impl clap::builder::TypedValueParser<Value = Effect> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let named = |id: String| Effect::ALL.into_iter().find(|effect| effect.id() == id);
    PossibleValuesParser::new(Effect::ALL.map(Effect::id))
        .try_map(move |id| named(id).ok_or("unknown effect"))
}

pub(crate) fn command(options: &ConformanceOptions) -> Result<Outcome, UsageError> {
    let table = Table::new(options);
    let text = match options.format {
        TableFormat::Text => table.text(),
        TableFormat::Markdown => table.markdown(),
        TableFormat::Json => text::json(&table)?,
    };
    console::print(&text)?;
    Ok(Outcome::Fine)
}

#[derive(Serialize)]
struct Table {
    totals: Vec<Totals>,
    entries: Vec<Row>,
}

/// How many functions of a kind act on a model.
#[derive(Serialize)]
struct Totals {
    kind: &'static str,
    model: &'static str,
    acts: usize,
    partly: usize,
    none: usize,
}

#[derive(Serialize)]
struct Row {
    #[serde(serialize_with = "kind_id")]
    kind: Kind,
    name: &'static str,
    controls: &'static str,
    effect: &'static str,
    moves: bool,
    missing: &'static str,
    source: &'static str,
    proof: &'static str,
}

fn kind_id<S: serde::Serializer>(kind: &Kind, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(kind.id())
}

impl Table {
    fn new(options: &ConformanceOptions) -> Table {
        let is_wanted = |entry: &&Entry| {
            options.model.is_none_or(|model| entry.is_of(model))
                && options.kind.is_none_or(|kind| entry.kind == kind)
        };
        let entries: Vec<&Entry> = all().iter().filter(is_wanted).collect();
        let models = ControlModel::FAMILIES
            .into_iter()
            .filter(|model| options.model.is_none_or(|wanted| wanted.family() == *model));
        let totals = models.flat_map(|model| {
            let kinds = Kind::ALL.into_iter();
            kinds.map(move |kind| (kind, model))
        });
        let totals = totals.filter(|(kind, _)| options.kind.is_none_or(|wanted| wanted == *kind));
        let totals = totals.map(|(kind, model)| Totals::new(&entries, kind, model));
        Table {
            totals: totals.collect(),
            entries: entries
                .iter()
                .filter(|entry| options.effect.is_none_or(|effect| entry.effect == effect))
                .map(|entry| Row::new(entry))
                .collect(),
        }
    }

    /// The rows of each kind, in the order of the registry.
    fn groups(&self) -> impl Iterator<Item = &[Row]> {
        self.entries.chunk_by(|a, b| a.kind == b.kind)
    }

    /// The totals as lines of columns.
    fn total_lines(&self) -> Vec<[String; 5]> {
        let line = |totals: &Totals| {
            [
                totals.model.to_owned(),
                totals.kind.to_owned(),
                totals.acts.to_string(),
                totals.partly.to_string(),
                totals.none.to_string(),
            ]
        };
        self.totals.iter().map(line).collect()
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for rows in self.groups() {
            let width = |of: fn(&Row) -> &str| {
                let lengths = rows.iter().map(|row| of(row).chars().count());
                lengths.max().unwrap_or_default()
            };
            let (name_width, controls_width) = (width(|row| row.name), width(|row| row.controls));
            text += &format!("{}\n", rows.first().map_or("", |row| row.kind.title()));
            for row in rows {
                let line = format!(
                    "  {:<name_width$}  {:<controls_width$}  {:<6}  {}{}",
                    row.name,
                    row.controls,
                    row.effect,
                    if row.moves { "(moves) " } else { "" },
                    row.missing,
                );
                text += &format!("{}\n", line.trim_end());
            }
            text += "\n";
        }
        text += &format!(
            "{:<9}{:<11}{:>6}{:>8}{:>6}\n",
            "control", "kind", "acts", "partly", "none"
        );
        for [model, kind, acts, partly, none] in self.total_lines() {
            text += &format!("{model:<9}{kind:<11}{acts:>6}{partly:>8}{none:>6}\n");
        }
        text
    }

    fn markdown(&self) -> String {
        let mut text = String::from(
            "# What each function does here\n\n\
             Made from the registry of the control models (`crates/models/parameters/data/conformance/`) with\n\
             `bahn conformance --format markdown`. **acts**: all that the manual says; **partly**: without what is\n\
             named; **none**: read and passed over, with a warning at the block that uses it. Programs that use a\n\
             function without which the real control moves differently (**moves**) are refused unless\n\
             `--skip-unknown` is given. The last column names the test that shows what acts.\n\n\
             | Control | Kind | acts | partly | none |\n|---|---|---|---|---|\n",
        );
        for line in self.total_lines() {
            text += &format!("| {} |\n", line.join(" | "));
        }
        for rows in self.groups() {
            text += &format!("\n## {}\n\n", rows.first().map_or("", |row| row.kind.title()));
            text += "| Function | Controls | Effect | Missing | Source | Test |\n|---|---|---|---|---|---|\n";
            for row in rows {
                let effect = if row.moves {
                    format!("{}, moves", row.effect)
                } else {
                    row.effect.to_owned()
                };
                text += &format!(
                    "| {} | {} | {effect} | {} | {} | {} |\n",
                    row.name, row.controls, row.missing, row.source, row.proof
                );
            }
        }
        text
    }
}

impl Totals {
    fn new(entries: &[&Entry], kind: Kind, model: ControlModel) -> Totals {
        let count = |effect| {
            let rows = entries
                .iter()
                .filter(|entry| entry.kind == kind && entry.effect == effect);
            rows.map(|entry| entry.count(model)).sum()
        };
        Totals {
            kind: kind.id(),
            model: model.id(),
            acts: count(Effect::Acts),
            partly: count(Effect::Partly),
            none: count(Effect::None),
        }
    }
}

impl Row {
    fn new(entry: &Entry) -> Row {
        Row {
            kind: entry.kind,
            name: entry.name,
            controls: entry.controls,
            effect: entry.effect.id(),
            moves: entry.moves,
            missing: entry.missing,
            source: entry.source,
            proof: entry.proof,
        }
    }
}
