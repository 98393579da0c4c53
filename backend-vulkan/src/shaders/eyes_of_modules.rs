//! Modules of other compilers that draw for both eyes at once: what `eyes` does to texts of GLSL is done to their SPIR-V.
//!
//! The entry point is called from one that finds out first which eye is drawn for, and puts vertices in its half or layer afterwards.
//! Texts in HLSL and Slang know the eye by a specialization constant, as that outlives what optimisers do. In the module the eye
//! takes its place. The index of a view is the eye in each way to draw both, also where the device knows of no views.

use super::eye_values::EyeValues;
use super::eyes::{BothEyes, EYE, HANDED_ON, LOCATION, NOT_AT_SEAM};
use super::module::{IndexedModule, id, storage_class};
use super::newer_version;
use super::rotation::{EYE_CONSTANT, ROTATION};
use super::text::RefusedStage;
use super::view_semantics;
use crate::base::{ShaderStage, StageFacts};
use framewright_graph::frame::{Eye, EyeForm};
use framewright_graph::shader::EyeSource;
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Instruction, Operand};
use rspirv::spirv::{BuiltIn, Capability, Decoration, FunctionControl, Op, StorageClass, Word};

/// What a text in HLSL or Slang begins with, if it asks for the eye and both are drawn for at once.
pub(super) fn declared() -> String {
    format!("#define FRAMEWRIGHT_EYE\n[[vk::constant_id({EYE_CONSTANT})]] const int {EYE} = 0;\n#line 1\n")
}

/// Makes a stage that was written for one eye, in another language than GLSL, one for both at once.
///
/// # Errors
/// What it does that can't be told of the eyes.
pub(super) fn for_both(spirv: &[u32], stage: ShaderStage, both: BothEyes) -> Result<Vec<u32>, RefusedStage> {
    let module = rspirv::dr::load_words(spirv).map_err(|error| format!("SPIR-V that can't be read: {error}"))?;
    let found = ModuleParts::in_module(&IndexedModule::new(&module));
    let cuts = both.cuts_at_seam() && stage.facts().places_vertices;
    if cuts && module.capabilities.iter().any(|it| declares(it, Capability::ClipDistance)) {
        return Err(RefusedStage::beginning(&["SV_ClipDistance", "gl_ClipDistance"], NOT_AT_SEAM.to_owned()));
    }
    let mut builder = Builder::new_from_module(module);
    if both.counts_instances() && both.form == EyeForm::Layers && stage.facts().places_vertices {
        newer_version::raise(&mut builder)?;
    }
    let mut made = Wrapped::new(builder, stage, both);
    let mut values = EyeValues::of(made.eye);
    values.constants.clone_from(&found.constants);
    values.views.clone_from(&found.views);
    if both.counts_instances() && stage.facts().places_vertices {
        values.instances.extend(found.instances.iter().chain(&found.bases));
        values.counted = Some(both.source);
    }
    values.put(&mut made.builder)?;
    made.wrap(&found, &values)?;
    Ok(made.builder.module().assemble())
}

/// Puts the eye in place of the index of a view where the device draws no views. `asks`: the text of the stage asks for it; `right`: the
/// right eye is drawn for by itself. In GLSL that draws for both at once a variable knows the eye.
///
/// # Errors
/// What the stage does with the index of a view that can't be followed.
pub(super) fn without_views(
    spirv: Vec<u32>,
    both: Option<BothEyes>,
    [asks, right]: [bool; 2],
) -> Result<Vec<u32>, RefusedStage> {
    let by_views = both.is_some_and(|both| both.source == EyeSource::ViewIndex);
    if by_views || !asks && !names_capability(&spirv, Capability::MultiView) {
        return Ok(spirv);
    }
    let module = rspirv::dr::load_words(&spirv).map_err(|error| format!("SPIR-V that can't be read: {error}"))?;
    let indexed = IndexedModule::new(&module);
    let found = ModuleParts::in_module(&indexed);
    let known = indexed
        .variables()
        .find(|(id, it)| storage_class(it) == Some(StorageClass::Private) && indexed.name(*id) == EYE);
    let known = known.map(|(id, _)| id).filter(|_| both.is_some());
    let mut builder = Builder::new_from_module(module);
    let mut values = match known {
        Some(variable) => EyeValues::of(variable),
        None => {
            let int = builder.type_int(32, 1);
            let value = builder.constant_bit32(int, right.into());
            EyeValues::constant(value)
        }
    };
    values.views = found.views;
    values.put(&mut builder)?;
    remove_capability(&mut builder, Capability::MultiView);
    Ok(builder.module().assemble())
}

