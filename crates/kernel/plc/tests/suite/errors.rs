//! Every error of the compiler, with its line; several in one pass.

use crate::common::compile;
use bahn_parameters::ControlModel;
use bahn_plc::{Compilation, Memories, MemoryFiles, Options, ProgramMemory};
use bahn_text::{Files, NamedFile};
use proptest::prelude::*;

/// Numbers and lines of the errors.
fn errors(program: &str) -> Vec<(u8, u32)> {
    numbers(&compile(program))
}

fn numbers(compilation: &Compilation) -> Vec<(u8, u32)> {
    compilation
        .errors
        .iter()
        .map(|error| (error.error.number(), error.span.line))
        .collect()
}

fn linked<const N: usize>(files: [(&str, &str); N]) -> Vec<(u8, String, u32)> {
    let files = MemoryFiles::from(files);
    let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
    let errors = compilation.errors.into_iter();
    errors
        .map(|error| (error.error.number(), error.file, error.span.line))
        .collect()
}

#[test]
fn each_rule_of_chains_has_its_error() {
    for (program, number, line) in [
        ("L M1\nA[\nL M2\n= M3\n]\n= M4\nEM", 10, 4),
        ("L M1\nJP 1\nLBL 1\nEM", 12, 2),
        ("L M1\n]\n= M2\nEM", 13, 2),
        ("L M1\nA[\nL M2\nLBL 1\nEM", 14, 4),
        ("L M1\nLBL 1\n EM", 15, 2),
        ("L M1\nA[\nL M2\nJPT 1\nLBL 1\nEM", 16, 4),
        ("L M1\nA[\nL M2\nCM 1\n]\n= M3\nEM\nLBL 1\nEM", 16, 4),
        ("L M1\nA[\nL M2\nEM", 17, 4),
        ("L W0\nL W2\n= W4\nEM", 19, 2),
        ("L M0\nL M2\n= M4\nEM", 20, 2),
        ("L M0\nL W0\n== K1\n= M4\nEM", 20, 3),
        ("+ W0\n= W2\nEM", 21, 1),
        ("= W2\nEM", 21, 1),
        ("S M2\nEM", 22, 1),
        ("A[\nL M1\n]\n= M2\nEM", 23, 1),
        ("L M1\n= M2\nA[\nL M1\n]\n= M2\nEM", 23, 3),
        ("L M1\nA[\nL W2\n]\n= M2\nEM", 24, 4),
        ("L W2\n+[\nL M2\n]\n= W2\nEM", 24, 4),
        ("JPT 1\nLBL 1\nEM", 25, 1),
        ("EMT\nEM", 25, 1),
        ("IFT\nENDI\nEM", 25, 1),
        ("+ S1\n= S0\nEM", 30, 1),
        ("= S0\nEM", 30, 1),
        ("L M1\nA[\nL S0\n= S1\nL M1\n]\n= M2\nEM", 31, 3),
        ("L S0\nL S1\n= S2\nEM", 32, 2),
    ] {
        let found = errors(program);
        assert_eq!(found.first(), Some(&(number, line)), "{program}");
    }
}

/// IF and WHILE crossed [000:14440-14449].
const CROSSED: &str = "L I0\nIFT\nL M1\nWHILEF\nL M1\n= M2\nENDI\nL M1\nENDW\nEM";

#[test]
fn one_mistake_is_one_error() {
    for (program, number, line) in [
        ("= M2\n= M3\nS M4\nJPT 1\nLBL 1\nEM", 22, 1),
        ("+ W0\n- W2\n= W4\n= W6\nEM", 21, 1),
        ("L M1\nA[\nL M2\nEM", 17, 4),
        (CROSSED, 43, 7),
        ("L M1\nA[\nL M2\n= M3\n= M4\n]\n= M5\nEM", 10, 4),
        ("LX M5\n= W4\nEM", 5, 1),
    ] {
        assert_eq!(errors(program)[0], (number, line), "{program}");
    }
    assert_eq!(errors("= M2\n= M3\nS M4\nJPT 1\nLBL 1\nEM").len(), 1);
    assert_eq!(errors("+ W0\n- W2\n= W4\n= W6\nEM").len(), 1);
    assert_eq!(errors("L M1\nA[\nL M2\n= M3\n= M4\n]\n= M5\nEM").len(), 1);
    assert_eq!(errors("LX M5\n= W4\nEM").len(), 1);
}

