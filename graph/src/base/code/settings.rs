//! Settings, parameters and their values.

room! {
    "Settings and parameters";

    /// The value is none that the setting or parameter allows.
    ///
    /// A setting declares which values it has: true and false, a range with steps, or a list. The help says which, or names the
    /// nearest.
    /// Wrong: `--set msaa=3`, with `of: [1, 2, 4, 8]`.
    /// Mended: `--set msaa=4`.
    VALUE_NOT_ALLOWED = 401,

    /// A setting or parameter allows no value, or its range makes no sense.
    ///
    /// `min` is at most `max`, a step is above 0 and fits into the range, steps begin at a `min`, and a list has an entry.
    RANGE_EMPTY = 402,

    /// The default is none of the values that are allowed.
    ///
    /// A pipeline must work without any choice, so a default lies within the range, on a step, or in the list.
    DEFAULT_NOT_ALLOWED = 403,

    /// A setting allows a value that can't be used where the setting is named.
    ///
    /// It is told when the file is read, and not only when somebody chooses that value.
    /// Wrong: `samples: "msaa"`, with `of: [1, 3]`.
    /// Mended: bound the setting to what can be used, `of: [1, 2, 4]`, or compute: `samples: "if(msaa == 3, 4, msaa)"`.
    SETTING_TOO_WIDE = 404,

    /// A fragment is used without a value for a parameter.
    ///
    /// A parameter without default gets its value by `with` at each use: `with: {"input": "color"}`.
    PARAMETER_MISSING = 405,
}
