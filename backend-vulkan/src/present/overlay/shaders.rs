//! The shaders that draw an overlay. They are built here, since no GLSL compiler may be there: that of a program, or its helper.

use crate::shaders::Spirv;
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Error, Operand};
use rspirv::spirv::{
    AddressingModel, BuiltIn, Capability, Decoration, Dim, ExecutionMode, ExecutionModel, FunctionControl, ImageFormat,
    MemoryModel, StorageClass, Word,
};

/// A triangle that covers the viewport, with the coordinates of a texture that fills it:
///
/// ```glsl
/// layout(location = 0) out vec2 place;
/// void main() {
///     place = vec2((gl_VertexIndex & 1) * 2, gl_VertexIndex & 2);
///     gl_Position = vec4(place * 2.0 - 1.0, 0.0, 1.0);
/// }
/// ```
pub(super) fn vertex() -> Spirv {
    built(|shader| {
        let (float, uint) = (shader.type_float(32, None), shader.type_int(32, 0));
        let (pair, four) = (shader.type_vector(float, 2), shader.type_vector(float, 4));
        let index = variable(shader, StorageClass::Input, uint);
        shader.decorate(index, Decoration::BuiltIn, [Operand::BuiltIn(BuiltIn::VertexIndex)]);
        let position = variable(shader, StorageClass::Output, four);
        shader.decorate(position, Decoration::BuiltIn, [Operand::BuiltIn(BuiltIn::Position)]);
        let place = variable(shader, StorageClass::Output, pair);
        shader.decorate(place, Decoration::Location, [Operand::LiteralBit32(0)]);
        let [one, two] = [1, 2].map(|number| shader.constant_bit32(uint, number));
        let [zero, unit, double] = [0.0_f32, 1.0, 2.0].map(|number| shader.constant_bit32(float, number.to_bits()));
        let main = begin(shader)?;
        let number = shader.load(uint, None, index, None, [])?;
        let odd = shader.bitwise_and(uint, None, number, one)?;
        let bits = [shader.shift_left_logical(uint, None, odd, one)?, shader.bitwise_and(uint, None, number, two)?];
        let mut ends = [zero; 2];
        let mut clip = [zero, zero, zero, unit];
        for (side, bit) in bits.into_iter().enumerate() {
            ends[side] = shader.convert_u_to_f(float, None, bit)?;
            let doubled = shader.f_mul(float, None, ends[side], double)?;
            clip[side] = shader.f_sub(float, None, doubled, unit)?;
        }
        let at = shader.composite_construct(pair, None, ends)?;
        shader.store(place, at, None, [])?;
        let at = shader.composite_construct(four, None, clip)?;
        shader.store(position, at, None, [])?;
        shader.entry_point(ExecutionModel::Vertex, main, "main", [index, position, place]);
        Ok(())
    })
}

/// The texel of a texture:
///
/// ```glsl
/// layout(set = 0, binding = 0) uniform sampler2D picture;
/// layout(location = 0) in vec2 place;
/// layout(location = 0) out vec4 color;
/// void main() { color = texture(picture, place); }
/// ```
pub(super) fn fragment() -> Spirv {
    built(|shader| {
        let float = shader.type_float(32, None);
        let (pair, four) = (shader.type_vector(float, 2), shader.type_vector(float, 4));
        let image = shader.type_image(float, Dim::Dim2D, 0, 0, 0, 1, ImageFormat::Unknown, None);
        let sampled = shader.type_sampled_image(image);
        let picture = variable(shader, StorageClass::UniformConstant, sampled);
        shader.decorate(picture, Decoration::DescriptorSet, [Operand::LiteralBit32(0)]);
        shader.decorate(picture, Decoration::Binding, [Operand::LiteralBit32(0)]);
        let place = variable(shader, StorageClass::Input, pair);
        let color = variable(shader, StorageClass::Output, four);
        for varying in [place, color] {
            shader.decorate(varying, Decoration::Location, [Operand::LiteralBit32(0)]);
        }
        let main = begin(shader)?;
        let at = shader.load(pair, None, place, None, [])?;
        let from = shader.load(sampled, None, picture, None, [])?;
        let texel = shader.image_sample_implicit_lod(four, None, from, at, None, [])?;
        shader.store(color, texel, None, [])?;
        shader.entry_point(ExecutionModel::Fragment, main, "main", [place, color]);
        shader.execution_mode(main, ExecutionMode::OriginUpperLeft, []);
        Ok(())
    })
}

/// The shader that `build` builds, up to the end of its one function.
fn built(build: impl FnOnce(&mut Builder) -> Result<(), Error>) -> Spirv {
    let mut shader = Builder::new();
    shader.set_version(1, 0);
    shader.capability(Capability::Shader);
    shader.memory_model(AddressingModel::Logical, MemoryModel::GLSL450);
    let whole = build(&mut shader).and_then(|()| shader.ret()).and_then(|()| shader.end_function());
    whole.expect("each instruction stands in the block that was begun");
    shader.module().assemble().into()
}

/// Begins the function.
fn begin(shader: &mut Builder) -> Result<Word, Error> {
    let void = shader.type_void();
    let function = shader.type_function(void, []);
    let main = shader.begin_function(void, None, FunctionControl::NONE, function)?;
    shader.begin_block(None)?;
    Ok(main)
}

fn variable(shader: &mut Builder, class: StorageClass, of: Word) -> Word {
    let pointer = shader.type_pointer(None, class, of);
    shader.variable(pointer, None, class, None)
}
