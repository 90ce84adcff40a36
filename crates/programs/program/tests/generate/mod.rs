//! Random blocks of every kind, and random damage to their text.

use bahn_path::{Axis, Direction, Sense};
use bahn_program::*;
use proptest::prelude::*;
use proptest::sample::select;

/// A number as it stands in programs.
fn number() -> BoxedStrategy<f64> {
    prop_oneof![
        4 => (-1_000_000_i64..1_000_000, 0..4).prop_map(|(n, decimals)| n as f64 / 10_f64.powi(decimals)),
        1 => -1e6..1e6,
        1 => select(vec![0.0, 1e15, -1e15, 0.000001, std::f64::consts::PI]),
    ]
    .boxed()
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        3 => number().prop_map(Value::Number),
        1 => (0..=1999_u16, any::<bool>()).prop_map(|(number, negative)| Value::Q { number, negative }),
    ]
}

fn word() -> impl Strategy<Value = Word> {
    (value(), any::<bool>()).prop_map(|(value, incremental)| Word { value, incremental })
}

fn axis() -> impl Strategy<Value = Axis> {
    select(Axis::ALL.to_vec())
}

fn coordinates(max: usize) -> impl Strategy<Value = Coordinates> {
    prop::collection::vec((axis(), word()), 0..=max).prop_map(|words| {
        let mut coordinates = Coordinates::default();
        for (axis, word) in words {
            coordinates.set(axis, word);
        }
        coordinates
    })
}

fn m_functions() -> impl Strategy<Value = MFunctions> {
    (
        prop::collection::vec(0..=102_u16, 0..3),
        prop::option::of((0..3_usize, value(), value())),
    )
        .prop_map(|(codes, with_arguments)| {
            let mut m = MFunctions::default();
            for code in codes {
                if !m.contains(code) {
                    m.push(code);
                }
            }
            let mut arguments = Vec::new();
            if let Some((which, first, second)) = with_arguments {
                let code = [103, 112, 120][which];
                m.push(code);
                match code {
                    112 => {
                        arguments.push(MArgument {
                            code,
                            letter: 'T',
                            value: first,
                        });
                        arguments.push(MArgument {
                            code,
                            letter: 'A',
                            value: second,
                        });
                    }
                    120 => arguments.push(MArgument {
                        code,
                        letter: 'L',
                        value: first,
                    }),
                    _ => arguments.push(MArgument {
                        code,
                        letter: 'F',
                        value: first,
                    }),
                }
            }
            m.arguments = (!arguments.is_empty()).then(|| arguments.into());
            m
        })
}

fn feed() -> impl Strategy<Value = Feed> {
    prop_oneof![Just(Feed::Max), value().prop_map(Feed::Value)]
}

fn motion() -> impl Strategy<Value = Motion> {
    use MotionKind::*;
    let kinds = vec![
        Line,
        Circle,
        CircleRadius,
        CircleTangential,
        LinePolar,
        CirclePolar,
        CircleTangentialPolar,
        LineNormal,
        Paraxial,
    ];
    let normal = prop::array::uniform3(value());
    (
        select(kinds),
        coordinates(4),
        (axis(), word()),
        prop::option::of(word()),
        prop::option::of(word()),
        prop::option::of(value()),
        prop::option::of(any::<bool>()),
        prop::option::of(0..3_usize),
        prop::option::of(feed()),
        (m_functions(), normal),
    )
        .prop_map(
            |(kind, several, (axis, word), pr, pa, radius, direction, compensation, feed, (m, normal))| {
                let polar = matches!(kind, LinePolar | CirclePolar | CircleTangentialPolar);
                let arc = matches!(kind, Circle | CircleRadius | CirclePolar);
                let mut one = Coordinates::default();
                one.set(axis, word);
                let compensations = match kind {
                    Paraxial => [Compensation::Off, Compensation::Lengthen, Compensation::Shorten],
                    _ => [Compensation::Off, Compensation::Left, Compensation::Right],
                };
                Motion {
                    kind,
                    coordinates: if kind == Paraxial { one } else { several },
                    polar_radius: pr.filter(|_| polar),
                    polar_angle: pa.filter(|_| polar),
                    radius: radius.filter(|_| kind == CircleRadius),
                    direction: direction.filter(|_| arc).map(sense),
                    compensation: compensation.map(|i| compensations[i]),
                    feed,
                    normal: (kind == LineNormal).then(|| Box::new(normal)),
                    m,
                    modal: None,
                }
            },
        )
}

