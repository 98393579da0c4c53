//! The driver's own cache of pipelines, kept from one process to the next.
//!
//! A file of the [`Cache`] holds what one version of one device's driver made of pipelines. It is read when the device opens, and
//! written when it closes.

use crate::base::{Cache, Error, digest, read_file, replace_file, shrink, used_now};
use crate::process::{LARGEST_FRAME, parse, read_frame, write, write_frame};
use ash::vk;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Larger files aren't kept, and are none of ours.
const LARGEST_FILE: u64 = 64 << 20;

/// Bytes of the files of all drivers above which those that were used least recently are removed.
const MOST_BYTES: u64 = 256 << 20;

/// How many pipelines a device made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct PipelineCounts {
    /// All that were made for Plans. A frame makes none.
    pub made: u64,
    /// Those of them that the driver found in its cache: it says so, where it says anything.
    pub found: u64,
}

/// The driver's cache of pipelines, which is its own to fill.
pub(crate) struct PipelineCache {
    pub(crate) raw: vk::PipelineCache,
    file: Option<CacheFile>,
    made: AtomicU64,
    found: AtomicU64,
}

/// The file that keeps it.
struct CacheFile {
    folder: PathBuf,
    path: PathBuf,
    /// The device and its driver.
    key: String,
    /// Digest of what the file held at first; `None`: there was none.
    first: Option<u64>,
}

/// The beginning of a file. The driver's bytes stand behind it.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    key: String,
    /// Digest of the driver's bytes: drivers trust them.
    digest: u64,
}

impl CacheFile {
    /// The file for a device of this identity.
    fn of(cache: &Cache, identity: &str) -> CacheFile {
        let (folder, key) = (cache.pipelines(), identity.to_owned());
        CacheFile { path: folder.join(format!("{:016x}", digest(&key))), folder, key, first: None }
    }

    /// The driver's bytes, if the file is whole and of this driver.
    fn read(&self) -> Option<Vec<u8>> {
        let file = read_file(&self.path, LARGEST_FILE)?;
        let mut rest = &*file;
        let header: Header = parse(&read_frame(&mut rest, LARGEST_FRAME).ok()?).ok()?;
        let bytes = read_frame(&mut rest, file.len()).ok()?;
        let whole = rest.is_empty() && header.digest == digest(&bytes) && header.key == self.key;
        whole.then_some(bytes)
    }

    /// Replaces it. Where that isn't possible, nothing is kept. What has grown too large is removed, so that the next process begins with
    /// nothing.
    fn write(&self, bytes: &[u8]) {
        let header = Header { key: self.key.clone(), digest: digest(bytes) };
        let mut file = Vec::new();
        let written = write(&mut file, &header).and_then(|()| write_frame(&mut file, bytes));
        if written.is_err() || file.len() as u64 > LARGEST_FILE {
            let _ = std::fs::remove_file(&self.path);
            return;
        }
        let _ = replace_file(&self.folder, &self.path, &file);
        shrink(&self.folder, MOST_BYTES);
    }
}

impl PipelineCache {
    /// The cache of `device`, whose identity tells its driver's version too, with what `cache` keeps of it.
    pub(super) fn open(device: &ash::Device, cache: Option<&Cache>, identity: &str) -> Result<PipelineCache, Error> {
        let mut file = cache.map(|cache| CacheFile::of(cache, identity));
        let kept = file.as_ref().and_then(CacheFile::read);
        if let (Some(file), Some(kept)) = (&mut file, &kept) {
            file.first = Some(digest(kept));
            used_now(&file.path);
        }
        // What a driver can't use, it has to pass over; one that fails instead begins with nothing.
        let raw = create(device, kept.as_deref().unwrap_or_default()).or_else(|_| create(device, &[]));
        let raw = raw.map_err(Error::vulkan("creating a pipeline cache"))?;
        Ok(PipelineCache { raw, file, made: AtomicU64::default(), found: AtomicU64::default() })
    }

    /// Counts a pipeline that was made. `found`: the driver found it here.
    pub(crate) fn count(&self, found: bool) {
        self.made.fetch_add(1, Ordering::Relaxed);
        self.found.fetch_add(found.into(), Ordering::Relaxed);
    }

    pub(super) fn counts(&self) -> PipelineCounts {
        PipelineCounts { made: self.made.load(Ordering::Relaxed), found: self.found.load(Ordering::Relaxed) }
    }

    /// Keeps what was added since it was opened, and destroys it.
    ///
    /// # Safety
    /// It is a cache of `device`, and isn't used any more.
    pub(super) unsafe fn close(&self, device: &ash::Device) {
        // SAFETY: the caller's promise.
        unsafe {
            self.keep(device);
            device.destroy_pipeline_cache(self.raw, None);
        }
    }

    /// Keeps what was added since it was opened, with what other processes kept meanwhile. Where two processes
    /// do so at once, the later may replace what the earlier added: that is made again some day.
    ///
    /// # Safety
    /// It is a cache of `device`, in which no thread makes pipelines.
    unsafe fn keep(&self, device: &ash::Device) {
        let Some(file) = &self.file else { return };
        let PipelineCounts { made, found } = self.counts();
        if made == found {
            return;
        }
        let others = file.read().filter(|others| Some(digest(others)) != file.first);
        let others = others.and_then(|others| create(device, &others).ok());
        // SAFETY: both are caches of the device, and no thread uses them. Without the others' the own is kept all the same.
        let kept = unsafe {
            if let Some(others) = others {
                let _ = device.merge_pipeline_caches(self.raw, &[others]);
                device.destroy_pipeline_cache(others, None);
            }
            device.get_pipeline_cache_data(self.raw)
        };
        if let Ok(kept) = kept
            && Some(digest(&kept)) != file.first
        {
            file.write(&kept);
        }
    }
}

fn create(device: &ash::Device, kept: &[u8]) -> Result<vk::PipelineCache, vk::Result> {
    let info = vk::PipelineCacheCreateInfo::default().initial_data(kept);
    // SAFETY: the bytes are those that a driver of this identity gave, by their digest.
    unsafe { device.create_pipeline_cache(&info, None) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn bytes_that_are_damaged_or_of_another_driver_are_not_given_to_a_driver() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::in_folder(folder.path());
        let file = CacheFile::of(&cache, "one driver");
        assert_eq!(file.read(), None);
        file.write(b"pipelines");
        assert_eq!(file.read().as_deref(), Some(&b"pipelines"[..]));
        let whole = fs::read(&file.path).expect("it is there");
        for at in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x10;
            fs::write(&file.path, &damaged).expect("written");
            assert_eq!(file.read(), None, "byte {at}");
            fs::write(&file.path, &whole[..at]).expect("written");
            assert_eq!(file.read(), None, "{at} bytes");
        }
        fs::write(&file.path, [&*whole, b"more"].concat()).expect("written");
        assert_eq!(file.read(), None);
        // Files of two drivers may have one name.
        let other = CacheFile::of(&cache, "another driver");
        fs::write(&other.path, &whole).expect("written");
        assert_eq!(other.read(), None);
        file.write(b"again");
        assert_eq!(file.read().as_deref(), Some(&b"again"[..]));
    }

    #[test]
    fn what_a_driver_makes_too_large_is_not_kept_and_neither_is_what_it_grew_from() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = CacheFile::of(&Cache::in_folder(folder.path()), "a driver");
        file.write(b"pipelines");
        file.write(&vec![7; usize::try_from(LARGEST_FILE).expect("it fits")]);
        assert_eq!(file.read(), None);
        file.write(b"pipelines");
        assert_eq!(file.read().as_deref(), Some(&b"pipelines"[..]));
    }
}
