//! Formats of vertex attributes by Vulkan's names.

use super::Component;
use serde::{Deserialize, Serialize};
use std::fmt;

macro_rules! support {
    (everywhere) => {
        true
    };
    (somewhere) => {
        false
    };
}

macro_rules! formats {
    ($($name:ident = $vulkan:literal, $bytes:literal bytes by $aligned:literal, $components:literal x $kind:ident, $support:ident;)*) => {
        /// The format of a vertex attribute (`VkFormat`, without its prefix).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[allow(non_camel_case_types, reason = "the names are Vulkan's")]
        pub enum VertexFormat { $(#[doc = concat!("`VK_FORMAT_", stringify!($name), "`")] $name,)* }

        impl VertexFormat {
            /// All of them, by name.
            pub const NAMED: &'static [(&'static str, VertexFormat)] = &[$((stringify!($name), VertexFormat::$name),)*];

            /// Vulkan's name, without `VK_FORMAT_`.
            #[must_use]
            pub const fn name(self) -> &'static str { match self { $(VertexFormat::$name => stringify!($name),)* } }

            /// The value of the `VkFormat` enumerant.
            #[must_use]
            pub const fn vulkan(self) -> i32 { match self { $(VertexFormat::$name => $vulkan,)* } }

            /// Bytes that an attribute takes.
            #[must_use]
            pub const fn bytes(self) -> u32 { match self { $(VertexFormat::$name => $bytes,)* } }

            /// The bytes of which its place in a buffer is a multiple: those of a component, of a packed format all.
            #[must_use]
            pub const fn alignment(self) -> u32 { match self { $(VertexFormat::$name => $aligned,)* } }

            /// Number of components.
            #[must_use]
            pub const fn components(self) -> u32 { match self { $(VertexFormat::$name => $components,)* } }

            /// The type of a component as shaders read it. Normalized and scaled numbers are floating point.
            #[must_use]
            pub const fn component(self) -> Component { match self { $(VertexFormat::$name => Component::$kind,)* } }

            /// Whether Vulkan demands of every device that it reads vertices of this format.
            #[must_use]
            pub const fn is_on_every_device(self) -> bool { match self { $(VertexFormat::$name => support!($support),)* } }
        }
    };
}

