//! Technology functions: M, H and S from the program to the PLC, and the path that waits where it must [004].