#[test]
fn labels_tables_and_structures() {
    for (program, expected) in [
        ("JP 5\nCM 6\nEM", vec![(7, 1), (7, 2)]),
        ("SUBM 5\n= B0\nL KF F\n= D0\nEM", vec![(7, 1), (7, 3)]),
        ("CM 9199\nEM", vec![(7, 1)]),
        ("L M1\n= M2", vec![(8, 1)]),
        ("L M1\n= M2\nEM\nLBL 3\nL M1\n= M2\n", vec![(8, 4)]),
        ("LBL 1\nLBL 1\nEM", vec![(18, 2)]),
        ("LBL 9000\nEM", vec![(18, 1)]),
        ("EXTERN A\nLBL A\nEM", vec![(18, 2), (39, 1)]),
        ("ENDC\nENDK\nEM", vec![(26, 1), (26, 2)]),
        ("CASE B0\nCM 1\nL M1\nENDC\nEM\nLBL 1\nEM", vec![(27, 3)]),
        ("EM\nKFIELD A\nK1\nCM 1\nENDK", vec![(27, 4)]),
        ("CASE B0\nENDC\nEM\nKFIELD A\nENDK", vec![(29, 1), (29, 4)]),
        ("CM 1\nEXTERN A\nEM\nLBL 1\nEM", vec![(33, 2), (39, 2)]),
        (
            "L M1\nIFT\nL M1\nWHILEF\nL M1\nENDI\nL M1\nENDW\nEM",
            vec![(15, 6), (43, 6)],
        ),
        ("ELSE\nEM", vec![(43, 1)]),
        ("L M1\nIFT\nEM", vec![(44, 2)]),
        ("REPEAT\nL M1\nWHILET\nEM", vec![(44, 1), (44, 3)]),
        ("CASE W0\nCM 1\n", vec![(7, 2), (8, 1), (44, 1)]),
        ("GLOBAL A\nLBL A\nEM", vec![(45, 1)]),
        ("L M1\n= M1\nKFIELD A\nK1\nENDK", vec![(8, 1)]),
    ] {
        let mut found = errors(program);
        found.sort();
        assert_eq!(found, expected, "{program}");
    }
}

#[test]
fn limits() {
    let nested = |count: usize| {
        let open = "L M1\nA[\n".repeat(count);
        format!("{open}L M1\n{}= M2\nEM", "]\n".repeat(count))
    };
    assert_eq!(errors(&nested(16)), []);
    assert_eq!(errors(&nested(17)), [(11, 34)]);
    let cases = |count: usize| format!("CASE B0\n{}ENDC\nEM\nLBL 1\nEM", "CM 1\n".repeat(count));
    assert_eq!(errors(&cases(128)), []);
    assert_eq!(errors(&cases(129)), [(28, 1)]);
    let labels = |count: usize| (0..count).map(|n| format!("LBL N{n}\n")).collect::<String>() + "EM";
    assert_eq!(errors(&labels(1000)), []);
    assert_eq!(errors(&labels(1001)), [(37, 1)]);
    let ifs = |count: usize| format!("{}{}EM", "L M1\nIFT\n".repeat(count), "ENDI\n".repeat(count));
    assert_eq!(errors(&ifs(16)), []);
    assert_eq!(errors(&ifs(17)), [(43, 34)]);
    // L and = of a marker take 4 bytes each; EM takes 4.
    let long = |pairs: usize| format!("{}EM", "L M1\n= M2\n".repeat(pairs));
    assert_eq!(compile(&long(8191)).size_bytes, 65_532);
    assert_eq!(errors(&long(8191)), []);
    assert_eq!(errors(&long(8192)), [(36, 1)]);
}

#[test]
fn the_whole_code_is_limited_by_the_model() {
    let half = format!("{}EM", "L M1\n= M2\n".repeat(5000));
    let main = format!("USES PART\n{half}");
    let files = MemoryFiles::from([("MAIN.PLC", main.as_str()), ("PART.PLC", half.as_str())]);
    let compile = |model| Compilation::compile(&files, "MAIN.PLC", Options::for_model(model));
    assert_eq!(numbers(&compile(ControlModel::Tnc415b)), []);
    assert_eq!(numbers(&compile(ControlModel::Tnc407)), [(9, 1)]);
}

