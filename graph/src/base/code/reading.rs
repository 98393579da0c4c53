//! Reading files: text, RON, and the shapes of values.

room! {
    "Reading files";

    /// The file is empty.
    ///
    /// The file holds nothing, or only blanks and comments, so there is no value to read. A pipeline begins with
    /// `Pipeline(version: 1,`, a scene with `Scene(version: 1,`, a settings file with `Settings(version: 1,`. An editor that
    /// saves in two steps may leave a file empty for a moment.
    FILE_EMPTY = 101,

    /// The file is not text.
    ///
    /// All files that people write are text in UTF-8. This one has a byte that UTF-8 doesn't allow, a zero byte, or another
    /// encoding, such as UTF-16. Often it is a picture or a compiled shader under a wrong name.
    /// Save it as UTF-8, or name the file that was meant.
    FILE_NOT_TEXT = 102,

    /// The file is larger than anything that a person writes.
    ///
    /// Files are read whole, and their size is bounded, so that a wrong name (a video, a device) costs no memory.
    /// The message names the bound. Split a pipeline into files that it includes, or make it by `repeat`.
    FILE_TOO_LARGE = 103,

    /// A bracket, text or comment has no end.
    ///
    /// What is opened by `(`, `[`, `{`, `"`, `'` or `/*` must be closed. The place that opened it is shown: the mistake is often
    /// there, far above the end of the file.
    /// Wrong: `(name: "sky, draw: Opaque)`.
    /// Mended: `(name: "sky", draw: Opaque)`.
    NOT_CLOSED = 104,

    /// The text is not RON.
    ///
    /// RON is made of values with commas between them: `Word(field: value)`, `[…]`, `{"key": value}`, texts, numbers and words.
    /// Here a comma, a colon or a value is missing, or a character stands where none can.
    /// Wrong: `[(name: "a") (name: "b")]`.
    /// Mended: `[(name: "a"), (name: "b")]`.
    RON_SYNTAX = 105,

    /// Brackets are nested too deeply.
    ///
    /// The depth is bounded, so that a hostile file can't exhaust the stack. No file that is of use needs more than a dozen levels.
    NESTED_TOO_DEEPLY = 106,

    /// Another kind of value is expected.
    ///
    /// Each field takes values of one shape: a text in quotes, a number, a word, a list, a map, or fields in parentheses.
    /// Wrong: `color: "scene"`.
    /// Mended: `color: ["scene"]`.
    WRONG_SHAPE = 107,

    /// The word is none of those that may stand there.
    ///
    /// Formats, filters, lifetimes and the like are words of a fixed list, with exactly this spelling and without quotes.
    /// The help names the nearest word, or all of them.
    /// Wrong: `filter: Bilinear`.
    /// Mended: `filter: Linear`.
    UNKNOWN_WORD = 108,

    /// There is no field of that name.
    ///
    /// A name that is misspelt would else be passed over, and its value never be used. So all fields are known ones.
    /// docs/language.md lists the fields of each entry; the help names the nearest.
    UNKNOWN_FIELD = 109,

    /// A field is missing.
    ///
    /// Some fields have no default, because no value would be right for most files. The message names those that are missing.
    /// Wrong: `images: [(format: Color)]`.
    /// Mended: `images: [(name: "color", format: Color)]`.
    FIELD_MISSING = 110,

    /// A field is given twice.
    ///
    /// Only one of two values could be in force, and which one isn't for the reader to guess. Remove one of them.
    FIELD_TWICE = 111,

    /// A word has parentheses that it doesn't take, or lacks those that it needs.
    ///
    /// Some words stand alone, as `Full`. Others say more in parentheses, as `Like("color")` or `Count(8, 8, 1)`.
    /// The help shows the form.
    PARENTHESES = 112,

    /// The number is too large to be held.
    ///
    /// Whole numbers have 64 bits, and other numbers are 64-bit floating point, which reaches about 1.79e308. A number beyond that
    /// would silently become another one.
    NUMBER_TOO_LARGE = 113,

    /// The number is outside of what is allowed there.
    ///
    /// The message names the least and the greatest number. If the number comes of an expression, the message says of which
    /// settings: bound those, or clamp it, as in `clamp(levels, 1, 8)`.
    NUMBER_OUTSIDE = 114,

    /// The file is of a version that this program doesn't read.
    ///
    /// `version` says how the file is to be understood. A newer version may mean something else by the same words, so it is
    /// refused. Take a newer program, or write the version that the help names.
    VERSION = 115,

    /// A value has no form in JSON.
    ///
    /// What is converted to JSON has texts as keys, each once, and numbers, texts, lists, maps and words as values.
    NO_JSON_FORM = 116,
}
