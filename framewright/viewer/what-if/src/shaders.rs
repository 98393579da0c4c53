//! The interfaces of shaders: recorded where there is a compiler, and told where there is none.

use framewright_graph::base::FilePath;
use framewright_graph::frame::Draw;
use framewright_graph::shader::{
    DrawInterface, DrawInterfaces, ProgramSet, ShaderInterface, ShaderInterfaces, ShaderProblem, Variant,
};
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// What was told of shaders.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShaderTable {
    /// Different interfaces.
    interfaces: Vec<ShaderInterface>,
    /// The number of the interface of each shader, as it is compiled; `None`: there is no such shader.
    compiled: Vec<(CompiledQuestion, Option<usize>)>,
    /// The name in Plans of each shader that a file names; `None`: there is no such shader.
    named: Vec<(NameQuestion, Option<Arc<str>>)>,
}

/// A shader as it is compiled: its name in Plans, its draw (`None`: a compute shader), its variant.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct CompiledQuestion(Arc<str>, Option<Draw>, Variant);

/// A shader as a file names it: the file, the name, its draw.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct NameQuestion(String, Arc<str>, Option<Draw>);

/// Tells what other interfaces tell, and records it.
pub struct ShaderRecorder<'i> {
    inner: &'i mut dyn ShaderInterfaces,
    table: ShaderTable,
    compiled: HashSet<CompiledQuestion>,
    named: HashSet<NameQuestion>,
}

impl<'i> ShaderRecorder<'i> {
    /// A recorder of what `inner` tells.
    pub fn new(inner: &'i mut dyn ShaderInterfaces) -> ShaderRecorder<'i> {
        ShaderRecorder { inner, table: ShaderTable::default(), compiled: HashSet::new(), named: HashSet::new() }
    }

    /// All that was told.
    #[must_use]
    pub fn table(self) -> ShaderTable {
        self.table
    }

    /// Records an answer. A shader that can't be used is left out: nothing is known of it then.
    fn record(&mut self, question: CompiledQuestion, answer: &Result<ShaderInterface, ShaderProblem>) {
        let number = match answer {
            Ok(interface) => {
                let known = self.table.interfaces.iter().position(|known| known == interface);
                Some(known.unwrap_or_else(|| {
                    self.table.interfaces.push(interface.clone());
                    self.table.interfaces.len() - 1
                }))
            }
            Err(ShaderProblem::Missing { .. }) => None,
            Err(_) => return,
        };
        if self.compiled.insert(question.clone()) {
            self.table.compiled.push((question, number));
        }
    }
}

impl ShaderInterfaces for ShaderRecorder<'_> {
    fn find(&mut self, from: &FilePath, name: &Arc<str>, draw: Option<Draw>) -> Result<Arc<str>, ShaderProblem> {
        let answer = self.inner.find(from, name, draw);
        let question = NameQuestion(from.to_string(), name.clone(), draw);
        let told = match &answer {
            Ok(name) => Some(name.clone()),
            Err(ShaderProblem::Missing { .. }) => None,
            Err(_) => return answer,
        };
        if self.named.insert(question.clone()) {
            self.table.named.push((question, told));
        }
        answer
    }

    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        let answer = self.inner.draw_shader(name, draw, variant);
        self.record(CompiledQuestion(name.into(), Some(draw), variant.clone()), &answer);
        answer
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        let answer = self.inner.compute_shader(name, variant);
        self.record(CompiledQuestion(name.into(), None, variant.clone()), &answer);
        answer
    }

    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        self.inner.brought_along(draw, name)
    }

    fn program_sets(&self) -> Vec<ProgramSet> {
        self.inner.program_sets()
    }

    fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        self.inner.custom_passes()
    }
}

/// Tells what was recorded, and nothing else.
pub(crate) struct CarriedShaders<'t> {
    table: &'t ShaderTable,
    draws: DrawInterfaces,
    compiled: HashMap<&'t CompiledQuestion, Option<usize>>,
    named: HashMap<&'t NameQuestion, Option<&'t Arc<str>>>,
}

impl<'t> CarriedShaders<'t> {
    pub(crate) fn new(table: &'t ShaderTable, draws: DrawInterfaces) -> CarriedShaders<'t> {
        CarriedShaders {
            table,
            draws,
            compiled: table.compiled.iter().map(|(question, answer)| (question, *answer)).collect(),
            named: table.named.iter().map(|(question, answer)| (question, answer.as_ref())).collect(),
        }
    }

    fn compiled(&self, question: &CompiledQuestion) -> Result<ShaderInterface, ShaderProblem> {
        let number = match self.compiled.get(question) {
            Some(told) => told.ok_or_else(missing)?,
            None => self.with_other_constants(question).ok_or_else(|| uncarried("as this pass draws it"))?,
        };
        self.table.interfaces.get(number).cloned().ok_or_else(|| uncarried("whole"))
    }

    /// The interface that a shader has for all values of its specialization constants that are known, if these are several.
    fn with_other_constants(&self, CompiledQuestion(name, draw, variant): &CompiledQuestion) -> Option<usize> {
        if variant.constants.is_empty() {
            return None;
        }
        let bare = |variant: &Variant| Variant { constants: Vec::new(), ..variant.clone() };
        let (wanted, mut alike) = (bare(variant), Vec::new());
        for (CompiledQuestion(known, as_drawn, as_compiled), answer) in &self.table.compiled {
            if known == name && as_drawn == draw && bare(as_compiled) == wanted {
                alike.push((*answer)?);
            }
        }
        let first = *alike.first()?;
        (alike.len() > 1 && alike.iter().all(|number| *number == first)).then_some(first)
    }
}

impl ShaderInterfaces for CarriedShaders<'_> {
    fn find(&mut self, from: &FilePath, name: &Arc<str>, draw: Option<Draw>) -> Result<Arc<str>, ShaderProblem> {
        match self.named.get(&NameQuestion(from.to_string(), name.clone(), draw)) {
            Some(told) => told.cloned().ok_or_else(missing),
            None => Err(uncarried("for such a draw")),
        }
    }

    fn draw_shader(&mut self, name: &str, draw: Draw, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(&CompiledQuestion(name.into(), Some(draw), variant.clone()))
    }

    fn compute_shader(&mut self, name: &str, variant: &Variant) -> Result<ShaderInterface, ShaderProblem> {
        self.compiled(&CompiledQuestion(name.into(), None, variant.clone()))
    }

    fn brought_along(&self, draw: Option<Draw>, name: &str) -> DrawInterface {
        self.draws.of_pass(draw, name)
    }

    fn program_sets(&self) -> Vec<ProgramSet> {
        self.draws.sets().to_vec()
    }

    fn custom_passes(&self) -> Option<Vec<Arc<str>>> {
        self.draws.custom_passes().map(<[Arc<str>]>::to_vec)
    }
}

fn missing() -> ShaderProblem {
    ShaderProblem::Missing { looked_in: Vec::new(), known: Vec::new() }
}

/// That nothing is known of a shader. Shaders are compiled where pages are made.
fn uncarried(how: &str) -> ShaderProblem {
    let what = format!(
        "this page doesn't carry it {how}; shaders are compiled where a page is made: make one with this choice"
    );
    ShaderProblem::Machine { what }
}
