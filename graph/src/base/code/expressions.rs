//! Expressions: their text, their types and their values.

room! {
    "Expressions";

    /// The expression can't be understood.
    ///
    /// Expressions are made of numbers, texts in single quotes, names, calls, parentheses and operators, as in C: `&&`, `||`, `!`,
    /// comparisons, `+ - * / %`. Comparisons aren't chained.
    /// Wrong: `when: "0 < levels < 5 and not vr"`.
    /// Mended: `when: "0 < levels && levels < 5 && !vr"`.
    EXPRESSION_SYNTAX = 301,

    /// The expression is too long, or nested too deeply.
    ///
    /// Length and depth are bounded, so that no file can take long or exhaust the stack. Split it: a parameter can hold a part.
    EXPRESSION_TOO_LONG = 302,

    /// There is no function of that name.
    ///
    /// docs/language.md lists the functions; the help names the nearest with its form.
    UNKNOWN_FUNCTION = 303,

    /// A function is given another number of values than it takes.
    ///
    /// The help shows the form, such as `clamp(value, low, high)`.
    ARGUMENTS = 304,

    /// A value has another type than the one that is needed.
    ///
    /// Types are whole numbers, numbers, texts, truths, images, buffers and formats. Only whole numbers become numbers by
    /// themselves.
    /// Wrong: `when: "levels"`.
    /// Mended: `when: "levels > 0"`.
    WRONG_TYPE = 305,

    /// An index stands behind what is no list, or a list has none.
    ///
    /// What `repeat` makes is a list, and an index says which of it is meant, counted from 0: `down[i - 1]`.
    /// Everything else takes no index.
    INDEX = 306,

    /// The list has no element of that number.
    ///
    /// Elements are counted from 0. In `repeat`, the first round often asks for the one before it.
    /// Wrong: `sample: {"source": "down[i - 1]"}`, with `i` from 0.
    /// Mended: `sample: {"source": "if(i == 0, color, down[i - 1])"}`.
    NO_ELEMENT = 307,

    /// A comparison can never hold.
    ///
    /// The setting has a list of texts, and the text that it is compared with isn't among them: most likely it is misspelt.
    NEVER_EQUAL = 308,

    /// The arithmetic has no result.
    ///
    /// Division by zero, a root of a negative number and a number beyond 64 bits have no value that could be used.
    /// The values that led there are shown: guard them, as in `if(count > 0, total / count, 0)`.
    ARITHMETIC = 309,

    /// The value is not known yet.
    ///
    /// Values are found from the top of the file to its end: a parameter's default can read those above it only.
    /// Move what it reads further up.
    NOT_KNOWN_YET = 310,

    /// The value is another one in each frame.
    ///
    /// `frame` and `time` are known when a frame is recorded, and a Plan holds for all frames. So they stand alone in `params`, and the
    /// shader computes with them. What decides more is a setting, which a program changes: that may make another Plan.
    FRAME_VALUE = 311,
}
