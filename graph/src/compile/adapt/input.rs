//! The input of `adapt`.

use crate::compile::cull::Live;
use crate::compile::model::Negotiated;
use crate::compile::options::Options;
use crate::device::Profile;
use crate::frame::Frame;
use crate::frame::tracked::Grids;

/// The frame, and what the stages before found out.
#[derive(Clone, Copy)]
pub(crate) struct Input<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) grids: &'a Grids,
    pub(crate) live: &'a Live,
    pub(crate) negotiated: &'a Negotiated,
    pub(crate) device: &'a Profile,
    pub(crate) options: &'a Options,
}
