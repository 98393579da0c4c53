//! The machine, the drivers and the program itself.

room! {
    "The machine and the program itself";

    /// A mistake of Framewright itself.
    ///
    /// Nothing is wrong with your files. Please report it, with the pipeline and the message.
    OWN_MISTAKE = 1301,

    /// The machine doesn't let a shader be compiled or read.
    ///
    /// A file may not be read, or no process can be started. Nothing is wrong with the shader.
    SHADER_MACHINE = 1302,

    /// The Vulkan driver is missing or refuses.
    ///
    /// There is no driver, no device, or the driver answered with an error, such as a lost device or a time-out.
    /// `framewright devices` shows what is there; docs/drivers.md says how to install one.
    DRIVER = 1303,

    /// The device has no memory left.
    ///
    /// Choose a smaller size, fewer samples, or fewer or smaller images; `framewright inspect` lists them with what each takes.
    OUT_OF_MEMORY = 1304,

    /// No window can be opened.
    ///
    /// `DISPLAY` or `WAYLAND_DISPLAY` names the screen, and libraries of the window system are needed. `xvfb-run` shows windows
    /// to nobody, and `framewright run` writes pictures without any.
    NO_WINDOW = 1305,

    /// The port can't be used.
    ///
    /// Another program listens there, or it is reserved. Name another one by `--port`; 0 takes any that is free.
    PORT = 1306,

    /// The program can't start itself anew.
    ///
    /// It starts itself for shaders, which are compiled in a process of their own, and under a validation layer that it brings
    /// along.
    OWN_PROCESS = 1307,

    /// The validation layer is missing, or would say nothing.
    ///
    /// A mistake is planted first, to see that the layer tells of it. Settings of the layer may keep it silent: the message names
    /// them.
    VALIDATION_LAYER = 1308,

    /// The program that draws the frame does something wrong.
    ///
    /// It records draws for a pass, imports images and brings along vertices. The message says what it misuses, or has its own
    /// words.
    DRAWING_PROGRAM = 1309,

    /// The compiler of a shader's language can't be used.
    ///
    /// Slang and WGSL, and HLSL where you like, are compiled by a command that you name: `--shader-compiler slang=slangc`, or
    /// `FRAMEWRIGHT_SLANG_COMPILER`. It isn't there, took too long, failed without a word, wrote no SPIR-V of version 1.6 or before, or
    /// lacks a library of its own. Where slangc lacks one, try `slangc -O0`, which calls none.
    SHADER_COMPILER = 1310,

    /// The compiler that a page carries is missing.
    ///
    /// A page that `inspect --what-if` makes carries the compiler, so that it works in the browser. In a checkout `.ci/what-if.sh` makes
    /// it; the archive of a release has it beside the command, as `what-if.wasm`. A file of that name that is something else is this
    /// mistake too.
    NO_MODULE = 1311,

    /// No viewer of a program answers.
    ///
    /// A program with a viewer prints the address of its page when it starts. A part of the address is secret, and another one at each
    /// start. To a program on another machine a tunnel leads: `ssh -L 7117:127.0.0.1:7117 MACHINE`.
    NO_VIEWER = 1312,
}