fn expression() -> impl Strategy<Value = Expression> {
    use UnaryFunction::*;
    let functions = vec![
        Negate,
        Square,
        SquareRoot,
        Sine,
        Cosine,
        Tangent,
        ArcSine,
        ArcCosine,
        ArcTangent,
        NaturalLogarithm,
        Logarithm,
        Exponential,
        Absolute,
        Integer,
        Fraction,
    ];
    let operators = vec![
        BinaryOperator::Add,
        BinaryOperator::Subtract,
        BinaryOperator::Multiply,
        BinaryOperator::Divide,
        BinaryOperator::Power,
    ];
    value()
        .prop_map(Expression::Value)
        .prop_recursive(5, 40, 2, move |inner| {
            prop_oneof![
                (select(functions.clone()), inner.clone())
                    .prop_map(|(f, a)| Expression::Unary(f, Box::new(a))),
                (select(operators.clone()), inner.clone(), inner).prop_map(|(o, a, b)| Expression::Binary(
                    o,
                    Box::new(a),
                    Box::new(b)
                )),
            ]
        })
}

fn decoration() -> impl Strategy<Value = Box<str>> {
    select(vec![
        "SET UP", "TIEFE", "V.ZEIT", "PROF.", "ABST", "Räumen", "P.P. INT", "PECKG",
    ])
    .prop_map(Into::into)
}

fn sense(plus: bool) -> Sense {
    if plus {
        Sense::CounterClockwise
    } else {
        Sense::Clockwise
    }
}

/// The words of one block: texts never stand side by side, and no axis has two values.
fn cycle_words(probe: bool) -> impl Strategy<Value = Vec<CycleWord>> {
    let unsigned_is_target = move |value| match value {
        Value::Q {
            negative: false,
            number,
        } if probe => CycleWord::Target(number),
        value => CycleWord::Number(value),
    };
    let word = prop_oneof![
        decoration().prop_map(CycleWord::Text),
        value().prop_map(unsigned_is_target),
        (axis(), word()).prop_map(|(axis, word)| CycleWord::Coordinate(axis, word)),
        axis().prop_map(CycleWord::Axis),
        (axis(), select(&Direction::BOTH[..])).prop_map(move |(axis, direction)| match probe {
            true => CycleWord::AxisDirection(axis, direction),
            false => CycleWord::Axis(axis),
        }),
        feed().prop_map(CycleWord::Feed),
        any::<bool>().prop_map(|plus| CycleWord::Sense(sense(plus))),
        (0..=1999_u16, value()).prop_map(|(number, value)| CycleWord::Assignment(number, value)),
        (0..=99_u16).prop_map(CycleWord::M),
    ];
    prop::collection::vec(word, 0..6).prop_map(|words| {
        let mut kept: Vec<CycleWord> = Vec::new();
        for word in words {
            let text_twice = matches!(
                (kept.last(), &word),
                (Some(CycleWord::Text(_)), CycleWord::Text(_))
            );
            let axis_twice = kept.iter().any(|before| match (before, &word) {
                (CycleWord::Coordinate(a, _), CycleWord::Coordinate(b, _)) => a == b,
                _ => false,
            });
            if !text_twice && !axis_twice {
                kept.push(word);
            }
        }
        kept
    })
}

fn cycle() -> impl Strategy<Value = CycleBlock> {
    let name = decoration().prop_map(|text| vec![CycleWord::Text(text)]).boxed();
    let labels = prop::collection::vec(0..=254_u16, 1..13).prop_map(|labels| {
        vec![
            CycleWord::Text("CONTOUR LABEL".into()),
            CycleWord::Labels(labels.into()),
        ]
    });
    let block = |number, sub, words| CycleBlock { number, sub, words };
    let other = select(vec![1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 16, 17, 68, 99]);
    prop_oneof![
        (1..=99_u16, name.clone()).prop_map(move |(number, words)| block(number, 0, words)),
        (other, 1..8_u16, cycle_words(false)).prop_map(move |(number, sub, mut words)| {
            if number == 7 {
                // Axes only.
                words.retain(|word| !matches!(word, CycleWord::Text(_)));
            }
            block(number, sub, words)
        }),
        name.prop_map(move |words| block(12, 1, words)),
        (20..=25_u16, 0..4_u16, cycle_words(false))
            .prop_map(move |(number, sub, words)| block(number, sub, words)),
        (axis(), value(), axis(), value()).prop_map(move |(factor, a, centre, b)| {
            let words = vec![CycleWord::AxisFactor(factor, a), CycleWord::Centre(centre, b)];
            block(26, 1, words)
        }),
        labels.prop_map(move |words| block(14, 1, words)),
        (200..300_u16, cycle_words(false)).prop_map(move |(number, words)| block(number, 0, words)),
    ]
}

