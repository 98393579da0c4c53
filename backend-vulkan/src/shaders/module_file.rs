//! SPIR-V that other compilers made: it is checked, and one entry point is cut out of it.
//!
//! What is cut out looks as if the GLSL compiler had written it: its entry point is `main`, it holds nothing that this one doesn't
//! reach, and all that a pass gives has a name. So nothing behind here knows of such files.

use super::constants::Constants;
use super::module::id;
use super::module_lines::ModuleLines;
use super::push_constants::PushedBy;
use super::{constants, module_capabilities, module_checks, module_words, place_names, push_constants, registers};
use crate::base::ShaderStage;
use framewright_graph::shader::ShaderProblem;
use rspirv::binary::Assemble;
use rspirv::dr::{Function, Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Capability, Decoration, ExecutionMode, ExecutionModel, Op};
use std::collections::{HashMap, HashSet};

/// A file of SPIR-V.
#[derive(Debug)]
pub(super) struct ModuleFile {
    module: Module,
    /// Entry points, by their functions, whose workgroups are sized by constants.
    sized_by: Vec<(u32, Vec<u32>)>,
}

/// The module of one entry point.
pub(super) struct CutModule {
    pub(super) spirv: Vec<u32>,
    /// Why its push constants aren't those of the draw, in words.
    pub(super) pushed_misfits: Vec<String>,
}

/// An entry point: its stage, its function and its name.
#[derive(Clone, Copy)]
struct EntryPoint<'m> {
    model: ExecutionModel,
    function: u32,
    name: &'m str,
}

impl ModuleFile {
    /// Reads a file.
    ///
    /// # Errors
    /// In words: it is no SPIR-V, or breaks a rule that every reader relies on.
    pub(super) fn read(bytes: &[u8]) -> Result<ModuleFile, String> {
        let words = module_words::words(bytes)?;
        let sized_by = module_words::sized_by_constants(bytes);
        let mut module = rspirv::dr::load_words(words).map_err(|error| error.to_string())?;
        module_checks::check(&module)?;
        without_groups(&mut module);
        Ok(ModuleFile { module, sized_by })
    }

    /// Reads what a compiler wrote.
    ///
    /// # Errors
    /// Those of [`ModuleFile::read`].
    pub(super) fn compiled(spirv: &[u32]) -> Result<ModuleFile, String> {
        let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
        ModuleFile::read(&bytes)
    }

    /// The lines of what it was compiled of. `bytes` are those that it was read of.
    pub(super) fn lines(&self, bytes: &[u8]) -> ModuleLines {
        ModuleLines::of(&self.module, module_words::texts(bytes))
    }

    /// Whether it may ask for the index of a view.
    pub(super) fn knows_views(&self) -> bool {
        let view = Operand::Capability(Capability::MultiView);
        self.module.capabilities.iter().any(|it| it.operands.first() == Some(&view))
    }

    /// Gives each resource of a pass a binding of its own, where HLSL numbers kinds of registers each from 0 on.
    pub(super) fn spread_registers(&mut self) {
        registers::spread(&mut self.module);
    }

    /// The name of its entry point of a stage, if it has only one.
    pub(super) fn only_entry(&self, stage: ShaderStage) -> Option<&str> {
        let mut of_stage = self.entry_points().filter(|entry| entry.model == stage.facts().model);
        of_stage.next().filter(|_| of_stage.next().is_none()).map(|entry| entry.name)
    }

