//! Names: how they are made, that each is given once, and that it exists.

room! {
    "Names";

    /// The name can't be a name.
    ///
    /// Names are letters, digits and `_`, begin with a letter or `_`, and have at most 64 bytes. Names of shaders may have `-`.
    /// Expressions read names, so `-` would be a minus there, and `scene`, `view`, `device`, `true` and `false` are taken.
    /// Wrong: `name: "half-size"`.
    /// Mended: `name: "half_size"`.
    NAME_FORM = 201,

    /// Two things have one name.
    ///
    /// Each image, buffer, pass, setting, view, fragment and anchor has a name of its own within its file, and what expressions can
    /// name (settings, images, buffers, indices) shares one space. Else a reference could mean either.
    /// Give one of them another name. In a file that extends another, change the first by `Set(…)` in place of adding a second.
    NAME_TAKEN = 202,

    /// The same thing is listed or set twice.
    ///
    /// Lists and maps of names hold each name once: the second entry would either change nothing or contradict the first.
    /// Remove one of them.
    LISTED_TWICE = 203,

    /// There is no setting of that name.
    ///
    /// Settings are declared in `settings` of the pipeline, or of what it extends. The help names the nearest.
    UNKNOWN_SETTING = 204,

    /// There is no preset of that name.
    ///
    /// Presets are declared in `presets` of the pipeline, or of what it extends. The help names the nearest.
    UNKNOWN_PRESET = 205,

    /// There is no view of that name.
    ///
    /// A frame has one view, or those that `views` lists, the main one first.
    /// `views: [(name: "main"), (name: "mirror")]` makes a second one.
    UNKNOWN_VIEW = 206,

    /// There is no image of that name.
    ///
    /// Passes use images that `images` or `textures` declares: that is where their format and size stand.
    /// Wrong: `color: ["colour"]`, with `images: [(name: "color", format: Color)]`.
    /// Mended: `color: ["color"]`.
    UNKNOWN_IMAGE = 207,

    /// There is no buffer of that name.
    ///
    /// Passes use buffers that `buffers` declares: that is where their size stands. The help names the nearest.
    UNKNOWN_BUFFER = 208,

    /// There is neither an image nor a buffer of that name.
    ///
    /// What leaves the frame, is copied or is bound as storage is declared in `images`, `textures` or `buffers`.
    UNKNOWN_IMAGE_OR_BUFFER = 209,

    /// There is no pass of that name.
    ///
    /// Changes name passes by their own names, as the extended pipeline has them: `framewright inspect` lists those.
    UNKNOWN_PASS = 210,

    /// Nothing that an expression can read has that name.
    ///
    /// Expressions read settings, parameters of a fragment, indices of `repeat`, images, buffers, and `scene`, `view` and `device`.
    /// Texts stand in single quotes there.
    /// Wrong: `when: "quality == high"`.
    /// Mended: `when: "quality == 'high'"`.
    UNKNOWN_VALUE = 211,

    /// There is no fragment of that name.
    ///
    /// `use` names a fragment that `fragments` of this file, or of a file that it includes, declares.
    UNKNOWN_FRAGMENT = 212,

    /// There is no parameter of that name.
    ///
    /// `with` gives values to parameters that the fragment declares. The help names the nearest that has no value yet.
    UNKNOWN_PARAMETER = 213,

    /// There is no anchor of that name.
    ///
    /// `Insert(at: "…")` names an anchor of the extended pipeline, which is a place that it keeps for others.
    /// Beside a pass, `Insert(before: "pass", …)` and `Insert(after: "pass", …)` insert.
    UNKNOWN_ANCHOR = 214,

    /// There is no output of that name.
    ///
    /// Outputs are the images and buffers that `outputs` lists. An image that is none of them can be written by `--dump`.
    UNKNOWN_OUTPUT = 215,

    /// There is no camera of that name.
    ///
    /// A view names a camera of the scene that is drawn. Cameras have names in `cameras` of a scene file, or in the glTF file.
    /// Without `camera` the scene's own camera is taken.
    UNKNOWN_CAMERA = 216,

    /// There is no material or object of that name.
    ///
    /// Objects of a scene file name materials that the same file declares, and cameras name objects.
    UNKNOWN_IN_SCENE = 217,

    /// The name is one of another kind of thing.
    ///
    /// An image can't stand where a buffer is needed, nor a number where a text is. The place that declares it is shown.
    WRONG_KIND = 218,

    /// A text in an expression has no quotes of its own.
    ///
    /// The quotes of RON only delimit the expression. A text within it stands in single quotes, or it is read as a name.
    /// Wrong: `with: {"quality": "high"}`.
    /// Mended: `with: {"quality": "'high'"}`.
    TEXT_WITHOUT_QUOTES = 219,
}
