//! What a device really can do: what it says, less what its self-tests refute.

use super::claims::claimed_profile;
use super::self_tests::SelfTests;
use crate::base::Error;
use crate::gpu::{Device, DeviceChoice, DeviceOptions, TestedDevice};
use framewright_graph::device::Profile;

impl Device {
    /// What the device can do, as far as Plans depend on it. The first time it is tried how the device resolves depth, and
    /// whether it draws several views at once, which takes small frames: in a helper process, if [`DeviceOptions::helper`] names
    /// one.
    #[must_use]
    pub fn profile(&self) -> Profile {
        self.tested().profile.clone()
    }

    /// What the device says it can do and is used without, and why: it failed the self-test, or the test gave no answer.
    /// The first time the device is tested.
    #[must_use]
    pub fn used_without(&self) -> Vec<String> {
        self.tested().used_without.clone()
    }

    fn tested(&self) -> &TestedDevice {
        self.tested.get_or_init(|| {
            let mut profile = claimed_profile(self);
            let found = SelfTests::of(self, self.helper.as_ref());
            let used_without = found.used_without(profile.max_multiview_views >= 2);
            found.take_from(&mut profile);
            TestedDevice { profile, used_without }
        })
    }

    /// Opens the device of this identity, for its self-tests.
    pub(crate) fn open_identified(identity: &str) -> Result<Device, Error> {
        let found = Device::list()?.into_iter().find(|device| device.identity == identity);
        let choice = DeviceChoice::Index(found.ok_or(Error::NoDevice)?.index);
        Device::open(&DeviceOptions { choice, ..DeviceOptions::default() })
    }
}