    fn entry_points(&self) -> impl Iterator<Item = EntryPoint<'_>> {
        self.module.entry_points.iter().filter_map(|it| match &it.operands[..] {
            [Operand::ExecutionModel(model), Operand::IdRef(function), Operand::LiteralString(name), ..] => {
                Some(EntryPoint { model: *model, function: *function, name })
            }
            _ => None,
        })
    }

    /// Whether it has an entry point of a stage.
    pub(super) fn has(&self, stage: ShaderStage) -> bool {
        self.entry_points().any(|entry| entry.model == stage.facts().model)
    }

    /// The module of one entry point: the one of this name, or else the only one of the stage. `file` is its file in messages. Its
    /// specialization constants have these values. `pushed` decides whose its push constants are.
    ///
    /// # Errors
    /// [`ShaderProblem::EntryPoint`] if there is none such, or there are several; [`ShaderProblem::BadModule`] if it isn't whole.
    pub(super) fn cut(
        &self,
        file: &str,
        stage: ShaderStage,
        named: Option<&str>,
        values: &Constants,
        pushed: &PushedBy,
    ) -> Result<CutModule, ShaderProblem> {
        let facts = stage.facts();
        let of_stage: Vec<EntryPoint<'_>> = self.entry_points().filter(|entry| entry.model == facts.model).collect();
        let mut wanted = of_stage.iter().filter(|entry| named.is_none_or(|named| entry.name == named));
        let (Some(entry), None) = (wanted.next(), wanted.next()) else {
            let others = self.entry_points().filter(|entry| entry.model != facts.model);
            return Err(ShaderProblem::EntryPoint {
                file: file.into(),
                stage: facts.name,
                named: named.map(str::to_owned),
                of_stage: of_stage.iter().map(|entry| entry.name.to_owned()).collect(),
                others: others.map(|entry| (entry.name.to_owned(), stage_name(entry.model))).collect(),
            });
        };
        let bad = |what: String| ShaderProblem::BadModule { what: format!("{file}: {what}") };
        let mut module = self.reached(*entry).map_err(bad)?;
        constants::put(&mut module, values);
        self.size_by_constants(&mut module, *entry);
        if facts.has_workgroups && !is_sized(&module) {
            return Err(bad(format!("its entry point `{}` doesn't say how large its workgroups are", entry.name)));
        }
        if self.module.entry_points.len() > 1 {
            module_capabilities::leave_out_foreign(&mut module);
        }
        let pushed_misfits = push_constants::as_params(&mut module, stage, pushed);
        place_names::add(&mut module);
        Ok(CutModule { spirv: module.assemble(), pushed_misfits })
    }

    /// Puts the constants' values in place of the size of workgroups.
    fn size_by_constants(&self, module: &mut Module, entry: EntryPoint<'_>) {
        let Some((_, sizes)) = self.sized_by.iter().find(|(function, _)| *function == entry.function) else { return };
        let sizes: Option<Vec<u32>> = sizes.iter().map(|size| constants::value_of(module, *size)).collect();
        let is_size =
            |it: &&mut Instruction| it.operands.get(1) == Some(&Operand::ExecutionMode(ExecutionMode::LocalSize));
        if let (Some(sizes), Some(mode)) = (sizes, module.execution_modes.iter_mut().find(is_size)) {
            mode.operands.truncate(2);
            mode.operands.extend(sizes.into_iter().map(Operand::LiteralBit32));
        }
    }

    /// The module with all that an entry point reaches.
    fn reached(&self, entry: EntryPoint<'_>) -> Result<Module, String> {
        let functions: HashMap<u32, &Function> =
            self.module.functions.iter().filter_map(|it| Some((module_checks::of(it)?, it))).collect();
        let globals = self.module.types_global_values.iter().filter_map(|it| Some((it.result_id?, it)));
        let globals: HashMap<u32, &Instruction> = globals.collect();
        if !functions.contains_key(&entry.function) {
            return Err(format!("the function of its entry point `{}` isn't there", entry.name));
        }
        let (mut reached, mut open) = (HashSet::new(), vec![entry.function]);
        if entry.model == ExecutionModel::GLCompute {
            open.extend(workgroup_sizes(&self.module));
            let sized = self.sized_by.iter().filter(|(function, _)| *function == entry.function);
            open.extend(sized.flat_map(|(_, sizes)| sizes));
        }
        while let Some(next) = open.pop() {
            if !reached.insert(next) {
                continue;
            }
            let (function, global) = (functions.get(&next), globals.get(&next));
            open.extend(function.into_iter().flat_map(|it| it.all_inst_iter()).flat_map(ids));
            open.extend(global.into_iter().flat_map(|it| ids(it)));
        }
        let within = functions.iter().filter(|(id, _)| reached.contains(*id));
        let within: HashSet<u32> =
            within.flat_map(|(_, it)| it.all_inst_iter()).filter_map(|it| it.result_id).collect();
        let keeps = |it: &Instruction| {
            let mut named = it.operands.iter().filter_map(Operand::id_ref_any);
            named.all(|id| reached.contains(&id) || within.contains(&id))
        };
        let mut module = self.module.clone();
        module.functions.retain(|it| module_checks::of(it).is_some_and(|id| reached.contains(&id)));
        module.types_global_values.retain(|it| it.result_id.is_some_and(|id| reached.contains(&id)));
        module.annotations.retain(keeps);
        module.debug_names.retain(keeps);
        module.execution_modes.retain(|it| id(it, 0) == Some(entry.function));
        module.entry_points.retain(|it| is(it, entry));
        for point in &mut module.entry_points {
            point.operands.retain(|operand| operand.id_ref_any().is_none_or(|id| reached.contains(&id)));
            if let Some(name) = point.operands.get_mut(2) {
                *name = Operand::LiteralString("main".to_owned());
            }
        }
        Ok(module)
    }
}