fn probe() -> impl Strategy<Value = CycleBlock> {
    prop_oneof![
        (0..8_u16, 0..4_u16, cycle_words(true))
            .prop_filter("5.1 names a file", |(number, sub, _)| (*number, *sub) != (5, 1))
            .prop_map(|(number, sub, words)| CycleBlock { number, sub, words }),
        Just(CycleBlock {
            number: 5,
            sub: 1,
            words: vec![CycleWord::Text("5007".into())]
        }),
    ]
}

fn calculation() -> impl Strategy<Value = Operation> {
    use Calculation::*;
    let functions = vec![
        Assign, Add, Subtract, Multiply, Divide, SquareRoot, Sine, Cosine, Length, Angle,
    ];
    (select(functions), 0..=1999_u16, value(), value()).prop_map(|(function, target, a, b)| {
        let b = if matches!(function, Assign | SquareRoot | Sine | Cosine) {
            Value::Number(0.0)
        } else {
            b
        };
        Operation::Calculate {
            function,
            target,
            a,
            b,
        }
    })
}

fn jump() -> impl Strategy<Value = Operation> {
    let conditions = vec![
        Condition::Equal,
        Condition::NotEqual,
        Condition::Greater,
        Condition::Less,
    ];
    (select(conditions), value(), value(), 0..=254_u16).prop_map(|(condition, a, b, label)| Operation::Jump {
        condition,
        a,
        b,
        label,
    })
}

fn tool() -> impl Strategy<Value = Operation> {
    let linear = select(vec![Axis::X, Axis::Y, Axis::Z, Axis::U, Axis::V, Axis::W]);
    prop_oneof![
        (value(), prop::option::of(value()), prop::option::of(value()))
            .prop_map(|(tool, length, radius)| Operation::ToolDefinition { tool, length, radius }),
        (
            prop::option::of(value()),
            prop::option::of(linear),
            prop::option::of(value()),
            prop::option::of(value()),
            prop::option::of(value()),
        )
            .prop_map(
                |(tool, axis, speed, delta_length, delta_radius)| Operation::ToolCall {
                    tool,
                    axis,
                    speed,
                    delta_length,
                    delta_radius,
                }
            ),
    ]
}

/// A comment or a name: no control characters, blanks only inside.
fn text() -> impl Strategy<Value = Box<str>> {
    "[A-Za-z0-9äöü_,+:]{1,8}( [A-Za-z0-9Ä.;/-]{1,6}[A-Z]){0,2}".prop_map(Into::into)
}

fn name() -> impl Strategy<Value = Box<str>> {
    "[A-Za-z0-9äöü_+:\\\\]{1,8}( [A-Z0-9/-]{1,6})?(\\.[HhI])?".prop_map(Into::into)
}

fn operation() -> impl Strategy<Value = Operation> {
    let mm = |coordinates: Coordinates| {
        let mut absolute = Coordinates::default();
        for (axis, word) in coordinates.iter() {
            absolute.set(
                axis,
                Word {
                    incremental: false,
                    ..word
                },
            );
        }
        absolute
    };
    prop_oneof![
        8 => motion().prop_map(Operation::Motion),
        1 => (coordinates(3), prop::option::of(axis())).prop_map(move |(c, axis)| Operation::BlankMin(mm(c), axis)),
        1 => coordinates(3).prop_map(Operation::BlankMax),
        2 => tool(),
        1 => coordinates(2).prop_map(Operation::CircleCentre),
        1 => (value(), prop::option::of(value())).prop_map(|(radius, feed)| Operation::Rounding { radius, feed }),
        1 => (value(), prop::option::of(value())).prop_map(|(length, feed)| Operation::Chamfer { length, feed }),
        1 => m_functions().prop_map(Operation::Stop),
        1 => m_functions().prop_map(Operation::Miscellaneous),
        1 => (0..=65_534_u16).prop_map(Operation::Label),
        1 => (0..=254_u16, prop::option::of(value())).prop_map(|(label, repeats)| Operation::CallLabel { label, repeats }),
        1 => name().prop_map(Operation::CallProgram),
        2 => calculation(),
        1 => jump(),
        1 => value().prop_map(Operation::ErrorNumber),
        1 => prop::collection::vec(value(), 1..=6).prop_map(|items| Operation::Print(items.into())),
        1 => (value(), prop::option::of(value())).prop_map(|(a, b)| Operation::Plc { a, b }),
        2 => (0..=1999_u16, expression())
            .prop_map(|(target, expression)| Operation::Formula { target, expression: Box::new(expression) }),
        3 => cycle().prop_map(|block| Operation::Cycle(Box::new(block))),
        1 => m_functions().prop_map(Operation::CycleCall),
        2 => probe().prop_map(|block| Operation::Probe(Box::new(block))),
        1 => (any::<bool>(), prop::collection::vec(0..=127_u16, 0..=15))
            .prop_map(|(call, texts)| Operation::Dialog(Box::new(Dialog { call, texts: texts.into() }))),
    ]
}

