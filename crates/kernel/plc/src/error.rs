//! The PLC's errors 0 to 56 [000:11915-12048].

use std::fmt;

macro_rules! errors {
    ($($number:literal $id:ident $when:literal $text:literal cause $cause:literal cure $cure:literal;)+) => {
        /// An error of a PLC program. Numbers, detection times and texts are in the table of this file;
        /// 1 and 46 to 49 are spare.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum PlcError {
            $(
                #[doc = concat!("Error ", $number, ", detected ", $when, ": ", $text, ".")]
                $id = $number,
            )+
        }

        impl PlcError {
            /// All errors in the order of their numbers.
            pub const ALL: &[PlcError] = &[$(PlcError::$id),+];

            /// The text that stands beside its number.
            pub const fn text(self) -> &'static str {
                match self { $(PlcError::$id => $text,)+ }
            }

            /// Why the control reports it.
            pub const fn cause(self) -> &'static str {
                match self { $(PlcError::$id => $cause,)+ }
            }

            /// What the programmer does about it.
            pub const fn cure(self) -> &'static str {
                match self { $(PlcError::$id => $cure,)+ }
            }

            const fn when(self) -> &'static str {
                match self { $(PlcError::$id => $when,)+ }
            }
        }
    };
}

errors! {
    0 NotACommand "E S C" "not a valid command"
        cause "The line begins with no instruction of the PLC."
        cure "Correct the spelling; comments begin with a semicolon.";
    2 InvalidOperandType "E S C" "invalid operand type"
        cause "The instruction does not work on operands of this type."
        cure "Take an operand of a type that it works on, for example a marker for logic, a word for numbers.";
    3 OperandNotFound "E S C" "operand not found"
        cause "The type of the operand stands without its number."
        cure "Write the number after the type, as in M2045 or W260.";
    4 OperandOutOfRange "E S C" "operand not in acceptable range"
        cause "The control has no operand of this number, or a word does not begin at an address that fits its width."
        cure "Look the range up with `bahn plc signals`; words have even addresses, doublewords multiples of four.";
    5 NoLimiter "E S C" "no limiter after command"
        cause "Something stands after the instruction that does not belong to it."
        cure "Delete it, or put a semicolon before it.";
    6 NoEndOfLine "E S C" "no end of line found"
        cause "The line is longer than 128 characters."
        cure "Shorten it, for example its comment.";
    7 LabelNotDefined "S C" "label not defined"
        cause "A jump or call names a label that the file neither sets with LBL or KFIELD nor imports with EXTERN."
        cure "Set the label, import it, or correct the name.";
    8 NoEndOfBlock "S C" "no end of block found"
        cause "The last instructions of the file are not ended by EM or JP, so that the PLC would run on into nothing."
        cure "End the module with EM.";
    9 ProgramTooLong "S C" "program too long (RAM overflow)"
        cause "The code is longer than the memory of the control."
        cure "Shorten the program, or take out modules that are not called.";
    10 AssignmentInBracket "S C" "assignment to a parenthesis"
        cause "A result is assigned while a bracket is open."
        cure "Close the bracket before the assignment.";
    11 BracketsTooDeep "S C" "parenthesis nesting too deep"
        cause "More than 16 brackets are open."
        cure "Keep intermediate results in markers.";
    12 JumpInChain "S C" "jump in a gating chain"
        cause "An unconditional jump leaves a chain whose result is not assigned."
        cure "Assign the result first, or make the jump conditional.";
    13 CloseWithoutOpen "S C" "close parenthesis with no open parenthesis"
        cause "A bracket is closed that was never opened."
        cure "Delete it, or open it with a gate before.";
    14 LabelInBracket "S C" "label within a parenthesis"
        cause "A label stands inside a bracket: who jumps there would close what he did not open."
        cure "Put the label before the chain.";
    15 LabelInChain "S C" "label within a gating chain"
        cause "A label stands within a chain, so that the next instruction would be a gate or a load depending on the way to it."
        cure "Assign the result before the label, and begin a new chain after it.";
    16 JumpInBracket "S C" "jump within a parenthesis"
        cause "A jump or call leaves an open bracket, which would never be closed."
        cure "Close the bracket before it.";
    17 BracketOpenAtEnd "S C" "parenthesis opened at end of block"
        cause "The module ends while a bracket is open."
        cure "Close the bracket before EM.";
    18 LabelDefinedTwice "S C" "label defined twice"
        cause "The name is set twice in the file, imported as well as set, or one of the reserved names 9000 to 9255."
        cure "Choose another name.";
    19 NoWordAssignment "S C" "no word assignment"
        cause "A new chain of words begins while the result of the one before was not used."
        cure "Assign the first result, or delete the chain.";
    20 NoLogicAssignment "S C" "no logic assignment"
        cause "A new logic chain begins while the result of the one before was not used."
        cure "Assign the first result, or use a gate (A, O) instead of a load.";
    21 WordNotLoaded "S C" "word accumulator not loaded"
        cause "The instruction works on the word accumulator, into which nothing was loaded."
        cure "Load a number first (L with byte, word or constant).";
    22 LogicNotLoaded "S C" "logic accumulator not loaded"
        cause "The instruction works on the logic accumulator, into which nothing was loaded."
        cure "Load a bit first (L, LN with marker, input or output).";
    23 NothingLoadedAtBracket "S C" "accumulators not loaded with open parenthesis"
        cause "A bracket opens although no chain was begun whose value it could gate."
        cure "Load an operand before the bracket.";
    24 WrongBracketResult "S C" "wrong type of parenthesis result"
        cause "The content of the bracket gives a number where a bit is needed, or a bit where a number is."
        cure "Make content and gate fit: logic gates take logic chains, arithmetic and comparisons take words.";
    25 ConditionNotLoaded "S C" "conditional jump with invalid logic accumulator"
        cause "A conditional jump, call or end has no logic value to decide by."
        cure "Load or gate a bit before it, or take the unconditional form.";
    26 EndOutsideTable "S C" "ENDC/ENDK outside a CASE/KFIELD instruction"
        cause "ENDC or ENDK stands without the CASE or KFIELD that it would end."
        cure "Delete it, or put CASE or KFIELD before.";
    27 WrongCommandInTable "S C" "wrong command within CASE table/KFIELD"
        cause "Between CASE and ENDC stands something else than CM, or between KFIELD and ENDK something else than K."
        cure "Move the instruction out of the table.";
    28 TooManyCases "S C" "too many table entries in CASE"
        cause "The table of a CASE has more than 128 entries."
        cure "Divide it into two with a comparison before.";
    29 EmptyTable "S C" "blank CASE instruction/KFIELD"
        cause "The table of CASE or KFIELD has no entry."
        cure "Write its entries, or delete it.";
    30 StringNotLoaded "S C" "string accumulator not loaded"
        cause "The instruction works on the string accumulator, into which nothing was loaded."
        cure "Load a string first (L S0, L S\"..\").";
    31 StringInBracket "S C" "string instruction within parentheses"
        cause "Strings cannot be gated in brackets."
        cure "Close the bracket before the string instruction.";
    32 NoStringAssignment "S C" "no string assignment"
        cause "A new string is loaded while the result of the chain before was not used."
        cure "Store the first string, or compare it.";
    33 LinkNotAtStart "S C" "GLOBAL/EXTERN not at start of file"
        cause "USES, GLOBAL or EXTERN stands after other instructions."
        cure "Move it to the top of the file.";
    34 TooManyFiles "(S) C" "too many modules"
        cause "USES links more than 64 files into one program."
        cure "Join files.";
    35 FileNotFound "(S) C" "file not found"
        cause "A file that USES names is not there, or lies in the RAM although the program runs from the EPROM (MP4010 = 0)."
        cure "Put it beside the main file, correct the name, or set MP4010 to 1.";
    36 FileTooLong "S C" "file too long"
        cause "The code of one file is longer than 64 KB."
        cure "Divide it into several files and link them with USES.";
    37 TooManyLabels "S C" "too many local labels"
        cause "A file has more than 1000 labels, those of its structures included."
        cure "Divide it into several files and link them with USES.";
    38 TooManyGlobals "C" "too many global labels"
        cause "All files together make more than 1000 labels GLOBAL."
        cure "Make GLOBAL only what other files call.";
    39 ExternNotDefined "C" "external label not defined"
        cause "No linked file makes the imported label GLOBAL."
        cure "Add GLOBAL in the file that has it, or link that file with USES.";
    40 ExternInCase "S C" "external label in CASE instruction"
        cause "CASE calls an imported label directly."
        cure "Write a module of this file that only calls the imported one, and name it in the table.";
    41 ExternInJump "S C" "external label in JP instruction"
        cause "A jump goes to an imported label; only calls may leave a file."
        cure "Call it with CM, CMT or CMF.";
    42 GlobalTwice "(S) C" "global label defined twice"
        cause "The same label is made GLOBAL more than once."
        cure "Rename one of them.";
    43 WrongStructure "S C" "wrong instruction structure"
        cause "ELSE, ENDI, ENDW or UNTIL has no IF, WHILE or REPEAT to belong to, or structures cross each other."
        cure "Close structures in the reverse order of their opening.";
    44 StructureOpen "S C" "structure open at end of file"
        cause "IF, WHILE or REPEAT is not closed before the end of the file."
        cure "Close it with ENDI, ENDW or UNTIL.";
    45 GlobalInMain "S C" "GLOBAL instruction in main file"
        cause "The main file makes a label GLOBAL; only linked files may."
        cure "Move the module into a file that is linked with USES.";
    50 NestingTooDeep "R" "nesting too deep"
        cause "More than 32 modules call each other, mostly because one calls itself."
        cure "Look for the module that calls itself, directly or by another.";
    51 StackUnderflow "R" "stack underflow"
        cause "PL fetches from the data stack what was not put there with PS."
        cure "Give each PL its PS on every way through the program; look at the parameters of module calls.";
    52 StackOverflow "R" "stack overflow"
        cause "More than 128 bytes lie on the data stack: something is put there and not fetched, or a module takes fewer parameters."
        cure "Fetch with PL what PS has put, on every way.";
    53 TimeOut "R" "time out"
        cause "One scan took longer than 10 ms of nominal time: a loop without end, or too much work in one scan."
        cure "Look for a jump backward; start long work as SUBMIT job. The place is the last jump that was executed.";
    54 CaseOutOfRange "R" "CASE out of range"
        cause "The operand of CASE is below 0 or above the last entry of its table."
        cure "Check the range before CASE.";
    55 ModuleNotDefined "R" "subprogram not defined"
        cause "A module is called that does not exist; the manual says that it cannot occur at present."
        cure "Compile the program again.";
    56 IndexOutOfRange "R" "index error"
        cause "With the index register the address leaves the range of its operand, field or string."
        cure "Limit X before the access: load it only after a comparison.";
}