/// Whether an instruction declares this entry point.
fn is(it: &Instruction, entry: EntryPoint<'_>) -> bool {
    it.operands.first() == Some(&Operand::ExecutionModel(entry.model))
        && it.operands.get(2).is_some_and(|name| matches!(name, Operand::LiteralString(name) if name == entry.name))
}

/// The ids that an instruction mentions.
fn ids(it: &Instruction) -> impl Iterator<Item = u32> + '_ {
    it.operands.iter().filter_map(Operand::id_ref_any).chain(it.result_type)
}

/// The constants that say how large workgroups are, in place of the entry point.
fn workgroup_sizes(module: &Module) -> impl Iterator<Item = u32> {
    let size = [Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(BuiltIn::WorkgroupSize)];
    let says = move |it: &&Instruction| it.operands.get(1..).is_some_and(|rest| *rest == size);
    module.annotations.iter().filter(says).filter_map(|it| id(it, 0))
}

fn is_sized(module: &Module) -> bool {
    let sizes = |it: &Instruction| it.operands.get(1) == Some(&Operand::ExecutionMode(ExecutionMode::LocalSize));
    module.execution_modes.iter().any(sizes) || workgroup_sizes(module).next().is_some()
}

/// A stage in words.
fn stage_name(model: ExecutionModel) -> &'static str {
    match ShaderStage::ALL.iter().find(|stage| stage.facts().model == model) {
        Some(stage) => stage.facts().name,
        None => match model {
            ExecutionModel::Geometry => "geometry",
            ExecutionModel::TessellationControl | ExecutionModel::TessellationEvaluation => "tessellation",
            ExecutionModel::MeshEXT | ExecutionModel::MeshNV => "mesh",
            ExecutionModel::TaskEXT | ExecutionModel::TaskNV => "task",
            _ => "ray tracing or kernel",
        },
    }
}

/// Puts the decorations of groups at each member of the group.
fn without_groups(module: &mut Module) {
    let is_group = |it: &Instruction| it.class.opcode == Op::DecorationGroup;
    let groups: HashSet<u32> =
        module.annotations.iter().filter(|it| is_group(it)).filter_map(|it| it.result_id).collect();
    if groups.is_empty() {
        return;
    }
    let of_group = |it: &Instruction| id(it, 0).is_some_and(|id| groups.contains(&id));
    let mut made = Vec::new();
    for it in &module.annotations {
        let decorations = module.annotations.iter().filter(|decoration| {
            decoration.class.opcode == Op::Decorate && decoration.operands.first() == it.operands.first()
        });
        match it.class.opcode {
            Op::GroupDecorate => {
                for (decoration, target) in decorations.flat_map(|one| it.operands[1..].iter().map(move |to| (one, to)))
                {
                    let operands = [std::slice::from_ref(target), &decoration.operands[1..]].concat();
                    made.push(Instruction::new(Op::Decorate, None, None, operands));
                }
            }
            Op::GroupMemberDecorate => {
                let members = it.operands[1..].chunks(2);
                for (decoration, member) in decorations.flat_map(|one| members.clone().map(move |to| (one, to))) {
                    let operands = [member, &decoration.operands[1..]].concat();
                    made.push(Instruction::new(Op::MemberDecorate, None, None, operands));
                }
            }
            _ => {}
        }
    }
    module.annotations.retain(|it| !is_group(it) && !of_group(it));
    module.debug_names.retain(|it| !of_group(it));
    module.annotations.append(&mut made);
}
