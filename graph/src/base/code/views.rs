//! Views, eyes and rotation.

room! {
    "Views, eyes and rotation";

    /// One eye's part is named of an image that both eyes share.
    ///
    /// `Eye(Left, "…")` is for images with `per_eye: true`. Others are the same for both eyes, and are named by themselves.
    SAME_FOR_BOTH_EYES = 1001,

    /// Both eyes would write one thing.
    ///
    /// A pass that writes what each eye has runs once for each eye, and the second run would overwrite the first.
    /// Say `per_eye: true` of what it writes, or write it in a pass of its own.
    WRITTEN_BY_BOTH_EYES = 1002,

    /// It isn't said which eye's image is read.
    ///
    /// The pass runs once, and each eye has an image of its own. Read one eye's: `Eye(Left, "…")`, or let the pass run for each
    /// eye.
    EYE_UNSAID = 1003,

    /// The shader doesn't ask for its eye's half.
    ///
    /// Both eyes' pictures lie side by side in one image. What finds the eye's own half in GLSL is `frag_coord()` of
    /// `include/rotation.glsl` and `found_in` of `include/texture.glsl`; in HLSL and Slang `frag_coord(position)` of
    /// `include/rotation.hlsl`, and `uv_clamp(uv_adjust(…))` of `include/part.hlsl` or `found_in` of `include/texture.hlsl`. SPIR-V files
    /// and WGSL aren't told of halves: for them choose a mode with layers, or `multi-pass`.
    EYE_HALF = 1004,

    /// The frame has no view.
    ///
    /// A frame without views shows nothing. Leave `views` out: there is one then.
    NO_VIEWS = 1005,

    /// The main view has a size of its own.
    ///
    /// The first view is the frame's, and has the size of the output. Leave `size` out, and choose the output's size.
    MAIN_VIEW_SIZE = 1006,

    /// Nothing can be rotated.
    ///
    /// A screen that is turned takes a frame that is drawn turned, and no output of this one is for a screen: `format: Output` is.
    NOTHING_TO_ROTATE = 1007,

    /// An output can't leave the frame rotated.
    ///
    /// A rotated output is drawn turned, with all that is drawn together with it. What is handed in with contents, is a buffer,
    /// or is drawn beside images that stay upright can't be. Draw into an image of its own, and from that into the output.
    ROTATION_UNFIT = 1008,

    /// A shader would see that its target is turned.
    ///
    /// It reads places or derivatives of the screen as they are. `frag_coord()`, `ddx()`, `ddy()` and `rotate_clip()` of
    /// `include/rotation.glsl` are those of the upright picture; `include/rotation.hlsl` has `frag_coord(position)` and
    /// `rotate_clip()`.
    SHADER_SEES_ROTATION = 1009,
}