/// When an error is found [000:11927-11934].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Detection {
    /// While the line is edited; it stays unformatted.
    Editing,
    /// In the syntax check of soft key COMPILE.
    SyntaxCheck,
    /// Perhaps in the syntax check, otherwise by the compiler.
    MaybeSyntaxCheck,
    /// By the compiler, also at power-on.
    Compiler,
    /// As the program runs; the PLC stops.
    RunTime,
}

impl PlcError {
    /// The number that the control shows.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The times at which it can be found.
    pub fn detection(self) -> impl Iterator<Item = Detection> {
        self.when().split(' ').filter_map(|class| match class {
            "E" => Some(Detection::Editing),
            "S" => Some(Detection::SyntaxCheck),
            "(S)" => Some(Detection::MaybeSyntaxCheck),
            "C" => Some(Detection::Compiler),
            "R" => Some(Detection::RunTime),
            _ => None,
        })
    }
}

impl fmt::Display for PlcError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.number(), self.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_all_numbers_but_the_spare_ones() {
        let numbers: Vec<u8> = PlcError::ALL.iter().map(|error| error.number()).collect();
        let expected: Vec<u8> = (0..=56).filter(|n| *n != 1 && !(46..=49).contains(n)).collect();
        assert_eq!(numbers, expected);
        for error in PlcError::ALL {
            for sentence in [error.cause(), error.cure()] {
                assert!(
                    sentence.ends_with('.') && sentence.len() > 10,
                    "{error}: {sentence}"
                );
            }
            assert_eq!(
                error.number() >= 50,
                error.detection().eq([Detection::RunTime]),
                "{error}"
            );
        }
    }
}