formats! {
    R8_UNORM = 9, 1 bytes by 1, 1 x Float, everywhere;
    R8_SNORM = 10, 1 bytes by 1, 1 x Float, everywhere;
    R8_USCALED = 11, 1 bytes by 1, 1 x Float, somewhere;
    R8_SSCALED = 12, 1 bytes by 1, 1 x Float, somewhere;
    R8_UINT = 13, 1 bytes by 1, 1 x Uint, everywhere;
    R8_SINT = 14, 1 bytes by 1, 1 x Int, everywhere;
    R8G8_UNORM = 16, 2 bytes by 1, 2 x Float, everywhere;
    R8G8_SNORM = 17, 2 bytes by 1, 2 x Float, everywhere;
    R8G8_USCALED = 18, 2 bytes by 1, 2 x Float, somewhere;
    R8G8_SSCALED = 19, 2 bytes by 1, 2 x Float, somewhere;
    R8G8_UINT = 20, 2 bytes by 1, 2 x Uint, everywhere;
    R8G8_SINT = 21, 2 bytes by 1, 2 x Int, everywhere;
    R8G8B8_UNORM = 23, 3 bytes by 1, 3 x Float, somewhere;
    R8G8B8_SNORM = 24, 3 bytes by 1, 3 x Float, somewhere;
    R8G8B8_USCALED = 25, 3 bytes by 1, 3 x Float, somewhere;
    R8G8B8_SSCALED = 26, 3 bytes by 1, 3 x Float, somewhere;
    R8G8B8_UINT = 27, 3 bytes by 1, 3 x Uint, somewhere;
    R8G8B8_SINT = 28, 3 bytes by 1, 3 x Int, somewhere;
    B8G8R8_UNORM = 30, 3 bytes by 1, 3 x Float, somewhere;
    B8G8R8_SNORM = 31, 3 bytes by 1, 3 x Float, somewhere;
    B8G8R8_USCALED = 32, 3 bytes by 1, 3 x Float, somewhere;
    B8G8R8_SSCALED = 33, 3 bytes by 1, 3 x Float, somewhere;
    B8G8R8_UINT = 34, 3 bytes by 1, 3 x Uint, somewhere;
    B8G8R8_SINT = 35, 3 bytes by 1, 3 x Int, somewhere;
    R8G8B8A8_UNORM = 37, 4 bytes by 1, 4 x Float, everywhere;
    R8G8B8A8_SNORM = 38, 4 bytes by 1, 4 x Float, everywhere;
    R8G8B8A8_USCALED = 39, 4 bytes by 1, 4 x Float, somewhere;
    R8G8B8A8_SSCALED = 40, 4 bytes by 1, 4 x Float, somewhere;
    R8G8B8A8_UINT = 41, 4 bytes by 1, 4 x Uint, everywhere;
    R8G8B8A8_SINT = 42, 4 bytes by 1, 4 x Int, everywhere;
    B8G8R8A8_UNORM = 44, 4 bytes by 1, 4 x Float, everywhere;
    B8G8R8A8_SNORM = 45, 4 bytes by 1, 4 x Float, somewhere;
    B8G8R8A8_USCALED = 46, 4 bytes by 1, 4 x Float, somewhere;
    B8G8R8A8_SSCALED = 47, 4 bytes by 1, 4 x Float, somewhere;
    B8G8R8A8_UINT = 48, 4 bytes by 1, 4 x Uint, somewhere;
    B8G8R8A8_SINT = 49, 4 bytes by 1, 4 x Int, somewhere;
    A8B8G8R8_UNORM_PACK32 = 51, 4 bytes by 4, 4 x Float, everywhere;
    A8B8G8R8_SNORM_PACK32 = 52, 4 bytes by 4, 4 x Float, everywhere;
    A8B8G8R8_USCALED_PACK32 = 53, 4 bytes by 4, 4 x Float, somewhere;
    A8B8G8R8_SSCALED_PACK32 = 54, 4 bytes by 4, 4 x Float, somewhere;
    A8B8G8R8_UINT_PACK32 = 55, 4 bytes by 4, 4 x Uint, everywhere;
    A8B8G8R8_SINT_PACK32 = 56, 4 bytes by 4, 4 x Int, everywhere;
    A2R10G10B10_UNORM_PACK32 = 58, 4 bytes by 4, 4 x Float, somewhere;
    A2R10G10B10_SNORM_PACK32 = 59, 4 bytes by 4, 4 x Float, somewhere;
    A2R10G10B10_USCALED_PACK32 = 60, 4 bytes by 4, 4 x Float, somewhere;
    A2R10G10B10_SSCALED_PACK32 = 61, 4 bytes by 4, 4 x Float, somewhere;
    A2R10G10B10_UINT_PACK32 = 62, 4 bytes by 4, 4 x Uint, somewhere;
    A2R10G10B10_SINT_PACK32 = 63, 4 bytes by 4, 4 x Int, somewhere;
    A2B10G10R10_UNORM_PACK32 = 64, 4 bytes by 4, 4 x Float, everywhere;
    A2B10G10R10_SNORM_PACK32 = 65, 4 bytes by 4, 4 x Float, somewhere;
    A2B10G10R10_USCALED_PACK32 = 66, 4 bytes by 4, 4 x Float, somewhere;
    A2B10G10R10_SSCALED_PACK32 = 67, 4 bytes by 4, 4 x Float, somewhere;
    A2B10G10R10_UINT_PACK32 = 68, 4 bytes by 4, 4 x Uint, somewhere;
    A2B10G10R10_SINT_PACK32 = 69, 4 bytes by 4, 4 x Int, somewhere;
    R16_UNORM = 70, 2 bytes by 2, 1 x Float, everywhere;
    R16_SNORM = 71, 2 bytes by 2, 1 x Float, everywhere;
    R16_USCALED = 72, 2 bytes by 2, 1 x Float, somewhere;
    R16_SSCALED = 73, 2 bytes by 2, 1 x Float, somewhere;
    R16_UINT = 74, 2 bytes by 2, 1 x Uint, everywhere;
    R16_SINT = 75, 2 bytes by 2, 1 x Int, everywhere;
    R16_SFLOAT = 76, 2 bytes by 2, 1 x Float, everywhere;
    R16G16_UNORM = 77, 4 bytes by 2, 2 x Float, everywhere;
    R16G16_SNORM = 78, 4 bytes by 2, 2 x Float, everywhere;
    R16G16_USCALED = 79, 4 bytes by 2, 2 x Float, somewhere;
    R16G16_SSCALED = 80, 4 bytes by 2, 2 x Float, somewhere;
    R16G16_UINT = 81, 4 bytes by 2, 2 x Uint, everywhere;
    R16G16_SINT = 82, 4 bytes by 2, 2 x Int, everywhere;
    R16G16_SFLOAT = 83, 4 bytes by 2, 2 x Float, everywhere;
    R16G16B16_UNORM = 84, 6 bytes by 2, 3 x Float, somewhere;
    R16G16B16_SNORM = 85, 6 bytes by 2, 3 x Float, somewhere;
    R16G16B16_USCALED = 86, 6 bytes by 2, 3 x Float, somewhere;
    R16G16B16_SSCALED = 87, 6 bytes by 2, 3 x Float, somewhere;
    R16G16B16_UINT = 88, 6 bytes by 2, 3 x Uint, somewhere;
    R16G16B16_SINT = 89, 6 bytes by 2, 3 x Int, somewhere;
    R16G16B16_SFLOAT = 90, 6 bytes by 2, 3 x Float, somewhere;
    R16G16B16A16_UNORM = 91, 8 bytes by 2, 4 x Float, everywhere;
    R16G16B16A16_SNORM = 92, 8 bytes by 2, 4 x Float, everywhere;
    R16G16B16A16_USCALED = 93, 8 bytes by 2, 4 x Float, somewhere;
    R16G16B16A16_SSCALED = 94, 8 bytes by 2, 4 x Float, somewhere;
    R16G16B16A16_UINT = 95, 8 bytes by 2, 4 x Uint, everywhere;
    R16G16B16A16_SINT = 96, 8 bytes by 2, 4 x Int, everywhere;
    R16G16B16A16_SFLOAT = 97, 8 bytes by 2, 4 x Float, everywhere;
    R32_UINT = 98, 4 bytes by 4, 1 x Uint, everywhere;
    R32_SINT = 99, 4 bytes by 4, 1 x Int, everywhere;
    R32_SFLOAT = 100, 4 bytes by 4, 1 x Float, everywhere;
    R32G32_UINT = 101, 8 bytes by 4, 2 x Uint, everywhere;
    R32G32_SINT = 102, 8 bytes by 4, 2 x Int, everywhere;
    R32G32_SFLOAT = 103, 8 bytes by 4, 2 x Float, everywhere;
    R32G32B32_UINT = 104, 12 bytes by 4, 3 x Uint, everywhere;
    R32G32B32_SINT = 105, 12 bytes by 4, 3 x Int, everywhere;
    R32G32B32_SFLOAT = 106, 12 bytes by 4, 3 x Float, everywhere;
    R32G32B32A32_UINT = 107, 16 bytes by 4, 4 x Uint, everywhere;
    R32G32B32A32_SINT = 108, 16 bytes by 4, 4 x Int, everywhere;
    R32G32B32A32_SFLOAT = 109, 16 bytes by 4, 4 x Float, everywhere;
    B10G11R11_UFLOAT_PACK32 = 122, 4 bytes by 4, 3 x Float, somewhere;
}

