//! Frames that a program makes itself, without a pipeline file.

room! {
    "Frames made by programs";

    /// The frame has too many images, buffers or passes.
    ///
    /// Their numbers have room to spare in 32 bits, and that bounds them. The message names the bound.
    FRAME_TOO_LARGE = 1201,

    /// A number names an image, buffer, view or output that doesn't exist.
    ///
    /// A frame refers to things by their place in its lists. Most likely a list was changed after the number was taken.
    NO_SUCH_NUMBER = 1202,

    /// A pass has other sources and targets than its work has.
    ///
    /// Copies and blits have one source and one target, fills one target, and draws and dispatches transfer nothing. A pass with
    /// attachments draws, and one that draws has some.
    PASS_PARTS = 1203,

    /// A pass accesses something in stages that it doesn't have.
    ///
    /// Draws have stages of vertices and fragments, dispatches that of compute: barriers are made of them.
    STAGES = 1204,

    /// A pass neither reads nor writes what it names.
    ///
    /// An access that is none would make no barrier. Say what it does, or leave it out.
    NO_ACCESS = 1205,

    /// An indirect pass has no buffer of counts, or another one has some.
    ///
    /// An indirect draw or dispatch reads its counts from one buffer. Other work reads none.
    INDIRECT_COUNTS = 1206,

    /// An image that holds both eyes' parts is used for one of them.
    ///
    /// Such an image has layers or halves for the eyes, as the frame's way of drawing for two eyes needs them. It is drawn,
    /// sampled and copied for both at once, and is flat, with one mip level.
    BOTH_EYES = 1207,

    /// A frame says of an image that it is turned.
    ///
    /// Only the compiler turns images. Set the rotation of an output.
    TURNED_IMAGE = 1208,

    /// A pass of a frame says `both_eyes`, and isn't recorded for both eyes.
    ///
    /// Only what the program records can say so: a draw into images that hold both eyes' parts, or commands outside of
    /// rendering scopes that touch one. Leave it out elsewhere: other passes are for both eyes where their images are.
    CLAIMS_BOTH_EYES = 1209,
}
