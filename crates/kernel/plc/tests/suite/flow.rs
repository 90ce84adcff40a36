//! Jumps, modules, structures, tables, submit jobs, timers, counters, edges; run-time errors.

use crate::common::{Bench, compile, example};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{InterfaceUser, PlcError, Start, TestNc};

/// Runs one scan that must fail; number and line of the error.
fn failing(before: &str, program: &str) -> (u8, u32) {
    let mut bench = Bench::new(program);
    bench.set(before);
    let error = bench.scan().unwrap_err();
    assert_eq!(bench.scan().unwrap_err(), error, "the PLC stays stopped");
    (error.error.number(), error.line)
}

#[test]
fn a_jump_skips_a_section() {
    example(
        "[000:13846-13870]",
        "I5=1 I3=1 M100=1",
        "L I5   | LA=1 | 1
         JPT 10 | LA=1
         L I3   | -
         O M500 | -
         = O20  | -
         LBL 10
         L M100 | LA=1 | 1",
        "O20=0",
    );
}

#[test]
fn a_module_is_called() {
    example(
        "[000:13931-13960]",
        "I5=0 M100=1 I3=0 M500=1",
        "L I5   | LA=0
         CMF 10
         L M100 | LA=1 | 1
         EM
         LBL 10
         L I3   | LA=0 | 0
         OM 500 | LA=1 | 1
         = O20  | LA=1 | 1",
        "O20=1",
    );
}

#[test]
fn the_caller_goes_on_with_the_modules_accumulator() {
    // As the spindle orientation does: the module loads, the caller sets [000:5979-5983][000:6014-6026].
    example(
        "[000:5979-5983]",
        "M1=1",
        "CM 180
         S M12  | LA=1 | 1
         EM
         LBL 180
         L M1   | LA=1
         EM",
        "M12=1",
    );
}

#[test]
fn ends_of_modules() {
    example(
        "[000:13962-13989]",
        "I1=1",
        "CM 1
         CM 2
         EM
         LBL 1
         L I1
         EMF
         S M1   | LA=1 | 1
         EMT
         S M2   | -
         EM
         LBL 2
         LN I1
         EMF
         S M3   | -",
        "M1=1 M2=0 M3=0",
    );
}

#[test]
fn a_constants_field() {
    let program =
        "L KF VALUESFIELD\n= D0\nINCX\nL KF VALUESFIELD[X]\n= D4\nINCX\nL KF VALUESFIELD[X]\n= D8\nINCX
        L KF VALUESFIELD[X]\n= D12\nEM\nKFIELD VALUESFIELD\nK+10\nK+1\nK$ABC\nK-100000\nENDK\n";
    let mut bench = Bench::new(program);
    bench.scan().unwrap();
    bench.expect("D0=10 D4=1 D8=2748 D12=-100000");
    let outside = |index: i32| {
        failing(
            "",
            &format!("L K{index}\n=X\nL KF F[X]\n= D0\nEM\nKFIELD F\nK1\nK2\nENDK\n"),
        )
    };
    assert_eq!(outside(2), (56, 3));
    assert_eq!(outside(-1), (56, 3));
}

#[test]
fn case_calls_an_entry_of_its_table() {
    // Seven entries, numbered from 0 [000:14561-14590].
    let numbers = [100, 200, 201, 202, 203, 204, 300];
    let mut program = "CASE B150\n".to_owned();
    numbers
        .iter()
        .for_each(|label| program += &format!("CM {label}\n"));
    program += "ENDC\nL K+1\n= B160\nEM\n";
    numbers
        .iter()
        .for_each(|label| program += &format!("LBL {label}\nL K{label}\n= W0\nEM\n"));
    for (entry, label) in numbers.into_iter().enumerate() {
        let mut bench = Bench::new(&program);
        bench.set(&format!("B150={entry}"));
        bench.scan().unwrap();
        bench.expect(&format!("W0={label} B160=1"));
    }
    assert_eq!(failing("B150=7", &program), (54, 1));
    assert_eq!(failing("B150=-1", &program), (54, 1));
}

