//! What each function of a control does here, from the registry of the control models and the table of the System 900.

use bahn_parameters::ControlModel;
use bahn_parameters::conformance::{Effect, Entry, Kind, all};
use bahn_system900::rows;
use serde::Serialize;

/// What may be asked for; a TNC knows them all but one.
pub const EFFECTS: [bahn_system900::Effect; 4] = bahn_system900::Effect::ALL;

/// What has a registry: a TNC, or the control whose parameters have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Model {
    /// A TNC.
    Tnc(ControlModel),
    /// The System 900.
    System900,
}

/// The name of the System 900 among those of the control models.
pub const SYSTEM_900: &str = "system900";

/// What is asked for; `None` is everything.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// One control, or all that are a TNC.
    pub model: Option<Model>,
    /// One kind of functions.
    pub kind: Option<Kind>,
    /// One effect, by its word.
    pub effect: Option<String>,
}

/// The functions that are asked for.
#[derive(Serialize)]
pub struct Table {
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
    #[serde(skip_serializing_if = "Option::is_none")]
    stored: Option<usize>,
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

/// Whether an effect is asked for.
fn is_asked(asked: &Asked, effect: &str) -> bool {
    asked.effect.as_deref().is_none_or(|wanted| wanted == effect)
}

impl Table {
    /// Of what is asked for.
    pub fn of(asked: &Asked) -> Table {
        match asked.model {
            None => Table::of_tnc(asked, None),
            Some(Model::Tnc(model)) => Table::of_tnc(asked, Some(model)),
            Some(Model::System900) => Table::of_system900(asked),
        }
    }

    fn of_tnc(asked: &Asked, model: Option<ControlModel>) -> Table {
        let is_wanted = |entry: &&Entry| {
            model.is_none_or(|model| entry.is_of(model)) && asked.kind.is_none_or(|kind| entry.kind == kind)
        };
        let entries: Vec<&Entry> = all().iter().filter(is_wanted).collect();
        let models = ControlModel::FAMILIES
            .into_iter()
            .filter(|family| model.is_none_or(|wanted| wanted.family() == *family));
        let totals = models.flat_map(|model| {
            let kinds = Kind::ALL.into_iter();
            kinds.map(move |kind| (kind, model))
        });
        let totals = totals.filter(|(kind, _)| asked.kind.is_none_or(|wanted| wanted == *kind));
        let totals = totals.map(|(kind, model)| Totals::new(&entries, kind, model));
        Table {
            totals: totals.collect(),
            entries: entries
                .iter()
                .filter(|entry| is_asked(asked, entry.effect.id()))
                .map(|entry| Row::new(entry))
                .collect(),
        }
    }

    /// The parameters of a System 900.
    fn of_system900(asked: &Asked) -> Table {
        let kind = Kind::MachineParameter;
        let is_wanted = asked.kind.is_none_or(|wanted| wanted == kind);
        let all: Vec<_> = rows().iter().filter(|_| is_wanted).collect();
        let count = |effect| all.iter().filter(|row| row.effect == effect).count();
        let [acts, partly, stored, none] = EFFECTS.map(count);
        let entries = all.iter().filter(|row| is_asked(asked, row.effect.id()));
        let entry = |row: &&bahn_system900::Row| Row {
            kind,
            name: row.number,
            controls: SYSTEM_900,
            effect: row.effect.id(),
            moves: false,
            missing: row.reason,
            source: row.source,
            proof: row.proof,
        };
        let totals = Totals {
            kind: kind.id(),
            model: SYSTEM_900,
            acts,
            partly,
            none,
            stored: Some(stored),
        };
        Table {
            totals: is_wanted.then_some(totals).into_iter().collect(),
            entries: entries.map(entry).collect(),
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

    /// For people.
    pub fn text(&self) -> String {
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
            "{:<10}{:<11}{:>6}{:>8}{:>6}\n",
            "control", "kind", "acts", "partly", "none"
        );
        for [model, kind, acts, partly, none] in self.total_lines() {
            text += &format!("{model:<10}{kind:<11}{acts:>6}{partly:>8}{none:>6}\n");
        }
        for stored in self.totals.iter().filter_map(|totals| totals.stored) {
            text += &format!("{stored} stored\n");
        }
        text
    }

    /// As the document has it.
    pub fn markdown(&self) -> String {
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
            stored: None,
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
