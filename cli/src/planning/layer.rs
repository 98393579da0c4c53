//! Validated runs look for the current validation layer, which the loader doesn't find by itself.

use crate::error::Error;
use crate::system::platform;

/// Goes on under the current validation layer, if it is installed and the user chose no other: the program starts itself
/// anew, since the loader finds layers through the environment, which can't be changed from within.
///
/// # Errors
/// If the layer's manifest can't be written, or the program can't be started anew.
pub(crate) fn under_the_current_one() -> Result<(), Error> {
    if let Some(mut command) = framewright_vulkan::layer::reexecution()? {
        // Takes this process's place: only a failure comes back.
        return Err(Error::Restart(platform::become_program(&mut command)));
    }
    Ok(())
}
