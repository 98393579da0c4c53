//! Facts of a scene that pipeline files may ask for: one table of names, types, values and meanings.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Facts of a scene, named `scene.…` in pipeline files.
///
/// They say what a scene can show from any place and in any direction, so a camera may move without a new Plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// See [`Fact::HasOpaque`].
    pub has_opaque: bool,
    /// See [`Fact::HasAlphaClip`].
    pub has_alpha_clip: bool,
    /// See [`Fact::HasTransparent`].
    pub has_transparent: bool,
    /// See [`Fact::HasCrossFade`].
    pub has_cross_fade: bool,
    /// See [`Fact::CastsShadows`].
    pub casts_shadows: bool,
    /// See [`Fact::ShadowCascades`].
    pub shadow_cascades: u32,
    /// See [`Fact::PeakRadiance`].
    pub peak_radiance: f64,
    /// See [`Fact::Exposure`].
    pub exposure: f64,
    /// See [`Fact::Size`].
    pub size: f64,
    /// See [`Fact::Suns`].
    pub suns: u32,
    /// See [`Fact::PointLights`].
    pub point_lights: u32,
    /// See [`Fact::Objects`].
    pub objects: u32,
    /// See [`Fact::Triangles`].
    pub triangles: u64,
    /// The diameter of the box around all objects and cameras, divided by the least near distance of the cameras; at least 1. So
    /// it holds for a camera anywhere among them. `None`: not known. Formats of depth follow it; pipeline files have no name for it.
    pub depth_range: Option<f64>,
}

/// A fact of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Fact {
    /// Anything is drawn that hides all behind it.
    HasOpaque,
    /// Anything with holes that its alpha cuts is drawn.
    HasAlphaClip,
    /// Anything transparent is drawn.
    HasTransparent,
    /// Anything fades by leaving out fragments.
    HasCrossFade,
    /// Any light casts shadows, and there is something to cast them.
    CastsShadows,
    /// How many cascades the sun's shadows need: 0 where it casts none.
    ShadowCascades,
    /// The most radiance that a pixel can show before any effect, linear.
    PeakRadiance,
    /// What all light of the scene's file was multiplied by.
    Exposure,
    /// A length that is typical of the scene, metres.
    Size,
    /// How many suns shine.
    Suns,
    /// How many point lights shine.
    PointLights,
    /// How many lights of any kind shine.
    Lights,
    /// How many objects there are.
    Objects,
    /// How many triangles all objects have together.
    Triangles,
}

/// The type of a fact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FactType {
    /// True or false.
    Bool,
    /// A whole number, at least 0.
    Integer,
    /// A number.
    Number,
}

/// The value of a fact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FactValue {
    /// True or false.
    Bool(bool),
    /// A whole number, at least 0.
    Integer(i64),
    /// A finite number.
    Number(f64),
}

impl Fact {
    /// Every fact.
    pub const ALL: [Fact; 14] = [
        Fact::HasOpaque,
        Fact::HasAlphaClip,
        Fact::HasTransparent,
        Fact::HasCrossFade,
        Fact::CastsShadows,
        Fact::ShadowCascades,
        Fact::PeakRadiance,
        Fact::Exposure,
        Fact::Size,
        Fact::Suns,
        Fact::PointLights,
        Fact::Lights,
        Fact::Objects,
        Fact::Triangles,
    ];

