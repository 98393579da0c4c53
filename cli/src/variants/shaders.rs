//! Shader interfaces that several threads ask for: each shader is compiled and reflected once.

use framewright_graph::frame::Draw;
use framewright_graph::interface::{DrawInterface, ShaderInterface, ShaderInterfaces, ShaderProblem};
use framewright_vulkan::ShaderLibrary;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// What one thread knows of a library that it shares.
pub(crate) struct Shared<'a> {
    library: &'a Mutex<ShaderLibrary>,
    /// By name, then by what is drawn; `None`: a compute shader.
    known: HashMap<String, Vec<(Option<Draw>, Found)>>,
}

type Found = Result<ShaderInterface, ShaderProblem>;

impl<'a> Shared<'a> {
    /// One that knows nothing yet.
    #[must_use]
    pub(crate) fn new(library: &'a Mutex<ShaderLibrary>) -> Shared<'a> {
        Shared { library, known: HashMap::new() }
    }

    fn find(&mut self, name: &str, draw: Option<Draw>) -> Found {
        let known = self.known.get(name).and_then(|all| all.iter().find(|(other, _)| *other == draw));
        if let Some((_, found)) = known {
            return found.clone();
        }
        let mut library = self.library.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match draw {
            Some(draw) => library.draw_shader(name, draw),
            None => library.compute_shader(name),
        };
        self.known.entry(name.to_owned()).or_default().push((draw, found.clone()));
        found
    }
}

impl ShaderInterfaces for Shared<'_> {
    fn draw_shader(&mut self, name: &str, draw: Draw) -> Result<ShaderInterface, ShaderProblem> {
        self.find(name, Some(draw))
    }

    fn compute_shader(&mut self, name: &str) -> Result<ShaderInterface, ShaderProblem> {
        self.find(name, None)
    }

    fn brought_along(&self, draw: Draw) -> DrawInterface {
        self.library.lock().unwrap_or_else(PoisonError::into_inner).brought_along(draw)
    }
}
