//! A desk on which modules are called.

use bahn_exchange::{Exchange, Number, Size};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Compilation, Machine, MemoryFiles, Options, Start, TestNc};

/// The results of a call in the order of the program's PL, and M3171.
pub type Outcome = (Vec<i32>, bool);

/// A module that did its work and has no result.
pub fn done() -> Outcome {
    (vec![], false)
}

/// A module that failed and has no result.
pub fn failed() -> Outcome {
    (vec![], true)
}

/// A module that did its work with one result.
pub fn value(value: i32) -> Outcome {
    (vec![value], false)
}

/// A module that returns a code: M3171 is 0 with code 0 only.
pub fn code(code: i32) -> Outcome {
    (vec![code], code != 0)
}

/// A control with its operands, on which single calls are made.
pub struct Desk {
    pub nc: TestNc,
    pub exchange: Exchange,
}

impl Desk {
    pub fn new() -> Desk {
        Desk {
            nc: TestNc::new(ParameterList::reference(ControlModel::Tnc415b)),
            exchange: Exchange::default(),
        }
    }

    /// `7280=1`.
    pub fn parameter(&mut self, assignment: &str) -> &mut Desk {
        self.nc.parameters.assign(assignment).unwrap();
        self
    }

    /// `W8=-3`, `M5=1`.
    pub fn set(&mut self, operand: &str, value: i32) -> &mut Desk {
        match operand.parse() {
            Ok(bit) => self.exchange.nc_set(bit, value != 0),
            Err(_) => self.exchange.nc_set_number(operand.parse().unwrap(), value),
        }
        self
    }

    pub fn set_text(&mut self, string: usize, text: &[u8]) -> &mut Desk {
        self.exchange.plc_mut().set_text(string, text);
        self
    }

    /// A string memory without end character.
    pub fn endless_text(&mut self, string: usize) -> &mut Desk {
        self.exchange.plc_mut().string_mut(string).unwrap().fill(b'1');
        self
    }

    pub fn get(&self, operand: &str) -> i32 {
        match operand.parse() {
            Ok(bit) => self.exchange.plc().bit(bit).into(),
            Err(_) => self.exchange.plc().number(operand.parse().unwrap()),
        }
    }

    pub fn text(&self, string: usize) -> String {
        String::from_utf8_lossy(self.exchange.plc().text(string)).into_owned()
    }

    /// Calls a module from the cyclic program.
    pub fn cyclic(&mut self, module: u16, arguments: &[i32], results: usize) -> Outcome {
        let program = format!("{}EM\n", call(module, arguments, results));
        self.run(&program, results)
    }

    /// Calls a module from a submit job.
    pub fn submit(&mut self, module: u16, arguments: &[i32], results: usize) -> Outcome {
        let program = format!("SUBM 1\nEM\nLBL 1\n{}EM\n", call(module, arguments, results));
        self.run(&program, results)
    }

    /// Whether a module that is called from a submit job comes back to it.
    pub fn returns(&mut self, module: u16, arguments: &[i32], results: usize) -> bool {
        let program = format!("SUBM 1\nEM\nLBL 1\n{}EM\n", call(module, arguments, results));
        self.scan(&program);
        self.get("M901") == 1
    }

    /// Runs a scan of a program that leaves results in D800, D804 and so on, and M3171 in M900.
    fn run(&mut self, program: &str, results: usize) -> Outcome {
        self.scan(program);
        assert_eq!(self.get("M901"), 1, "the call came to its end");
        let result = |index: usize| Number::new(Size::Double, 800 + 4 * index as u16).unwrap();
        let results = (0..results).map(|index| self.exchange.plc().number(result(index)));
        (results.collect(), self.get("M900") == 1)
    }

    /// A scan of a program that sets M901 where the call has returned.
    fn scan(&mut self, program: &str) {
        let files = MemoryFiles::from([("MAIN.PLC", program)]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
        assert_eq!(compilation.errors, [], "{program}");
        let mut machine = Machine::new(compilation.program.unwrap().into(), Start::Interruption);
        self.exchange.plc_mut().set_bit("M901".parse().unwrap(), false);
        machine.scan(&mut self.exchange, &mut self.nc).unwrap();
    }
}

fn call(module: u16, arguments: &[i32], results: usize) -> String {
    let push: String = arguments
        .iter()
        .map(|argument| format!("PS K{argument:+}\n"))
        .collect();
    let pull: String = (0..results)
        .map(|index| format!("PL D{}\n", 800 + 4 * index))
        .collect();
    format!("{push}CM {module}\n{pull}L M3171\n= M900\nLN M3171\nO M3171\n= M901\n")
}