    /// The name in pipeline files, type and meaning (a sentence without final stop).
    const fn row(self) -> (&'static str, FactType, &'static str) {
        use FactType::{Bool, Integer, Number};
        match self {
            Fact::HasOpaque => ("scene.has_opaque", Bool, "something is drawn that hides all behind it"),
            Fact::HasAlphaClip => ("scene.has_alpha_clip", Bool, "something is drawn whose alpha cuts holes"),
            Fact::HasTransparent => ("scene.has_transparent", Bool, "something is drawn that lets light through"),
            Fact::HasCrossFade => ("scene.has_cross_fade", Bool, "something fades by leaving out fragments"),
            Fact::CastsShadows => {
                ("scene.casts_shadows", Bool, "a light casts shadows, and something stands in its light")
            }
            Fact::ShadowCascades => (
                "scene.shadow_cascades",
                Integer,
                "how many cascades the sun's shadows need, as far as the scene goes: 0, 1, 2 or 4. With these, no texel of a map \
                 covers more of the picture than with four cascades in a scene of any depth",
            ),
            Fact::PeakRadiance => (
                "scene.peak_radiance",
                Number,
                "no pixel shows more than this before effects, from whatever place and in whatever direction; \
                 linear, 1 is a white surface in a sun of colour 1; at most 65504",
            ),
            Fact::Exposure => (
                "scene.exposure",
                Number,
                "what all light of the scene's file was multiplied by, so that a white surface in it shows about 1; \
                 1 where the file's own numbers are drawn",
            ),
            Fact::Size => (
                "scene.size",
                Number,
                "a length that is typical of the scene, metres: the geometric mean of the radius of the box around all objects \
                 and of the median radius of the boxes around each; 1 if there is nothing to measure. Effects of a certain width \
                 are made a share of it, so that a scene may be of any size",
            ),
            Fact::Suns => ("scene.suns", Integer, "how many suns shine: 0 or 1"),
            Fact::PointLights => ("scene.point_lights", Integer, "how many point lights shine"),
            Fact::Lights => ("scene.lights", Integer, "how many lights of any kind shine"),
            Fact::Objects => ("scene.objects", Integer, "how many objects there are, seen or not"),
            Fact::Triangles => ("scene.triangles", Integer, "how many triangles all objects have together"),
        }
    }

    /// The name in pipeline files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// The type.
    #[must_use]
    pub const fn ty(self) -> FactType {
        self.row().1
    }

    /// The meaning, without final stop.
    #[must_use]
    pub const fn about(self) -> &'static str {
        self.row().2
    }

    /// Whether it is a length or a factor: more than 0, and without a bound.
    #[must_use]
    pub const fn is_measure(self) -> bool {
        matches!(self, Fact::Exposure | Fact::Size)
    }
}

impl Facts {
    /// The facts of an unknown scene: it holds everything, and as much of it as a scene may.
    pub const UNKNOWN: Facts = Facts {
        has_opaque: true,
        has_alpha_clip: true,
        has_transparent: true,
        has_cross_fade: true,
        casts_shadows: true,
        shadow_cascades: 4,
        peak_radiance: 65504.0,
        exposure: 1.0,
        size: 1.0,
        suns: 1,
        point_lights: 4096,
        objects: 250_000,
        triangles: 4_194_304_000_000,
        depth_range: None,
    };

    /// The value of `fact`, of the type that [`Fact::ty`] says.
    #[must_use]
    pub const fn value(&self, fact: Fact) -> FactValue {
        match fact {
            Fact::HasOpaque => FactValue::Bool(self.has_opaque),
            Fact::HasAlphaClip => FactValue::Bool(self.has_alpha_clip),
            Fact::HasTransparent => FactValue::Bool(self.has_transparent),
            Fact::HasCrossFade => FactValue::Bool(self.has_cross_fade),
            Fact::CastsShadows => FactValue::Bool(self.casts_shadows),
            Fact::ShadowCascades => FactValue::Integer(self.shadow_cascades as i64),
            Fact::PeakRadiance => FactValue::Number(self.peak_radiance),
            Fact::Exposure => FactValue::Number(self.exposure),
            Fact::Size => FactValue::Number(self.size),
            Fact::Suns => FactValue::Integer(self.suns as i64),
            Fact::PointLights => FactValue::Integer(self.point_lights as i64),
            Fact::Lights => FactValue::Integer(self.suns as i64 + self.point_lights as i64),
            Fact::Objects => FactValue::Integer(self.objects as i64),
            Fact::Triangles if self.triangles > i64::MAX as u64 => FactValue::Integer(i64::MAX),
            Fact::Triangles => FactValue::Integer(self.triangles.cast_signed()),
        }
    }

