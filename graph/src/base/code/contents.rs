//! The order of passes, and the contents that they need.

room! {
    "Order and contents";

    /// Something is read or leaves the frame, and no pass writes it.
    ///
    /// Its contents would be undefined. Let a pass write it, or don't use it. If an extension removed the pass, that place is
    /// shown.
    NEVER_WRITTEN = 901,

    /// Something is needed, and the pass that fills it is off.
    ///
    /// With these settings `when` of that pass is false. Say what takes its place, `otherwise: Clear(image: "…", value: 0)`, or
    /// give the reader the same `when`.
    WRITER_IS_OFF = 902,

    /// An earlier frame's contents are read, and no pass writes them.
    ///
    /// What has history is written anew in each frame: some pass must do that, also where nothing of the same frame reads it.
    HISTORY_NEVER_WRITTEN = 903,

    /// Something is read before it is written.
    ///
    /// Passes run in the order of the file, and a pass reads what passes above it wrote. Move the reader down, or read what the
    /// frame before left: `(image: "…", previous: 1)`.
    READ_BEFORE_WRITTEN = 904,

    /// What is handed in without contents is read.
    ///
    /// `before: Undefined` says that an imported image or buffer holds nothing. Say in which state it really is, or write it first.
    IMPORTED_WITHOUT_CONTENTS = 905,

    /// The first pass that draws into an image may leave parts of it untouched.
    ///
    /// What it doesn't cover would be undefined. Clear it: `color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]`, or say
    /// `covers: true` of a pass that sets every texel.
    NOT_CLEARED = 906,

    /// Passes wait for each other in a circle.
    ///
    /// Each reads what another of them writes. Let one read what the frame before left, or an image of its own.
    PASSES_IN_CIRCLE = 907,

    /// A pass writes one thing in two ways at once.
    ///
    /// Nothing orders the two writes, so which one lasts would be chance. Make it two passes.
    WRITTEN_IN_TWO_WAYS = 908,

    /// A pass samples the depth that it also writes.
    ///
    /// What a sample reads would depend on the order of fragments. Test without writing, `depth: (image: "…", write: false)`, or
    /// sample a copy.
    DEPTH_FEEDBACK = 909,
}
