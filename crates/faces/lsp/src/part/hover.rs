//! What a word means: its rule and unit, and what is known of its value.

use bahn_dialogue::{TemplatePart, Tongue, cycle_template};
use bahn_parameters::conformance::{Entry, Kind, find as registered};
use bahn_parameters::technology::{Output, Technology};
use bahn_path::At;
use bahn_program::{CycleFunction, Operation, Unit, WordKind, WordSpan, cycle, cycle_parameters};

use super::words::{self, Part, Word};
use super::{PartProgram, ReadBlock};
use crate::language::{Examined, Hover, Role, Thing, mention_at, mentions_of};
use crate::markdown::Markdown;

pub(super) fn hover(program: &PartProgram, at: usize, examined: Option<&Examined>) -> Option<Hover> {
    if let Some(mention) = mention_at(crate::language::Analysis::mentions(program), at)
        && let Some(text) = named(program, &mention.thing, examined)
    {
        return Some(Hover {
            range: mention.range.clone(),
            text,
        });
    }
    let place = program.block_at(at)?;
    let block = program.read(place);
    let word = block.words.iter().find(|word| word.span.contains(&at));
    let word = word.or_else(|| block.words.iter().find(|word| word.span.end == at))?;
    Some(Hover {
        range: word.span.clone(),
        text: of_word(program, &block, word)?,
    })
}

/// What a label, a parameter, a tool or a program is.
fn named(program: &PartProgram, thing: &Thing, examined: Option<&Examined>) -> Option<String> {
    let mentions = crate::language::Analysis::mentions(program);
    let blocks = |role: Role| {
        let places = mentions_of(mentions, thing).filter(|mention| mention.role == role);
        let mut blocks: Vec<u32> = places
            .filter_map(|mention| program.block_at(mention.range.start))
            .map(|place| program.program.number_of(place.number))
            .collect();
        blocks.dedup();
        shortened(&blocks)
    };
    let limits = program.model.limits();
    Some(match thing {
        Thing::Label(number) => Markdown::titled(&format!("Label {number}"))
            .fact("Set in block", &blocks(Role::Sets))
            .fact("Called in blocks", &blocks(Role::Uses))
            .fact(
                "Range",
                &format!("1 to {}; 0 ends a subprogram", limits.label_max),
            )
            .source("[003:3623-3670]")
            .text(),
        Thing::Q(number) => Markdown::titled(&format!("Q{number}"))
            .fact("At the end of a run", &value(*number, examined))
            .fact("Set in blocks", &blocks(Role::Sets))
            .fact("Read in blocks", &blocks(Role::Uses))
            .fact("Range", &format!("Q0 to Q{}", limits.q_max))
            .source("[003:4066]")
            .text(),
        Thing::Tool(number) => Markdown::titled(&format!("Tool {number}"))
            .fact("Defined in blocks", &blocks(Role::Sets))
            .fact("Called in blocks", &blocks(Role::Uses))
            .fact("Range", &format!("0 to {}", limits.tool_max))
            .source("[003:1803-1840]")
            .text(),
        Thing::File(name) => Markdown::titled(&format!("Program {name}"))
            .paragraph("It lies beside this one.")
            .source("[003:3898]")
            .text(),
        _ => return None,
    })
}

/// The first numbers of a list.
fn shortened(blocks: &[u32]) -> String {
    const SHOWN: usize = 12;
    let shown: Vec<String> = blocks.iter().take(SHOWN).map(u32::to_string).collect();
    let more = if blocks.len() > SHOWN { ", ..." } else { "" };
    shown.join(", ") + more
}

/// The value of a parameter after a run.
fn value(number: u16, examined: Option<&Examined>) -> String {
    let Some(examined) = examined else {
        return String::new();
    };
    let ended = if examined.complete {
        ""
    } else {
        " (the run was broken off)"
    };
    match examined.values.get(usize::from(number)) {
        Some(Some(value)) => format!("{value}{ended}"),
        Some(None) => {
            format!("not known: the program does not set it, or from what only the machine knows{ended}")
        }
        None => String::new(),
    }
}

