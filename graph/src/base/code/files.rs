//! Pipelines made of several files: includes, extensions, changes and fragments.

room! {
    "Composing files";

    /// A file that another names can't be read.
    ///
    /// Paths are relative to the file that names them, and then to what is shipped with the program. The message says whether the
    /// file is missing, is no file, or may not be read.
    FILE_NAMED_UNREAD = 501,

    /// A file lies outside of the folder that may be read.
    ///
    /// A pipeline reads only files in its root folder, so that a pipeline from elsewhere can't read yours.
    /// The root is the folder of the pipeline; the program that reads it can name a wider one (`--root`).
    FILE_OUTSIDE_ROOT = 502,

    /// Files include or extend each other in a circle.
    ///
    /// Each file is put together from those that it names, and that never ends in a circle. One of them must do without the others.
    FILES_IN_CIRCLE = 503,

    /// A pipeline is made of too many files.
    ///
    /// The number is bounded, so that no pipeline can keep the program reading. Name each file only once.
    TOO_MANY_FILES = 504,

    /// A file stands where a pipeline is needed, and is an extension.
    ///
    /// An extension (`Extension(…)`) changes another pipeline and is none itself. A pipeline applies it by `extensions: ["…"]`,
    /// or the program that reads the pipeline does (`--extend`).
    NO_PIPELINE = 505,

    /// A pipeline that extends another has passes of its own.
    ///
    /// Where they would run among the other pipeline's passes isn't said. Insert them at a place:
    /// `changes: [Insert(at: End, passes: […])]`.
    PASSES_WHILE_EXTENDING = 506,

    /// An extension is applied twice.
    ///
    /// Its changes are made already: the second time they would change their own results.
    EXTENSION_TWICE = 507,

    /// A change doesn't say one thing that can be done.
    ///
    /// A change names one thing and what becomes of it: `Set(pass: "sky", to: (…))`, `Remove(image: "…")`,
    /// `Insert(after: "sky", passes: […])`. It sets fields that the thing has, gives it no other name, and inserts at one place.
    CHANGE_UNFIT = 508,

    /// A change names what an earlier change removed.
    ///
    /// Changes are made in order. The place of the removal is shown: remove it later, or change something else.
    REMOVED_ALREADY = 509,

    /// Fragments use each other in a circle.
    ///
    /// A use puts the fragment's passes in its place, and that never ends in a circle.
    FRAGMENTS_IN_CIRCLE = 510,

    /// Uses of fragments stand too deep in each other.
    ///
    /// The depth is bounded. Fragments that use each other in a long chain can be used one after the other in place of that.
    FRAGMENTS_TOO_DEEP = 511,

    /// The pipeline makes too many things.
    ///
    /// `repeat` and fragments within fragments multiply. The number of images, buffers, passes and uses is bounded, so that a
    /// mistake in one count can't take all memory.
    TOO_MANY_THINGS = 512,

    /// Images, buffers or lifetimes follow each other in a circle.
    ///
    /// `Like("other")` takes a size, format or lifetime from another, and one of them must have its own.
    /// Wrong: `(name: "a", size: Like("b"))`, `(name: "b", size: Like("a"))`.
    /// Mended: `(name: "a", size: Output)`, `(name: "b", size: Like("a"))`.
    FOLLOWS_IN_CIRCLE = 513,

    /// A pass of a fragment is for a view of its own.
    ///
    /// All that a fragment makes is for the view of its use: say `view` where the fragment is used.
    VIEW_IN_FRAGMENT = 514,
}
