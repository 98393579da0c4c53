//! The buffers of a view, and the bind groups over them.
//!
//! They stay when the frame changes: each write goes to a copy that no frame in flight reads.

use super::frame_data::{ViewTransform, view_block};
use super::interface::{
    CASCADES_BINDING, CLUSTERS_BINDING, FRAME_SET, LIGHTS_BINDING, MOTION_BINDING, OBJECTS_BINDING, VIEW_BINDING,
    interface,
};
use crate::scene::Camera;
use framewright_graph::frame::{Draw, DrawList, Eye};
use framewright_vulkan::{BindGroup, BufferUsage, Device, DynamicBuffer, Error, Resource};
use std::collections::BTreeMap;

/// What sees the scene with transforms of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Sight {
    /// The camera, which stands between the eyes if there are two.
    Between,
    /// One eye.
    Of(Eye),
    /// Both eyes at once.
    OfBoth,
    /// The sun, in this cascade.
    OfSun(usize),
}

/// The contents of the blocks that all sights of a view share.
pub(super) struct Blocks {
    pub(super) lights: Vec<u8>,
    pub(super) objects: Vec<u8>,
    pub(super) cascades: Vec<u8>,
    pub(super) clusters: Vec<u8>,
    pub(super) motion: Vec<u8>,
}

/// The buffers of a view.
pub(super) struct ViewBuffers {
    device: Device,
    /// Those that all sights share, by binding.
    shared: BTreeMap<u32, DynamicBuffer>,
    /// The transforms of each sight, and its bind group.
    groups: BTreeMap<Sight, (DynamicBuffer, BindGroup)>,
}

impl ViewBuffers {
    /// No buffers yet.
    pub(super) fn new(device: &Device) -> ViewBuffers {
        ViewBuffers { device: device.clone(), shared: BTreeMap::new(), groups: BTreeMap::new() }
    }

    /// Writes the blocks that all sights share. Groups that were given out before must be asked for again.
    pub(super) fn write(&mut self, blocks: &Blocks) -> Result<(), Error> {
        let Blocks { lights, objects, cascades, clusters, motion } = blocks;
        for (binding, usage, block) in [
            (LIGHTS_BINDING, BufferUsage::Storage, lights),
            (OBJECTS_BINDING, BufferUsage::Storage, objects),
            (CASCADES_BINDING, BufferUsage::Uniform, cascades),
            (CLUSTERS_BINDING, BufferUsage::Storage, clusters),
            (MOTION_BINDING, BufferUsage::Storage, motion),
        ] {
            let bytes = block.len() as u64;
            let before = self.shared.get(&binding).map(DynamicBuffer::bytes);
            if before.is_none_or(|before| before < bytes) {
                // One that grows gets room to grow on.
                let bytes = before.map_or(bytes, |_| bytes.next_power_of_two());
                self.shared.insert(binding, self.device.dynamic_buffer(usage, bytes)?);
                self.groups.clear();
            }
            if let Some(buffer) = self.shared.get(&binding) {
                buffer.write(block)?;
            }
        }
        Ok(())
    }

    /// The bind group of a sight, whose transforms are written into it.
    pub(super) fn group(
        &mut self,
        of: Sight,
        camera: &Camera,
        transforms: [ViewTransform; 2],
    ) -> Result<BindGroup, Error> {
        let block = view_block(camera, transforms);
        if let Some((view, group)) = self.groups.get(&of) {
            view.write(&block)?;
            return Ok(group.clone());
        }
        let view = self.device.dynamic_buffer(BufferUsage::Uniform, block.len() as u64)?;
        view.write(&block)?;
        let shared = self.shared.iter().map(|(binding, buffer)| (*binding, Resource::Dynamic(buffer)));
        let resources: Vec<_> = shared.chain([(VIEW_BINDING, Resource::Dynamic(&view))]).collect();
        let group = self.device.bind_group(&interface(Draw::Objects(DrawList::Opaque)), FRAME_SET, &resources)?;
        self.groups.insert(of, (view, group.clone()));
        Ok(group)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::view_draws::{ViewDraws, Viewpoint};
    use crate::scene::{PointLight, Scene, load};
    use framewright_tests::render::device;
    use std::collections::BTreeSet;
    use std::path::Path;

    /// Objects and a camera that move, and its view.
    fn passing() -> (Scene, Viewpoint) {
        let scene = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/passing.ron")).expect("a scene");
        let view = Viewpoint::of_one(scene.camera, [4, 4], Vec::new());
        (scene, view)
    }

    /// EM-6.
    #[test]
    fn a_view_that_changes_from_frame_to_frame_takes_no_new_buffers() {
        let Some(device) = device() else { return };
        let (scene, view) = passing();
        let mut draws = ViewDraws::new(device, &scene, &view, 0).expect("memory");
        let mut bound = BTreeSet::new();
        for frame in 1..10 {
            draws.advance_to(&scene, &view, frame).expect("memory");
            let of_sights = draws.buffers.groups.values().map(|(view, _)| view);
            bound.extend(draws.buffers.shared.values().chain(of_sights).map(|buffer| buffer.current().raw()));
        }
        // Five that all sights share, and that of the camera. No frame reads them here, so each is written in place.
        assert_eq!(bound.len(), 6);
    }

    #[test]
    fn lights_that_come_into_view_take_a_larger_buffer() {
        let Some(device) = device() else { return };
        let (mut scene, view) = passing();
        let place = scene.camera.position() - scene.camera.transform.z_axis.truncate() * 3.0;
        let lamp = |range| PointLight {
            position: place.to_array(),
            color: [1.0; 3],
            intensity: 1.0,
            range: Some(range),
            shadows: false,
        };
        scene.point_lights = vec![lamp(1e-6)];
        let mut draws = ViewDraws::new(device, &scene, &view, 0).expect("memory");
        let bytes = |draws: &ViewDraws| draws.buffers.shared[&CLUSTERS_BINDING].bytes();
        let before = bytes(&draws);
        scene.point_lights = vec![lamp(0.5); 100];
        draws.renew(&scene, &view, 1).expect("memory");
        assert!(bytes(&draws) > before && bytes(&draws).is_power_of_two(), "{before} {}", bytes(&draws));
    }
}