    /// These facts with another value of `fact`. A value of another type than the fact's changes nothing; a count that is too
    /// large becomes the largest. If there are several [`Fact::Lights`], one is a sun.
    #[must_use]
    pub fn with(mut self, fact: Fact, value: FactValue) -> Facts {
        let count = |value: i64| u32::try_from(value.max(0)).unwrap_or(u32::MAX);
        match (fact, value) {
            (Fact::HasOpaque, FactValue::Bool(value)) => self.has_opaque = value,
            (Fact::HasAlphaClip, FactValue::Bool(value)) => self.has_alpha_clip = value,
            (Fact::HasTransparent, FactValue::Bool(value)) => self.has_transparent = value,
            (Fact::HasCrossFade, FactValue::Bool(value)) => self.has_cross_fade = value,
            (Fact::CastsShadows, FactValue::Bool(value)) => self.casts_shadows = value,
            (Fact::ShadowCascades, FactValue::Integer(value)) => self.shadow_cascades = count(value),
            (Fact::PeakRadiance, FactValue::Number(value)) => self.peak_radiance = value,
            (Fact::Exposure, FactValue::Number(value)) => self.exposure = value,
            (Fact::Size, FactValue::Number(value)) => self.size = value,
            (Fact::Suns, FactValue::Integer(value)) => self.suns = count(value),
            (Fact::PointLights, FactValue::Integer(value)) => self.point_lights = count(value),
            (Fact::Lights, FactValue::Integer(value)) => {
                self.suns = count(value.min(1));
                self.point_lights = count(value.saturating_sub(1));
            }
            (Fact::Objects, FactValue::Integer(value)) => self.objects = count(value),
            (Fact::Triangles, FactValue::Integer(value)) => self.triangles = value.max(0).cast_unsigned(),
            _ => {}
        }
        self
    }

    /// Whether `fact`, which is true or false, holds.
    #[must_use]
    pub const fn holds(&self, fact: Fact) -> bool {
        matches!(self.value(fact), FactValue::Bool(true))
    }
}

impl FactValue {
    /// The type.
    #[must_use]
    pub const fn ty(self) -> FactType {
        match self {
            FactValue::Bool(_) => FactType::Bool,
            FactValue::Integer(_) => FactType::Integer,
            FactValue::Number(_) => FactType::Number,
        }
    }
}

impl fmt::Display for FactValue {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FactValue::Bool(value) => value.fmt(out),
            FactValue::Integer(value) => value.fmt(out),
            FactValue::Number(value) => value.fmt(out),
        }
    }
}

impl fmt::Display for FactType {
    /// As settings are declared.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            FactType::Bool => "Bool",
            FactType::Integer => "Integer",
            FactType::Number => "Number",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fact_can_be_changed_by_itself() {
        for fact in Fact::ALL {
            let value = match fact.ty() {
                FactType::Bool => FactValue::Bool(false),
                FactType::Integer => FactValue::Integer(0),
                FactType::Number => FactValue::Number(0.25),
            };
            let changed = Facts::UNKNOWN.with(fact, value);
            assert_eq!(changed.value(fact), value, "{}", fact.name());
            let follows = |other: Fact| {
                let lights = [Fact::Suns, Fact::PointLights, Fact::Lights];
                other == fact || lights.contains(&other) && lights.contains(&fact)
            };
            let kept = Fact::ALL.into_iter().filter(|other| !follows(*other));
            assert!(
                kept.into_iter().all(|other| changed.value(other) == Facts::UNKNOWN.value(other)),
                "{}",
                fact.name()
            );
        }
    }

    #[test]
    fn every_fact_has_the_type_that_the_table_says_and_a_name_of_its_own() {
        for (number, fact) in Fact::ALL.into_iter().enumerate() {
            assert_eq!(Facts::UNKNOWN.value(fact).ty(), fact.ty(), "{}", fact.name());
            assert!(fact.name().starts_with("scene.") && !fact.about().ends_with('.'), "{}", fact.name());
            assert!(Fact::ALL[..number].iter().all(|other| other.name() != fact.name()), "{}", fact.name());
        }
    }
}
