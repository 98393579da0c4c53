//! The tests of the lab as programs use it. Its figures are tested through the command, by `measuring::` and `compare::` of its suite.

mod programs;