impl VertexFormat {
    /// 32-bit floats, by the number of their components less one.
    const FLOATS: [VertexFormat; 4] = [
        VertexFormat::R32_SFLOAT,
        VertexFormat::R32G32_SFLOAT,
        VertexFormat::R32G32B32_SFLOAT,
        VertexFormat::R32G32B32A32_SFLOAT,
    ];

    /// The format of 1 to 4 components of 32-bit floats; `None` of other numbers.
    #[must_use]
    pub const fn floats(components: u32) -> Option<VertexFormat> {
        match components {
            1..=4 => Some(VertexFormat::FLOATS[components as usize - 1]),
            _ => None,
        }
    }

    /// Whether its components are 32-bit floats.
    #[must_use]
    pub fn is_floats(self) -> bool {
        VertexFormat::FLOATS.contains(&self)
    }
}

impl fmt::Display for VertexFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::Format;

    #[test]
    fn formats_that_images_have_too_are_the_same_there() {
        let mut found = 0;
        for (name, vertex) in VertexFormat::NAMED {
            let Some(image) = Format::ALL.iter().find(|format| format.name() == *name) else { continue };
            assert_eq!(vertex.vulkan(), image.vulkan(), "{name}");
            assert_eq!(u64::from(vertex.bytes()), image.texel_bytes(), "{name}");
            assert_eq!(vertex.components(), image.components(), "{name}");
            assert_eq!(vertex.component(), Component::of(*image), "{name}");
            found += 1;
        }
        assert!(found > 30, "{found}");
    }

    #[test]
    fn a_format_is_as_long_as_its_name_says() {
        for (name, format) in VertexFormat::NAMED {
            let channels = name.split('_').next().unwrap_or_default();
            let numbers =
                channels.split(|letter: char| letter.is_ascii_alphabetic()).filter_map(|it| it.parse::<u32>().ok());
            assert_eq!(numbers.clone().sum::<u32>(), 8 * format.bytes(), "{name}");
            assert_eq!(numbers.count(), format.components() as usize, "{name}");
        }
    }
}
