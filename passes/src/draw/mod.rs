//! What a draw brings along, and the draw source that draws a scene.

mod interface;

pub use interface::{
    BASE_COLOR_TEXTURE_BINDING, FRAME_SET, LIGHTS_BINDING, MATERIAL_SET, OBJECTS_BINDING, VIEW_BINDING, interface,
};