fn of_word(program: &PartProgram, block: &ReadBlock<'_>, word: &WordSpan) -> Option<String> {
    let is_iso = program.is_iso();
    if let (false, Some(text)) = (word.kind == WordKind::Comment, cycle_of(program, block, word)) {
        return Some(text);
    }
    let text = program.capitals(&word.span);
    match word.kind {
        WordKind::Function => {
            let bare = text
                .trim_end_matches(|c: char| c.is_ascii_digit() || c == '.')
                .trim_end();
            let found = words::find(is_iso, Part::Function, &text);
            let found = found.or_else(|| words::find(is_iso, Part::Function, bare));
            match found {
                Some(row) => Some(described(program, row)),
                None if is_iso => of_code(program, &text),
                None => None,
            }
        }
        WordKind::Address => {
            let end = match word.value.is_empty() {
                true => word.span.end,
                false => word.value.start,
            };
            let letters = program.capitals(&(word.span.start..end));
            if is_iso && let Some(text) = parameter_of(program, block, &letters) {
                return Some(text);
            }
            if letters == "M" {
                return m_function(program, &program.capitals(&word.value));
            }
            let find = |name: &str| words::find(is_iso, Part::Address, name);
            let in_tool = matches!(block.operation, Operation::ToolDefinition { .. }) && letters == "L";
            let row = if in_tool {
                find("L ADDRESS")
            } else {
                find(&text).or_else(|| find(&letters))
            };
            let incremental = || find(letters.strip_prefix('I')?);
            row.or_else(incremental).map(|row| described(program, row))
        }
        _ => None,
    }
}

/// A word of the table.
fn described(program: &PartProgram, row: &Word) -> String {
    let registered = registered(program.model, Kind::Word, row.word);
    Markdown::titled(&format!("{}: {}", row.word, row.title))
        .paragraph(row.rule)
        .fact("Unit", unit(program, row.unit))
        .fact("Range", &range(program, row))
        .fact("Here", &registered.and_then(Entry::remark).unwrap_or_default())
        .source(row.source)
        .text()
}

fn unit(program: &PartProgram, unit: &str) -> &'static str {
    match (unit, program.program.unit()) {
        ("length", Unit::Mm) => "mm",
        ("length", Unit::Inch) => "inch",
        ("feed", Unit::Mm) => "mm/min",
        ("feed", Unit::Inch) => "inch, as the control counts it: 0.1 inch/min or inch/min",
        ("degrees", _) => "degrees",
        ("rpm", _) => "rpm",
        _ => "",
    }
}

/// What a word may be on the control.
fn range(program: &PartProgram, row: &Word) -> String {
    let limits = program.model.limits();
    let scale = program.program.unit().mm();
    let signed = |most: f64| format!("-{most} to +{most}");
    match (row.word, row.unit) {
        ("F", _) => format!("0 to {} mm/min", limits.feed_max_mm_min),
        ("S", _) => format!("0 to {} rpm", limits.spindle_speed_max_rpm),
        ("PA", _) => signed(limits.polar_angle_max_deg),
        ("R", _) => format!("up to {}", limits.circle_radius_max_mm / scale),
        ("REP", _) => format!("0 to {}", limits.repeat_max),
        ("LBL" | "CALL LBL", _) => format!("1 to {}", limits.label_max),
        ("TOOL DEF" | "TOOL CALL" | "T", _) => format!("0 to {}", limits.tool_max),
        ("X" | "Y" | "Z" | "U" | "V" | "W" | "IV", _) => signed(limits.coordinate_max / scale),
        ("A" | "B" | "C", _) => signed(limits.coordinate_max),
        _ => String::new(),
    }
}

