//! The draw interface, and the draw source that draws a scene.

mod block;
pub mod cascades;
pub mod clusters;
mod eyes;
mod frame_data;
pub mod frustum;
mod geometry;
mod interface;
mod lists;
mod source;
mod textures;
mod view_buffers;
mod view_draws;

pub use eyes::{EyeSight, Eyes};
pub use interface::{
    BASE_COLOR_TEXTURE_BINDING, CASCADES_BINDING, CLUSTERS_BINDING, FRAME_SET, LIGHTS_BINDING, MATERIAL_SET,
    MOTION_BINDING, OBJECTS_BINDING, VIEW_BINDING, interface, interfaces,
};
pub use lists::{draw_order, draw_order_from};
pub use source::{MOST_POINT_LIGHTS, SceneDrawSource};
