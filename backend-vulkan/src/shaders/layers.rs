//! Images that a shader samples as flat and that are two layers of one image, one an eye: every look-up is given its layer.
//!
//! It is done to SPIR-V, so that shaders are written for one eye. Images become arrays where they are declared, handed on and
//! looked up; functions that are handed such an image, and one that stays as it is elsewhere, are there twice afterwards.

use super::eyes::EYE;
use super::module::{IndexedModule, id, number, storage_class};
use crate::base::named;
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Function, Instruction, Operand};
use rspirv::spirv::{Dim, ImageFormat, Op, StorageClass};
use std::collections::HashMap;

/// The module with what it samples as `names` in layers, that of the eye which it draws for.
///
/// # Errors
/// In words: what it does with such an image that can't be given a layer.
pub(super) fn by_eye(spirv: &[u32], names: &[&str]) -> Result<Vec<u32>, String> {
    let module = rspirv::dr::load_words(spirv).map_err(|error| format!("SPIR-V that can't be read: {error}"))?;
    let (mut found, mut eye) = (Vec::new(), None);
    let indexed = IndexedModule::new(&module);
    for (variable, instruction) in indexed.variables() {
        let name = indexed.name(variable);
        match storage_class(instruction) {
            Some(StorageClass::Private) if name == EYE => eye = Some(variable),
            Some(StorageClass::UniformConstant) if names.contains(&name) => {
                let ty = indexed.pointee(instruction);
                let alone = ty.filter(|ty| ty.class.opcode == Op::TypeImage);
                let joined = ty.filter(|ty| ty.class.opcode == Op::TypeSampledImage);
                let image = alone.or_else(|| joined.and_then(|ty| indexed.global(id(ty, 0)?)));
                let image = image.ok_or_else(|| format!("`{name}` is no image that is sampled"))?;
                let flat = FlatTypes::of(image).ok_or_else(|| format!("`{name}` isn't declared flat"))?;
                found.push((variable, flat, alone.is_some()));
            }
            _ => {}
        }
    }
    let (Some(eye), false) = (eye, found.is_empty()) else { return Ok(spirv.to_vec()) };
    let mut layers = Layers::new(Builder::new_from_module(module), eye);
    for (variable, flat, alone) in found {
        layers.declare(variable, flat, alone);
    }
    layers.functions()?;
    Ok(layers.builder.module().assemble())
}

/// A flat image's type, as far as it isn't the same for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct FlatTypes {
    sampled: u32,
    depth: u32,
    multisampled: u32,
}

impl FlatTypes {
    fn of(image: &Instruction) -> Option<FlatTypes> {
        let literal = |at: usize| image.operands.get(at).and_then(number);
        let flat = image.operands.get(1) == Some(&Operand::Dim(Dim::Dim2D)) && literal(3) == Some(0);
        let (depth, multisampled) = (literal(2)?, literal(4)?);
        flat.then_some(FlatTypes { sampled: id(image, 0)?, depth, multisampled })
    }
}

/// The types of an image in layers.
#[derive(Debug, Clone, Copy)]
struct LayeredTypes {
    image: u32,
    sampled_image: u32,
    /// What is loaded: the image, or the image with its sampler.
    loaded: u32,
}

/// A value that is an image in layers, or leads to one.
#[derive(Debug, Clone, Copy)]
struct Layered {
    types: LayeredTypes,
    /// Its own type, which is one of them.
    ty: u32,
}

struct Layers {
    builder: Builder,
    /// The variable that says which eye is drawn for.
    eye: u32,
    float: u32,
    int: u32,
    /// Image variables in layers.
    variables: HashMap<u32, Layered>,
    /// Functions as they were.
    originals: HashMap<u32, Function>,
    /// By function and by which of its parameters are in layers, what it is then.
    lifted: HashMap<(u32, Vec<Option<u32>>), u32>,
    /// Functions that are to be made.
    wanted: Vec<(u32, Vec<Option<Layered>>, u32)>,
}