#[test]
fn linked_files() {
    let part = "GLOBAL MODULE\nLBL MODULE\nL M1\n= M2\nEM\n";
    let main = "USES PART\nUSES PART.PLC\nEXTERN MODULE\nCM MODULE\nEM\n";
    assert_eq!(linked([("MAIN.PLC", main), ("PART.PLC", part)]), []);
    let at = |number: u8, file: &str, line: u32| (number, file.to_owned(), line);
    assert_eq!(linked([("MAIN.PLC", "USES PART\nEM")]), [at(35, "MAIN.PLC", 1)]);
    assert_eq!(linked([]), [at(35, "MAIN.PLC", 1)]);
    let main = "USES PART\nEXTERN MODULE\nJP MODULE\nCASE B0\nCM MODULE\nENDC\nEM";
    let expected = [at(41, "MAIN.PLC", 3), at(40, "MAIN.PLC", 5)];
    assert_eq!(linked([("MAIN.PLC", main), ("PART.PLC", part)]), expected);
    let files = [
        ("MAIN.PLC", "USES PART\nUSES OTHER\nEM"),
        ("PART.PLC", part),
        ("OTHER.PLC", part),
    ];
    assert_eq!(linked(files), [at(42, "OTHER.PLC", 1)]);
    let files = [
        ("MAIN.PLC", "USES PART\nEXTERN OTHER\nCM OTHER\nEM"),
        ("PART.PLC", part),
    ];
    assert_eq!(linked(files), [at(39, "MAIN.PLC", 2)]);
    let files = [
        ("MAIN.PLC", "USES PART\nEM"),
        ("PART.PLC", "GLOBAL F\nEM\nKFIELD F\nK1\nENDK\n"),
    ];
    assert_eq!(linked(files), [at(7, "PART.PLC", 1)]);
}

#[test]
fn a_program_of_the_eprom_links_no_file_of_the_ram() {
    // MP4010 [000:14616-14618]: from the RAM both are searched, RAM first.
    let main = "USES PART\nUSES OTHER\nEXTERN P\nCM P\nEM\n";
    let ram = MemoryFiles::from([("MAIN.PLC", main), ("PART.PLC", "GLOBAL P\nLBL P\nINC B0\nEM\n")]);
    let eprom = MemoryFiles::from([
        ("MAIN.PLC", main),
        ("OTHER.PLC", "LBL 1\nEM\n"),
        ("PART.PLC", "GLOBAL P\nLBL P\nINC B0\nINC B0\nEM\n"),
    ]);
    let compile = |eprom: &MemoryFiles, memory| {
        let files = Memories {
            ram: &ram,
            eprom: Some(eprom),
        };
        Compilation::compile(files, "MAIN.PLC", Options::default().stored_in(memory))
    };
    let size = |memory| {
        let compilation = compile(&eprom, memory);
        assert_eq!(compilation.errors, []);
        compilation.size_bytes
    };
    assert!(
        size(ProgramMemory::Ram) < size(ProgramMemory::Eprom),
        "another PART.PLC"
    );
    let eprom = MemoryFiles::from([("MAIN.PLC", main), ("OTHER.PLC", "LBL 1\nEM\n")]);
    let compilation = compile(&eprom, ProgramMemory::Eprom);
    assert_eq!(numbers(&compilation), [(35, 1), (39, 3)]);
    assert!(
        compilation.errors[0].detail.contains("RAM"),
        "{}",
        compilation.errors[0].detail
    );
}

#[test]
fn a_thousand_labels_are_global_and_not_more() {
    // 600 in one file, 400 or 401 in another.
    let part = |letter: char, count: usize| -> String {
        let globals: String = (0..count).map(|n| format!("GLOBAL {letter}{n}\n")).collect();
        let labels: String = (0..count).map(|n| format!("LBL {letter}{n}\n")).collect();
        globals + &labels + "EM\n"
    };
    let compile = |count: usize| {
        let (a, b) = (part('A', 600), part('B', count));
        linked([
            ("MAIN.PLC", "USES A\nUSES B\nEM\n"),
            ("A.PLC", a.as_str()),
            ("B.PLC", b.as_str()),
        ])
    };
    assert_eq!(compile(400), []);
    assert_eq!(compile(401), [(38, "MAIN.PLC".to_owned(), 1)]);
}

#[test]
fn sixty_four_files_are_linked_and_not_more() {
    let compile = |count: usize| {
        let uses: String = (1..count).map(|n| format!("USES F{n}\n")).collect();
        struct Many(String);
        impl Files for Many {
            fn read(&self, name: &str) -> Option<NamedFile> {
                let bytes = match name {
                    "MAIN.PLC" => self.0.clone().into_bytes(),
                    _ => b"LBL 1\nEM\n".to_vec(),
                };
                let name = name.to_owned();
                Some(NamedFile { name, bytes })
            }
        }
        numbers(&Compilation::compile(
            &Many(uses + "EM\n"),
            "MAIN.PLC",
            Options::default(),
        ))
    };
    assert_eq!(compile(64), []);
    assert_eq!(compile(65), [(34, 64)]);
}

