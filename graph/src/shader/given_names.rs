//! SPIR-V takes over the names by which a pass gives it things.

use super::{
    BindingKind, GivenNames, PARAMS, PASS_SET, ShaderInterface, binding_name, declared_name, is_place, offset_name,
};

impl ShaderInterface {
    /// Takes over the names that a pass gives: of what it names by its place, and of the block of parameters. That is the block
    /// `params`, or else the only uniform block that is given no buffer.
    pub fn take_names(&mut self, given: &GivenNames) {
        let is_given = |name: &str| given.bindings.iter().any(|given| declared_name(given) == name);
        if given.bindings.iter().any(|name| is_place(declared_name(name))) {
            let mut renamed = Vec::new();
            for binding in self.bindings.iter_mut().filter(|it| it.set == PASS_SET) {
                let place = binding_name(PASS_SET, binding.binding);
                if is_given(&place) {
                    rename(&mut self.sees_alike, &binding.name, &place);
                    renamed.push((std::mem::replace(&mut binding.name, place.clone()), place));
                }
            }
            for (from, to) in renamed {
                self.bindings.iter_mut().for_each(|binding| binding.kind.rename_sampled(&from, &to));
            }
        }
        let named = self.bindings.iter().any(|it| it.set == PASS_SET && it.name == PARAMS);
        let blocks = self.bindings.iter_mut().filter(|it| it.set == PASS_SET && it.kind.uniform_block().is_some());
        let mut left = blocks.filter(|it| it.length.is_none() && (it.name == PARAMS || !named && !is_given(&it.name)));
        if let (Some(block), None) = (left.next(), left.next()) {
            self.sees_alike.retain(|name| *name != block.name);
            PARAMS.clone_into(&mut block.name);
            if let BindingKind::UniformBlock(block) = &mut block.kind {
                for member in &mut block.members {
                    let place = offset_name(member.offset);
                    if given.params.iter().any(|name| **name == *place) {
                        member.name = place;
                    }
                }
            }
        }
    }
}

fn rename(names: &mut [String], from: &str, to: &str) {
    for name in names.iter_mut().filter(|name| **name == from) {
        to.clone_into(name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{Binding, Block, Member};
    use crate::vulkan::Stages;
    use std::sync::Arc;

    fn block(binding: u32, name: &str) -> Binding {
        let member = |name: &str, offset| {
            let (name, ty) = (name.to_owned(), "float".to_owned());
            Member { name, offset, ty, ..Member::default() }
        };
        let kind = BindingKind::UniformBlock(Block { bytes: 16, members: vec![member("scale", 0), member("bias", 4)] });
        let (name, stages) = (name.to_owned(), Stages::COMPUTE_SHADER);
        Binding { set: PASS_SET, binding, name, kind, length: None, adapts: false, separate: false, stages }
    }

    /// The names of blocks, and of the members of the first, as a pass that gives these names sees them.
    fn taken(blocks: &[(u32, &str)], bindings: &[&str], params: &[&str]) -> (Vec<String>, Vec<String>) {
        let bindings_of = blocks.iter().map(|(binding, name)| block(*binding, name)).collect();
        let mut interface = ShaderInterface { bindings: bindings_of, ..ShaderInterface::default() };
        let [bindings, params] = [bindings, params].map(|names| names.iter().map(|name| Arc::from(*name)).collect());
        interface.take_names(&GivenNames { bindings, params });
        let members = interface.bindings[0].kind.uniform_block().expect("a block").members.clone();
        let names = interface.bindings.into_iter().map(|it| it.name);
        (names.collect(), members.into_iter().map(|it| it.name).collect())
    }

    #[test]
    fn the_only_block_without_a_buffer_takes_the_parameters() {
        assert_eq!(taken(&[(0, "Post")], &[], &[]).0, ["params"]);
        assert_eq!(taken(&[(0, "Post"), (1, "View")], &["View"], &[]).0, ["params", "View"]);
        assert_eq!(taken(&[(0, "Post"), (1, "View")], &["binding 1"], &[]).0, ["params", "binding 1"]);
        assert_eq!(taken(&[(0, "Post"), (1, "View")], &[], &[]).0, ["Post", "View"]);
        assert_eq!(taken(&[(0, "Post"), (1, "params")], &[], &[]).0, ["Post", "params"]);
        assert_eq!(taken(&[(0, "Post")], &["Post"], &[]).0, ["Post"]);
    }

    #[test]
    fn a_place_names_what_has_a_name_too() {
        let (names, members) = taken(&[(3, "params"), (7, "View")], &["binding 7"], &["offset 4"]);
        assert_eq!(
            (names, members),
            (vec!["params".into(), "binding 7".into()], vec!["scale".into(), "offset 4".into()])
        );
    }
}
