//! Passes: what they do, what they draw into, and what they move.

room! {
    "Passes";

    /// The pass does nothing.
    ///
    /// A pass has one of `draw`, `dispatch`, `copy`, `blit`, `fill` and `custom`, and writes something. If its effect isn't in
    /// the frame, `side_effect: true` says so.
    /// Wrong: `(name: "sky", draw: FullScreen("sky"))`.
    /// Mended: `(name: "sky", draw: FullScreen("sky"), color: ["color"])`.
    PASS_DOES_NOTHING = 701,

    /// The pass does two things.
    ///
    /// One pass is one draw, dispatch, copy, blit, fill or custom pass. Make it two passes: they are joined where that is faster.
    PASS_DOES_TWO_THINGS = 702,

    /// A field means nothing beside what the pass does.
    ///
    /// It would be passed over, and that is seldom what was meant: targets go with draws, workgroups with dispatches, and so on.
    FIELD_UNFIT = 703,

    /// The pass needs a shader.
    ///
    /// Dispatches and draws of vertices name the shader that they run: `shader: "…"`.
    SHADER_UNSAID = 704,

    /// How many workgroups run isn't said, or is more than can run.
    ///
    /// `groups: Texels("image")` runs the shader once for each texel of an image. `Count(8, 8, 1)` runs 64 workgroups.
    /// `Indirect("counts")` reads their number from a buffer, at a multiple of 4 bytes.
    GROUPS = 705,

    /// A pass draws into one image twice.
    ///
    /// Two targets of one draw would both write the same texels, in no order. Remove one, or draw into another layer.
    TARGET_TWICE = 706,

    /// The targets of a pass differ.
    ///
    /// One draw covers all targets: they have one size, one sample count and as many layers. `Like("other")` lets one follow the
    /// other.
    TARGETS_DIFFER = 707,

    /// The image can't be such a target.
    ///
    /// Colour targets hold colour, depth targets hold depth, and three-dimensional images are stored into by dispatches.
    TARGET_UNFIT = 708,

    /// A target can't be blended.
    ///
    /// Blending mixes colours, and integers have no mixture. Write `blend: Replace`, or choose a format of colours.
    BLEND_UNFIT = 709,

    /// A pass gives one name of its shader two things.
    ///
    /// A name of the shader stands once, in `sample`, `storage` or `uniform`.
    BINDING_TWICE = 710,

    /// What stands in for a pass that is off doesn't fit.
    ///
    /// `otherwise` needs `when`, fills images that the pass itself writes, each once, and forwards another image of the same kind.
    STAND_IN_UNFIT = 711,

    /// The copy can't be made.
    ///
    /// A copy moves bits as they are: both sides have one size of texels, one size, and as many samples, planes and layers.
    /// A blit scales, and a draw converts.
    COPY_UNFIT = 712,

    /// The blit can't be made.
    ///
    /// A blit scales images with one sample, between formats of one kind, and depth only into the same format. A draw does the
    /// rest: `draw: FullScreen("copy")`.
    BLIT_UNFIT = 713,

    /// Something is copied or scaled onto itself.
    ///
    /// Source and target would be read and written at once. Another mip level or layer of the image is another part.
    TRANSFER_TO_ITSELF = 714,

    /// The buffer is too small, or a copy wouldn't fill it.
    ///
    /// A buffer holds at least the bytes that a pass takes of it: the block of a shader, the counts of a draw, the texels
    /// of a copy. A copy between buffers also fills its target whole. The message has both numbers.
    BUFFER_SIZE_UNFIT = 715,

    /// A linear filter can't be used.
    ///
    /// Integers have no mixture, a blit doesn't mix depth, and single samples are read one by one. Write `filter: Nearest`.
    LINEAR_FILTER = 716,

    /// A blit would mix in texels of which the frame uses none.
    ///
    /// Of an image that changes its size a part is in use, and a linear filter looks beyond its edge. A draw clamps there:
    /// `draw: FullScreen("copy")`.
    BLIT_OF_PART = 717,

    /// The cascades of a view don't go together.
    ///
    /// The passes that draw a view's shadows are of one number of cascades and one reach, and their maps have one size. None is missing:
    /// `repeat` a pass as often as there are. Each draws its own number. Where shaders sample them, they are the layers
    /// of one image, each of its own number.
    CASCADES = 718,

    /// A pass uses one thing in two ways at once.
    ///
    /// Within a pass nothing orders its accesses, so what it writes it accesses once: for reading and writing, or in two passes.
    USED_TWICE = 719,

    /// The raster state of a pass doesn't go with what it draws.
    ///
    /// `topology` goes with `Vertices`, `Indirect` and custom passes, whose vertex shader writes `gl_PointSize` where it makes points. Where the
    /// program says what its draws make, a pass says nothing else. `primitive_restart` goes with strips and fans that have indices. A blend with
    /// the shader's second colour needs one (`layout(location = 0, index = 1)`), and is that of the one colour target. A pass that
    /// leaves out front and back faces covers nothing.
    RASTER_UNFIT = 720,

    /// A custom pass can't use something as it declares.
    ///
    /// `uses` says by which stages and accesses, and in which layout, the program touches what the pass names in `reads`,
    /// `writes`, `sample`, `storage` or `uniform`. Each access happens in one of the stages and in the layout; the pass names all of what
    /// is declared, reads what is read, and writes what is written. What isn't declared is waited for by all commands.
    USE_UNFIT = 721,

    /// A pass says in no possible way in which frames it runs.
    ///
    /// `Every(count: 6, at: 2)` is one frame of six: the frames of a round are numbered from 0, below `count`.
    CADENCE_UNFIT = 722,

    /// What a pass leaves for frames in which it doesn't run is written by others too.
    ///
    /// Where the pass is left out, its readers would find what the others wrote. Let the others write a copy, or run in the same
    /// frames; or declare it `lifetime: Persistent`: then readers find what any pass wrote last.
    KEPT_WRITTEN = 723,

    /// Something can't stay for frames in which its writer doesn't run.
    ///
    /// Outputs, imports and images with a history are others in each frame, and `Dynamic` images change their size. Let the pass
    /// write an image of its own, and another one copy that in each frame.
    KEPT_UNFIT = 724,

    /// Counts of draws can't stand so in a buffer.
    ///
    /// Counts of `Indirect` draws, and their number, stand at multiples of 4 bytes. From counts to counts there are at least 16 bytes, those of a
    /// `VkDrawIndirectCommand`, or with `index` 20, those of a `VkDrawIndexedIndirectCommand`.
    INDIRECT_UNFIT = 728,
}
