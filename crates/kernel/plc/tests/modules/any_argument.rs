//! No argument and no content of the memory makes a module panic, or stops the PLC.

use std::sync::{Arc, OnceLock};

use bahn_exchange::{Exchange, Number, Size};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{
    Compilation, HostLink, HostMessage, Machine, MemoryFiles, MemoryTable, Options, PalletLine, PlcProgram,
    Start, TableKind, TestNc, modules,
};
use proptest::prelude::*;

/// Calls every module with the values of D900 to D916, from the cyclic program and from a submit job.
fn program() -> Arc<PlcProgram> {
    static PROGRAM: OnceLock<Arc<PlcProgram>> = OnceLock::new();
    let compile = || {
        let call = |module: &bahn_plc::Module| {
            let push: String = (0..5).map(|index| format!("PS D{}\n", 900 + 4 * index)).collect();
            format!("{push}CM {}\n", module.number)
        };
        // Every call may leave up to 20 bytes on the stack of 128 bytes; so each is a module of its own in
        // its own submit job or scan, selected by B920.
        let cases: String = (0..modules().len())
            .map(|index| format!("CM {}\n", index + 100))
            .collect();
        let bodies: String = modules()
            .iter()
            .enumerate()
            .map(|(index, module)| format!("LBL {}\n{}EM\n", index + 100, call(module)))
            .collect();
        let source = format!(
            "SUBM 1\nCASE B920\n{cases}ENDC\nEM\nLBL 1\nCASE B920\n{cases}ENDC\nLN M1\nO M1\n= M2\nEM\n{bodies}"
        );
        let files = MemoryFiles::from([("MAIN.PLC", source.as_str())]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
        assert_eq!(compilation.errors, []);
        compilation.program.unwrap().into()
    };
    Arc::clone(PROGRAM.get_or_init(compile))
}

fn nc(running: bool) -> TestNc {
    let mut nc = TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
    for assignment in ["10=%11111", "60=%11111", "3010=6", "7641=1"] {
        nc.parameters.assign(assignment).unwrap();
    }
    nc.program_running = running;
    for kind in [TableKind::Tool, TableKind::Datum, TableKind::Pocket] {
        nc.tables.insert(kind, MemoryTable::new(kind, 20));
    }
    nc.pallet = Some(vec![PalletLine {
        program: "7432".to_owned(),
        datum_table: None,
    }]);
    nc.compensation = Some(vec![vec![]]);
    nc.messages = vec!["OIL".to_owned()];
    let mut host = HostLink::default();
    host.incoming.push_back(HostMessage::Text(vec![b'X'; 300]));
    nc.host = Some(host);
    nc
}

fn argument() -> impl Strategy<Value = i32> {
    prop_oneof![
        4 => -2..30_i32,
        2 => 900..1030_i32,
        1 => Just(i32::MIN),
        1 => Just(i32::MAX),
        1 => any::<i32>(),
        1 => proptest::sample::select(vec![10, 910, 3010, 4110, 7280, 7224]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn any_argument(
        arguments in proptest::array::uniform5(argument()),
        texts in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 128), 4),
        readable in "[-+ 0-9A-F.,\u{1a}ED]{0,127}",
        received in proptest::collection::vec(any::<u8>(), 0..200),
        running in any::<bool>(),
        word_processing in any::<bool>(),
    ) {
        for module in 0..modules().len() {
            let mut exchange = Exchange::default();
            for (index, argument) in arguments.iter().enumerate() {
                let number = Number::new(Size::Double, 900 + 4 * index as u16).unwrap();
                exchange.nc_set_number(number, *argument);
            }
            exchange.nc_set_number("B920".parse().unwrap(), module as i32);
            exchange.nc_set("M2719".parse().unwrap(), word_processing);
            for (index, text) in texts.iter().enumerate() {
                exchange.plc_mut().string_mut(index).unwrap().copy_from_slice(text);
            }
            exchange.plc_mut().set_text(1, readable.as_bytes());
            let mut nc = nc(running);
            for interface in &mut nc.interfaces {
                interface.user = Some(bahn_plc::InterfaceUser::Plc);
                interface.ready = true;
                interface.received = true;
                interface.receive.clone_from(&received);
            }
            let mut machine = Machine::new(program(), Start::PowerOn);
            let scan = machine.scan(&mut exchange, &mut nc);
            // A module may write B920 itself: then the job finds no case. Anything else runs to its end.
            if let Err(error) = scan {
                prop_assert_eq!(error.error, bahn_plc::PlcError::CaseOutOfRange);
            }
            nc.end_scan();
        }
    }
}
