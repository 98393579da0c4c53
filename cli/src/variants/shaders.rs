//! A shader library that threads share: each shader is compiled and reflected once.

use framewright_graph::base::FilePath;
use framewright_graph::frame::Draw;
use framewright_graph::shader::{DrawInterface, ProgramSet, ShaderInterface, ShaderInterfaces, ShaderProblem, Variant};
use framewright_vulkan::ShaderLibrary;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// One thread's cache of a shared library.
pub(crate) struct SharedShaders<'a> {
    library: &'a Mutex<ShaderLibrary>,
    /// By name, then by the kind of draw (`None`: a compute shader) and the variant.
    known: HashMap<String, Vec<(Option<Draw>, Variant, Reflection)>>,
    /// The shader's full name, by the file that names it, its name there and the kind of draw.
    which: HashMap<ShaderKey, Result<Arc<str>, ShaderProblem>>,
}

type Reflection = Result<ShaderInterface, ShaderProblem>;

type ShaderKey = (FilePath, Arc<str>, Option<Draw>);

impl<'a> SharedShaders<'a> {
    /// An empty cache.
    #[must_use]
    pub(crate) fn new(library: &'a Mutex<ShaderLibrary>) -> SharedShaders<'a> {
        SharedShaders { library, known: HashMap::new(), which: HashMap::new() }
    }

    fn compiled(&mut self, name: &str, draw: Option<Draw>, variant: &Variant) -> Reflection {
        let same = |(other, compiled, _): &&(Option<Draw>, Variant, Reflection)| *other == draw && compiled == variant;
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

impl ShaderInterfaces for SharedShaders<'_> {
    fn find(&mut self, from: &FilePath, name: &Arc<str>, draw: Option<Draw>) -> Result<Arc<str>, ShaderProblem> {
        let library = self.library;
        let find = || library.lock().unwrap_or_else(PoisonError::into_inner).find(from, name, draw);
        self.which.entry((from.clone(), name.clone(), draw)).or_insert_with(find).clone()
    }

    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(name, Some(draw), variant)
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(name, None, variant)
    }

    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        self.library.lock().unwrap_or_else(PoisonError::into_inner).brought_along(draw, name)
    }

    fn program_sets(&self) -> Vec<ProgramSet> {
        self.library.lock().unwrap_or_else(PoisonError::into_inner).program_sets()
    }

    fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        self.library.lock().unwrap_or_else(PoisonError::into_inner).custom_passes()
    }
}
