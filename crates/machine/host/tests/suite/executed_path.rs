//! Elements of the path are handed out when they are executed, each once and in their order.

use bahn_host::{Action, Answer, ElementId, ExecutedPath, Host, Source};
use bahn_tnc::{Command, RunState};

/// Two lines that the axes need seconds for, after one that they do not move on.
const LINES: &str = "1 L Z+50 R0 F MAX\n2 L X+10 Y+0 R0 F600\n3 L X+20 R0\n4 L X+60 R0";

/// The sequences that a run hands out, as long as `goes_on` says so.
fn handed_out(host: &mut Host, path: &mut ExecutedPath, goes_on: impl Fn(&Host) -> bool) -> Vec<u64> {
    let mut seen = Vec::new();
    while goes_on(host) {
        host.step().unwrap();
        path.follow(host);
        let control = host.control();
        for element in path.by_ref() {
            let current = control.element();
            assert!(
                control.has_ended()
                    || current.is_some_and(|current| ElementId::of(current).sequence > element.sequence),
                "element {} is handed out before it is executed",
                element.sequence
            );
            seen.push(element.sequence);
        }
    }
    seen
}

#[test]
fn a_run_hands_out_each_element_once() {
    let mut host = crate::support::mill(LINES);
    host.keep_path();
    let mut path = ExecutedPath::of(0);
    let seen = handed_out(&mut host, &mut path, |host| !host.control().has_ended());
    assert!(seen.len() >= 4, "{seen:?}");
    assert!(seen.windows(2).all(|pair| pair[0] < pair[1]), "{seen:?}");
    assert_eq!(path.next(), None);
}

/// Block 4 is not done when the run is broken off in it; what was before it is, and what waits is forgotten.
#[test]
fn what_is_broken_off_is_not_handed_out() {
    let mut host = crate::support::mill(LINES);
    host.keep_path();
    let mut path = ExecutedPath::of(0);
    let in_block_4 = |host: &Host| host.control().element().is_some_and(|own| own.block.block == 4);
    let seen = handed_out(&mut host, &mut path, |host| !in_block_4(host));
    crate::support::seconds(&mut host, 0.5);
    path.follow(&mut host);
    path.finish();
    assert_eq!(path.next(), None, "after {seen:?}");
    let stop = Action::parse("key NC_STOP tap").unwrap();
    for action in [stop, Action::Command(0, Command::InternalStop)] {
        let answer = host.act(Source::Client("test".to_owned()), action);
        assert!(matches!(answer, Ok(Answer::Done)));
        crate::support::seconds(&mut host, 1.0);
    }
    path.follow(&mut host);
    path.clear();
    path.finish();
    assert_eq!((host.control().run_state(), path.next()), (RunState::Idle, None));
}

/// The movements of a cycle are handed out while it goes on, not with its last one: who looks on sees the pocket grow.
#[test]
fn a_cycle_is_handed_out_movement_by_movement() {
    let mut host = crate::support::mill(
        "TOOL DEF 9 L+0 R+4\nTOOL CALL 9 Z S2000\nL Z+100 R0 FMAX M3\nL X+50 Y+50 FMAX\n\
         CYCL DEF 4.0 POCKET MILLING\nCYCL DEF 4.1 SET UP 2\nCYCL DEF 4.2 DEPTH -4\nCYCL DEF 4.3 PECKG 2 F500\n\
         CYCL DEF 4.4 X+30\nCYCL DEF 4.5 Y+20\nCYCL DEF 4.6 F2000 DR+\nL Z+2 FMAX\nCYCL CALL\nL Z+100 FMAX",
    );
    host.keep_path();
    let mut path = ExecutedPath::of(0);
    let mut during = 0;
    while !host.control().has_ended() {
        host.step().unwrap();
        path.follow(&mut host);
        let current = host.control().element().map(|element| element.sequence);
        during += path.by_ref().filter(|own| Some(own.sequence) == current).count();
    }
    assert!(during > 10, "{during}");
}
