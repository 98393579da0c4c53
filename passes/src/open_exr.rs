//! Pictures of OpenEXR files: which of their channels are colours, and their texels.

use exr::image::read::specific_channels::ReadSpecificChannel;
use exr::meta::attribute::{ChannelDescription, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::{MetaData, ReadChannels, ReadLayers, Vec2, read};
use std::io::{BufRead, Seek, SeekFrom};

/// The picture in a file, not yet decoded.
pub struct OpenExr<R> {
    file: R,
    /// Width and height of what is shown of it.
    pub extent: [u32; 2],
    /// The largest number of texels of a part of the file.
    pub stored: u64,
    /// Channels beside those that are read, without alpha, and other parts of the file, in words.
    pub left_out: Vec<String>,
    /// Whether a channel that is read holds integers.
    pub integers: bool,
    /// Where the first texel that is stored lies in what is shown.
    offset: [i64; 2],
    channels: Channels,
}

/// What the channels of a file stand for.
#[derive(Debug, Clone, PartialEq)]
enum Channels {
    /// Red, green, blue, and alpha if it is there.
    Colors,
    /// Red and green.
    RedGreen,
    /// One value, which all three colours get; and alpha if it is there.
    Grey(Text),
}

/// Names that no channel has.
const ABSENT: [&str; 2] = ["(absent 1)", "(absent 2)"];

impl<R: BufRead + Seek> OpenExr<R> {
    /// Looks at a file's headers. The first part with colours counts; where none has colours, the first part that can be
    /// read.
    ///
    /// # Errors
    /// In words: the file is damaged, or has no channels that are colours.
    pub fn open(mut file: R) -> Result<OpenExr<R>, String> {
        let headers = MetaData::read_from_buffered(&mut file, false).map_err(|error| error.to_string())?.headers;
        let flat = || headers.iter().filter(|header| !header.deep);
        let readable = || flat().filter_map(|header| Some((header, Channels::of(header)?)));
        let found = readable().find(|(_, channels)| channels.are_colors()).or_else(|| readable().next());
        let Some((header, channels)) = found else {
            let channels: Vec<_> = flat().flat_map(|header| &header.channels.list).collect();
            let is_sparse = |channel: &&ChannelDescription| channel.sampling != Vec2(1, 1) || is_chroma(channel);
            if channels.iter().any(is_sparse) {
                return Err(
                    "it holds luminance and chroma, or fewer values than texels: save it as R, G and B".to_owned()
                );
            }
            let names = channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>().join(", ");
            let names = if names.is_empty() { "none" } else { &names };
            return Err(format!(
                "its channels are {names}: R, G and B are read, R and G, Y, and one channel of any name, each with A or without"
            ));
        };
        let shown = header.shared_attributes.display_window;
        let stored = flat().map(|header| header.layer_size.area() as u64).max().unwrap_or(0);
        let position = header.own_attributes.layer_position;
        let offset = [position.x(), position.y()].map(i64::from);
        let from = [shown.position.x(), shown.position.y()].map(i64::from);
        let read = header.channels.list.iter().filter(|channel| channels.reads(channel));
        let integers = read.clone().any(|channel| channel.sample_type == SampleType::U32);
        let others = header.channels.list.iter().filter(|channel| !channels.reads(channel) && !channel.name.eq("A"));
        let mut left_out: Vec<String> = others.map(|channel| format!("channel {}", channel.name)).collect();
        if headers.len() > 1 {
            left_out.push(format!("{} of {} layers", headers.len() - 1, headers.len()));
        }
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        Ok(OpenExr {
            extent: [side(shown.size.width()), side(shown.size.height())],
            stored,
            offset: [offset[0] - from[0], offset[1] - from[1]],
            channels,
            left_out,
            integers,
            file,
        })
    }

    /// Whether it holds colours or greys, and not depth or other values.
    #[must_use]
    pub fn is_color(&self) -> bool {
        self.channels.are_colors()
    }

    /// Red, green, blue and alpha of each texel that is shown, in rows from the top. What isn't stored is 0.
    ///
    /// # Errors
    /// In words: the file is damaged.
    pub fn texels(mut self) -> Result<Vec<f32>, String> {
        self.file.seek(SeekFrom::Start(0)).map_err(|error| error.to_string())?;
        let [first, second, third] = match &self.channels {
            Channels::Colors => ["R", "G", "B"].map(Text::from),
            Channels::RedGreen => ["R", "G", ABSENT[0]].map(Text::from),
            Channels::Grey(name) => [name.clone(), ABSENT[0].into(), ABSENT[1].into()],
        };
        let alpha = match &self.channels {
            Channels::Grey(name) if name.eq("A") => "(absent 3)",
            _ => "A",
        };
        let is_grey = matches!(self.channels, Channels::Grey(_));
        let ([width, height], [left, top]) = (self.extent, self.offset);
        let components = width as usize * height as usize * 4;
        let place = move |at: Vec2<usize>| {
            let [x, y] = [at.x() as i64 + left, at.y() as i64 + top];
            let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
            inside.then(|| (y as usize * width as usize + x as usize) * 4)
        };
        let set = move |texels: &mut Vec<f32>, at: Vec2<usize>, (one, two, three, alpha): (f32, f32, f32, f32)| {
            if let Some(place) = place(at) {
                let color = if is_grey { [one, one, one, alpha] } else { [one, two, three, alpha] };
                texels[place..place + 4].copy_from_slice(&color);
            }
        };
        let picture = read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required(first)
            .optional(second, 0.0_f32)
            .optional(third, 0.0_f32)
            .optional(alpha, 1.0_f32)
            .collect_pixels(move |_, _| vec![0.0_f32; components], set)
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(&mut self.file)
            .map_err(|error| error.to_string())?;
        Ok(picture.layer_data.channel_data.pixels)
    }
}

impl Channels {
    /// What the channels of a part stand for; `None`: no picture.
    fn of(header: &Header) -> Option<Channels> {
        let list = &header.channels.list;
        let has = |name: &str| list.iter().any(|channel| channel.name.eq(name));
        if list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
            return None;
        }
        let others: Vec<_> = list.iter().filter(|channel| !channel.name.eq("A")).collect();
        match &others[..] {
            _ if has("R") && has("G") && has("B") => Some(Channels::Colors),
            _ if has("Y") && !list.iter().any(is_chroma) => Some(Channels::Grey("Y".into())),
            [_, _] if has("R") && has("G") => Some(Channels::RedGreen),
            [only] => Some(Channels::Grey(only.name.clone())),
            [] => list.first().map(|alpha| Channels::Grey(alpha.name.clone())),
            _ => None,
        }
    }

    /// Whether they are colours or greys, and not depth or other values.
    fn are_colors(&self) -> bool {
        match self {
            Channels::Colors | Channels::RedGreen => true,
            Channels::Grey(name) => name.eq("Y"),
        }
    }

    /// Whether a channel is one of them, alpha left aside.
    fn reads(&self, channel: &ChannelDescription) -> bool {
        let is = |names: &[&str]| names.iter().any(|name| channel.name.eq(name));
        match self {
            Channels::Colors => is(&["R", "G", "B"]),
            Channels::RedGreen => is(&["R", "G"]),
            Channels::Grey(name) => channel.name == *name,
        }
    }
}

/// Whether a channel holds a colour's difference from luminance.
fn is_chroma(channel: &ChannelDescription) -> bool {
    channel.name.eq("RY") || channel.name.eq("BY")
}
