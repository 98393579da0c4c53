//! The materials of a scene file.

use super::values::{color, counts, number, web_color};
use crate::scene::limits;
use crate::scene::model::{AlphaMode, Material, Texture};
use crate::scene::pattern::{MOST_CELLS, Pattern, PatternKind};
use framewright_graph::base::Code;
use framewright_graph::fields;
use framewright_graph::ron::{Leaf, Reader};

fields! {
    pub(super) struct MaterialFields<'s> {
        pub(super) name: Leaf<'s>,
        color: Option<Leaf<'s>>,
        opacity: Option<Leaf<'s>>,
        texture: Option<Leaf<'s>>,
        emissive: Option<Leaf<'s>>,
        strength: Option<Leaf<'s>>,
        alpha: Option<Leaf<'s>>,
        double_sided: Option<Leaf<'s>>,
    }
}

/// Textures, each pattern once.
#[derive(Default)]
pub(super) struct Patterns {
    pub(super) textures: Vec<Texture>,
    known: Vec<Pattern>,
    bytes: u64,
}

impl Patterns {
    /// The place of a pattern's texture in the list; a mistake at `leaf` if the textures grow too large.
    fn place<'s>(&mut self, reader: &mut Reader, leaf: Leaf<'s>, pattern: Pattern, name: &str) -> Option<usize> {
        if let Some(place) = self.known.iter().position(|known| *known == pattern) {
            return Some(place);
        }
        self.bytes += pattern.bytes();
        if self.bytes > limits::TEXTURE_BYTES {
            let help = format!("together they may take {} bytes", limits::TEXTURE_BYTES);
            reader.wrong(Code::SCENE_TOO_LARGE, leaf, "with this one the textures are too large", &help);
            return None;
        }
        self.known.push(pattern);
        self.textures.push(pattern.texture(name.to_owned()));
        Some(self.textures.len() - 1)
    }
}

/// A material; `None` if mistakes were reported. Every field is read, even if another one is wrong.
pub(super) fn lower<'s>(reader: &mut Reader, fields: &MaterialFields<'s>, patterns: &mut Patterns) -> Option<Material> {
    let name = reader.reference(fields.name, "a material");
    let color = fields.color.map_or(Some([1.0; 3]), |leaf| color(reader, leaf, "the colour", 1.0));
    let opacity = fields.opacity.map_or(Some(1.0), |leaf| number(reader, leaf, "the opacity", 0.0, 1.0));
    let pattern = fields.texture.map_or(Some(None), |leaf| pattern(reader, leaf).map(|pattern| Some((leaf, pattern))));
    let emissive = fields.emissive.map_or(Some([0.0; 3]), |leaf| self::color(reader, leaf, "the emissive colour", 1.0));
    let strength =
        fields.strength.map_or(Some(1.0), |leaf| number(reader, leaf, "the strength", 0.0, limits::RADIANCE));
    let alpha = fields.alpha.map_or(Some(AlphaMode::Opaque), |leaf| alpha(reader, leaf));
    let double_sided = fields.double_sided.map_or(Some(false), |leaf| reader.truth(leaf));
    let name = name?.text.to_string();
    let [r, g, b] = color?;
    let base_color_texture = match pattern? {
        Some((leaf, pattern)) => Some(patterns.place(reader, leaf, pattern, &name)?),
        None => None,
    };
    let (opacity, strength) = (opacity? as f32, strength? as f32);
    Some(Material {
        base_color: [r, g, b, opacity],
        base_color_texture,
        emissive: emissive?.map(|part| part * strength),
        alpha: alpha?,
        double_sided: double_sided?,
        name,
    })
}

fn alpha<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<AlphaMode> {
    let forms = "write `Opaque`, `Mask(0.5)` or `Blend`";
    match reader.word(leaf, "what alpha does", &["Opaque", "Mask", "Blend"], forms)? {
        ("Mask", rest) => {
            let [cutoff] = reader.inside::<[Leaf<'_>; 1]>(leaf, rest, "Mask(0.5)")?;
            Some(AlphaMode::Mask { cutoff: number(reader, cutoff, "the cut-off", 0.0, 1.0)? as f32 })
        }
        (word, rest) => {
            reader.bare(word, rest)?;
            Some(if word == "Blend" { AlphaMode::Blend } else { AlphaMode::Opaque })
        }
    }
}

fields! {
    struct CheckerFields<'s> {
        count: Leaf<'s>,
        colors: Leaf<'s>,
    }
}

fields! {
    struct DotsFields<'s> {
        count: Leaf<'s>,
        radius: Leaf<'s>,
    }
}

fn pattern<'s>(reader: &mut Reader, leaf: Leaf<'s>) -> Option<Pattern> {
    const CHECKER: &str = "Checker(count: (8, 8), colors: (\"#ffffff\", \"#808080\"))";
    const DOTS: &str = "Dots(count: (8, 8), radius: 0.3)";
    let forms = format!("write `{CHECKER}` or `{DOTS}`");
    let cells = |reader: &mut Reader, leaf| counts::<2>(reader, leaf, "(across, down)", MOST_CELLS);
    match reader.word(leaf, "a texture", &["Checker", "Dots"], &forms)? {
        ("Checker", rest) => {
            let fields: CheckerFields<'_> = reader.inside(leaf, rest, CHECKER)?;
            let colors: Option<[Leaf<'_>; 2]> = reader.read(fields.colors, "`colors`");
            let cells = cells(reader, fields.count);
            let [one, other] = colors?.map(|leaf| web_color(reader, leaf, "the colour"));
            Some(Pattern { kind: PatternKind::Checker([one?, other?]), cells: cells? })
        }
        (_, rest) => {
            let fields: DotsFields<'_> = reader.inside(leaf, rest, DOTS)?;
            let cells = cells(reader, fields.count);
            let radius = number(reader, fields.radius, "the radius", 0.01, 0.7)?;
            Some(Pattern { kind: PatternKind::Dots(radius), cells: cells? })
        }
    }
}
