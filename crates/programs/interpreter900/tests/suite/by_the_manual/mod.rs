//! The manual's examples, one after the other, on a channel with three axes.

mod corners;
mod correction;
mod cycles;
mod flow;
mod functions;
mod paths;
mod plain;
mod reader;
mod support;
mod zero_points;
