//! A PLC that serves the ranges in its window of bytes.

use crate::common::{Bench, T};
use bahn_technology::{EventKind, PlcMemory, Report, WINDOW_BYTES};

/// Time from the start of a run of the PLC to the next one, s.
const RUN_S: f64 = 0.02;

/// What a PLC program does with its bytes in a run, at a time.
type Program = Box<dyn FnMut(&mut [u8; WINDOW_BYTES as usize], f64)>;

/// A PLC with an image of its own, as that of a TNC: what the channel writes it sees when it begins a run.
struct Plc {
    program: Program,
    image: [u8; WINDOW_BYTES as usize],
    written: Vec<(u16, Vec<u8>)>,
    runs: u64,
}

impl Plc {
    fn new(program: impl FnMut(&mut [u8; WINDOW_BYTES as usize], f64) + 'static) -> Plc {
        Plc {
            program: Box::new(program),
            image: [0xEE; WINDOW_BYTES as usize],
            written: Vec::new(),
            runs: 0,
        }
    }
}

impl PlcMemory for Plc {
    fn run_to(&mut self, time_s: f64) -> Result<u64, String> {
        while (self.runs + 1) as f64 * RUN_S <= time_s + 1e-9 {
            for (at, bytes) in self.written.drain(..) {
                self.image[usize::from(at)..][..bytes.len()].copy_from_slice(&bytes);
            }
            self.runs += 1;
            let now = self.runs as f64 * RUN_S;
            (self.program)(&mut self.image, now);
            if self.image[0] == b'!' {
                return Err("PLC error 54".to_owned());
            }
        }
        Ok(self.runs)
    }

    fn read(&self, at: u16) -> u8 {
        self.image[usize::from(at)]
    }

    fn write(&mut self, at: u16, bytes: &[u8]) {
        self.written.push((at, bytes.to_vec()));
    }
}

fn times(report: &Report, kind: EventKind, function: &str) -> Vec<f64> {
    let of =
        |event: &&bahn_technology::Event| event.kind == kind && event.function.as_deref() == Some(function);
    report.events.iter().filter(of).map(|event| event.t).collect()
}

/// The first run that begins at a time or after it.
fn next_run(t: f64) -> f64 {
    (t / RUN_S - 1e-6).ceil() * RUN_S
}

/// The first cycle at a time or after it.
fn next_cycle(t: f64) -> f64 {
    (t / T - 1e-6).ceil() * T
}

#[test]
fn a_function_stands_in_the_window_with_all_that_is_said_of_it() {
    let seen = std::rc::Rc::new(std::cell::RefCell::new(Vec::new()));
    let keep = std::rc::Rc::clone(&seen);
    let mut plc = Plc::new(move |image, _| {
        for slot in image.chunks_exact_mut(16) {
            if slot[0] != 0 && slot[1] == 0 {
                keep.borrow_mut().push(<[u8; 16]>::try_from(&*slot).unwrap());
                slot[1] = 3;
            }
        }
    });
    let list = "m_synch[25] MVS_SVS\nm_prozess_zeit[25] 150000\nh_synch[5] MOS\nm_synch[300] MOS_TS\n\
                spindel[0].bezeichnung S1\nspindel[0].achs_mode 0x00040000\nspindel[0].s_synch MVS_SVS\n";
    let program = "%T\nN10 G01 F1000 X10 M25\nN20 X20 Y[H5=-2]\nN30 X30 M300\nN40 X40 S1200\nN50 M30\n";
    let report = Bench::new(program, list).run_beside(&mut plc);
    assert!(report.completed, "{report:?}");
    let seen = seen.borrow();
    let word = |bytes: &[u8]| i32::from(i16::from_be_bytes(bytes.try_into().unwrap()));
    let double = |bytes: &[u8]| i32::from_be_bytes(bytes.try_into().unwrap());
    let reported: Vec<_> = seen
        .iter()
        .map(|slot| (slot[0], slot[2], slot[3], word(&slot[4..6]), double(&slot[8..12])))
        .collect();
    // Letter, range (0 channel, 2 is Y, 64 the first spindle), waits | value | time stamp, number, value.
    let expected = [
        (b'M', 0, 0b001, 25, 0),
        (b'H', 2, 0b010, 5, -2),
        (b'M', 0, 0b100, 300, 0),
        (b'S', 64, 0b011, 0, 1_200_000),
    ];
    assert_eq!(reported, expected);
    assert_eq!(double(&seen[0][12..]), 150_000);
    let stamp = double(&seen[2][12..]);
    let offset = report.events.iter().find_map(|event| event.offset_us).unwrap();
    assert!((f64::from(stamp) - offset).abs() <= 0.5 && stamp < 1000);
    let counts: Vec<_> = seen.iter().map(|slot| word(&slot[6..8])).collect();
    assert!(counts.is_sorted_by(|a, b| a < b), "{counts:?}");
}