/// An M function: what it does, when, and what waits for it.
pub(super) fn m_function(program: &PartProgram, digits: &str) -> Option<String> {
    let number: u16 = digits.parse().ok()?;
    let name = format!("M{number}");
    let row = words::find(program.is_iso(), Part::M, &name);
    let entry = registered(program.model, Kind::MFunction, &name)?;
    let technology = Technology::of_m(program.model, number);
    let when = technology.map_or("", |technology| match technology.at {
        At::Start => "at the start of its block",
        At::End => "at the end of its block",
        At::Length(_) | At::BeforeEnd(_) | At::Ahead(_) => "on the path of its block",
    });
    let to = technology.map_or("", |technology| match technology.output {
        Output::Plc => "to the PLC, with its strobe",
        Output::Path => "to the path",
        Output::Block => "",
    });
    let title = row.map_or("free: its machine builder says what it does", |row| row.title);
    let text = Markdown::titled(&format!("{name}: {title}"))
        .fact("Acts", when)
        .fact("Goes", to)
        .fact("Here", &entry.remark().unwrap_or_default())
        .source(entry.source);
    Some(text.text())
}

/// A D function or a G function that is a cycle.
fn of_code(program: &PartProgram, text: &str) -> Option<String> {
    let found = words::of_language(true).find(|row| row.word == canonical(text))?;
    match found.part {
        Part::Calculation => {
            let plain = words::find(false, Part::Function, found.title)?;
            let text = Markdown::titled(&format!("{}: {}", found.word, plain.title));
            Some(text.source(plain.source).text())
        }
        Part::Cycle => {
            let (function, number) = cycle_named(found.title)?;
            Some(cycle_text(
                program,
                function,
                number,
                None,
                &format!("{} = ", found.word),
            ))
        }
        _ => Some(described(program, found)),
    }
}

/// `G1` as the table has it, `G01`.
fn canonical(text: &str) -> String {
    let digits = text.get(1..).and_then(|digits| digits.parse::<u16>().ok());
    let letter = text.get(..1).unwrap_or_default();
    digits.map_or_else(|| text.to_owned(), |number| format!("{letter}{number:02}"))
}

/// `CYCL DEF 1` or `TCH PROBE 0`.
pub(super) fn cycle_named(name: &str) -> Option<(CycleFunction, u16)> {
    let (function, number) = name.rsplit_once(' ')?;
    let function = match function {
        "CYCL DEF" => CycleFunction::Definition,
        _ => CycleFunction::Probe,
    };
    Some((function, number.parse().ok()?))
}

/// The cycle of a block of plain language, whatever word of it is meant but M and Q.
fn cycle_of(program: &PartProgram, block: &ReadBlock<'_>, word: &WordSpan) -> Option<String> {
    if program.is_iso() || word.kind == WordKind::Number {
        return None;
    }
    let (function, cycle) = match &block.operation {
        Operation::Cycle(cycle) => (CycleFunction::Definition, cycle),
        Operation::Probe(cycle) => (CycleFunction::Probe, cycle),
        _ => return None,
    };
    Some(cycle_text(program, function, cycle.number, Some(cycle.sub), ""))
}

/// A P word of a cycle in DIN/ISO: the parameters are counted as the dialogue asks for them, those of a cycle of the machine
/// builder go to the Q parameters of their numbers [000:17966-17984].
fn parameter_of(program: &PartProgram, block: &ReadBlock<'_>, letters: &str) -> Option<String> {
    let index = letters
        .strip_prefix('P')?
        .trim_end()
        .parse::<usize>()
        .ok()?
        .checked_sub(1)?;
    let cycle_block = block.operation.parts().iter().find_map(|part| match part {
        Operation::Cycle(block) => Some(block),
        _ => None,
    })?;
    let (function, number) = (CycleFunction::Definition, cycle_block.number);
    let Some(known) = cycle(function, number) else {
        let text = Markdown::titled(&format!("P{:02}: Q{} of cycle {number}", index + 1, index + 1));
        return Some(text.source("[000:17966-17984]").text());
    };
    let template = cycle_template(function, number);
    let of_block = |(parts, sub): (&Vec<TemplatePart>, u16)| {
        let parameters = cycle_parameters(function, number, sub).iter();
        let asked = asked(program, parts, function, number, sub);
        let own = parameters
            .zip(asked)
            .filter(|(of, _)| of.quantity != bahn_program::Quantity::Turn);
        own.map(|(_, asked)| asked).collect::<Vec<_>>()
    };
    let all: Vec<String> = template.iter().zip(0..).flat_map(of_block).collect();
    // More labels than blocks ask for: the last one repeats.
    let asked = all.get(index).or(all.last())?;
    let entry = registered(program.model, Kind::Cycle, &format!("CYCL DEF {number}"));
    let text = Markdown::titled(&format!("P{:02}: {asked}", index + 1));
    let of = format!("CYCL DEF {number} {}", known.name);
    Some(
        text.fact("Of", &of)
            .source(entry.map_or("", |entry| entry.source))
            .text(),
    )
}

