//! Which separate samplers and images a stage uses together, read off its SPIR-V.

use super::module::{IndexedModule, id};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::Op;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The images that each sampler samples, and the images and samplers by which depths are compared; by variables.
#[derive(Debug, Default)]
pub(super) struct SamplerPairs {
    images: BTreeMap<u32, BTreeSet<u32>>,
    compared: HashSet<u32>,
}

impl SamplerPairs {
    pub(super) fn of(module: &IndexedModule<'_>) -> SamplerPairs {
        let joined: Vec<&Instruction> = module.code().filter(|it| it.class.opcode == Op::SampledImage).collect();
        let mut pairs = SamplerPairs::default();
        if joined.is_empty() {
            return pairs;
        }
        let origins = Origins::of(module);
        let compares = module.code().filter(|it| compares(it.class.opcode)).filter_map(|it| id(it, 0));
        let compared: HashSet<u32> = compares.collect();
        for it in joined {
            let [images, samplers] = [0, 1].map(|at| id(it, at).map_or_else(BTreeSet::new, |id| origins.variables(id)));
            for sampler in &samplers {
                pairs.images.entry(*sampler).or_default().extend(&images);
            }
            if it.result_id.is_some_and(|result| compared.contains(&result)) {
                pairs.compared.extend(images.iter().chain(&samplers));
            }
        }
        pairs
    }

    /// The images that a sampler samples.
    pub(super) fn images_of(&self, sampler: u32) -> impl Iterator<Item = u32> {
        self.images.get(&sampler).into_iter().flatten().copied()
    }

    /// Whether depths are compared by an image or sampler.
    pub(super) fn compares(&self, variable: u32) -> bool {
        self.compared.contains(&variable)
    }
}

fn compares(opcode: Op) -> bool {
    matches!(
        opcode,
        Op::ImageSampleDrefImplicitLod
            | Op::ImageSampleDrefExplicitLod
            | Op::ImageSampleProjDrefImplicitLod
            | Op::ImageSampleProjDrefExplicitLod
            | Op::ImageDrefGather
    )
}

/// Where values and pointers come from: a load from its pointer, a parameter from what is handed over.
struct Origins(HashMap<u32, Vec<u32>>);

impl Origins {
    fn of(module: &IndexedModule<'_>) -> Origins {
        let mut origins: HashMap<u32, Vec<u32>> = HashMap::new();
        let functions = module.module.functions.iter();
        let parameters = functions.filter_map(|it| {
            let ids = it.parameters.iter().filter_map(|it| it.result_id).collect::<Vec<_>>();
            Some((it.def.as_ref()?.result_id?, ids))
        });
        let parameters: HashMap<u32, Vec<u32>> = parameters.collect();
        for it in module.code() {
            match it.class.opcode {
                Op::Load | Op::AccessChain | Op::InBoundsAccessChain | Op::CopyObject => {
                    if let (Some(result), Some(from)) = (it.result_id, id(it, 0)) {
                        origins.entry(result).or_default().push(from);
                    }
                }
                Op::FunctionCall => {
                    let taken = id(it, 0).and_then(|callee| parameters.get(&callee)).into_iter().flatten();
                    let handed = it.operands.iter().skip(1).filter_map(Operand::id_ref_any);
                    for (parameter, argument) in taken.zip(handed) {
                        origins.entry(*parameter).or_default().push(argument);
                    }
                }
                _ => {}
            }
        }
        Origins(origins)
    }

    /// What a value comes from in the end.
    fn variables(&self, value: u32) -> BTreeSet<u32> {
        let (mut found, mut seen, mut open) = (BTreeSet::new(), HashSet::new(), vec![value]);
        while let Some(next) = open.pop() {
            if !seen.insert(next) {
                continue;
            }
            match self.0.get(&next) {
                Some(from) => open.extend(from),
                None => _ = found.insert(next),
            }
        }
        found
    }
}