/// Whether SPIR-V names a capability; they stand at its beginning.
fn names_capability(spirv: &[u32], wanted: Capability) -> bool {
    let after_header = spirv.get(5..).unwrap_or_default();
    let capabilities = after_header.chunks(2).take_while(|it| it[0] == (2 << 16 | Op::Capability as u32));
    capabilities.into_iter().any(|it| it.get(1) == Some(&(wanted as u32)))
}

fn declares(it: &Instruction, wanted: Capability) -> bool {
    it.operands.first() == Some(&Operand::Capability(wanted))
}

fn remove_capability(builder: &mut Builder, unwanted: Capability) {
    builder.module_mut().capabilities.retain(|it| !declares(it, unwanted));
}

/// Whether a module is of a version, which are `0x00010300` and so on, or a later one.
fn is_since(builder: &Builder, major: u8, minor: u8) -> bool {
    builder.version().is_some_and(|version| version >= (major, minor))
}

/// What a module has that knows of eyes, or that eyes change.
#[derive(Default)]
struct ModuleParts {
    /// Input variables: views, the numbers of instances, and the first instance of a draw.
    views: Vec<u32>,
    instances: Vec<u32>,
    bases: Vec<u32>,
    /// Specialization constants that stand for the eye.
    constants: Vec<u32>,
    /// The constant that says by how much the picture is turned.
    rotation: Option<u32>,
    /// The output variables of the position and of clip distances, and which members of them these are.
    position: Option<(u32, Option<u32>)>,
    clip_distance: Option<(u32, Option<u32>)>,
    has_layer: bool,
}

impl ModuleParts {
    fn in_module(module: &IndexedModule<'_>) -> ModuleParts {
        let mut found = ModuleParts::default();
        for (variable, it) in module.variables() {
            let own = module.decoration(variable, Decoration::BuiltIn).flatten();
            match (storage_class(it), own) {
                (Some(StorageClass::Input), Some(Operand::BuiltIn(built_in))) => match built_in {
                    BuiltIn::ViewIndex => found.views.push(variable),
                    BuiltIn::InstanceIndex => found.instances.push(variable),
                    BuiltIn::BaseInstance => found.bases.push(variable),
                    _ => {}
                },
                // A compiler that doesn't know it took it for a value of another stage.
                (Some(StorageClass::Input), _)
                    if module.decoration_number(variable, Decoration::Location) == Some(view_semantics::LOCATION) =>
                {
                    found.views.push(variable);
                }
                (Some(StorageClass::Output), Some(Operand::BuiltIn(built_in))) => {
                    found.output(*built_in, variable, None);
                }
                (Some(StorageClass::Output), _) => {
                    let Some(block) = module.pointee(it).filter(|ty| ty.class.opcode == Op::TypeStruct) else {
                        continue;
                    };
                    for (member, _) in (0..).zip(&block.operands) {
                        let of = block.result_id.unwrap_or(0);
                        let built_in = module.member_decoration(of, member, Decoration::BuiltIn).flatten();
                        if let Some(Operand::BuiltIn(built_in)) = built_in {
                            found.output(*built_in, variable, Some(member));
                        }
                    }
                }
                _ => {}
            }
        }
        let constants = module.module.types_global_values.iter().filter(|it| it.class.opcode == Op::SpecConstant);
        for constant in constants.filter_map(|it| it.result_id) {
            match module.decoration_number(constant, Decoration::SpecId) {
                Some(EYE_CONSTANT) if module.name(constant) == EYE => found.constants.push(constant),
                Some(ROTATION) => found.rotation = Some(constant),
                _ => {}
            }
        }
        found
    }

