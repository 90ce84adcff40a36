//! A program as machine builders write them, in a size they rarely reach: 8000 instructions in two files of
//! modules. It is generated, the same in every run.

use std::fmt::Write;

use bahn_plc::MemoryFiles;

const MODULES: u32 = 40;
/// Instructions of a module, about.
const LENGTH: usize = 204;

/// The files of the program; the main file is `MILL.PLC`.
pub fn mill() -> MemoryFiles {
    let mut dice = Dice(0x5eed_0415);
    let (mut main, mut second) = (String::from("USES TOOLS.PLC\n"), String::new());
    for module in MODULES / 2..MODULES {
        writeln!(main, "EXTERN UNIT_{module}").unwrap();
        writeln!(second, "GLOBAL UNIT_{module}").unwrap();
    }
    for module in 0..MODULES {
        writeln!(main, "CM UNIT_{module}").unwrap();
    }
    main.push_str("EM\n");
    for module in 0..MODULES {
        let file = if module < MODULES / 2 {
            &mut main
        } else {
            &mut second
        };
        unit(file, module, &mut dice);
    }
    for (file, name) in [(&mut main, "A"), (&mut second, "B")] {
        // Limits a word to 0..100.
        write!(
            file,
            "LBL LIMIT_{name}\nL W900\n> K+100\nJPF LOW_{name}\nL K+100\n= W900\nLBL LOW_{name}\nEM\n"
        )
        .unwrap();
    }
    MemoryFiles::from([("MILL.PLC", main), ("TOOLS.PLC", second)])
}

/// One unit of the machine: interlocks, set points, comparisons, a timer, calls.
fn unit(file: &mut String, module: u32, dice: &mut Dice) {
    let mut lines: Vec<String> = vec![format!("LBL UNIT_{module}")];
    let mut sections = 0;
    while lines.len() < LENGTH {
        sections += 1;
        match dice.below(20) {
            0..=9 => interlock(&mut lines, dice),
            10 => lines.extend([
                bit("L", dice),
                bit("A[", dice).replace("A[ ", "A[\nL "),
                bit("O", dice),
                "]".into(),
                result("=", dice),
            ]),
            11 | 12 => {
                let (from, to) = (dice.below(200) * 2 + 128, dice.below(200) * 2 + 128);
                let operation = ["+", "-", "A", "O"][dice.below(4) as usize];
                lines.extend([
                    format!("L W{from}"),
                    format!("{operation} K+{}", dice.below(50)),
                    format!("= W{to}"),
                ]);
            }
            13 | 14 => {
                let comparison = ["==", "<", ">", "<=", ">=", "<>"][dice.below(6) as usize];
                lines.extend([
                    format!("L B{}", dice.below(800) + 128),
                    format!("{comparison} K+{}", dice.below(100)),
                    result("=", dice),
                ]);
            }
            15 => lines.extend([
                format!("L D{}", dice.below(100) * 4 + 528),
                format!("= D{}", dice.below(100) * 4 + 528),
            ]),
            16 => {
                lines.push(bit("L", dice));
                lines.push("IFT".into());
                interlock(&mut lines, dice);
                lines.push("ELSE".into());
                interlock(&mut lines, dice);
                lines.push("ENDI".into());
            }
            17 => {
                lines.extend([bit("L", dice), format!("JPF SKIP_{module}_{sections}")]);
                lines.extend([
                    format!("L B{}", dice.below(800) + 128),
                    format!("= B{}", dice.below(800) + 128),
                    format!("INC W{}", dice.below(200) * 2 + 128),
                    format!("LBL SKIP_{module}_{sections}"),
                ]);
            }
            18 => lines.extend([bit("L", dice), bit("AN", dice), format!("= T{}", dice.below(48))]),
            _ => {
                let name = if module < MODULES / 2 { "A" } else { "B" };
                lines.extend([
                    format!("L W{}", dice.below(200) * 2 + 128),
                    "= W900".into(),
                    format!("CM LIMIT_{name}"),
                ]);
            }
        }
    }
    for line in lines {
        writeln!(file, "{line}").unwrap();
    }
    file.push_str("EM\n");
}

/// A chain of bits with one or two results.
fn interlock(lines: &mut Vec<String>, dice: &mut Dice) {
    lines.push(bit(["L", "LN"][dice.below(2) as usize], dice));
    for _ in 0..1 + dice.below(5) {
        lines.push(bit(
            ["A", "A", "AN", "O", "ON", "XO"][dice.below(6) as usize],
            dice,
        ));
    }
    lines.push(result(["=", "=", "=", "S", "R"][dice.below(5) as usize], dice));
    if dice.below(3) == 0 {
        lines.push(result("=N", dice));
    }
}

fn bit(command: &str, dice: &mut Dice) -> String {
    match dice.below(4) {
        0 => format!("{command} I{}", dice.below(32)),
        1 => format!("{command} O{}", dice.below(31)),
        _ => format!("{command} M{}", dice.below(1000)),
    }
}

fn result(command: &str, dice: &mut Dice) -> String {
    match dice.below(5) {
        0 => format!("{command} O{}", dice.below(31)),
        _ => format!("{command} M{}", dice.below(1000)),
    }
}

/// Pseudo-random numbers (xorshift).
struct Dice(u32);

impl Dice {
    fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 % end
    }
}
