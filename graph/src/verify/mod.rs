//! An independent checker: a Plan goes in, violations come out. Shares no code with the compile stages.