    fn output(&mut self, built_in: BuiltIn, variable: u32, member: Option<u32>) {
        match built_in {
            BuiltIn::Position => self.position = Some((variable, member)),
            BuiltIn::ClipDistance => self.clip_distance = Some((variable, member)),
            BuiltIn::Layer => self.has_layer = true,
            _ => {}
        }
    }
}

/// A module whose entry point is being wrapped.
struct Wrapped {
    builder: Builder,
    stage: ShaderStage,
    both: BothEyes,
    int: Word,
    float: Word,
    /// The variable that says which eye is drawn for.
    eye: Word,
    /// Variables of the entry point's that are new.
    inputs_and_outputs: Vec<Word>,
}

impl Wrapped {
    fn new(mut builder: Builder, stage: ShaderStage, both: BothEyes) -> Wrapped {
        let (int, float) = (builder.type_int(32, 1), builder.type_float(32, None));
        let eye = global(&mut builder, int, StorageClass::Private);
        builder.name(eye, EYE);
        Wrapped { builder, stage, both, int, float, eye, inputs_and_outputs: Vec::new() }
    }

    /// A new variable of the entry point's.
    fn variable(&mut self, ty: Word, class: StorageClass) -> Word {
        let variable = global(&mut self.builder, ty, class);
        self.inputs_and_outputs.push(variable);
        variable
    }

    fn built_in(&mut self, ty: Word, class: StorageClass, built_in: BuiltIn) -> Word {
        let variable = self.variable(ty, class);
        self.builder.decorate(variable, Decoration::BuiltIn, [Operand::BuiltIn(built_in)]);
        variable
    }

    /// The number that a draw counts instances by.
    fn instance(&mut self, found: &ModuleParts) -> Word {
        let known = found.instances.first().copied();
        known.unwrap_or_else(|| self.built_in(self.int, StorageClass::Input, BuiltIn::InstanceIndex))
    }

    fn wrap(&mut self, found: &ModuleParts, values: &EyeValues) -> Result<(), RefusedStage> {
        let StageFacts { places_vertices, writes_attachments, .. } = self.stage.facts();
        let by_instances = self.both.counts_instances();
        let source = match self.both.source {
            EyeSource::ViewIndex => {
                self.demand(Capability::MultiView, (1, 3), "SPV_KHR_multiview");
                let view = self.built_in(self.int, StorageClass::Input, BuiltIn::ViewIndex);
                if writes_attachments {
                    self.builder.decorate(view, Decoration::Flat, []);
                }
                Some(view)
            }
            _ if by_instances && places_vertices => Some(self.instance(found)),
            _ if by_instances => Some(self.handed_on(StorageClass::Input)),
            _ => None,
        };
        if self.both.source != EyeSource::ViewIndex {
            remove_capability(&mut self.builder, Capability::MultiView);
        }
        let handed_on = (by_instances && places_vertices).then(|| self.handed_on(StorageClass::Output));
        let layer = match (handed_on, self.both.form) {
            (Some(_), EyeForm::Layers) if found.has_layer => {
                return Err("it chooses its layer, and so does a draw for both eyes".to_owned().into());
            }
            (Some(_), EyeForm::Layers) => {
                self.demand(Capability::ShaderLayer, (1, 5), "SPV_EXT_shader_viewport_index_layer");
                Some(self.built_in(self.int, StorageClass::Output, BuiltIn::Layer))
            }
            _ => None,
        };
        let was = self.begin()?;
        let failed = |error: rspirv::dr::Error| RefusedStage::from(error.to_string());
        let eye = self.eye_of(source).map_err(failed)?;
        self.builder.store(self.eye, eye, None, []).map_err(failed)?;
        values.initialise(&mut self.builder).map_err(failed)?;
        let void = self.builder.type_void();
        self.builder.function_call(void, None, was, []).map_err(failed)?;
        for target in handed_on.into_iter().chain(layer) {
            self.builder.store(target, eye, None, []).map_err(failed)?;
        }
        if self.both.cuts_at_seam()
            && places_vertices
            && let Some(position) = found.position
        {
            self.place_in_half(found, position, eye).map_err(failed)?;
        }
        self.builder.ret().map_err(failed)?;
        self.builder.end_function().map_err(failed)?;
        self.complete_interface();
        Ok(())
    }