#[test]
fn if_else() {
    let program = "L I0\nIFT\nL K1\n= B0\nELSE\nL K2\n= B0\nENDI\nL I0\nIFF\nL K3\n= B1\nENDI\nEM\n";
    let mut bench = Bench::new(program);
    bench.set("I0=1");
    bench.scan().unwrap();
    bench.expect("B0=1 B1=0");
    bench.set("I0=0");
    bench.scan().unwrap();
    bench.expect("B0=2 B1=3");
}

#[test]
fn repeat_until() {
    // As [000:14490-14499]: until X is 100.
    let mut bench = Bench::new("REPEAT\nINC W0\nINCX\nLX\n>= K100\nUNTILT\nEM\n");
    bench.scan().unwrap();
    bench.expect("W0=100");
    assert_eq!(bench.machine.registers().index, 100);
    // At least one pass.
    let mut bench = Bench::new("LN M0\nS M0\nREPEAT\nINC W0\nL M0\nUNTILT\nEM\n");
    bench.scan().unwrap();
    bench.expect("W0=1");
}

#[test]
fn while_endw() {
    // The loop runs while W0 is below 5; its condition is made again before ENDW.
    let program = "L W0\n< K5\nWHILET\nINC W0\nL W0\n< K5\nENDW\nL M0\nWHILEF\nL M0\nON M0\n= M1\nENDW\nEM\n";
    let mut bench = Bench::new(program);
    bench.scan().unwrap();
    bench.expect("W0=5 M1=1");
    bench.set("W0=7 M0=1 M1=0");
    bench.scan().unwrap();
    bench.expect("W0=7 M1=0");
}

#[test]
fn memory_modules() {
    let program = "PS K100\nPS K200\nPS K3\nCM 9000\nPS K4\nCM 9010\nPL W20\nPS K8\nPS K-2\nCM 9022\nPS K6\nCM 9012\nPL D12
        EM\n";
    let mut bench = Bench::new(program);
    bench.set("M100=1 M102=1 B4=-7");
    bench.scan().unwrap();
    bench.expect("M200=1 M201=0 M202=1 W20=-7 D8=-2 D12=0 M3171=1");
    let mut bench = Bench::new("PS K0\nPS K1\nPS K4\nCM 9001\nEM\n");
    bench.set("B0=9 B1=8 M3171=1");
    bench.scan().unwrap();
    bench.expect("B1=9 B2=9 B3=9 B4=9 B5=0 M3171=0");
}

#[test]
fn timer_1_runs_for_nine_cycles() {
    // MP4110.1 = 9 [000:11764-11768].
    let mut bench = Bench::new("L I1\n= T1\nEM\n");
    bench.set("MP4110.1=9 I1=1");
    bench.scan().unwrap();
    bench.expect("T49=0");
    bench.set("I1=0");
    let running: Vec<i64> = (0..12)
        .map(|_| {
            bench.scan().unwrap();
            bench.get("T49")
        })
        .collect();
    assert_eq!(running, [1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0]);
}

/// On the TNC 155 timers 0 to 15 are MP110 to MP125, 16 to 31 MP193 to MP208, counters 0 to 15 MP94 to MP109
/// [001:1832-1833].
#[test]
fn timers_and_counters_of_the_old_controls() {
    let mut bench = Bench::new("L I1\n= T1\n= T16\n= T32\n= C1\nL I2\n= C97\nEM\n");
    bench.nc = TestNc::new(ParameterList::reference(ControlModel::Tnc155));
    bench.set("MP111=4 MP193=2 MP95=3 I1=1");
    bench.scan().unwrap();
    bench.set("I1=0 I2=1");
    let running: Vec<[i64; 4]> = (0..6)
        .map(|_| {
            bench.scan().unwrap();
            ["T49", "T64", "T80", "C49"].map(|operand| bench.get(operand))
        })
        .collect();
    assert_eq!(
        running,
        // The counter is released one scan later.
        [
            [1, 1, 0, 1],
            [1, 1, 0, 1],
            [1, 0, 0, 1],
            [1, 0, 0, 0],
            [0, 0, 0, 0],
            [0, 0, 0, 0]
        ]
    );
}

