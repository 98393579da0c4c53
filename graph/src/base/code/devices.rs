//! The limits of devices.

room! {
    "Limits of devices";

    /// The device lacks what a shader needs.
    ///
    /// The shader uses a feature, or more of something, than the device has. `framewright devices` tells what a device has; a
    /// `when` that asks `device` lets a pass run only where it can.
    SHADER_NEEDS = 1101,

    /// The device lacks a feature that a state needs.
    ///
    /// The state in which something is handed in or leaves is one of a feature that the device doesn't have.
    STATE_NEEDS = 1102,

    /// A buffer is larger than the device allows.
    ///
    /// Devices bound buffers, and more tightly what a shader sees as a uniform or storage block. The message names the limit.
    BUFFER_TOO_LARGE = 1103,

    /// A pass draws into more images than the device has room for.
    ///
    /// Split the pass, or put several values into one image.
    TOO_MANY_TARGETS = 1104,

    /// An image is larger, or has more layers, than the device allows.
    ///
    /// The help names what the device allows. Choose a smaller size, or fewer layers.
    IMAGE_TOO_LARGE = 1105,

    /// The device can't use a format as the frame does.
    ///
    /// Each format serves some uses on a device: being sampled, drawn into, stored into, copied. The help names formats that
    /// would do.
    FORMAT_UNSUPPORTED = 1106,

    /// The device can't filter or blend a format.
    ///
    /// Many devices don't filter or blend 32-bit floating point and integers. Choose another format, or another filter.
    FORMAT_OPERATION = 1107,

    /// The frame takes more memory than the device has.
    ///
    /// The help names what is largest. Make images and buffers smaller or fewer, or choose fewer samples or smaller formats.
    TOO_MUCH_MEMORY = 1108,

    /// Samples can't be resolved.
    ///
    /// What has several samples is resolved before it is sampled. That can't be done with stencil, with an image of several
    /// layers, and with what an earlier frame left. The help says what can be done in place of it.
    RESOLVE_IMPOSSIBLE = 1109,

    /// One image can't take another's place.
    ///
    /// Where a pass is off, or parts are scaled, one image is drawn into the other, and that needs formats of colour and one layer.
    FORWARD_IMPOSSIBLE = 1110,

    /// The device can't draw for two eyes in that way.
    ///
    /// Ways to draw for two eyes need features of the device. Choose another one, or let the program choose.
    STEREO_UNSUPPORTED = 1111,

    /// The device lacks what is needed.
    ///
    /// A feature, extension or limit of Vulkan isn't there. `framewright devices` lists the devices, and what is missing on each.
    DEVICE_LACKS = 1112,

    /// The device lacks what the raster state of a pass needs.
    ///
    /// A bound of the depth bias, depth that is clamped, wide lines, points and blends with a second colour are features that not
    /// every device has. The message names the feature or the limit. A `when` that asks `device` lets a pass run only where it can.
    RASTER_NEEDS = 1113,

    /// The device lacks what a sampler needs.
    ///
    /// The least or greatest of texels, anisotropy, images that are mirrored once, and how far mip levels may be moved are features
    /// and limits that not every device has. The message names it.
    SAMPLER_NEEDS = 1114,

    /// The device was made without a feature that the Plan uses.
    ///
    /// A device that the program made itself has the features that the program switched on. The message names each that is missing, and
    /// what uses it. `Plan::features` tells all that a Plan uses before there is a device.
    NOT_SWITCHED_ON = 1115,

    /// The device can't make the indirect draws of a pass.
    ///
    /// Several draws at once (`multiDrawIndirect`), a number of draws in a buffer (`drawIndirectCount`) and how many there may be
    /// (`maxDrawIndirectCount`) aren't the same on every device. The message names what is missing. A `when` that asks `device` lets a pass run only
    /// where it can; a pass with one draw, `Indirect("buffer")`, can everywhere.
    DRAW_NEEDS = 1116,
}