impl Layers {
    fn new(mut builder: Builder, eye: u32) -> Layers {
        let (float, int) = (builder.type_float(32, None), builder.type_int(32, 1));
        let functions = builder.module_ref().functions.iter();
        let originals = functions.filter_map(|it| Some((it.def.as_ref()?.result_id?, it.clone()))).collect();
        let (variables, lifted, wanted) = (HashMap::new(), HashMap::new(), Vec::new());
        Layers { builder, eye, float, int, variables, originals, lifted, wanted }
    }

    /// Declares a variable in layers. It comes last then, behind its type. `alone`: it is without a sampler.
    fn declare(&mut self, variable: u32, flat: FlatTypes, alone: bool) {
        let FlatTypes { sampled, depth, multisampled } = flat;
        let format = ImageFormat::Unknown;
        let image = self.builder.type_image(sampled, Dim::Dim2D, depth, 1, multisampled, 1, format, None);
        let sampled_image = self.builder.type_sampled_image(image);
        let loaded = if alone { image } else { sampled_image };
        let pointer = self.builder.type_pointer(None, StorageClass::UniformConstant, loaded);
        let types = LayeredTypes { image, sampled_image, loaded };
        self.variables.insert(variable, Layered { types, ty: pointer });
        let globals = &mut self.builder.module_mut().types_global_values;
        if let Some(at) = globals.iter().position(|it| it.result_id == Some(variable)) {
            let mut declared = globals.remove(at);
            declared.result_type = Some(pointer);
            globals.push(declared);
        }
    }

    fn functions(&mut self) -> Result<(), String> {
        let given = std::mem::take(&mut self.builder.module_mut().functions);
        let mut made = Vec::with_capacity(given.len());
        for function in given {
            made.push(self.rewritten(function, self.variables.clone())?);
        }
        while let Some((of, parameters, name)) = self.wanted.pop() {
            let Some(original) = self.originals.get(&of).cloned() else { continue };
            let function = self.copied(original, &parameters, name);
            let mut known = self.variables.clone();
            let ids = function.parameters.iter().filter_map(|it| it.result_id);
            known.extend(ids.zip(parameters).filter_map(|(id, arrayed)| Some((id, arrayed?))));
            made.push(self.rewritten(function, known)?);
        }
        self.builder.module_mut().functions = made;
        Ok(())
    }

    /// The function `name`, like another one but for its parameters. All ids in it are new.
    fn copied(&mut self, mut function: Function, parameters: &[Option<Layered>], name: u32) -> Function {
        let mut ids = HashMap::new();
        let all = |function: &mut Function, each: &mut dyn FnMut(&mut Instruction)| {
            let Function { def, end, parameters, blocks } = function;
            def.iter_mut().chain(parameters).for_each(&mut *each);
            for block in blocks {
                block.label.iter_mut().chain(&mut block.instructions).for_each(&mut *each);
            }
            end.iter_mut().for_each(each);
        };
        all(&mut function, &mut |it| {
            if let Some(old) = it.result_id {
                ids.insert(old, self.builder.id());
            }
        });
        self.decorate_alike(&ids);
        ids.extend(function.def.as_ref().and_then(|def| def.result_id).map(|old| (old, name)));
        all(&mut function, &mut |it| {
            it.result_id = it.result_id.map(|old| ids[&old]);
            for operand in it.operands.iter_mut().filter_map(Operand::id_ref_any_mut) {
                *operand = ids.get(operand).copied().unwrap_or(*operand);
            }
        });
        for (parameter, arrayed) in function.parameters.iter_mut().zip(parameters) {
            parameter.result_type = arrayed.map_or(parameter.result_type, |arrayed| Some(arrayed.ty));
        }
        let types: Vec<u32> = function.parameters.iter().filter_map(|it| it.result_type).collect();
        if let Some(def) = &mut function.def {
            let ty = self.builder.type_function(def.result_type.unwrap_or(0), types);
            if let Some(last) = def.operands.last_mut() {
                *last = Operand::IdRef(ty);
            }
        }
        function
    }

