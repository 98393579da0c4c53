//! Images and buffers at random.

use super::Maker;
use crate::random_pipelines::allowed::{Allowed, Kind};
use crate::random_pipelines::pipeline::{Buffer, Contents, Image, Life, SAMPLES};
use crate::random_pipelines::rng::Rng;
use crate::random_pipelines::valid::size;
use framewright_graph::vulkan::Format::{
    D32_SFLOAT, D32_SFLOAT_S8_UINT, R8_UINT, R8G8B8A8_UINT, R8G8B8A8_UNORM, R16G16B16A16_SFLOAT, R32_SFLOAT, R32_UINT,
    R32G32B32A32_UINT,
};
use framewright_graph::vulkan::{ResolveMode, Shape};

pub(super) fn images(rng: &mut Rng, passes: u32, allowed: &Allowed) -> Vec<Image> {
    let [width, height] = rng.of([[8, 8], [16, 8], [12, 20], [24, 16], [40, 24]]);
    let count = 3 + rng.below(3 + passes.min(80) / 4);
    (0..count).map(|_| image(rng, [width, height], allowed)).collect()
}

fn image(rng: &mut Rng, [width, height]: [u32; 2], allowed: &Allowed) -> Image {
    let format = if rng.one_in(5) {
        if allowed.has(Kind::Stencil) { rng.of([D32_SFLOAT, D32_SFLOAT_S8_UINT]) } else { D32_SFLOAT }
    } else {
        rng.of([
            R32_UINT,
            R32_UINT,
            R8G8B8A8_UINT,
            R32G32B32A32_UINT,
            R8_UINT,
            R8G8B8A8_UNORM,
            R16G16B16A16_SFLOAT,
            R32_SFLOAT,
        ])
    };
    let factor = if rng.one_in(4) { rng.of([2, 3]) } else { 1 };
    let flat = Image {
        format,
        shape: Shape::D2,
        extent: [width * factor, height * factor, 1],
        mips: 1,
        layers: 1,
        samples: 1,
        resolve: None,
        life: life(rng, allowed),
    };
    let color = !format.is_depth();
    match rng.below(10) {
        0 | 1 if allowed.has(Kind::Multisampled) => {
            let resolve = if color { None } else { resolve(rng) };
            Image { samples: SAMPLES, resolve, life: Life::Transient, ..flat }
        }
        2 if allowed.has(Kind::Mips) => Image { mips: 2 + rng.below(2), ..flat },
        3 if allowed.has(Kind::Layers) => Image { layers: 2 + rng.below(2), ..flat },
        4 if allowed.has(Kind::Mips) && allowed.has(Kind::Layers) => Image { mips: 2, layers: 2, ..flat },
        5 if color && allowed.has(Kind::Deep) => Image { shape: Shape::D3, extent: [8, 8, 4], ..flat },
        6 if color && allowed.has(Kind::Cube) => {
            Image { shape: Shape::Cube, extent: [8, 8, 1], layers: 6, mips: 1 + rng.below(2), ..flat }
        }
        _ => flat,
    }
}

/// How the samples of depth become one value: every other image says it.
fn resolve(rng: &mut Rng) -> Option<ResolveMode> {
    let modes = [ResolveMode::SampleZero, ResolveMode::Min, ResolveMode::Max, ResolveMode::Average];
    if rng.one_in(2) { Some(rng.of(modes)) } else { None }
}

fn life(rng: &mut Rng, allowed: &Allowed) -> Life {
    let value = (1 + rng.below(60)) as u8;
    match rng.below(13) {
        0 if allowed.has(Kind::Persistent) => Life::Persistent(value),
        1 if allowed.has(Kind::History) => Life::History(1 + rng.below(3), value),
        2 if allowed.has(Kind::Imported) => Life::Imported,
        3 if allowed.has(Kind::Imported) => Life::Target,
        _ => Life::Transient,
    }
}

impl Maker<'_> {
    pub(super) fn buffers(&mut self, passes: u32) -> Vec<Buffer> {
        if !self.allowed.has(Kind::Buffers) {
            return Vec::new();
        }
        let mut buffers = Vec::new();
        for _ in 0..2 + self.rng.below(3 + passes.min(60) / 6) {
            let life = match life(&mut self.rng, self.allowed) {
                Life::Target => Life::Imported,
                life => life,
            };
            let words = self.rng.of([16, 64, 192]);
            buffers.push(Buffer { words, contents: Contents::Words, life });
        }
        // As large as some mip level, to be copied.
        let image = self.rng.below(self.pipeline.images.len() as u32) as usize;
        let part = self.part(image, 1, u32::MAX);
        let size = size(&self.pipeline.images[image], part).iter().product::<u32>();
        let words = size * self.pipeline.images[image].format.texel_bytes() as u32 / 4;
        if words >= 16 {
            buffers.push(Buffer { words, contents: Contents::Words, life: Life::Transient });
        }
        let structured = [
            (Kind::VertexBuffer, Contents::Vertices),
            (Kind::IndexBuffer, Contents::Indices),
            (Kind::IndirectDraw, Contents::Draw),
            (Kind::IndirectDraw, Contents::IndexedDraw),
            (Kind::IndirectDispatch, Contents::Dispatch),
        ];
        for (kind, contents) in structured {
            if self.allowed.has(kind) && self.rng.one_in(2) {
                buffers.push(Buffer { words: 16, contents, life: Life::Transient });
            }
        }
        buffers
    }
}
