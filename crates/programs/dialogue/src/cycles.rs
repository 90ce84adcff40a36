//! What cycles and probe functions ask: derived from the table of cycles.
//!
//! Decision: Contour data are asked three in a block, as the cycles of the machine builder; those of a machine that
//! lacks the cycle are text

use bahn_program::{
    Cycle, CycleBlock, CycleFunction, CycleParameter, CycleWord, Quantity, Sign, assigned_parameters, cycle,
};

use crate::blocks::{SIGNED, TURN, UNSIGNED, coordinates};
use crate::field::{Ask, Field, Most, Need, Signs, Slot};
use crate::line::Line;
use crate::prompt::prompt;
use crate::{BuilderCycle, Setting};

/// Cycles of the machine builder [003:4904-4906].
pub(crate) const OEM_CYCLES: std::ops::RangeInclusive<u16> = 68..=99;

/// The prompt of a parameter of a cycle of the machine builder that has no text of its own.
pub(crate) const PARAMETER: &str = "parameter";

const SHIFT: Ask = Ask::Coordinates {
    prefix: "",
    signs: Signs::Always,
    incremental: true,
    most: Most::Count(1),
    table: true,
};
const FACTORS: Ask = Ask::Coordinates {
    prefix: "",
    signs: Signs::None,
    incremental: false,
    most: Most::Count(3),
    table: false,
};
const CENTRE: Ask = Ask::Coordinates {
    prefix: "CC",
    signs: Signs::Always,
    incremental: false,
    most: Most::Count(3),
    table: false,
};
/// The probe function whose coordinates are corners [003:6577-6611].
const RANGE: u16 = 5;
/// Assignments in a block, as the example of the manual has them [000:17953-17964].
const ASSIGNMENTS: usize = 3;

/// The words of all blocks of a cycle or probe function; of those of the machine builder that the machine does not have,
/// their `Qn=` words as text.
pub(crate) fn cycle_lines(function: CycleFunction, number: u16, setting: &Setting) -> Vec<Line> {
    let builder = setting.builder_cycle(number);
    lines_of(
        function,
        number,
        builder.filter(|_| function == CycleFunction::Definition),
    )
}

/// Ids of all that a standard cycle asks.
pub(crate) fn prompts_of(function: CycleFunction, number: u16) -> Vec<&'static str> {
    let lines = lines_of(function, number, None);
    let fields = lines.iter().flat_map(Line::fields);
    fields.map(|field| field.slot.prompt).collect()
}

pub(crate) fn lines_of(function: CycleFunction, number: u16, builder: Option<&BuilderCycle>) -> Vec<Line> {
    let numbers: Vec<u16> = match builder {
        Some(cycle) => cycle.parameters.iter().map(|(number, _)| *number).collect(),
        None if function == CycleFunction::Definition => {
            let parameters = assigned_parameters(number).iter();
            parameters.map(|parameter| parameter.number).collect()
        }
        None => Vec::new(),
    };
    if builder.is_some() || !numbers.is_empty() {
        let name = builder.map(|cycle| cycle.name.as_str());
        let first = match name {
            Some(name) => Line::new(format!("CYCL DEF {number}.0 {name}").trim_end(), Vec::new()),
            None => cycle_line(function, number, 0),
        };
        let blocks = (1..).zip(numbers.chunks(ASSIGNMENTS));
        let blocks = blocks.map(|(sub, numbers)| assigned_line(number, sub, numbers));
        return std::iter::once(first).chain(blocks).collect();
    }
    let known = cycle(function, number);
    let last = known.and_then(Cycle::last_block).unwrap_or(1);
    (0..=last).map(|sub| cycle_line(function, number, sub)).collect()
}

/// A block of assignments to Q parameters.
pub(crate) fn assigned_line(cycle: u16, sub: u16, numbers: &[u16]) -> Line {
    let field = |number: &u16| {
        let ids = [format!("cycle {cycle} Q{number}"), format!("cycle Q{number}")];
        let found = ids.iter().find_map(|id| prompt(id));
        // The texts of the machine builder come from the machine.
        let id = found
            .filter(|_| !OEM_CYCLES.contains(&cycle))
            .map_or(PARAMETER, |prompt| prompt.id());
        let mut field = Field::new(slot(SIGNED, id, Need::Required));
        field.glue = format!(" Q{number}=").into();
        field
    };
    Line::new(
        &format!("CYCL DEF {cycle}.{sub}"),
        numbers.iter().map(field).collect(),
    )
}

