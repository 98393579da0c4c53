//! Texture files of tests: KTX2 and DDS, written in the fewest bytes.

/// What a KTX2 file says of itself.
#[derive(Debug, Clone, Copy)]
pub struct Ktx2 {
    /// The number of a `VkFormat`.
    pub format: i32,
    /// Width, height and depth; 0 where there is none.
    pub extent: [u32; 3],
    /// Layers of an array; 0: it is none.
    pub layers: u32,
    /// 1, or 6 of a cube.
    pub faces: u32,
    /// The number of the supercompression.
    pub packing: u32,
    /// The number of the colour model in the data format descriptor.
    pub model: u8,
}

impl Ktx2 {
    /// A flat texture.
    #[must_use]
    pub const fn flat(format: i32, [width, height]: [u32; 2]) -> Ktx2 {
        Ktx2 { format, extent: [width, height, 0], layers: 0, faces: 1, packing: 0, model: 1 }
    }

    /// The file, with the bytes of each mip level, the largest first, and how many they are when they are unpacked.
    #[must_use]
    pub fn with_levels(&self, levels: &[(Vec<u8>, usize)]) -> Vec<u8> {
        const DESCRIPTOR: u32 = 44;
        let after_index = 80 + 24 * levels.len() as u32;
        let words = [
            self.format.cast_unsigned(),
            1,
            self.extent[0],
            self.extent[1],
            self.extent[2],
            self.layers,
            self.faces,
            levels.len() as u32,
            self.packing,
            after_index,
            DESCRIPTOR,
            0,
            0,
            0,
            0,
            0,
            0,
        ];
        let mut file = b"\xABKTX 20\xBB\r\n\x1A\n".to_vec();
        file.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        let mut offset = u64::from(after_index + DESCRIPTOR);
        for (bytes, unpacked) in levels {
            let index = [offset, bytes.len() as u64, *unpacked as u64];
            file.extend(index.iter().flat_map(|word| word.to_le_bytes()));
            offset += bytes.len() as u64;
        }
        file.extend([DESCRIPTOR, 0, 40 << 16 | 2].iter().flat_map(|word| word.to_le_bytes()));
        file.extend([self.model, 1, 1]);
        file.resize((after_index + DESCRIPTOR) as usize, 0);
        levels.iter().for_each(|(bytes, _)| file.extend(bytes));
        file
    }

    /// The file of levels that aren't packed.
    #[must_use]
    pub fn plain(&self, levels: &[Vec<u8>]) -> Vec<u8> {
        let levels: Vec<_> = levels.iter().map(|bytes| (bytes.clone(), bytes.len())).collect();
        self.with_levels(&levels)
    }
}

/// What a DDS file says of itself.
#[derive(Debug, Clone, Copy)]
pub struct Dds {
    /// Width, height and depth.
    pub extent: [u32; 3],
    /// Mip levels.
    pub mips: u32,
    /// Elements of an array, each of six faces if it is of cubes.
    pub elements: u32,
    /// Whether it holds cubes.
    pub cube: bool,
    /// Its texels.
    pub texels: DdsTexels,
}

/// How a DDS file names its texels.
#[derive(Debug, Clone, Copy)]
pub enum DdsTexels {
    /// By a number of DXGI's, in a DX10 header.
    Dxgi(u32),
    /// By four letters.
    Letters([u8; 4]),
    /// By bits of a texel, and the masks of red, green, blue and alpha.
    Masks([u32; 5]),
}

impl Dds {
    /// The file with these texels, layer after layer.
    #[must_use]
    pub fn with(&self, texels: &[u8]) -> Vec<u8> {
        let [width, height, depth] = self.extent;
        let (flags, letters, masks) = match self.texels {
            DdsTexels::Dxgi(_) => (4, *b"DX10", [0; 5]),
            DdsTexels::Letters(letters) => (4, letters, [0; 5]),
            DdsTexels::Masks(masks) => (0x40 | u32::from(masks[4] != 0), [0; 4], masks),
        };
        let deep = u32::from(depth > 1);
        let mut words = vec![124, 0x0002_1007 | deep << 23, height, width, 0, depth, self.mips];
        words.extend([0; 11]);
        words.extend([32, flags, u32::from_le_bytes(letters)]);
        words.extend(masks);
        let caps2 = if self.cube { 0xFE00 } else { deep << 21 };
        words.extend([0x1000, caps2, 0, 0, 0]);
        if let DdsTexels::Dxgi(number) = self.texels {
            words.extend([number, 3 + deep, u32::from(self.cube) << 2, self.elements, 0]);
        }
        let mut file = b"DDS ".to_vec();
        file.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        file.extend(texels);
        file
    }
}