#[test]
fn counter_1_counts_ten_released_cycles() {
    // MP4120.1 = 10 [000:11828-11829]; without release it waits.
    let mut bench = Bench::new("L I1\n= C1\nL I2\n= C97\nEM\n");
    bench.set("MP4120.1=10 I1=1");
    bench.scan().unwrap();
    bench.set("I1=0");
    bench.scans(5);
    bench.expect("C49=1");
    bench.set("I2=1");
    bench.scan().unwrap();
    for released in 1..=10 {
        bench.expect("C49=1");
        bench.scan().unwrap();
        assert_eq!(
            bench.get("C49"),
            i64::from(released < 10),
            "after {released} released cycles"
        );
    }
}

/// The gear change of the manual [000:5658-5710]: timers 13 and 14 start each other while the gear strobe stands. `freed` is
/// what frees the second one. The swings of so many scans.
fn gear_change(freed: &str, scans: usize) -> (Bench, String) {
    let idle = "AN T13\nAN T14\nAN T61\nAN T62\n";
    let program = format!(
        "L M2043\nAN M968\n{idle}= T13\nS M968
        L M2043\nAN M969\n{idle}= T14\nS M969
        L T61\n= M2490\nL T62\n= M2491
        LN T13\nAN T61\nR M968\n{freed}
        L M2043\nA I5\nS M2480\nL M2043\nCMT 50\nEM
        LBL50\nL M2043\nL W256\nB= O15\nEM\n"
    );
    let mut bench = Bench::new(&program);
    bench.set("M2043=1 W256=5 MP4110.13=3 MP4110.14=2");
    let swing = (0..scans).map(|_| {
        bench.scan().unwrap();
        match (bench.get("M2490"), bench.get("M2491")) {
            (0, 0) => '-',
            (1, 0) => 'L',
            (0, 1) => 'R',
            both => panic!("{both:?}"),
        }
    });
    let swing = swing.collect();
    (bench, swing)
}

#[test]
fn gear_change_swings_the_spindle_left_and_right() {
    let (mut bench, swing) = gear_change("LN T14\nAN T62\nR M969", 15);
    // A start takes one scan; then the direction stands for the cycles of its parameter.
    assert_eq!(swing, "-LLL-RR-LLL-RR-");
    bench.expect("O15=1 O16=0 O17=1 M2480=0");
    bench.set("I5=1");
    bench.scan().unwrap();
    bench.expect("M2480=1");
    // No timer is started any more when the strobe has gone, the running one ends.
    bench.set("M2043=0 I5=0");
    let left: Vec<i64> = (0..6)
        .map(|_| {
            bench.scan().unwrap();
            bench.get("M2490")
        })
        .collect();
    assert_eq!(left, [1, 1, 0, 0, 0, 0]);
}

/// As it is printed the program frees M968 twice and M969 never. T61 is not yet on in the scan that starts T13, so the second
/// time frees M968 at once, and T13 goes before T14 whenever no timer runs: the spindle swings to the left only.
#[test]
fn gear_change_as_printed() {
    let (_, swing) = gear_change("LN T14\nAN T61\nR M968", 13);
    assert_eq!(swing, "-LLL-LLL-LLL-");
}

#[test]
fn edges_of_inputs_last_one_run() {
    let mut bench = Bench::new("L M2497\nSN M2497\nL M1504\n= M1\nL M1704\n= M2\nEM\n");
    bench.scan().unwrap();
    bench.set("I4=1");
    bench.scan().unwrap();
    bench.expect("M1=1 M2=0");
    bench.scan().unwrap();
    bench.expect("M1=0 M2=0");
    bench.set("I4=0");
    bench.scan().unwrap();
    bench.expect("M1=0 M2=1");
    bench.scan().unwrap();
    bench.expect("M2=0");
}

#[test]
fn the_first_scan_is_marked() {
    let mut bench = Bench::new("L M2180\nS M1\nL M2185\nS M2\nEM\n");
    bench.scan().unwrap();
    bench.expect("M1=1 M2=0 M2180=1");
    bench.scan().unwrap();
    bench.expect("M2180=0");
}

