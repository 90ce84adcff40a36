//! A block search of a family that is none of the shipped ones: its programs are lists of numbers, each of which is a block and
//! what it leaves in force.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use bahn_kernel::block_search::{Latest, PassOver, Passed, Search, search};

/// Programs one after the other, with the block that is looked for. A negative number is refused.
struct Lists {
    programs: Vec<Vec<i32>>,
    wanted: i32,
    /// What the next block waits for, in steps.
    waits: usize,
    /// Of each ten the last.
    in_force: Latest<i32>,
}

impl Lists {
    fn new(programs: &[&[i32]], wanted: i32) -> Lists {
        Lists {
            programs: programs.iter().map(|program| program.to_vec()).collect(),
            wanted,
            waits: 0,
            in_force: Latest::default(),
        }
    }
}

impl PassOver for Lists {
    type Fault = i32;

    fn pass(&mut self) -> Result<Passed, i32> {
        if self.waits > 0 {
            self.waits -= 1;
            return Ok(Passed::Waits);
        }
        let program = self.programs.first_mut().unwrap();
        let Some(block) = program.first().copied() else {
            return Ok(Passed::End);
        };
        if block < 0 {
            return Err(block);
        }
        if block == self.wanted {
            return Ok(Passed::Found);
        }
        program.remove(0);
        self.in_force.put(block, |other| other / 10 == block / 10);
        Ok(Passed::Block)
    }

    fn begin_next(&mut self) -> Result<bool, i32> {
        self.programs.remove(0);
        Ok(!self.programs.is_empty())
    }
}

/// Over the end of the first program to the block in the second one; 25 has replaced 21, and stands where it came.
#[test]
fn the_block_is_found_with_what_is_in_force() {
    let mut lists = Lists::new(&[&[11, 21, 31], &[25, 40, 50]], 40);
    assert_eq!(search(&mut lists, 100), Ok(Search::Found));
    assert_eq!(lists.programs, [[40, 50]]);
    assert_eq!(lists.in_force.into_vec(), [11, 31, 25]);
}

#[test]
fn a_block_that_no_program_has_is_missing() {
    assert_eq!(
        search(&mut Lists::new(&[&[1], &[2]], 3), 100),
        Ok(Search::Missing)
    );
    assert_eq!(search(&mut Lists::new(&[&[1, -2, 3]], 3), 100), Err(-2));
}

/// It takes no more steps than it may, and goes on where it was.
#[test]
fn a_search_goes_on_later() {
    let mut lists = Lists::new(&[&[1, 2, 3, 4]], 4);
    assert_eq!(search(&mut lists, 2), Ok(Search::Open));
    assert_eq!(lists.programs, [[3, 4]]);
    lists.waits = 1;
    assert_eq!(search(&mut lists, 2), Ok(Search::Open));
    assert_eq!(search(&mut lists, 2), Ok(Search::Found));
}