/// A cycle with what one of its blocks, or all of them, ask for.
fn cycle_text(
    program: &PartProgram,
    function: CycleFunction,
    number: u16,
    sub: Option<u16>,
    before: &str,
) -> String {
    let name = match function {
        CycleFunction::Definition => format!("CYCL DEF {number}"),
        CycleFunction::Probe => format!("TCH PROBE {number}"),
    };
    let known = cycle(function, number);
    let title = known.map_or("cycle of the machine builder", |cycle| cycle.name);
    let entry = registered(program.model, Kind::Cycle, &name);
    let acts = known.map_or("", |cycle| match (function, cycle.acts_at_definition) {
        (CycleFunction::Probe, _) => "in its block",
        (_, true) => "when it is defined",
        (_, false) => "when it is called: CYCL CALL, M99, M89",
    });
    let template = cycle_template(function, number);
    let blocks = template.iter().zip(0..).filter(|(_, block)| match sub {
        Some(sub) if sub > 0 => *block == sub,
        _ => true,
    });
    let asked = blocks.flat_map(|(parts, block)| asked(program, parts, function, number, block));
    let absent = if entry.is_none() {
        "the control does not have it"
    } else {
        ""
    };
    Markdown::titled(&format!("{before}{name} {title}"))
        .list(asked)
        .fact("Acts", acts)
        .fact("On this control", absent)
        .fact("Here", &entry.and_then(Entry::remark).unwrap_or_default())
        .source(entry.map_or("", |entry| entry.source))
        .text()
}

/// What a block of a cycle asks for: block, prompt, unit, sign.
fn asked(
    program: &PartProgram,
    parts: &[TemplatePart],
    function: CycleFunction,
    number: u16,
    sub: u16,
) -> Vec<String> {
    let prompts = parts.iter().filter_map(|part| match part {
        TemplatePart::Ask { prompt, optional } => Some((*prompt, *optional)),
        TemplatePart::Text(_) => None,
    });
    let parameters = cycle_parameters(function, number, sub);
    let details: Vec<String> = parameters
        .iter()
        .map(|parameter| quantity(program, parameter))
        .collect();
    prompts
        .enumerate()
        .map(|(index, (prompt, optional))| {
            let prompt = prompt.map_or("value", |prompt| prompt.text(Tongue::English));
            let detail = details.get(index).filter(|detail| !detail.is_empty());
            let detail = detail.map_or_else(String::new, |detail| format!(" {detail}"));
            let optional = if optional { " (optional)" } else { "" };
            format!("{number}.{sub} {prompt}{detail}{optional}")
        })
        .collect()
}

/// Unit and sign of a parameter.
fn quantity(program: &PartProgram, parameter: &bahn_program::CycleParameter) -> String {
    use bahn_program::{Quantity, Sign};
    let unit = match parameter.quantity {
        Quantity::Length | Quantity::Coordinates | Quantity::Side | Quantity::Shift => {
            unit(program, "length")
        }
        Quantity::Dwell => "s",
        Quantity::Milliseconds => "ms",
        Quantity::Rotation | Quantity::Angle | Quantity::Orientation => "degrees",
        Quantity::Feed => unit(program, "feed"),
        _ => "",
    };
    let sign = match parameter.sign {
        Sign::Working => ", sign of the working direction",
        Sign::Signed | Sign::NotNegative | Sign::Unsigned | Sign::PlusOmitted => "",
    };
    match unit {
        "" => String::new(),
        unit => format!("in {unit}{sign}"),
    }
}
