//! Budgets.

room! {
    "Budgets";

    /// The file is no budget.
    ///
    /// A budget is `Budget(version: 1, limits: [(resolves: 3, memory_mib: 64), …])`; docs/command.md lists the bounds.
    BUDGET_FILE = 1501,

    /// A limit of a budget bounds nothing, or can't be held.
    ///
    /// A limit has a bound at least, and each bound is a finite number that isn't negative. Settings have numbers, texts, true or
    /// false.
    BUDGET_LIMIT = 1502,

    /// The budget is exceeded.
    ///
    /// The frame takes more than a limit allows. The step that passes the bound is shown with its cause, and the limit.
    OVER_BUDGET = 1503,
}
