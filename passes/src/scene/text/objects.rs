//! The objects of a scene file.

use super::values::{angles, count, counts, movement, number, place, size, sizes};
use crate::scene::model::{Bounds, Mesh, Object};
use crate::scene::{limits, shapes};
use framewright_graph::base::Code;
use framewright_graph::fields;
use framewright_graph::ron::{Leaf, Names, Reader, Shape};
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::TAU;

fields! {
    struct ObjectFields<'s> {
        name: Option<Leaf<'s>>,
        material: Leaf<'s>,
        position: Option<Leaf<'s>>,
        rotation: Option<Leaf<'s>>,
        size: Leaf<'s>,
        repeat: Option<Leaf<'s>>,
        cross_fade: Option<Leaf<'s>>,
        velocity: Option<Leaf<'s>>,
        spin: Option<Leaf<'s>>,
    }
}

fields! {
    /// A sphere says its radius instead of its size.
    struct SphereFields<'s> {
        name: Option<Leaf<'s>>,
        material: Leaf<'s>,
        position: Option<Leaf<'s>>,
        rotation: Option<Leaf<'s>>,
        radius: Leaf<'s>,
        repeat: Option<Leaf<'s>>,
        cross_fade: Option<Leaf<'s>>,
        velocity: Option<Leaf<'s>>,
        spin: Option<Leaf<'s>>,
    }
}

/// The objects so far, and the meshes that they share.
#[derive(Default)]
pub(super) struct Objects {
    pub(super) meshes: Vec<Mesh>,
    pub(super) objects: Vec<Object>,
    /// Whether there were too many: reading on would only take time.
    pub(super) full: bool,
    /// The shape of each mesh.
    shapes: Vec<&'static str>,
}

/// The box around all objects.
pub(super) fn bounds(objects: &Objects) -> Option<Bounds> {
    let boxes = objects.objects.iter().map(|object| objects.meshes[object.mesh].bounds.transformed(object.transform));
    boxes.reduce(Bounds::union)
}

impl Objects {
    fn mesh(&mut self, shape: &'static str) -> usize {
        self.shapes.iter().position(|known| *known == shape).unwrap_or_else(|| {
            self.shapes.push(shape);
            self.meshes.push(match shape {
                "Plane" => shapes::plane(),
                "Sphere" => shapes::sphere(),
                _ => shapes::cube(),
            });
            self.meshes.len() - 1
        })
    }

    /// Adds the objects of an entry of the list, or reports its mistakes.
    pub(super) fn add<'s>(
        &mut self,
        reader: &mut Reader,
        leaf: Leaf<'s>,
        index: usize,
        materials: &Names,
        names: &mut Names,
    ) -> Option<()> {
        const FORMS: &str = "write `Plane(…)`, `Sphere(…)` or `Cube(…)`";
        let (shape, rest) = reader.word(leaf, "a shape", &["Plane", "Sphere", "Cube"], FORMS)?;
        let (fields, extents) = extents(reader, leaf, shape, rest)?;
        let name = match fields.name {
            Some(leaf) => {
                let name = reader.reference(leaf, "an object")?;
                names.give(reader, Some(name.clone()));
                Some(name.text.to_string())
            }
            None => Some(format!("{} {index}", shape.to_lowercase())),
        };
        let palette = palette(reader, fields.material, materials);
        let position = fields.position.map_or(Some(DVec3::ZERO), |leaf| place(reader, leaf, "the position"));
        let rotation = fields.rotation.map_or(Some(DVec3::ZERO), |leaf| angles(reader, leaf));
        let places = fields.repeat.map_or(Some(vec![DMat4::IDENTITY]), |leaf| repeat(reader, leaf));
        let fade = |leaf| number(reader, leaf, "the share that is seen", -1.0, 1.0);
        let cross_fade = fields.cross_fade.map_or(Some(1.0), fade);
        let movement = movement(reader, fields.velocity, fields.spin);
        let (name, palette, places, position) = (name?, palette?, places?, position?);
        let turns = rotation?.to_array().map(f64::to_radians);
        let rotation =
            DQuat::from_rotation_z(turns[2]) * DQuat::from_rotation_y(turns[1]) * DQuat::from_rotation_x(turns[0]);
        if self.objects.len() + places.len() > limits::OBJECTS {
            let message = format!("with these the scene has {} objects", self.objects.len() + places.len());
            reader.wrong(Code::SCENE_TOO_LARGE, leaf, message, &format!("at most {} are allowed", limits::OBJECTS));
            self.full = true;
            return None;
        }
        let (mesh, cross_fade, movement) = (self.mesh(shape), cross_fade? as f32, movement?);
        let own = DMat4::from_scale_rotation_translation(extents?, rotation, DVec3::ZERO);
        for (copy, (place, material)) in places.iter().zip(palette.iter().cycle()).enumerate() {
            let transform = DMat4::from_translation(position) * *place * own;
            let name = if copy == 0 { name.clone() } else { format!("{name}, copy {copy}") };
            self.objects.push(Object { name, mesh, material: *material, transform, cross_fade, movement });
        }
        Some(())
    }
}

