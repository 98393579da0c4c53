//! Shaders: that they exist and compile, and that a pass gives what they ask for.

room! {
    "Shaders";

    /// There is no shader of that name.
    ///
    /// The help says where it was looked for: beside the pipeline, in the folders that were named, and among those that are
    /// shipped.
    UNKNOWN_SHADER = 801,

    /// The shader doesn't compile.
    ///
    /// The compiler's complaints are shown with the lines that they are about, or the bound of time, memory or stack that it
    /// reached.
    SHADER_BROKEN = 802,

    /// The shader can't be used.
    ///
    /// It compiles, but does something that no pass here can serve, such as a kind of binding that isn't supported.
    SHADER_UNFIT = 803,

    /// The shader has nothing of that name.
    ///
    /// Names in `sample`, `storage` and `uniform` are those that the shader declares, in the pass's own set. The help names the
    /// nearest.
    UNKNOWN_BINDING = 804,

    /// The shader uses something that the pass doesn't give.
    ///
    /// Each image and buffer that the shader declares in the pass's own set gets one of the pipeline's:
    /// `sample: {"source": "color"}`.
    BINDING_MISSING = 805,

    /// The elements of an array are given otherwise than the shader declares them.
    ///
    /// A list under the array's name gives its elements: `"taps": ["a", "b"]`, as many as the shader has.
    BINDING_ARRAY = 806,

    /// The shader has no parameter of that name.
    ///
    /// `params` gives values to the members of the shader's block of parameters. The help names the nearest.
    UNKNOWN_PARAM = 807,

    /// A parameter of a shader has another type than the value.
    ///
    /// The message names the type that the shader declares: a `vec4` takes four numbers, `(1.0, 0.5, 0.0, 1.0)`.
    PARAM_TYPE = 808,

    /// A shader's parameter gets no value.
    ///
    /// The block of parameters is written whole, and what nobody gives would be undefined. The help shows the entry to add.
    PARAM_MISSING = 809,

    /// The block of parameters is given a buffer.
    ///
    /// The program fills that block with the pass's parameters: `params: {"…": …}`.
    PARAMS_AS_BUFFER = 810,

    /// Pass and shader disagree on whether depths are compared.
    ///
    /// `sampler2DShadow` compares a depth with the image's, and the pass says how: `(image: "shadow", compare: GreaterOrEqual)`.
    /// A shader that declares `sampler2D` reads depth as it is.
    COMPARE = 811,

    /// The image has another dimension, or another number of layers, than the shader declares.
    ///
    /// `sampler2D` reads one layer, `sampler2DArray` several, `samplerCube` a cube and `sampler3D` a three-dimensional image.
    DIMENSION = 812,

    /// The shader takes an image for other numbers than it holds.
    ///
    /// Floating-point numbers, signed integers and unsigned integers are read, stored and drawn by shader types of their own.
    /// An image of `R32_UINT` is read by `usampler2D`.
    COMPONENT_TYPE = 813,

    /// Single samples are read where there are none, or not where there are.
    ///
    /// `sampler2DMS` reads single samples, and needs an image with several. `sampler2D` reads what they are resolved to.
    /// `TEXTURE_name` in the shader fits both.
    SINGLE_SAMPLES = 814,

    /// An image can't be stored into by a shader, or not like this.
    ///
    /// Shaders store into images with one sample, of formats other than depth and sRGB, and the format in `layout(…)` is the
    /// image's own.
    STORAGE_IMAGE = 815,

    /// Pass and shader disagree on reading and writing.
    ///
    /// `access` says what the shader does with it. In the shader, `readonly` and `writeonly` say the same.
    STORAGE_ACCESS = 816,

    /// A shader doesn't ask which part of an image is in use.
    ///
    /// Of an image that changes its size a part is used, and beyond it there is nothing. `include/part.glsl` and `include/part.hlsl` have
    /// `uv_adjust` and `uv_clamp`, which look up within the part. `found_in` of `include/texture.glsl` and `include/texture.hlsl` does
    /// so in one call.
    PART_NOT_ASKED = 817,

    /// An image can't be read at the fragment's own position.
    ///
    /// `own_pixel` is for draws, and for images of the size of what is drawn into: one level and one layer, declared
    /// `subpassInput` where the device has local reads. Leave it out elsewhere.
    OWN_PIXEL = 818,

    /// The shader has no output for a target, or one with too few components.
    ///
    /// What a shader doesn't write would be undefined. Outputs are matched by location: the first target is location 0.
    OUTPUT_MISSING = 819,

    /// The shader leaves an output unset on some path.
    ///
    /// Its value would be undefined there. Set it at the beginning of `main`; `discard` leaves texels as they were.
    OUTPUT_UNSET = 820,

    /// There is no alpha that could say what is covered.
    ///
    /// `alpha_to_coverage` makes samples of the alpha of the first colour target: floating-point colour of four components.
    ALPHA_TO_COVERAGE = 821,

    /// The vertices that a shader reads aren't those that it is given.
    ///
    /// The attributes of a shader's vertices come from `vertex`, or from what the program draws, by their names and types.
    VERTEX_ATTRIBUTES = 822,

    /// The shader uses something that the draw source doesn't bring along.
    ///
    /// What isn't in the pass's own set comes from the program that draws: cameras, lights, textures of a scene. Set, binding and
    /// kind are those that it declares; `framewright facts` and an interface file (`--interface`) tell them.
    DRAW_SOURCE_LACKS = 823,

    /// Nobody records the custom pass.
    ///
    /// `custom` names work that the program records itself. The program must know the name; `--interface` tells `check` of it.
    CUSTOM_UNKNOWN = 824,

    /// An interface file contradicts itself.
    ///
    /// It tells what a program brings along for its draws: for each kind of draw once, at places of their own, and without
    /// vertices for dispatches.
    INTERFACE_FILE = 825,

    /// A file of SPIR-V can't be read.
    ///
    /// It is cut off, of a version after 1.6, or breaks the rules that every reader relies on. Compile it anew, for Vulkan 1.3.
    SPIRV_FILE = 826,

    /// SPIR-V has no such entry point, or several.
    ///
    /// A stage is the entry point that is named behind the file, `post.spv:PSMain`, or else the only one of its stage. The help
    /// lists those that there are.
    ENTRY_POINT = 827,

    /// A shader samples images by one sampler, and the pass gives them in different ways.
    ///
    /// A sampler of its own (`sampler`, HLSL's `SamplerState`) takes filter and address from the images that it samples. Say the same
    /// `filter`, `mip_filter` and `address` of all of them.
    SAMPLER_SHARED = 828,

    /// A shader reads a set of the program's otherwise than it is.
    ///
    /// The program tells the layout of sets that it binds itself: with `DrawInterfaces::with_set`, or in `sets` of an interface file
    /// (`--interface`). A shader declares what is there: at its binding, of its type, with as many elements or fewer, in its stages.
    PROGRAM_SET = 829,

    /// The shader has no such specialization constant, or it has another type than the value.
    ///
    /// `constants: {"TILE": 8}` gives values to the constants of a shader: GLSL's `layout(constant_id = 0)`, HLSL's
    /// `[[vk::constant_id(0)]]`. Truth values and numbers of 32 bits have values. The help names those that there are.
    SHADER_CONSTANT = 830,

    /// An image can't be sampled so.
    ///
    /// A border goes with `address: Border`, and is one of integers where the image holds integers. Anisotropy goes with
    /// `filter: Linear`, and the least mip level lies below the greatest. What is compared has no reduction.
    SAMPLER_UNFIT = 831,

    /// A shader reads push constants that aren't set for it.
    ///
    /// What a pass gives its shader comes in the uniform block `params`. Push constants are those of a program's draws, which tells their
    /// bytes: `DrawInterface::push_constants`, or `push_constants` in an interface file (`--interface`). A shader that reads any asks for no
    /// part of an image.
    PUSH_CONSTANTS = 832,

    /// Parameters have several blocks to go into.
    ///
    /// A shader in HLSL, Slang, WGSL or SPIR-V has several uniform blocks that the pass gives no buffer, and none of them is called
    /// `params`. Put their members into one, or give the others buffers.
    PARAM_BLOCKS = 833,

    /// A parameter that is an array has another number of elements than the value.
    ///
    /// The message names the type that the shader declares: a `float[3]` takes three numbers, `[0.25, 0.5, 0.25]`.
    PARAM_LENGTH = 836,

    /// A module's push constants are neither those of the draw nor parameters.
    ///
    /// Push constants of shaders in HLSL, Slang or SPIR-V are the draw's where the program brings the bytes of their members to the stage:
    /// `DrawInterface::push_constants`, or `push_constants` in an interface file (`--interface`). Else they are parameters, and the pass
    /// gives each member a value: `params: {"…": …}`.
    PUSHED_UNFIT = 837,
}