/// The guard of the manual: one submission while a job runs, cancelled by I11 [000:14374-14398].
const GUARD: &str = "L I10\nJPF 100\nRPLY B128\n<> K+0\nJPT 100\nSUBM 300\n= B128\nLBL 100\nL I11\nJPF 110
    CAN B128\nLBL 110\nRPLY B128\n= B130\nEM
    LBL 300\nINC W200\nREPEAT\nL M50\nUNTILT\nINC W202\nEM\n";

#[test]
fn a_submit_job_is_started_once_and_can_be_cancelled() {
    let mut bench = Bench::new(GUARD);
    bench.set("I10=1");
    bench.scans(5);
    bench.expect("W200=1 B130=1");
    bench.set("M50=1 I10=0");
    bench.scans(2);
    bench.expect("W200=1 W202=1 B130=0");
    bench.set("M50=0 I10=1");
    bench.scans(3);
    bench.expect("W200=2 W202=1 B130=1");
    bench.set("I10=0 I11=1");
    bench.scans(2);
    bench.expect("W202=1 B130=0");
}

#[test]
fn eight_jobs_are_queued_in_order_with_their_own_markers_and_registers() {
    let program = "L M1\nJPT 9\nLN M1\nS M1
        SUBM 1\n= B1\nSUBM 2\n= B2\nSUBM 2\n= B3\nSUBM 2\n= B4\nSUBM 2\n= B5\nSUBM 2\n= B6\nSUBM 2\n= B7\nSUBM 2\n= B8
        SUBM 2\n= B9\nRPLY B1\n= B11\nRPLY B2\n= B12
        LBL 9\nL M3169\n= M10\nEM
        LBL 1\nL K1\n/ K0\n= D200\nL M3169\n= M11\nSUBM 2\n= B20\nEM
        LBL 2\nINC B21\nL M3169\n= M12\nEM\n";
    let mut bench = Bench::new(program);
    bench.set("B20=99");
    bench.scans(2);
    bench.expect("B1=1 B2=2 B8=8 B9=0 B11=1 B12=2");
    // 1 / 0 leaves its mark in the job alone; a job cannot submit.
    bench.expect("M10=0 M11=1 M12=0 M3169=0 B20=0 B21=7");
}

#[test]
fn jobs_get_one_millisecond_of_nominal_time_each_scan() {
    // INC 0.5 us, L 0.7 us, UNTILT 0.5 us, REPEAT 0.5 us: 2.2 us for a pass of the loop.
    let mut bench = Bench::new(
        "L M1\nJPT 9\nLN M1\nS M1\nSUBM 1\n= B31\nLBL 9\nEM\nLBL 1\nREPEAT\nINC W0\nL M2\nUNTILT\nEM\n",
    );
    bench.scan().unwrap();
    let passes = bench.get("W0");
    assert_eq!(passes, (1_000.0_f64 / 2.2).ceil() as i64);
    bench.scan().unwrap();
    assert_eq!(bench.get("W0"), 2 * passes);
}

#[test]
fn processing_time_is_nominal() {
    // L of a marker 0.7 us, = 0.5 us, EM 3.8 us; 100 % are 5 ms.
    let mut bench = Bench::new("L M1\n= M2\nEM\n");
    let report = bench.scan().unwrap();
    assert_eq!(report.time.current, 700 + 500 + 3800);
    assert!((report.time.current_percent() - 0.1).abs() < 1e-12);
    let compilation = compile("L M1\n= M2\nEM\n");
    assert_eq!(
        (compilation.size_bytes, compilation.nominal_time),
        (4 + 4 + 4, 5000)
    );
}

#[test]
fn an_endless_loop_is_a_time_out_at_its_jump() {
    assert_eq!(failing("", "L M1\n= M2\nLBL 1\nL M1\n= M2\nJP 1\nEM\n"), (53, 6));
    assert_eq!(
        failing("", "LBL 1\nCM 2\nJP 1\nEM\nLBL 2\nL M1\n= M2\nEM\n").0,
        53
    );
}

