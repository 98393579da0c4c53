//! Images and buffers: what they are, how long they live, and their parts.

room! {
    "Images and buffers";

    /// The size can't be one.
    ///
    /// Each side of an image or view has from 1 texel up to what the message names, and only three-dimensional images have depth.
    /// A size that comes of a scale is shown with the numbers that made it.
    SIZE_OUTSIDE = 601,

    /// The scale can't be one.
    ///
    /// A scale is greater than 0: `1` is the same size, `0.5` half the width and half the height.
    SCALE = 602,

    /// An image that changes its size is used as none can be.
    ///
    /// Such an image (`Dynamic(by: …, up_to: …)`) has room for its largest size, is flat, and each frame writes it anew: it is transient,
    /// or has `lifetime: History`. Scale it into an image of a fixed size, and go on with that.
    DYNAMIC_SIZE = 603,

    /// The sample count can't be one.
    ///
    /// Sample counts are 1, 2, 4, 8 and 16, and an image with several samples is flat and has one mip level.
    SAMPLE_COUNT = 604,

    /// The image has more mip levels than its size allows.
    ///
    /// Each level is half as large as the one before, down to a single texel, so the size bounds their number.
    /// `mips: Full` makes as many as there are.
    MIP_LEVELS = 605,

    /// Shape, layers, format and size of an image contradict each other.
    ///
    /// A cube is square and has 6 layers, or 12 for two cubes. A three-dimensional image has one layer and no depth format.
    SHAPE = 606,

    /// The size of a buffer can't be one.
    ///
    /// Buffers have a multiple of 4 bytes, at least 4, and at most what the message names: that is what copies and fills move.
    BUFFER_SIZE = 607,

    /// The image can't be resolved in that way.
    ///
    /// Colour is averaged or weighted, integers take the first sample, and depth takes one sample, the least, the greatest or the
    /// average. The help names the ways that its format has.
    RESOLVE_UNFIT = 608,

    /// A texture's file can't be used.
    ///
    /// The message says why: it is missing, damaged, of a kind that isn't read, or has another shape than the texture declares.
    TEXTURE_FILE = 609,

    /// A texture can't have that format.
    ///
    /// Texels come as the file has them: a format may differ in how they are seen, but not in what they hold.
    TEXTURE_FORMAT = 610,

    /// The image has no such layer or mip level.
    ///
    /// Layers and mip levels are counted from 0. The place that declares the image is shown.
    NO_SUCH_PART = 611,

    /// The image has no such plane, or it has two and which is meant isn't said.
    ///
    /// Depth formats have a depth plane, and those with stencil a stencil plane as well.
    /// `format: DepthStencil` has both, and `(image: "…", plane: Depth)` names one of them.
    PLANE = 612,

    /// It isn't said which layer or mip level is meant.
    ///
    /// A draw, and a shader's store, reaches one mip level and one layer.
    /// Wrong: `color: ["cascades"]`, an image of 4 layers.
    /// Mended: `color: [(image: "cascades", layer: 0)]`.
    PART_UNSAID = 613,

    /// The value is none that the format holds.
    ///
    /// Images and buffers are cleared and filled with what their format can hold: floating-point numbers, integers that fit into
    /// its bits, or depth from 0 (infinitely far) to 1 (nearest).
    FILL_UNFIT = 614,

    /// An image or buffer can't be in that state.
    ///
    /// A state is a layout, stages and accesses that Vulkan allows together: a buffer has no layout, an image has one, and a layout
    /// for depth needs a depth format.
    STATE_UNFIT = 615,

    /// An image or buffer is to be left in two states.
    ///
    /// Both the import (`after`) and the output ask for a state, and they differ. Leave one of them out.
    TWO_STATES = 616,

    /// The lifetime can't be one.
    ///
    /// What is kept of earlier frames has a number of frames within bounds, and only textures come from files.
    LIFETIME = 617,

    /// An earlier frame is read of what isn't kept that long.
    ///
    /// `previous: 1` needs `lifetime: History(frames: 1)` or more: everything else is one thing for all frames, or is gone.
    NOT_KEPT = 618,

    /// An earlier frame's contents are used in another way than being read.
    ///
    /// What an earlier frame left is sampled, copied from or read as a buffer. It is never written, as each frame writes what has
    /// history anew, and never bound as a storage image.
    EARLIER_FRAME = 619,

    /// An image that comes from a file is used in another way than being sampled.
    ///
    /// A texture is filled once, when the pipeline is loaded, and no pass makes it. The shader `copy` draws it into an image of
    /// your own.
    TEXTURE_WRITTEN = 620,

    /// The output can't leave the frame in that encoding.
    ///
    /// An encoding says what the numbers of an image mean to a screen or file, and needs a format that holds it. Buffers have none.
    ENCODING = 621,

    /// The frame has no output.
    ///
    /// A frame is made for what leaves it: without outputs no pass would run. Name an image: `outputs: ["color"]`.
    NO_OUTPUTS = 622,

    /// One place names an image and a buffer, or neither.
    ///
    /// Each place is for one of them: `image: "…"` or `buffer: "…"`. Mip levels, layers and planes are for images.
    IMAGE_OR_BUFFER = 623,

    /// An image in a compressed format is used in another way than being sampled.
    ///
    /// Devices read compressed texels, and don't write them. Such an image is a texture of a KTX2 or DDS file, or imported. For
    /// other images choose a format that isn't compressed.
    /// Wrong: `(name: "light", format: BC7_SRGB_BLOCK, size: Output)`.
    /// Mended: `(name: "light", format: R8G8B8A8_SRGB, size: Output)`.
    FORMAT_COMPRESSED = 624,

    /// A texture is compressed with Basis Universal.
    ///
    /// KTX2 files of ETC1S or UASTC have to be transcoded to a format that devices have, which isn't done yet. Store the texture in
    /// such a format: BC7 for desktop devices, ASTC or ETC2 for mobile ones. A format that a device lacks is decoded.
    TEXTURE_BASIS = 625,

    /// An earlier picture of an image that changes its size is copied or scaled.
    ///
    /// Such an image (`Dynamic(by: …, up_to: …)`) may have had another size in that frame, and a copy moves as many texels in each frame.
    /// A shader that samples it is told how large it was: draw it, as the shader `copy` does.
    /// Wrong: `(name: "keep", copy: (from: (image: "color", previous: 1), to: "kept"))`.
    /// Mended: `(name: "keep", draw: FullScreen("copy"), sample: {"source": (image: "color", previous: 1)}, color: ["kept"])`.
    EARLIER_SIZE = 626,

    /// An image that changes its size is shown in a window.
    ///
    /// A window has a size of its own, and shows all of an image. Scale what is drawn into an image of the size `Output`.
    SHOWN_SIZE = 627,
}
