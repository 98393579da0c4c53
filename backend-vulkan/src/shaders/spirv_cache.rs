//! The cache of compiled stages: one file for each text with its macros.
//!
//! A file holds digests of all that its SPIR-V was made from: the compiler, the stage's text and macros, and each file that was
//! included. It is taken only where all of that is the same now, but for line endings.

use super::compile::Includes;
use crate::base::{Cache, bytes_in, digest, identity_of, read_file, replace_file, shrink, used_now};
use crate::process::{
    CompileJob, CompilerAnswer, IncludedFile, LARGEST_FRAME, LARGEST_SPIRV, Limits, Verdict, parse, read_frame, write,
    write_frame,
};
use framewright_graph::base::unix_lines;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Bytes of all files above which the files that were used least recently are removed. A stage takes some 50 KiB.
const MOST_BYTES: u64 = 64 << 20;

/// Larger files aren't kept, and are none of ours.
const LARGEST_FILE: u64 = MOST_BYTES / 16;

/// Compiled stages in a folder.
pub(super) struct SpirvCache {
    folder: PathBuf,
    /// The compiling program, and its limits: a shader that exceeds other ones is a mistake, however it was compiled before.
    compiler: String,
    /// Bytes of all files; `None` until this process keeps something.
    bytes: Option<u64>,
}

/// The beginning of a file. The SPIR-V stands behind it.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    compiler: String,
    /// Digest of the stage's text and macros.
    job: u64,
    includes: Vec<Inclusion>,
    /// Digest of the SPIR-V.
    spirv: u64,
    /// The validator's verdict on it.
    verdict: Verdict,
}

/// An included file: how it was asked for, and a digest of its text. Its place isn't told: a stage is the same wherever its
/// files lie.
#[derive(Debug, Serialize, Deserialize)]
struct Inclusion {
    /// The file that includes it: 0 for the stage's own, 1 for the first that was included, and so on.
    from: usize,
    /// Its name there.
    name: String,
    text: u64,
    /// The inclusion before that it repeats, if the file says that it is included once.
    repeats: Option<usize>,
}

/// The files that a compilation includes.
pub(super) struct Inclusions {
    /// The name of each file that messages show, the stage's own first.
    shown: Vec<String>,
    once: Vec<Option<u64>>,
    list: Vec<Inclusion>,
}

impl Inclusions {
    /// None so far.
    pub(super) fn of(job: &CompileJob) -> Inclusions {
        Inclusions { shown: vec![job.shown.clone()], once: Vec::new(), list: Vec::new() }
    }

    /// Adds a file that the file `from` includes as `name`.
    pub(super) fn add(&mut self, from: &str, name: &str, file: &IncludedFile) {
        let from = self.shown.iter().position(|shown| shown == from).unwrap_or(0);
        let repeats = repeated(&self.once, file.once);
        self.list.push(Inclusion { from, name: name.to_owned(), text: digest(&unix_lines(&file.text)), repeats });
        self.shown.push(file.shown.clone());
        self.once.push(file.once);
    }
}

impl SpirvCache {
    /// The stages in `cache` that this program compiled within these limits.
    pub(super) fn new(cache: &Cache, program: &Path, limits: &Limits) -> SpirvCache {
        let Limits { time, memory, stack, self_test: _ } = limits;
        let compiler = format!("{}; {time:?}, {memory:?}, {stack}", identity_of(program));
        SpirvCache { folder: cache.spirv(), compiler, bytes: None }
    }

    /// The stages in `cache` that a command of this identity compiled.
    pub(super) fn of_command(cache: &Cache, identity: String) -> SpirvCache {
        SpirvCache { folder: cache.spirv(), compiler: identity, bytes: None }
    }

    /// The SPIR-V of a stage, if it was compiled before and `includes` finds the same files as then.
    pub(super) fn find(&self, job: &CompileJob, includes: &mut Includes<'_>) -> Option<CompilerAnswer> {
        let path = self.path(job);
        let file = read_file(&path, LARGEST_FILE)?;
        let mut rest = &*file;
        let header: Header = parse(&read_frame(&mut rest, LARGEST_FRAME).ok()?).ok()?;
        let spirv = read_frame(&mut rest, LARGEST_SPIRV).ok()?;
        let (words, end) = spirv.as_chunks();
        let whole = end.is_empty() && rest.is_empty() && header.spirv == digest(&spirv);
        if !(whole && header.compiler == self.compiler && header.job == digest_of(job)) {
            return None;
        }
        let (mut shown, mut once) = (vec![job.shown.clone()], Vec::new());
        for Inclusion { from, name, text, repeats } in &header.includes {
            let found =
                includes(shown.get(*from)?, name).ok().filter(|found| digest(&unix_lines(&found.text)) == *text)?;
            if repeated(&once, found.once) != *repeats {
                return None;
            }
            shown.push(found.shown);
            once.push(found.once);
        }
        used_now(&path);
        let spirv = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
        Some(CompilerAnswer { spirv, verdict: header.verdict })
    }

