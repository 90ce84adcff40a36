//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../support/stand.rs"]
mod stand;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/terminals.rs"]
mod terminals;

mod axis_enable;
mod axis_faults;
mod beside;
mod channels;
mod chaos;
mod clearing;
mod compensation;
mod contour;
mod data_lines;
mod determinism;
mod digital_drives;
mod digitizing;
mod drip_feed;
mod emergency_stop;
mod endless_loop;
mod entered;
mod handwheel;
mod hirth;
mod kernel_rules;
mod key_codes;
mod m_functions;
mod manual_operation;
mod manual_probing;
mod messages;
mod own_functions;
mod pallets;
mod plant;
mod plc_and_program;
mod plc_axes;
mod plc_interface;
mod power_on;
mod probing;
mod program_run;
mod read_beside;
mod readers;
mod reference_run;
mod refused_blocks;
mod registry;
mod restore;
mod run_control;
mod small_mill;
mod spindle;
mod spindle_module;
mod standard_plc;
mod standard_plc_emergency;
mod standard_plc_lock;
mod standard_plc_numbers;
mod stylus_lead;
mod superimposing;
mod synchronized_axes;
mod tapping;
mod thread_faults;
mod threads;
mod tilting;
mod tnc155_axis_switchover;
mod tnc155_feed_release;
mod tnc155_offset;
mod tnc155_parameters;
mod tnc155_probe;
mod tnc155_reference;
mod tnc155_station;
mod tnc155_words;
mod tnc355;
mod tool_calls;
mod tool_changer;
mod tool_life;
mod tool_measuring;
mod tool_replacement;
mod upkeep;
mod voltages;
mod work_beside;
