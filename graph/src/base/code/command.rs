//! The command: its files, its choices and its results.

room! {
    "The command";

    /// A file that the command line names is missing.
    ///
    /// Neither the folder nor what is shipped has a file of that name. The message lists what is shipped.
    FILE_MISSING = 1601,

    /// A file can't be read.
    ///
    /// The system's own words are in the message: most often rights are missing, or it is a folder.
    FILE_UNREADABLE = 1602,

    /// A file, folder or output can't be written.
    ///
    /// The system's own words are in the message. The help says what mends it: another folder, rights, or room on the disk.
    FILE_UNWRITABLE = 1603,

    /// Something would be overwritten and lost.
    ///
    /// The command never writes over what it reads, over what it writes already, or over a file or results that were there before.
    WOULD_BE_LOST = 1604,

    /// A device profile can't be used.
    ///
    /// No profile has that name, its file is wrong, or a profile stands where a device is needed. `framewright devices` lists
    /// devices.
    DEVICE_PROFILE = 1605,

    /// Options contradict each other, or what they are for.
    ///
    /// The message names the option: some need another one, and choices for a pipeline are none for a Plan that is made already.
    OPTIONS = 1606,

    /// There are too many variants or passes for what is asked.
    ///
    /// Pairs of values and pictures of graphs are bounded. Choose settings by `--set`, or another format.
    TOO_MANY = 1607,

    /// A file is no Plan that can be used.
    ///
    /// The message says which rule it breaks. `framewright run … --save-plan` and `framewright inspect … --format json` write
    /// Plans.
    NO_PLAN = 1608,

    /// There is nothing of that name to explain.
    ///
    /// `framewright inspect` lists the passes, images and buffers that a Plan has, and docs/codes.md has all codes.
    NOTHING_TO_EXPLAIN = 1609,

    /// The output has no picture in that form.
    ///
    /// Buffers are no pictures, and OpenEXR files hold floating-point numbers and integers only.
    NO_PICTURE = 1610,

    /// Results can't be used.
    ///
    /// A file or folder of results is damaged, is of another sweep or Plan, or lacks what a limit asks for. The message says which.
    RESULTS = 1611,

    /// The command was interrupted.
    ///
    /// Ctrl-C ended it. The message says what was kept; `framewright measure` goes on when it is called anew.
    INTERRUPTED = 1612,

    /// Another process works in that folder.
    ///
    /// Two that measure into one folder would mix their results. Wait until it ends, or name another folder.
    FOLDER_HELD = 1613,

    /// The sweep can't be measured.
    ///
    /// A sweep names settings with values that the pipeline allows, and as many choices as can be measured. The message says what
    /// is wrong.
    SWEEP = 1614,

    /// Two pictures can't be compared.
    ///
    /// Only pictures of one size are compared, by pixels that are finite in both.
    NOT_COMPARABLE = 1615,

    /// RenderDoc isn't there, or took nothing.
    ///
    /// RenderDoc starts the programs that it looks into. The message has the command. It takes nothing of a device that it can't replay.
    RENDERDOC = 1616,
}