    /// Decorates new values as the old ones are, by old value: a number that differs from pixel to pixel says so.
    fn decorate_alike(&mut self, ids: &HashMap<u32, u32>) {
        let annotations = &mut self.builder.module_mut().annotations;
        let of_copies: Vec<Instruction> = annotations
            .iter()
            .filter_map(|it| {
                let mut copy = it.clone();
                *copy.operands.first_mut()? = Operand::IdRef(*ids.get(&id(it, 0)?)?);
                Some(copy)
            })
            .collect();
        annotations.extend(of_copies);
    }

    /// A function in which what is `known` to be in layers, and what comes of it, is looked up so.
    fn rewritten(&mut self, mut function: Function, mut known: HashMap<u32, Layered>) -> Result<Function, String> {
        let mut types = HashMap::new();
        for it in function.blocks.iter().flat_map(|it| &it.instructions).chain(&function.parameters) {
            types.extend(it.result_id.zip(it.result_type));
        }
        for block in &mut function.blocks {
            let given = std::mem::take(&mut block.instructions);
            for it in given {
                self.step(it, &mut known, &types, &mut block.instructions)?;
            }
        }
        Ok(function)
    }

    fn step(
        &mut self,
        mut it: Instruction,
        known: &mut HashMap<u32, Layered>,
        types: &HashMap<u32, u32>,
        made: &mut Vec<Instruction>,
    ) -> Result<(), String> {
        if it.class.opcode == Op::FunctionCall {
            self.call(&mut it, known);
            made.push(it);
            return Ok(());
        }
        let Some(arrayed) = id(&it, 0).and_then(|image| known.get(&image).copied()) else {
            made.push(it);
            return Ok(());
        };
        let Layered { types: all, ty } = arrayed;
        match it.class.opcode {
            Op::Load | Op::Image | Op::SampledImage | Op::CopyObject => {
                let ty = match it.class.opcode {
                    Op::Load => all.loaded,
                    Op::Image => all.image,
                    Op::SampledImage => all.sampled_image,
                    _ => ty,
                };
                it.result_type = Some(ty);
                known.extend(it.result_id.map(|result| (result, Layered { types: all, ty })));
                made.push(it);
            }
            Op::ImageSampleImplicitLod
            | Op::ImageSampleExplicitLod
            | Op::ImageGather
            | Op::ImageSampleDrefImplicitLod
            | Op::ImageSampleDrefExplicitLod
            | Op::ImageDrefGather => {
                self.give_layer(&mut it, types, made)?;
                made.push(it);
            }
            Op::ImageFetch => {
                self.give_layer(&mut it, types, made)?;
                made.push(it);
            }
            Op::ImageQuerySizeLod | Op::ImageQuerySize => {
                let component = it.result_type.and_then(|ty| self.component(ty)).unwrap_or(self.int);
                let size = self.builder.type_vector(component, 3);
                let (flat, result) = (it.result_type, it.result_id);
                let all = self.builder.id();
                (it.result_type, it.result_id) = (Some(size), Some(all));
                made.push(it);
                let parts =
                    [Operand::IdRef(all), Operand::IdRef(all), Operand::LiteralBit32(0), Operand::LiteralBit32(1)];
                made.push(Instruction::new(Op::VectorShuffle, flat, result, parts.into()));
            }
            Op::ImageQueryLevels | Op::ImageQuerySamples | Op::ImageQueryLod => made.push(it),
            opcode => return Err(format!("Op{} of an image that both eyes have of their own", named(opcode))),
        }
        Ok(())
    }