    /// The varying that hands the eye on.
    fn handed_on(&mut self, class: StorageClass) -> Word {
        let variable = self.variable(self.int, class);
        self.builder.name(variable, HANDED_ON);
        self.builder.decorate(variable, Decoration::Location, [Operand::LiteralBit32(LOCATION)]);
        self.builder.decorate(variable, Decoration::Flat, []);
        variable
    }

    /// Declares a capability, which takes an extension before a version of SPIR-V.
    fn demand(&mut self, wanted: Capability, (major, minor): (u8, u8), extension: &str) {
        remove_capability(&mut self.builder, wanted);
        self.builder.capability(wanted);
        if !is_since(&self.builder, major, minor) {
            self.builder.extension(extension);
        }
    }

    /// Begins the function that becomes the entry point, and tells which was it.
    fn begin(&mut self) -> Result<Word, RefusedStage> {
        let was = self.builder.module_ref().entry_points.first().and_then(|it| id(it, 1));
        let was = was.ok_or_else(|| "its SPIR-V has no entry point".to_owned())?;
        let void = self.builder.type_void();
        let ty = self.builder.type_function(void, []);
        let failed = |error: rspirv::dr::Error| RefusedStage::from(error.to_string());
        let main = self.builder.begin_function(void, None, FunctionControl::NONE, ty).map_err(failed)?;
        self.builder.begin_block(None).map_err(failed)?;
        let module = self.builder.module_mut();
        let modes = module.execution_modes.iter_mut().filter_map(|it| it.operands.first_mut());
        let points = module.entry_points.iter_mut().filter_map(|it| it.operands.get_mut(1));
        for function in modes.chain(points).filter(|it| **it == Operand::IdRef(was)) {
            *function = Operand::IdRef(main);
        }
        Ok(was)
    }

    /// The eye, as a value of the new entry point.
    fn eye_of(&mut self, source: Option<Word>) -> Result<Word, rspirv::dr::Error> {
        let of_instance = self.stage.facts().places_vertices && self.both.counts_instances();
        let Some(variable) = source else {
            let right = self.both.source == EyeSource::One(Eye::Right);
            return Ok(self.builder.constant_bit32(self.int, right.into()));
        };
        let ty = pointee(&self.builder, variable).unwrap_or(self.int);
        let told = self.builder.load(ty, None, variable, None, [])?;
        if !of_instance {
            return Ok(told);
        }
        let (one, last) = (self.builder.constant_bit32(ty, 1), self.builder.constant_bit32(ty, 31));
        let eye = match self.both.source {
            EyeSource::InstanceBit => self.builder.shift_right_logical(ty, None, told, last)?,
            EyeSource::InstanceParity | EyeSource::ViewIndex | EyeSource::One(_) => {
                self.builder.bitwise_and(ty, None, told, one)?
            }
        };
        if ty == self.int { Ok(eye) } else { self.builder.bitcast(self.int, None, eye) }
    }

    /// A pointer to an output, or to a member of one.
    fn output(&mut self, (variable, member): (u32, Option<u32>), ty: Word) -> Result<Word, rspirv::dr::Error> {
        let Some(member) = member else { return Ok(variable) };
        let pointer = self.builder.type_pointer(None, StorageClass::Output, ty);
        let at = self.builder.constant_bit32(self.int, member);
        self.builder.access_chain(pointer, None, variable, [at])
    }