#[test]
fn run_time_errors_name_the_line() {
    assert_eq!(failing("", "CM 1\nEM\nLBL 1\nCM 1\nEM\n"), (50, 4));
    assert_eq!(failing("", "PS K1\nPL D0\nPL D4\nEM\n"), (51, 3));
    assert_eq!(failing("", "PS M1\nPLW\n= D0\nEM\n"), (51, 2));
    assert_eq!(failing("", "LBL 1\nPS K1\nJP 1\nEM\n"), (52, 2));
    let indexed = |index: i32, command: &str| {
        let program = format!("L K{index}\n=X\nL K1\n{command}\nEM\n");
        let mut bench = Bench::new(&program);
        bench.scan().err().map(|error| (error.error, error.line))
    };
    // X may be -100 to 923 [000:14014-14016].
    assert_eq!(indexed(-100, "= B100[X]"), None);
    assert_eq!(indexed(923, "= B100[X]"), None);
    assert_eq!(indexed(-101, "= B100[X]"), Some((PlcError::IndexOutOfRange, 4)));
    assert_eq!(indexed(924, "= B100[X]"), Some((PlcError::IndexOutOfRange, 4)));
    assert_eq!(indexed(511, "= W0[X]"), None);
    assert_eq!(indexed(512, "= W0[X]"), Some((PlcError::IndexOutOfRange, 4)));
    assert_eq!(indexed(256, "= D0[X]"), Some((PlcError::IndexOutOfRange, 4)));
    // Only the low 16 bits address.
    assert_eq!(indexed(0x1_0000, "= B1023[X]"), None);
    // Reads are not checked.
    let mut bench = Bench::new("L K5000\n=X\nL B0[X]\n= D4\nEM\n");
    bench.set("D4=7");
    bench.scan().unwrap();
    bench.expect("D4=0");
    for command in ["L S0[X]", "L S#E990[X]", "L S#D0[X]", "L S3^X"] {
        let program = format!("L K1000\n=X\n{command}\n= S1\nEM\n");
        assert_eq!(failing("", &program), (56, 3), "{command}");
    }
}

#[test]
fn index_and_stack_start_anew_in_every_cycle() {
    let mut bench = Bench::new("PS K1\nINCX\nLX\n= W0\nEM\n");
    bench.scans(200);
    bench.expect("W0=1");
}

#[test]
fn a_restart_gives_back_what_the_program_had() {
    let program = "L M2180\n= M1\nL M2185\n= M2\nLN M3\nS T1\nL T49\n= M4\nSUBM 1\n= B200\nEM\n
        LBL 1\nPS K+0\nPS K+0\nCM 9100\nREPEAT\nL M5\nUNTILT\nEM\n";
    let mut bench = Bench::new(program);
    bench.set("MP4110.1=50 MP10=%11111 MP60=%10000");
    bench.nc.axes[4].override_percent = 25.0;
    bench.scans(1);
    bench.set("M3=1");
    bench.scans(2);
    bench.expect("M1=0 M2=0 M4=1");
    assert_eq!(bench.nc.interfaces[0].user, Some(InterfaceUser::Plc));
    bench.nc.interfaces[1].user = Some(InterfaceUser::Nc);
    bench.machine.restart(Start::Interruption, &mut bench.nc);
    assert_eq!(
        (bench.nc.interfaces[0].user, bench.nc.interfaces[1].user),
        (None, Some(InterfaceUser::Nc))
    );
    assert_eq!(bench.nc.axes[4].override_percent, 100.0);
    assert_eq!(bench.machine.time().maximum, 0);
    let report = bench.scan().unwrap();
    assert_eq!(report.scans, 1);
    // The jobs of before are gone: the first identifier is given again.
    bench.expect("M1=0 M2=1 B200=1");
    bench.machine.load(
        compile("L K1\n/ K0\nINC W0\nEM\n").program.unwrap().into(),
        &mut bench.nc,
    );
    bench.scans(2);
    bench.expect("W0=2 M2185=0");
}

#[test]
fn a_stopped_plc_goes_on_after_a_restart() {
    let mut bench = Bench::new("INC W0\nCASE B0\nCM 1\nENDC\nEM\nLBL 1\nEM\n");
    bench.set("B0=1");
    assert_eq!(bench.scan().unwrap_err().error, PlcError::CaseOutOfRange);
    bench.set("B0=0");
    assert!(bench.scan().is_err());
    bench.machine.restart(Start::Interruption, &mut bench.nc);
    bench.scans(1);
    bench.expect("W0=2");
}