    /// Adds the layer to the coordinate of a look-up.
    fn give_layer(
        &mut self,
        it: &mut Instruction,
        types: &HashMap<u32, u32>,
        made: &mut Vec<Instruction>,
    ) -> Result<(), String> {
        let unusual = || format!("Op{} with an unusual coordinate", named(it.class.opcode));
        let given = id(it, 1).ok_or_else(unusual)?;
        let component = self.type_of(given, types).and_then(|ty| self.component(ty)).ok_or_else(unusual)?;
        let flat = self.builder.type_vector(component, 2);
        let [with_depth, with_more] = [3, 4].map(|length| self.builder.type_vector(component, length));
        let coordinate = match self.type_of(given, types) {
            Some(ty) if ty == flat => given,
            // The compiler hands over the depth that is compared behind the coordinate too.
            Some(ty) if ty == with_depth || ty == with_more => {
                let first = self.builder.id();
                let parts = [given, given].map(Operand::IdRef).into_iter().chain([0, 1].map(Operand::LiteralBit32));
                made.push(Instruction::new(Op::VectorShuffle, Some(flat), Some(first), parts.collect()));
                first
            }
            _ => return Err(unusual()),
        };
        let eye = self.builder.id();
        made.push(Instruction::new(Op::Load, Some(self.int), Some(eye), vec![Operand::IdRef(self.eye)]));
        let layer = if component == self.int {
            eye
        } else {
            // Texels may be numbered without signs.
            let op = if component == self.float { Op::ConvertSToF } else { Op::Bitcast };
            let layer = self.builder.id();
            made.push(Instruction::new(op, Some(component), Some(layer), vec![Operand::IdRef(eye)]));
            layer
        };
        let (ty, place) = (self.builder.type_vector(component, 3), self.builder.id());
        let parts = vec![Operand::IdRef(coordinate), Operand::IdRef(layer)];
        made.push(Instruction::new(Op::CompositeConstruct, Some(ty), Some(place), parts));
        it.operands[1] = Operand::IdRef(place);
        Ok(())
    }

    /// The type of a vector's component.
    fn component(&self, vector: u32) -> Option<u32> {
        let globals = &self.builder.module_ref().types_global_values;
        let ty = globals.iter().find(|it| it.result_id == Some(vector))?;
        id(ty, 0).filter(|_| ty.class.opcode == Op::TypeVector)
    }

    /// The type of a value of a function, or of a constant.
    fn type_of(&self, value: u32, types: &HashMap<u32, u32>) -> Option<u32> {
        let globals = || self.builder.module_ref().types_global_values.iter();
        types.get(&value).copied().or_else(|| globals().find(|it| it.result_id == Some(value))?.result_type)
    }

    /// Calls the function that takes what it is given.
    fn call(&mut self, it: &mut Instruction, known: &HashMap<u32, Layered>) {
        let Some(callee) = id(it, 0) else { return };
        let given = it.operands[1..].iter().map(|it| known.get(&it.id_ref_any()?).copied());
        let given: Vec<Option<Layered>> = given.collect();
        if given.iter().all(Option::is_none) {
            return;
        }
        let key = (callee, given.iter().map(|it| it.map(|it| it.ty)).collect());
        let name = match self.lifted.get(&key) {
            Some(name) => *name,
            None => {
                let name = self.builder.id();
                self.lifted.insert(key, name);
                self.wanted.push((callee, given, name));
                name
            }
        };
        it.operands[0] = Operand::IdRef(name);
    }
}

#[cfg(test)]
mod tests {
    use super::by_eye;
    use rspirv::binary::Assemble;
    use rspirv::dr::Builder;
    use rspirv::spirv::StorageClass;

    /// ST-4: only an image can have a layer for each eye.
    #[test]
    fn what_is_no_image_has_no_layers() {
        let mut builder = Builder::new();
        let sampler = builder.type_sampler();
        let pointer = builder.type_pointer(None, StorageClass::UniformConstant, sampler);
        let variable = builder.variable(pointer, None, StorageClass::UniformConstant, None);
        builder.name(variable, "smooth");
        let spirv = builder.module().assemble();
        assert_eq!(by_eye(&spirv, &["smooth"]), Err("`smooth` is no image that is sampled".to_owned()));
        assert_eq!(by_eye(&spirv, &["source"]), Ok(spirv.clone()));
    }
}
