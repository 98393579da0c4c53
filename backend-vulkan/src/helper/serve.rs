//! The helper process itself: it compiles GLSL and tests drivers for the program that started it.

use crate::base::{end_process, limit_this_process, take_standard_output};
use crate::gpu::Device;
use crate::probe::{multiview, sample_resolve};
use crate::process::{
    self, ARGUMENT, Answer, CompileFailure, CompileJob, CompilerAnswer, IncludedFile, LARGEST_FRAME, Request, SelfTest,
};
use crate::shaders::compile;
use std::fs::File;
use std::sync::mpsc;
use std::sync::mpsc::Receiver;
use std::{env, io, thread};

/// Turns this process into a helper if it was started as one, and comes back at once if not. `main` calls this before
/// anything else; a helper ends in here.
pub fn serve() {
    let mut arguments = env::args_os().skip(1);
    if arguments.next().is_none_or(|first| first != ARGUMENT) {
        return;
    }
    let mut number = || arguments.next().and_then(|it| it.to_str().and_then(|it| it.parse::<u64>().ok()));
    let (Some(memory), Some(stack)) = (number(), number().and_then(|it| usize::try_from(it).ok())) else {
        end_process(2);
    };
    limit_this_process((memory > 0).then_some(memory));
    // A program that ends, however it does, closes the pipe: then this process ends too, even if its other thread still works.
    // Drivers register functions for the end of a process, which may wait for that thread: they don't run.
    let ended = match take_standard_output() {
        Ok(output) => work(output, stack),
        Err(error) => Err(error),
    };
    end_process(if ended.is_ok() { 0 } else { 1 });
}

/// Hands on what the program says until it says no more.
fn work(output: File, stack: usize) -> io::Result<()> {
    let (hand_on, requests) = mpsc::channel();
    let work = move || {
        // Without the program nobody needs the answers.
        let code = if answer(&requests, output).is_ok() { 0 } else { 1 };
        end_process(code);
    };
    thread::Builder::new().name("helper".to_owned()).stack_size(stack).spawn(work)?;
    let mut input = io::stdin().lock();
    while let Ok(frame) = process::read_frame(&mut input, LARGEST_FRAME) {
        if hand_on.send(frame).is_err() {
            break;
        }
    }
    Ok(())
}

/// Answers requests.
fn answer(requests: &Receiver<Vec<u8>>, mut output: File) -> io::Result<()> {
    while let Ok(frame) = requests.recv() {
        match process::parse(&frame)? {
            Request::Compile(job) => match compiled(&job, requests, &output) {
                Ok(CompilerAnswer { spirv, verdict }) => {
                    let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
                    process::write(&mut output, &Answer::Spirv(verdict))?;
                    process::write_frame(&mut output, &bytes)?;
                }
                Err(failure) => process::write(&mut output, &Answer::CompileFailure(failure))?,
            },
            Request::SelfTest { test, device } => process::write(&mut output, &tested(test, &device))?,
            Request::Included(_) => return Err(process::invalid()),
        }
    }
    Ok(())
}

/// Compiles, and asks the program for what is included.
fn compiled(job: &CompileJob, requests: &Receiver<Vec<u8>>, output: &File) -> Result<CompilerAnswer, CompileFailure> {
    let ask = |from: &str, name: &str| -> io::Result<Result<IncludedFile, String>> {
        let (from, name) = (from.to_owned(), name.to_owned());
        process::write(&mut &*output, &Answer::Include { from, name })?;
        match process::parse(&requests.recv().map_err(io::Error::other)?)? {
            Request::Included(found) => Ok(found),
            Request::Compile(_) | Request::SelfTest { .. } => Err(process::invalid()),
        }
    };
    let mut includes = |from: &str, name: &str| ask(from, name).unwrap_or_else(|error| Err(error.to_string()));
    compile(job, &mut includes)
}

/// Tests a device, and closes it: drivers crash then too.
fn tested(test: SelfTest, identity: &str) -> Answer {
    let tested = Device::open_identified(identity).and_then(|device| match test {
        SelfTest::SampleResolve { draws_views } => {
            sample_resolve::probe(&device, draws_views).map(Answer::SampleResolve)
        }
        SelfTest::Multiview => multiview::probe(&device).map(Answer::DrawsViews),
    });
    tested.unwrap_or_else(|error| Answer::NotTested(error.to_string()))
}