#[test]
fn a_global_label_runs_in_its_own_file() {
    let files = MemoryFiles::from([
        (
            "MAIN.PLC",
            "USES PART\nEXTERN MODULE\nCM MODULE\nL KF F\n= D4\nEM\nLBL 5\nEM\nKFIELD F\nK7\nENDK\n",
        ),
        (
            "PART.PLC",
            "GLOBAL MODULE\nLBL 5\nL K1\n= W0\nEM\nLBL MODULE\nCM 5\nCASE B20\nCM 5\nENDC\nL KF F\n= D8\nEM\nKFIELD F\nK9\nENDK\n",
        ),
    ]);
    let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
    assert_eq!(compilation.errors, []);
    let mut machine = bahn_plc::Machine::new(compilation.program.unwrap().into(), bahn_plc::Start::PowerOn);
    let mut exchange = bahn_exchange::Exchange::default();
    let mut nc = bahn_plc::TestNc::new(bahn_parameters::ParameterList::reference(ControlModel::Tnc415b));
    machine.scan(&mut exchange, &mut nc).unwrap();
    let value = |operand: &str| exchange.plc().number(operand.parse().unwrap());
    assert_eq!((value("W0"), value("D4"), value("D8")), (1, 7, 9));
}

#[test]
fn several_errors_are_found_in_one_pass() {
    let found = errors("L M1\nL M2\n= M3\nFOO\nL B2000\n= W2\nJP 7\nEM\n");
    assert_eq!(found, [(20, 2), (0, 4), (4, 5), (7, 7)]);
}

#[test]
fn programs_of_the_tnc_355_are_read_with_warnings() {
    let compilation = compile("U E4\nUN M5\n= A2\n");
    assert_eq!(compilation.errors, []);
    let warned: Vec<u8> = compilation
        .warnings
        .iter()
        .map(|warning| warning.error.number())
        .collect();
    assert_eq!(
        warned,
        [0, 8, 0, 0],
        "three lines, and the appended EM at the first one"
    );
}