    /// Puts a vertex in the half of its eye, and cuts at the seam: as `place` of `eyes` writes it in GLSL.
    fn place_in_half(
        &mut self,
        found: &ModuleParts,
        position: (u32, Option<u32>),
        eye: Word,
    ) -> Result<(), rspirv::dr::Error> {
        let (float, int) = (self.float, self.int);
        let [vec2, vec4] = [2, 4].map(|length| self.builder.type_vector(float, length));
        let bool = self.builder.type_bool();
        let mut constant = |value: f32| self.builder.constant_bit32(float, value.to_bits());
        let [zero, one, less, half] = [0.0, 1.0, -1.0, 0.5].map(&mut constant);
        let left = self.builder.constant_bit32(int, 0);
        let pointer = self.output(position, vec4)?;
        let builder = &mut self.builder;
        let whole = builder.load(vec4, None, pointer, None, [])?;
        let w = builder.composite_extract(float, None, whole, [3])?;
        let place = builder.vector_shuffle(vec2, None, whole, whole, [0, 1])?;
        let right = match found.rotation {
            None => builder.composite_construct(vec2, None, [one, zero])?,
            Some(rotation) => {
                let ty = type_of(builder, rotation).unwrap_or(int);
                let mut turned = |quarters: u32, yes: Word, no: Word| {
                    let quarters = builder.constant_bit32(ty, quarters);
                    let is = builder.i_equal(bool, None, rotation, quarters)?;
                    builder.select(float, None, is, yes, no)
                };
                let opposite = turned(2, less, zero)?;
                let x = turned(0, one, opposite)?;
                let up = turned(3, less, zero)?;
                let y = turned(1, one, up)?;
                builder.composite_construct(vec2, None, [x, y])?
            }
        };
        let across = builder.dot(float, None, place, right)?;
        let is_left = builder.i_equal(bool, None, eye, left)?;
        let side = builder.select(float, None, is_left, less, one)?;
        let reach = builder.f_mul(float, None, side, across)?;
        let distance = builder.f_add(float, None, w, reach)?;
        let edge = builder.f_mul(float, None, side, w)?;
        let off = builder.f_sub(float, None, edge, across)?;
        let off = builder.f_mul(float, None, half, off)?;
        let off = builder.vector_times_scalar(vec2, None, right, off)?;
        let place = builder.f_add(vec2, None, place, off)?;
        let placed = builder.vector_shuffle(vec4, None, whole, place, [4, 5, 2, 3])?;
        builder.store(pointer, placed, None, [])?;
        self.demand(Capability::ClipDistance, (1, 0), "");
        let uint = self.builder.type_int(32, 0);
        let length = self.builder.constant_bit32(uint, 1);
        let distances = self.builder.type_array(float, length);
        let variable = match found.clip_distance {
            Some(known) => known,
            None => (self.built_in(distances, StorageClass::Output, BuiltIn::ClipDistance), None),
        };
        let path: Vec<u32> = variable.1.into_iter().chain([0]).collect();
        let path: Vec<Word> = path.into_iter().map(|at| self.builder.constant_bit32(int, at)).collect();
        let pointer = self.builder.type_pointer(None, StorageClass::Output, float);
        let first = self.builder.access_chain(pointer, None, variable.0, path)?;
        self.builder.store(first, distance, None, [])
    }

    /// Names the new variables in the entry point: from SPIR-V 1.4 on all, else those that come in and go out.
    fn complete_interface(&mut self) {
        let names_all = is_since(&self.builder, 1, 4);
        let Some(point) = self.builder.module_mut().entry_points.first_mut() else { return };
        let private = names_all.then_some(self.eye);
        point.operands.extend(self.inputs_and_outputs.drain(..).chain(private).map(Operand::IdRef));
    }
}

/// A new global variable.
fn global(builder: &mut Builder, ty: Word, class: StorageClass) -> Word {
    let (pointer, variable) = (builder.type_pointer(None, class, ty), builder.id());
    let made = Instruction::new(Op::Variable, Some(pointer), Some(variable), vec![Operand::StorageClass(class)]);
    builder.module_mut().types_global_values.push(made);
    variable
}

/// The type of a global value.
fn type_of(builder: &Builder, value: Word) -> Option<Word> {
    let globals = &builder.module_ref().types_global_values;
    globals.iter().find(|it| it.result_id == Some(value))?.result_type
}

/// The type that a global variable points to.
fn pointee(builder: &Builder, variable: Word) -> Option<Word> {
    let pointer = type_of(builder, variable)?;
    let globals = &builder.module_ref().types_global_values;
    id(globals.iter().find(|it| it.result_id == Some(pointer))?, 1)
}
