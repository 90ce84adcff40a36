//! Cycles whose words are values of Q parameters: those of the machine builder, which DIN/ISO calls by D, and contour data.

use crate::support::*;
use bahn_convert::Language;
use bahn_parameters::ControlModel;

/// The definition of the bolt hole circle is the same in both languages as the manual prints it [000:17958-17962]
/// [000:17982], and the run calls the cycle with the same values.
#[test]
fn a_cycle_of_the_machine_builder_is_d68() {
    let plain = "BEGIN PGM A MM\nTOOL CALL 1 Z S1000\nL Z+2 R0 FMAX M3\nCYCL DEF 68.0 HOLES\n\
                 CYCL DEF 68.1 Q1=+8 Q2=+40 Q3=+60\nCYCL DEF 68.2 Q4=+50 Q5=-2 Q6=-20\nCYCL DEF 68.3 Q7=+100\nCYCL CALL\n\
                 END PGM A MM\n";
    let source = program(plain, Language::Plain);
    let (made, iso) = converted(&source, Language::Iso);
    assert!(made.refused.is_empty(), "{:?}", made.refused);
    let line = "D68 P01 +8 P02 +40 P03 +60 P04 +50 P05 -2 P06 -20 P07 +100";
    assert!(made.text.contains(line), "{}", made.text);
    let (back, again) = converted(&iso, Language::Plain);
    assert!(back.refused.is_empty(), "{:?}", back.refused);
    for block in [
        "68.1 Q1=+8 Q2=+40 Q3=+60",
        "68.2 Q4=+50 Q5=-2 Q6=-20",
        "68.3 Q7=+100",
    ] {
        assert!(back.text.contains(block), "{}", back.text);
    }
    // The cycle of the shipped machine drills the holes.
    let eprom = root().join("machines/mill/programs/eprom");
    let settings = settings(ControlModel::Tnc415b);
    for target in [&iso, &again] {
        let proof = proof(&source, target, &settings, &eprom);
        assert!(proof.holds() && proof.message.is_none(), "{proof:?}");
        assert!(proof.elements > 8, "{proof:?}");
    }
}

/// G120 to G127 have the Q parameters of contour data in one block, plain language three in each.
#[test]
fn contour_data_go_there_and_back() {
    let source = program(
        "BEGIN PGM A MM\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nCYCL DEF 14.0 CONTOUR GEOMETRY\n\
         CYCL DEF 14.1 CONTOUR LABEL 1\nCYCL DEF 20.0 CONTOUR DATA\nCYCL DEF 20.1 Q1=-5 Q2=+1 Q3=+0\n\
         CYCL DEF 20.2 Q4=+0 Q5=+0 Q6=+2\nCYCL DEF 20.3 Q7=+20 Q8=+0 Q9=+1\nCYCL DEF 22.0 ROUGH-OUT\n\
         CYCL DEF 22.1 Q10=-5 Q11=+100 Q12=+350\nL X+0 Y+0 Z+20 R0 FMAX M3\nCYCL CALL\nL Z+50 FMAX M2\nLBL 1\n\
         L X+40 Y+40 RL\nL X+80\nL Y+80\nL X+40\nL Y+40\nLBL 0\nEND PGM A MM\n",
        Language::Plain,
    );
    let proof = there_and_back(&source, &settings(ControlModel::Tnc415b), &root());
    assert!(proof.message.is_none() && proof.elements > 20, "{proof:?}");
}