    /// Keeps a stage that includes these files. Where that isn't possible, or it is very large or invalid, it is compiled again next
    /// time.
    pub(super) fn keep(
        &mut self,
        job: &CompileJob,
        includes: Inclusions,
        CompilerAnswer { spirv, verdict }: &CompilerAnswer,
    ) {
        if size_of_val(&spirv[..]) as u64 > LARGEST_FILE / 2 || matches!(verdict, Verdict::Invalid(_)) {
            return;
        }
        let spirv: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
        let (compiler, digest_of_spirv) = (self.compiler.clone(), digest(&spirv));
        let (includes, verdict) = (includes.list, verdict.clone());
        let header = Header { compiler, job: digest_of(job), includes, spirv: digest_of_spirv, verdict };
        let mut file = Vec::new();
        let written = write(&mut file, &header)
            .and_then(|()| write_frame(&mut file, &spirv))
            .and_then(|()| replace_file(&self.folder, &self.path(job), &file));
        if written.is_ok() {
            let bytes =
                self.bytes.map_or_else(|| bytes_in(&self.folder), |bytes| bytes.saturating_add(file.len() as u64));
            self.bytes = Some(if bytes > MOST_BYTES { shrink(&self.folder, MOST_BYTES / 4 * 3) } else { bytes });
        }
    }

    /// The file of a stage. Others may have the same name: each file says what it is of.
    fn path(&self, job: &CompileJob) -> PathBuf {
        self.folder.join(format!("{:016x}", digest(&(&self.compiler, digest_of(job)))))
    }
}

/// Which of the files that were included before a file is, if it says that it is included once.
fn repeated(before: &[Option<u64>], file: Option<u64>) -> Option<usize> {
    file.and_then(|file| before.iter().position(|before| *before == Some(file)))
}

/// The digest of all that a stage is compiled from, but what it includes.
fn digest_of(CompileJob { stage, language, entry, shown: _, text, macros }: &CompileJob) -> u64 {
    digest(&(stage, language, entry, unix_lines(text), macros))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::ShaderStage;
    use std::fs::{self, File};
    use std::time::{Duration, SystemTime};

    fn job(text: &str) -> CompileJob {
        let (shown, text) = ("a.vert".to_owned(), text.to_owned());
        CompileJob { stage: ShaderStage::Vertex, language: None, entry: None, shown, text, macros: Vec::new() }
    }

    fn compiled(spirv: &[u32]) -> CompilerAnswer {
        CompilerAnswer { spirv: spirv.to_vec(), verdict: Verdict::Valid }
    }

    fn found(cache: &SpirvCache, text: &str) -> bool {
        cache.find(&job(text), &mut |_, _| unreachable!("nothing is included")).is_some()
    }

    /// A cache in a folder, with four stages of the same size; the first was used least recently.
    fn cache(folder: &Path) -> SpirvCache {
        let mut cache = SpirvCache::new(&Cache::in_folder(folder), Path::new("compiler"), &Limits::default());
        for (hours, text) in ["a", "b", "c", "d"].into_iter().enumerate() {
            cache.keep(&job(text), Inclusions::of(&job(text)), &compiled(&[7; 1000]));
            let used = SystemTime::now() - Duration::from_secs(3600 * (10 - hours as u64));
            let file = File::options().append(true).open(cache.path(&job(text))).expect("it is kept");
            file.set_modified(used).expect("its time is set");
        }
        cache
    }

    #[test]
    fn files_that_were_used_least_recently_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path());
        let all = cache.bytes.expect("counted");
        assert_eq!((bytes_in(&cache.folder), shrink(&cache.folder, all)), (all, all));
        // Being found is being used.
        assert!(found(&cache, "a"));
        // Files differ by a few bytes.
        let two = all / 2 + 64;
        assert!(shrink(&cache.folder, two) <= two);
        assert_eq!(["a", "b", "c", "d"].map(|text| found(&cache, text)), [true, false, false, true]);
        // Times in the future are ignored: a clock was wrong.
        let file = File::options().append(true).open(cache.path(&job("d"))).expect("it is there");
        file.set_modified(SystemTime::now() + Duration::from_secs(1 << 30)).expect("its time is set");
        assert!(found(&cache, "d") && file.metadata().expect("there").modified().expect("a time") <= SystemTime::now());
        assert_eq!(shrink(&cache.folder, 0), 0);
    }

    #[test]
    fn a_stage_that_would_take_much_of_the_cache_is_not_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut cache = cache(folder.path());
        let large = vec![7; 1 << 20];
        cache.keep(&job("large"), Inclusions::of(&job("large")), &compiled(&large));
        assert!(!found(&cache, "large") && found(&cache, "a"));
    }

    #[test]
    fn another_build_of_the_compiler_compiles_anew_and_has_files_of_its_own() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path());
        let program = folder.path().join("compiler");
        let of_build = |contents: &str| {
            fs::write(&program, contents).expect("written");
            SpirvCache::new(&Cache::in_folder(folder.path()), &program, &Limits::default())
        };
        let mut one = of_build("one");
        assert!(!found(&one, "a"));
        one.keep(&job("a"), Inclusions::of(&job("a")), &compiled(&[1]));
        let other = of_build("other");
        assert!(found(&one, "a") && !found(&other, "a") && found(&cache, "a"));
        // Files of two builds may have one name.
        fs::copy(one.path(&job("a")), other.path(&job("a"))).expect("copied");
        assert!(!found(&other, "a"));
    }
}