/// A block of any kind but BEGIN, END and invalid ones.
pub fn block() -> impl Strategy<Value = Block> {
    prop_oneof![
        12 => (any::<bool>(), operation(), prop::option::of(text()))
            .prop_map(|(skip, operation, comment)| Block { skip, operation, comment }),
        1 => (any::<bool>(), text(), any::<bool>()).prop_map(|(skip, text, structure)| {
            let text = if structure { format!("* - {text}").into() } else { text };
            Block { skip, operation: Operation::Comment(text), comment: None }
        }),
    ]
}

/// A piece of program text, sensible or not.
#[expect(clippy::too_many_lines, reason = "a list")]
pub fn fragment() -> impl Strategy<Value = String> {
    let pieces = vec![
        "L ",
        "LP ",
        "C ",
        "CC ",
        "CR ",
        "CT ",
        "CTP ",
        "CP ",
        "RND ",
        "CHF ",
        "X",
        "Y",
        "IZ",
        "IPA",
        "PR",
        "+",
        "-",
        "5",
        "12.5",
        ",",
        ".",
        "...",
        "Q",
        "Q1",
        " = ",
        "R0",
        "RL",
        "R+",
        "R",
        "F",
        "FMAX",
        " M",
        "M3",
        "DR",
        "DR-",
        "TOOL DEF ",
        "TOOL CALL ",
        "S",
        "LBL ",
        "CALL LBL ",
        "REP ",
        "/",
        "CALL PGM ",
        "FN 0: ",
        "FN4: ",
        "DIV",
        "SIN ",
        "SQRT",
        "(",
        ")",
        "^",
        "*",
        "IF ",
        "EQU",
        "GOTO LBL ",
        "FN14: ERROR",
        "FN15: PRINT ",
        "FN19: PLC ",
        "CYCL DEF ",
        "CYCL CALL ",
        "1.1 ",
        "8.1",
        "12.1 ",
        "14.1 ",
        "200 ",
        "SET UP ",
        "TCH PROBE ",
        "0.0 ",
        "5.1 ",
        "7.2 ",
        "NAME:",
        ":",
        "STOP ",
        "BLK FORM 0.1",
        "0.2 ",
        "BEGIN PGM ",
        "END PGM ",
        "MM",
        "INCH",
        " P",
        "ERROR = ",
        "DLG-CALL ",
        ";",
        " ; c",
        "~",
        " ~\n",
        "\n",
        "\n",
        "\n",
        "\r\n",
        "\r",
        "\x0c",
        "\t",
        " ",
        "\0",
        "\x1a",
        "\u{feff}",
        "ä",
        "\u{85}",
        "\"A\"",
        "APPR LT",
        "N10",
        "%",
        "00",
        "99999",
        "9999999999999999999999",
    ];
    select(pieces).prop_map(str::to_owned)
}

/// One damage to a text.
#[derive(Clone, Debug)]
pub enum Damage {
    Delete,
    Insert(u8),
    Replace(u8),
    Double,
    CutLine,
}

impl Damage {
    pub fn apply(self, bytes: &mut Vec<u8>, place: usize) {
        match self {
            Damage::Delete => {
                bytes.remove(place);
            }
            Damage::Insert(byte) => bytes.insert(place, byte),
            Damage::Replace(byte) => bytes[place] = byte,
            Damage::Double => bytes.insert(place, bytes[place]),
            Damage::CutLine => {
                let end = bytes[place..]
                    .iter()
                    .position(|&b| b == b'\n')
                    .map_or(bytes.len(), |i| place + i);
                bytes.drain(place..end);
            }
        }
    }
}

pub fn damage() -> impl Strategy<Value = Damage> {
    let byte = prop_oneof![any::<u8>(), select(b" +-.,;~/\nQXRFM:=0\"\r".to_vec())].boxed();
    prop_oneof![
        Just(Damage::Delete),
        byte.clone().prop_map(Damage::Insert),
        byte.prop_map(Damage::Replace),
        Just(Damage::Double),
        Just(Damage::CutLine),
    ]
}
