//! The view that an entry is for.

use super::lower::{Lowering, Place};
use crate::frame::ViewIndex;
use crate::language::entries::body::Body;
use crate::language::model::Off;
use crate::ron::{Leaf, Reader};

impl<'t> Lowering<'_, 't> {
    /// The view that an entry names, else the one that everything here is for.
    pub(crate) fn view(
        &self,
        reader: &mut Reader,
        body: &Body<'t>,
        place: &Place,
        leaf: Option<Leaf<'t>>,
    ) -> Option<ViewIndex> {
        match leaf {
            None => Some(place.view),
            Some(leaf) if body.known.settings => self.views.find(reader, leaf),
            Some(leaf) => {
                let help = "leave it out; the use of the fragment may have a `view`";
                reader.wrong(leaf, "all that a fragment makes is for the view of its use", help);
                None
            }
        }
    }

    /// Width and height of a view.
    pub(crate) fn extent(&self, view: ViewIndex) -> [u32; 2] {
        self.views.seen(view).map_or(self.surroundings.extent, |seen| seen.surroundings.extent)
    }

    /// Why something is off, and in which view.
    pub(crate) fn off_within(&self, view: ViewIndex, off: Option<Off>) -> Option<Off> {
        off.map(|Off { span, because }| Off { span, because: self.views.within(view, because.into()).to_string() })
    }
}
