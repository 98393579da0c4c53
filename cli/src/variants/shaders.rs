//! Shader interfaces that several threads ask for: each shader is compiled and reflected once.

use framewright_graph::frame::Draw;
use framewright_graph::interface::{DrawInterface, ShaderInterface, ShaderInterfaces, ShaderProblem, Variant};
use framewright_vulkan::ShaderLibrary;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// What one thread knows of a library that it shares.
pub(crate) struct Shared<'a> {
    library: &'a Mutex<ShaderLibrary>,
    /// By name, then by what is drawn (`None`: a compute shader) and how it is compiled.
    known: HashMap<String, Vec<(Option<Draw>, Variant, Found)>>,
}

type Found = Result<ShaderInterface, ShaderProblem>;

impl<'a> Shared<'a> {
    /// One that knows nothing yet.
    #[must_use]
    pub(crate) fn new(library: &'a Mutex<ShaderLibrary>) -> Shared<'a> {
        Shared { library, known: HashMap::new() }
    }

    fn find(&mut self, name: &str, draw: Option<Draw>, variant: &Variant) -> Found {
        let same = |(other, compiled, _): &&(Option<Draw>, Variant, Found)| *other == draw && compiled == variant;
        if let Some((.., found)) = self.known.get(name).and_then(|all| all.iter().find(same)) {
            return found.clone();
        }
        let mut library = self.library.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match draw {
            Some(draw) => library.draw_shader(name, draw, variant),
            None => library.compute_shader(name, variant),
        };
        self.known.entry(name.to_owned()).or_default().push((draw, variant.clone(), found.clone()));
        found
    }
}

impl ShaderInterfaces for Shared<'_> {
    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.find(name, Some(draw), variant)
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.find(name, None, variant)
    }

    fn brought_along(&self, draw: Draw) -> DrawInterface {
        self.library.lock().unwrap_or_else(PoisonError::into_inner).brought_along(draw)
    }
}
