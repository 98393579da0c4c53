//! The fields of a pass.

use super::condition::CONDITION;
use super::repeat::REPEAT;
use super::stand_ins::OTHERWISE;
use super::{bindings, cadence, declared_uses, dispatch, draw, parts, raster, shader, targets, transfer, views};
use crate::fields;
use crate::ron::{Leaf, PlainForm};

fields! {
    /// A pass: one draw, dispatch, copy, blit or fill, or commands of the program's own.
    /// ```ron
    /// (name: "glass", when: "scene.has_transparent", draw: Objects(Transparent), shader: "lit",
    ///     color: [(image: "image", blend: Premultiplied)], depth: (image: "depth", write: false))
    /// ```
    pub(crate) struct PassFields<'src> as "Pass" {
        /// Its name, unique among passes and uses.
        pub(crate) name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The view that it draws for; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// In [which frames](#passes-that-dont-run-in-every-frame) it runs; always if left out.
        pub(crate) run: Option<Leaf<'src>> => cadence::RUN,
        /// The name of an index, and how often the entry is repeated.
        pub(crate) repeat: Option<Leaf<'src>> => REPEAT,
        /// It draws.
        pub(crate) draw: Option<Leaf<'src>> => draw::DRAW,
        /// It runs a compute shader, `NAME.comp`, or one in a file of another language.
        pub(crate) dispatch: Option<Leaf<'src>> => shader::STAGE,
        /// It copies bits as they are: texels to texels, bytes to bytes, or rows of texels without gaps to or from a buffer.
        pub(crate) copy: Option<Leaf<'src>> => transfer::COPY,
        /// It copies an image and scales it.
        pub(crate) blit: Option<Leaf<'src>> => transfer::BLIT,
        /// It sets an image or buffer to a value.
        pub(crate) fill: Option<Leaf<'src>> => transfer::FILL,
        /// It runs commands that the embedding program records under this name: with `color` or `depth` within a rendering
        /// scope, where its shader is the one of this name if there is one; else outside.
        pub(crate) custom: Option<Leaf<'src>> => Form::Plain(PlainForm::Outside),
        /// The shader of the draw.
        pub(crate) shader: Option<Leaf<'src>> => shader::SHADER,
        /// The number of workgroups of the dispatch.
        pub(crate) groups: Option<Leaf<'src>> => dispatch::WORKGROUPS,
        /// Images that its shaders sample, by the shader's names.
        pub(crate) sample: Option<Leaf<'src>> => bindings::SAMPLE,
        /// Images and buffers that its shaders read and write by themselves, by the shader's names.
        pub(crate) storage: Option<Leaf<'src>> => bindings::STORAGE,
        /// Buffers that its shaders read as uniform blocks, by the shader's names.
        pub(crate) uniform: Option<Leaf<'src>> => bindings::UNIFORM,
        /// The buffer of the vertices of `Vertices` and `Indirect`.
        pub(crate) vertex: Option<Leaf<'src>> => parts::BUFFER,
        /// The buffer of their indices, 32 bits each.
        pub(crate) index: Option<Leaf<'src>> => parts::BUFFER,
        /// The colour targets, by location.
        pub(crate) color: Option<Leaf<'src>> => targets::COLOR,
        /// The target for depth and stencil.
        pub(crate) depth: Option<Leaf<'src>> => targets::DEPTH,
        /// How triangles, lines and points become fragments.
        pub(crate) raster: Option<Leaf<'src>> => raster::RASTER,
        /// `true`: the alpha that the shader writes at location 0 tells how many samples of a texel are covered, where its
        /// targets have several; not if left out.
        pub(crate) alpha_to_coverage: Option<Leaf<'src>> => Form::Truth,
        /// `true`: promises that it sets every texel of its targets, where that [isn't proven](#what-a-pass-leaves-untouched).
        pub(crate) covers: Option<Leaf<'src>> => Form::Truth,
        /// Images and buffers, or parts of them, that it reads by transfer. Beside targets, name them in `storage` or `uniform`.
        pub(crate) reads: Option<Leaf<'src>> => transfer::TRANSFERRED,
        /// Images and buffers, or parts of them, that it writes by transfer; all of each is written, unless it is in `reads` too. Beside targets,
        /// name them in `storage`.
        pub(crate) writes: Option<Leaf<'src>> => transfer::TRANSFERRED,
        /// How the program's commands use what the pass names, for what is to be [waited for less](#declared-uses) than by all commands.
        pub(crate) uses: Option<Leaf<'src>> => declared_uses::USES,
        /// `Any`: the program may be asked to record it for a queue for compute, where that gains. `Graphics` if left out.
        pub(crate) queue: Option<Leaf<'src>> => declared_uses::QUEUE,
        /// `true`: the program records it for [both eyes at once](#two-eyes), where the frame is drawn so; for one eye after the other if
        /// left out.
        pub(crate) both_eyes: Option<Leaf<'src>> => Form::Truth,
        /// Values for the members of the shader's block `params`, by name: vectors and columns of matrices in `(…, …)`.
        pub(crate) params: Option<Leaf<'src>> => bindings::PARAMS,
        /// Values for the shader's specialization constants, by name, or by number where they have none: `"constant 0"`.
        pub(crate) constants: Option<Leaf<'src>> => bindings::CONSTANTS,
        /// `true`: it is kept although nothing in the frame needs it.
        pub(crate) side_effect: Option<Leaf<'src>> => Form::Truth,
        /// A condition: if it is false, the pass is off, and expressions in it need no values.
        pub(crate) when: Option<Leaf<'src>> => CONDITION,
        /// Stand-ins: contents of the images that it would write, when it is off.
        pub(crate) otherwise: Option<Leaf<'src>> => OTHERWISE,
    }
}
