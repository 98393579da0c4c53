//! Capabilities of a device: its own claims, less those that its self-tests refute.

use super::claims::claimed_profile;
use super::self_tests::SelfTests;
use crate::base::Error;
use crate::gpu::{Device, DeviceChoice, DeviceOptions, TestedDevice};
use framewright_graph::device::Profile;

impl Device {
    /// Capabilities of the device, as far as Plans depend on them. The first call tries how the device resolves depth and
    /// whether it draws several views at once, which takes small frames: in a helper process, if [`DeviceOptions::helper`]
    /// names one.
    #[must_use]
    pub fn profile(&self) -> Profile {
        self.tested().profile.clone()
    }

    /// Features that the device claims and is used without, and why: it failed the self-test, or the test gave no answer. The
    /// first call tests the device.
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
