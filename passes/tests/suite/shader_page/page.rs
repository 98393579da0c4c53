//! The page: a text with one place for each kind of shader.

use crate::shader_page::comments;
use framewright_graph::frame::{Cascade, Draw, DrawList, Share};
use framewright_graph::shader::{Binding, BindingKind, PASS_SET, ShaderInterface, Variant};
use framewright_passes::draw;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::shaders::ShaderLibrary;
use std::collections::BTreeSet;
use std::sync::Arc;

/// How a pipeline names a shader of some kind, and what it draws then. A shader is of the first kind that it fits.
const DRAWS: [(&str, Draw); 5] = [
    ("FullScreen", Draw::FullScreen),
    ("Sky", Draw::Sky),
    ("Objects", Draw::Objects(DrawList::Opaque)),
    (
        "Casters",
        Draw::Casters(Cascade {
            list: DrawList::Opaque,
            index: 0,
            of: 1,
            reach: None,
            logarithmic: Share::OF_CASCADES,
        }),
    ),
    ("Indirect", Draw::Indirect),
];

/// One shader.
struct Shader {
    name: &'static str,
    /// `FullScreen`, `Sky`, `Objects`, `Casters`, `Indirect` or `dispatch`.
    kind: &'static str,
    /// Its own files one after the other.
    text: String,
    interface: ShaderInterface,
}

/// Fills the places of a text, `{{FullScreen}}` and so on. Every shipped shader has its place.
pub(crate) fn make(text: &str) -> String {
    let shaders = shaders();
    let mut filled = BTreeSet::new();
    let mut page = String::new();
    for line in text.lines() {
        match line.strip_prefix("{{").and_then(|line| line.strip_suffix("}}")) {
            Some(kind) => {
                let told: Vec<String> = shaders.iter().filter(|shader| shader.kind == kind).map(tell).collect();
                filled.extend(shaders.iter().filter(|shader| shader.kind == kind).map(|shader| shader.name));
                page += &told.join("\n\n");
            }
            None => page += line,
        }
        page.push('\n');
    }
    let without: Vec<_> = shaders.iter().map(|shader| shader.name).filter(|name| !filled.contains(name)).collect();
    assert!(without.is_empty(), "tests/suite/shader_page/shaders.md has no place for {without:?}");
    page
}

fn shaders() -> Vec<Shader> {
    let mut library = ShaderLibrary::new(Vec::new(), SHADERS, draw::interfaces());
    let files = SHADERS.iter().filter(|(file, _)| !file.contains('/'));
    files
        .filter_map(|(file, text)| match file.rsplit_once('.')? {
            (name, "comp") => {
                let compiled = library.compute(name, &Variant::default()).expect(file);
                Some(Shader { name, kind: "dispatch", text: (*text).to_owned(), interface: compiled.interface })
            }
            (name, "frag") => Some(drawn(&mut library, name, text)),
            _ => None,
        })
        .collect()
}

/// A shader that draws.
fn drawn(library: &mut ShaderLibrary, name: &'static str, text: &str) -> Shader {
    let vertex = SHADERS.iter().find(|(file, _)| *file == format!("{name}.vert")).map(|(_, text)| *text);
    let fits = DRAWS.iter().filter(|(kind, _)| match vertex {
        Some(_) if name == "sky" => *kind == "Sky",
        Some(_) if name.starts_with("motion") => *kind == "Objects",
        Some(_) => *kind == "Indirect",
        None if name.starts_with("casters") => *kind == "Casters",
        None => *kind != "Indirect",
    });
    let variant = Variant { sampled: optional(text), ..Variant::default() };
    let mut compiled = fits.filter_map(|(kind, draw)| Some((*kind, library.compiled(name, *draw, &variant).ok()?)));
    let (kind, compiled) = compiled.next().unwrap_or_else(|| panic!("{name} fits no kind of draw"));
    let text = format!("{text}\n{}", vertex.unwrap_or_default());
    Shader { name, kind, text, interface: compiled.interface }
}

/// Names of what a shader may be compiled without.
fn optional(text: &str) -> Vec<Arc<str>> {
    let named = text.lines().filter_map(|line| line.strip_prefix("#ifdef HAS_"));
    named.map(|name| name.trim().into()).collect()
}

/// The section of the page about a shader.
fn tell(shader: &Shader) -> String {
    let about = comments::of_main(&shader.text);
    assert!(!about.is_empty(), "{}: no comment above `main` says what it does", shader.name);
    let of_pass = shader.interface.bindings.iter().filter(|binding| binding.set == PASS_SET);
    let mut rows: Vec<[String; 4]> = of_pass.flat_map(|binding| self::rows(shader, binding)).collect();
    rows.extend(shader.interface.outputs.iter().map(|output| {
        let about = comments::above(&shader.text, |line| {
            line.contains(") out vec") && line.ends_with(&format!(" {};", output.name))
        });
        let ty = if output.components == 1 { "float".to_owned() } else { format!("vec{}", output.components) };
        ["color".to_owned(), output.name.clone(), code(&ty), about]
    }));
    let mut told = format!("### {}\n\n{about}", shader.name);
    if let Some([x, y, z]) = shader.interface.workgroup_size {
        told += &format!(" A workgroup has {x} × {y} × {z} invocations.");
    }
    told += "\n\n| field | name | type | meaning |\n|---|---|---|---|";
    for [field, name, ty, about] in rows {
        told += &format!("\n| {} | {} | {ty} | {about} |", code(&field), code(&name));
    }
    told
}

/// The rows of a binding: the pass's field for it, the name there, the type and the meaning.
fn rows(shader: &Shader, binding: &Binding) -> Vec<[String; 4]> {
    let said = |about: String, name: &str| {
        assert!(!about.is_empty(), "{}: no comment above `{name}` says what it is", shader.name);
        about
    };
    let about = || said(comments::of_binding(&shader.text, binding.binding), &binding.name);
    let row = |field: &str, ty: String| vec![[field.to_owned(), binding.name.clone(), ty, about()]];
    match &binding.kind {
        BindingKind::SampledImage(_) if binding.adapts => row("sample", code(&format!("TEXTURE_{}", binding.name))),
        BindingKind::SampledImage(shape) => row("sample", code(&shape.to_string())),
        BindingKind::UniformBlock(block) if binding.name == "params" => {
            let row = |name: &str| {
                let (ty, about) = comments::of_param(&shader.text, name);
                ["params".to_owned(), name.to_owned(), code(ty), said(about, name)]
            };
            block.members.iter().map(|member| row(&member.name)).collect()
        }
        BindingKind::UniformBlock(block) => row("uniform", format!("a buffer of {} bytes", block.bytes)),
        BindingKind::StorageBlock { readable, writable, .. } => {
            let access = match (readable, writable) {
                (_, false) => "read",
                (false, true) => "written",
                (true, true) => "read and written",
            };
            row("storage", format!("a buffer that is {access}"))
        }
        other => panic!("{}: say in tests/suite/shader_page/page.rs what {other:?} is", shader.name),
    }
}

fn code(text: &str) -> String {
    format!("`{text}`")
}
