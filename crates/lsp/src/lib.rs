//! Language server for part programs, PLC programs and parameter lists.