/// The numbers of the Q parameters that a block assigns to and nothing else.
pub(crate) fn assigned(block: &CycleBlock) -> Option<Vec<u16>> {
    let numbers = block.words.iter().map(|word| match word {
        CycleWord::Assignment(number, _) => Some(*number),
        _ => None,
    });
    let numbers: Vec<u16> = numbers.collect::<Option<_>>()?;
    (block.sub > 0 && !numbers.is_empty()).then_some(numbers)
}

/// The words of one block.
pub(crate) fn cycle_line(function: CycleFunction, number: u16, sub: u16) -> Line {
    let word = match function {
        CycleFunction::Definition => "CYCL DEF",
        CycleFunction::Probe => "TCH PROBE",
    };
    let known = cycle(function, number);
    let name = known.map_or("", |cycle| cycle.name);
    if sub == 0 {
        // The first block of REF. PLANE takes the result parameter and the direction [003:4414-4428].
        let probing = function == CycleFunction::Probe && number == 0;
        let fields = if probing { ref_plane(name) } else { Vec::new() };
        let name = if probing { "" } else { name };
        return Line::new(format!("{word} {number}.0 {name}").trim_end(), fields);
    }
    let head = format!("{word} {number}.{sub}");
    let parameters = known.map_or(&[][..], |cycle| cycle.block(sub));
    if parameters.is_empty() {
        let slot = slot(Ask::Text, "parameters", Need::Optional);
        return Line::new(&head, vec![Field::new(slot)]);
    }
    let mut fields: Vec<Field> = Vec::new();
    for (index, parameter) in parameters.iter().enumerate() {
        let before = parameters.iter().take(index);
        let occurrence = 1 + before.filter(|other| other.name == parameter.name).count();
        let place = Place {
            function,
            number,
            sub,
            occurrence,
        };
        fields.extend(place.fields(parameter));
    }
    Line::new(&head, fields)
}

/// Whether a block like the last one may follow it: a datum shift has one for each axis [003:6222].
pub(crate) fn repeats(function: CycleFunction, number: u16, setting: &Setting) -> bool {
    let fixed = setting.builder_cycle(number).is_some() || !assigned_parameters(number).is_empty();
    if function == CycleFunction::Definition && fixed {
        return false;
    }
    let last = cycle(function, number).and_then(|cycle| cycle.blocks.last());
    let shifts = |parameter: &CycleParameter| parameter.quantity == Quantity::Shift;
    last.is_none_or(|block| block.iter().any(shifts))
}

fn slot(ask: Ask, prompt: &'static str, need: Need) -> Slot {
    Slot {
        glue: " ",
        address: "",
        ask,
        prompt,
        need,
        sign: Sign::Signed,
        of: "",
    }
}

fn ref_plane(name: &str) -> Vec<Field> {
    let target = Slot {
        address: "Q",
        ..slot(Ask::Integer { q: false }, "probe target", Need::Required)
    };
    let mut target = Field::new(target);
    target.glue = format!(" {name} ").into();
    let direction = Field::new(slot(Ask::Direction, "probe direction", Need::Required));
    vec![target, direction]
}

/// Where a parameter stands.
struct Place {
    function: CycleFunction,
    number: u16,
    sub: u16,
    /// Which one of its name in the block, from 1.
    occurrence: usize,
}