#[test]
fn loose_spelling_is_a_warning_or_in_strict_checking_an_error() {
    let files = MemoryFiles::from([("MAIN.PLC", "LM 1\n= M2\nEM\n")]);
    let tolerant = Compilation::compile(&files, "MAIN.PLC", Options::default());
    assert_eq!((tolerant.errors.len(), tolerant.warnings.len()), (0, 1));
    let strict = Compilation::compile(&files, "MAIN.PLC", Options::default().strict());
    assert_eq!(numbers(&strict), [(5, 1)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_bytes_compile_to_a_program_or_errors(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let files = MemoryFiles::from([("MAIN.PLC", &bytes)]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
        prop_assert_eq!(compilation.program.is_some(), compilation.errors.is_empty());
    }

    #[test]
    fn any_lines_compile_and_run_to_an_end(
        lines in prop::collection::vec(
            prop::sample::select(LINES), 0..60,
        ),
    ) {
        let compilation = compile(&(lines.join("\n") + "\nEM\nLBL 1\nINC W0\nEM\nKFIELD F\nK1\nENDK\n"));
        if let Some(program) = compilation.program {
            let mut machine = bahn_plc::Machine::new(program.into(), bahn_plc::Start::PowerOn);
            let mut exchange = bahn_exchange::Exchange::default();
            let list = bahn_parameters::ParameterList::reference(ControlModel::Tnc415b);
            let mut nc = bahn_plc::TestNc::new(list);
            for _ in 0..3 {
                if let Err(error) = machine.scan(&mut exchange, &mut nc) {
                    prop_assert!(error.error.number() >= 50 && error.line > 0);
                    break;
                }
            }
        }
    }
}

const LINES: &[&str] = &[
    "L M1",
    "LN I3",
    "A M2",
    "= O5",
    "S M3[X]",
    "L W4",
    "L- D8[X]",
    "+ K+5",
    "x W2",
    "/ B0",
    "MOD K0",
    "= W6[X]",
    "= D0",
    "B= M50[X]",
    "LW M20",
    "== W8",
    "A[",
    "+[",
    "]",
    "<< B3",
    ">> K40",
    "BS B1",
    "BT K3",
    "PS W2",
    "PS M4",
    "PL D4",
    "PL M5",
    "PSW",
    "PLW",
    "=X",
    "LX",
    "INCX",
    "INC W0",
    "JPT 1",
    "CM 1",
    "CMF 1",
    "L S\"ABC\"",
    "+ S0[X]",
    "= S1[X]",
    "OVWR S2",
    "== S1^X",
    "L KF F[X]",
    "SUBM 1",
    "= B30",
    "RPLY B30",
    "CAN B30",
    "IFT",
    "ELSE",
    "ENDI",
    "REPEAT",
    "UNTILT",
    "WHILEF",
    "ENDW",
    "CASE B0",
    "ENDC",
    "CM 9000",
    "CM 9020",
    "PS K1",
    "EMT",
];

/// What is still open is named with its place: brackets, structures, tables.
#[test]
fn errors_name_what_was_opened() {
    let opened = |program: &str, number: u8| {
        let files = MemoryFiles::from([("MAIN.PLC", program)]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
        let mut errors = compilation.errors.iter();
        let error = errors.find(|error| error.error.number() == number);
        error
            .unwrap_or_else(|| panic!("no error {number}: {program}"))
            .opened
            .map(|span| (span.line, span.column))
    };
    assert_eq!(
        opened("L I4\nA[\nL I5\n  O[\nL I6\n= O1\n]\n]\n= O2\nEM\n", 10),
        Some((4, 3)),
        "innermost"
    );
    assert_eq!(opened("L I4\nA[\nL I5\nLBL 7\nEM\n", 14), Some((2, 1)));
    assert_eq!(opened("L I4\nA[\nL I5\nCM 7\nEM\nLBL 7\nEM\n", 16), Some((2, 1)));
    assert_eq!(opened("L I4\nA[\nL I5\nEM\n", 17), Some((2, 1)));
    assert_eq!(opened("L I4\nA[\nL W6\n]\n= O1\nEM\n", 24), Some((2, 1)));
    assert_eq!(
        opened("L I4\nIFT\nREPEAT\nL I5\nENDI\nUNTILT\nEM\n", 43),
        Some((3, 1)),
        "the inner one"
    );
    assert_eq!(
        opened("CASE W6\nCM 7\nL I4\nENDC\nEM\nLBL 7\nEM\n", 27),
        Some((1, 1))
    );
    assert_eq!(opened("]\nEM\n", 13), None);
}

/// Each control has its inputs and outputs: the TNC 151 and 155 E0 to E62, E64 to E126, A0 to A30, A32 to A62
/// [001:297-323], the others those of the directory [000:11556-11567].
#[test]
fn inputs_and_outputs_are_those_of_the_control() {
    let is_read = |operand: &str, model| {
        let source = format!("L {operand}\n= M1\nEM");
        let files = MemoryFiles::from([("MAIN.PLC", source.as_str())]);
        Compilation::compile(&files, "MAIN.PLC", Options::for_model(model))
            .errors
            .is_empty()
    };
    for (old, new) in [
        (["I40", "I62", "O62"], ["I128", "I254", "O94"]),
        (["E32", "A32", "A30"], ["I152", "O64", "O111"]),
    ]
    .into_iter()
    .flat_map(|(old, new)| old.into_iter().zip(new))
    {
        for model in [ControlModel::Tnc151, ControlModel::Tnc155] {
            assert!(
                is_read(old, model) && !is_read(new, model),
                "{model}: {old}, {new}"
            );
        }
        let only_old = ["I40", "I62", "E32"].contains(&old);
        for model in [ControlModel::Tnc360, ControlModel::Tnc407, ControlModel::Tnc425] {
            assert!(
                is_read(old, model) != only_old && is_read(new, model),
                "{model}: {old}, {new}"
            );
        }
    }
    let limits = ControlModel::Tnc415b.limits();
    assert_eq!(limits.inputs, bahn_exchange::BitArea::I.ranges());
    assert_eq!(limits.outputs, bahn_exchange::BitArea::O.ranges());
}

/// A file that is no PLC program has an error in each of its lines: a thousand are listed, the others counted.
#[test]
fn a_thousand_errors_are_listed() {
    let compilation = compile(&format!("{}EM\n", "JUNK\n".repeat(4000)));
    assert_eq!((compilation.errors.len(), compilation.not_listed), (1000, 3000));
    assert!(compilation.program.is_none());
    let compilation = compile(&format!("{}EM\n", "LM 4\n= M5\n".repeat(2500)));
    assert!(compilation.program.is_some(), "{:?}", compilation.errors.first());
    assert_eq!((compilation.warnings.len(), compilation.not_listed), (1000, 1500));
}