/// The fields of an entry, and how its unit shape is scaled (`None` if that is wrong).
fn extents<'s>(
    reader: &mut Reader,
    leaf: Leaf<'s>,
    shape: &str,
    rest: Option<Leaf<'s>>,
) -> Option<(ObjectFields<'s>, Option<DVec3>)> {
    if shape == "Sphere" {
        let form = "Sphere(material: \"…\", radius: 0.5)";
        let SphereFields { name, material, position, rotation, radius, repeat, cross_fade, velocity, spin } =
            reader.inside(leaf, rest, form)?;
        let extents = size(reader, radius, "the radius").map(|radius| DVec3::splat(2.0 * radius));
        let size = radius;
        let fields = ObjectFields { name, material, position, rotation, size, repeat, cross_fade, velocity, spin };
        return Some((fields, extents));
    }
    let plane = shape == "Plane";
    let form = if plane { "Plane(material: \"…\", size: (10, 10))" } else { "Cube(material: \"…\", size: 1)" };
    let fields: ObjectFields<'_> = reader.inside(leaf, rest, form)?;
    let extents = if plane {
        sizes::<2>(reader, fields.size, "(width, depth)").map(|[width, depth]| DVec3::new(width, 1.0, depth))
    } else {
        sizes::<3>(reader, fields.size, "(width, height, depth)").map(DVec3::from)
    };
    Some((fields, extents))
}

/// One material, or several that copies take by turns.
fn palette<'s>(reader: &mut Reader, leaf: Leaf<'s>, materials: &Names) -> Option<Vec<usize>> {
    let leaves = match leaf.shape() {
        Shape::List => reader.list(leaf, "`material`")?,
        _ => vec![leaf],
    };
    if leaves.is_empty() {
        reader.wrong(Code::SCENE_VALUE, leaf, "an object needs a material", "");
        return None;
    }
    let find = |leaf| {
        let name = reader.reference(leaf, "a material")?;
        materials.find(reader, &name)
    };
    let found: Vec<Option<usize>> = leaves.into_iter().map(find).collect();
    found.into_iter().collect()
}

fields! {
    struct GridFields<'s> {
        count: Leaf<'s>,
        step: Leaf<'s>,
    }
}

fields! {
    struct RingFields<'s> {
        count: Leaf<'s>,
        radius: Leaf<'s>,
        start: Option<Leaf<'s>>,
    }
}

/// The places of copies, relative to the object's position.
fn repeat<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Vec<DMat4>> {
    const GRID: &str = "Grid(count: (3, 1, 3), step: (2, 0, 2))";
    const RING: &str = "Ring(count: 12, radius: 4, start: 0)";
    let forms = format!("write `{GRID}` or `{RING}`");
    match reader.word(leaf, "a way to repeat", &["Grid", "Ring"], &forms)? {
        ("Grid", rest) => {
            let fields: GridFields<'_> = reader.inside(leaf, rest, GRID)?;
            let counts = counts::<3>(reader, fields.count, "(in x, in y, in z)", limits::OBJECTS as u32);
            let step = place(reader, fields.step, "the step")?;
            let counts = counts?;
            let copies: u64 = counts.iter().map(|count| u64::from(*count)).product();
            if copies > limits::OBJECTS as u64 {
                let message = format!("this grid has {copies} objects");
                reader.wrong(
                    Code::SCENE_TOO_LARGE,
                    fields.count,
                    message,
                    &format!("at most {} are allowed", limits::OBJECTS),
                );
                return None;
            }
            // Around the position: the middle of the grid is the object's own place.
            let middle = DVec3::from(counts.map(|count| f64::from(count - 1) * 0.5));
            let [x, y, z] = counts;
            let cells = (0..z).flat_map(|k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])));
            Some(
                cells.map(|cell| DMat4::from_translation((DVec3::from(cell.map(f64::from)) - middle) * step)).collect(),
            )
        }
        (_, rest) => {
            let fields: RingFields<'_> = reader.inside(leaf, rest, RING)?;
            let copies = count(reader, fields.count, "the count", 1, limits::OBJECTS as u32);
            let start = fields.start.map_or(Some(0.0), |leaf| number(reader, leaf, "the start", -360.0, 360.0));
            let radius = size(reader, fields.radius, "the radius")?;
            let (copies, start) = (copies?, start?.to_radians());
            let turn = |copy| DMat4::from_rotation_y(start + TAU * f64::from(copy) / f64::from(copies));
            Some((0..copies).map(|copy| turn(copy) * DMat4::from_translation(DVec3::Z * radius)).collect())
        }
    }
}