impl Place {
    /// What is asked for a parameter.
    fn fields(&self, parameter: &CycleParameter) -> Vec<Field> {
        let need = match parameter.optional {
            true => Need::Optional,
            false => Need::Required,
        };
        let id = |what: &str| self.prompt(what);
        let name = parameter.name;
        let one = |ask, what: &str| vec![Field::new(slot(ask, id(what), need))];
        match parameter.quantity {
            Quantity::Coordinates => {
                let ranges = self.function == CycleFunction::Probe && self.number == RANGE;
                let most = if ranges { Most::Corner } else { Most::Count(3) };
                one(coordinates(most, true), "coordinates")
            }
            Quantity::Side => {
                let mut sides = one(coordinates(Most::Count(1), false), "side");
                sides.iter_mut().for_each(|side| side.slot.sign = parameter.sign);
                sides
            }
            Quantity::Shift => one(SHIFT, "shift"),
            Quantity::Axes => {
                let most = match self.function {
                    CycleFunction::Definition => 3,
                    CycleFunction::Probe => 1,
                };
                named(
                    name,
                    one(Ask::Axes(most), if name.is_empty() { "axes" } else { name }),
                )
            }
            Quantity::Directions => {
                let first = Field::new(slot(Ask::Direction, id("approach"), need));
                let mut second = Field::new(slot(Ask::Direction, id("start"), need));
                second.glue = "/".into();
                let mut fields = named(name, vec![first]);
                fields.push(second);
                fields
            }
            Quantity::AxisFactors => {
                let mut fields = one(FACTORS, "factors");
                fields.push(Field::new(slot(CENTRE, id("centre"), Need::Optional)));
                fields
            }
            Quantity::Feed => {
                let slot = slot(Ask::Feed { max: false }, id(name), need);
                vec![Field::new(Slot { address: "F", ..slot })]
            }
            Quantity::Turn => {
                let slot = slot(TURN, id(name), need);
                vec![Field::new(Slot {
                    address: "DR",
                    ..slot
                })]
            }
            Quantity::Target => {
                let target = slot(Ask::Integer { q: false }, "probe target", need);
                vec![Field::new(Slot {
                    address: "Q",
                    ..target
                })]
            }
            Quantity::Labels => named(name, one(Ask::Labels, name)),
            Quantity::Program => named(name, one(Ask::Name, name)),
            // `ROT`, incremental `IROT` [003:6313-6333].
            Quantity::Rotation => {
                let ask = Ask::Number {
                    signs: Signs::Always,
                    incremental: true,
                };
                vec![Field::new(Slot {
                    address: "ROT",
                    ..slot(ask, id(name), need)
                })]
            }
            Quantity::Length
            | Quantity::Dwell
            | Quantity::Milliseconds
            | Quantity::Angle
            | Quantity::Orientation
            | Quantity::Choice
            | Quantity::Factor => named(name, vec![self.number(parameter, need)]),
        }
    }

    fn number(&self, parameter: &CycleParameter, need: Need) -> Field {
        let ask = match parameter.sign {
            Sign::Signed | Sign::Working | Sign::NotNegative => SIGNED,
            Sign::PlusOmitted => Ask::Number {
                signs: Signs::Minus,
                incremental: false,
            },
            Sign::Unsigned => UNSIGNED,
        };
        let slot = slot(ask, self.prompt(parameter.name), need);
        Field::new(Slot {
            sign: parameter.sign,
            ..slot
        })
    }

    /// Id of the prompt for this place, or the one that more places share.
    fn prompt(&self, what: &str) -> &'static str {
        let Place {
            number,
            sub,
            occurrence,
            ..
        } = self;
        let kind = match self.function {
            CycleFunction::Definition => "cycle",
            CycleFunction::Probe => "probe",
        };
        let ids = [
            format!("{kind} {number}.{sub} {what} {occurrence}"),
            format!("{kind} {number}.{sub} {what}"),
            format!("{kind} {number} {what}"),
            format!("{kind} {what}"),
        ];
        let found = ids.iter().find_map(|id| prompt(id));
        found.map_or("", |prompt| prompt.id())
    }
}

/// Fields whose first has the name of the parameter before it.
fn named(name: &str, mut fields: Vec<Field>) -> Vec<Field> {
    if let Some(first) = fields.first_mut().filter(|_| !name.is_empty()) {
        first.glue = format!(" {name} ").into();
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::{ControlModel, ParameterList};
    use bahn_program::CYCLES;

    #[test]
    fn every_parameter_of_every_cycle_has_its_question() {
        let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc425));
        for cycle in CYCLES {
            for line in cycle_lines(cycle.function, cycle.number, &setting) {
                for field in line.fields() {
                    let id = field.slot.prompt;
                    assert!(prompt(id).is_some(), "{} has no prompt", line.head());
                }
            }
        }
    }

    #[test]
    fn a_cycle_asks_block_by_block() {
        let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc360));
        let lines = cycle_lines(CycleFunction::Definition, 4, &setting);
        let asked: Vec<Vec<&str>> = lines
            .iter()
            .map(|line| line.fields().iter().map(|field| field.slot.prompt).collect())
            .collect();
        assert_eq!(asked[0], [""; 0]);
        assert_eq!(asked[3], ["cycle PECKG", "cycle 4.3 F"]);
        assert_eq!(asked[4..6], [["cycle 4.4 side"], ["cycle 4.5 side"]]);
        assert_eq!(asked[6], ["cycle F", "cycle DR", "cycle 4.6 RADIUS"]);
        let feeds = cycle_line(CycleFunction::Definition, 16, 2);
        let ids: Vec<_> = feeds.fields().iter().map(|field| field.slot.prompt).collect();
        assert_eq!(ids, ["cycle PECKG", "cycle 16.2 F", "cycle DR", "cycle 16.2 F 2"]);
        assert!(
            repeats(CycleFunction::Definition, 7, &setting)
                && !repeats(CycleFunction::Definition, 1, &setting)
        );
    }
}