#[test]
fn answers_are_seen_in_the_cycle_after_the_run_that_gives_them() {
    // Fetched at once, acknowledged 0.1 s later.
    let mut since = None;
    let mut plc = Plc::new(move |image, now| {
        if image[0] == b'M' {
            let begun = *since.get_or_insert(now);
            image[1] = if now >= begun + 0.1 - 1e-9 { 3 } else { 1 };
        }
    });
    let report = Bench::new(
        "%T\nN10 G01 F1000 X10\nN20 X20 M25\nN30 M30\n",
        "m_synch[25] MVS_SVS\n",
    )
    .run_beside(&mut plc);
    let output = times(&report, EventKind::Output, "M25")[0];
    // What is output in a cycle the PLC sees when it runs through next, after that cycle.
    let run = next_run(output + 1e-6);
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
    close(times(&report, EventKind::Fetch, "M25")[0], next_cycle(run));
    close(
        times(&report, EventKind::Acknowledge, "M25")[0],
        next_cycle(run + 0.1),
    );
    close(report.waits[0].to_s.unwrap(), next_cycle(run + 0.1));
    assert!(report.completed);
}

#[test]
fn more_functions_than_slots_come_one_after_the_other() {
    let mut plc = Plc::new(|image, _| {
        let standing = image.chunks_exact(16).filter(|slot| slot[0] != 0).count();
        assert!(standing <= 8);
        for slot in image.chunks_exact_mut(16).filter(|slot| slot[0] != 0) {
            slot[1] = 1;
        }
    });
    // Twelve in one block: all go out, eight of them have a slot at once.
    let functions: String = (30..42).map(|number| format!(" M{number}")).collect();
    let list: String = (30..42)
        .map(|number| format!("m_synch[{number}] MOS\n"))
        .collect();
    let report = Bench::new(
        &format!("%T\nN10 G01 F600 X10{functions}\nN20 X20\nN30 M30\n"),
        &list,
    )
    .run_beside(&mut plc);
    assert!(report.completed, "{report:?}");
    let fetches: Vec<_> = report
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Fetch)
        .collect();
    let order: Vec<_> = fetches
        .iter()
        .map(|event| event.function.clone().unwrap())
        .collect();
    assert_eq!(
        order,
        (30..42).map(|number| format!("M{number}")).collect::<Vec<_>>()
    );
    assert!(fetches[7].t + RUN_S - T <= fetches[8].t, "the ninth a run later");
}

#[test]
fn a_plc_that_never_answers_ends_the_run() {
    let mut plc = Plc::new(|_, _| ());
    let report =
        Bench::new("%T\nN10 G01 F1000 X10 M25\nN20 M30\n", "m_synch[25] MVS_SVS\n").run_beside(&mut plc);
    assert!(!report.completed && report.error.is_none());
    assert_eq!((report.waits.len(), report.waits[0].to_s), (1, None));
    assert!((60.0..61.0).contains(&report.time_s), "{}", report.time_s);
}

#[test]
fn what_is_not_fetched_blocks_its_range() {
    let mut plc = Plc::new(|image, now| {
        if image[0] != 0 && (now >= 1.0 || image[5] != 25) {
            image[1] = 1;
        }
    });
    // M25 stays in the window until 1 s: M26, due within the block, finds its range blocked.
    let report = Bench::new(
        "%T\nN10 G01 F6000 X10 M25\nN20 X60 M26\nN30 M30\n",
        "m_synch[25] MOS\nm_synch[26] MOS\n",
    )
    .run_beside(&mut plc);
    assert!(report.completed);
    let fetched = times(&report, EventKind::Fetch, "M25")[0];
    assert!((fetched - next_cycle(1.0)).abs() < 1e-6, "{fetched}");
    assert!(times(&report, EventKind::Output, "M26")[0] >= fetched);
    assert_eq!(report.waits[0].function, "M25");
}

#[test]
fn a_reset_clears_the_window_and_an_error_of_the_plc_ends_the_run() {
    let seen = std::rc::Rc::new(std::cell::RefCell::new(Vec::new()));
    let keep = std::rc::Rc::clone(&seen);
    let mut plc = Plc::new(move |image, now| keep.borrow_mut().push((now, image[0])));
    let list = "m_synch[25] MVS_SVS\nm_synch[26] MOS\n";
    let bench = Bench::new("%T\nN10 G01 F1000 X10 M25\nN20 M30\n", list)
        .and("%T2\nN10 G01 F1000 X20\nM30\n")
        .script("reset 0.5");
    let report = bench.run_beside(&mut plc);
    assert!(!report.completed && report.error.is_none());
    let seen = seen.borrow();
    assert!(seen.iter().any(|(now, letter)| *now < 0.5 && *letter == b'M'));
    let after: Vec<_> = seen.iter().filter(|(now, _)| *now > 1.0).collect();
    assert!(!after.is_empty() && after.iter().all(|(_, letter)| *letter == 0));
    drop(seen);
    let mut plc = Plc::new(|image, now| {
        if now > 0.1 {
            image[0] = b'!';
        }
    });
    let report = Bench::new("%T\nN10 G01 F1000 X10 M25\nN20 M30\n", list).run_beside(&mut plc);
    let error = report.error.unwrap();
    assert_eq!(
        (error.code.as_str(), error.message.as_str()),
        ("plc", "PLC error 54")
    );
}
