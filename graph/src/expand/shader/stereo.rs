//! What draws for two eyes ask of shaders: the place within a half of an image, and a matrix for each eye.

use crate::base::{Code, Diagnostic};
use crate::expand::resources::Resources;
use crate::frame::{Draw, EyeForm, NoteKind, Remark};
use crate::language;
use crate::shader::{FileLanguage, LanguageFacts, ShaderInterface, UnturnedPart, shader_words};

/// Reports a shader that reads `gl_FragCoord` without `frag_coord()`, or what its language calls so: in halves it isn't the place in one
/// eye's picture.
pub(in crate::expand) fn check_halves(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    let targets = pass.color.iter().map(|target| target.part.image).chain(pass.depth.iter().map(|it| it.part.image));
    let halves = |image: &language::ImageRef| {
        resources.image(image.index).is_some_and(|image| image.image.eyes == Some(EyeForm::Halves))
    };
    let Some(target) = targets.into_iter().find(halves) else { return };
    let (Some(shader), true) = (pass.shader(), interface.unturned.contains(&UnturnedPart::FragCoord)) else { return };
    let name = &resources.declared(target.index).name.text;
    let language = FileLanguage::of_shader(&shader.text);
    let message = format!("shader `{}` {}", shader.text, shader_words::unturned(&shader.text, UnturnedPart::FragCoord));
    let wrong = Diagnostic::new(Code::EYE_HALF, shader.span, message);
    let wrong = wrong.label(target.span, format!("both eyes' pictures lie side by side in `{name}`"));
    let help = match (shader_words::upright_position(language), language.map(FileLanguage::facts)) {
        (Some([function, file]), _) => format!("`{function}` of `{file}` is the place in the eye's own picture"),
        (None, facts) => shader_words::without_halves(facts.map_or("GLSL", |facts| facts.name)),
    };
    errors.push(wrong.help(help));
}

/// Notes a pass that draws vertices of the file's own into an image of each eye, by a matrix that both eyes share. A buffer is there
/// once, so both see the same, without parallax.
pub(in crate::expand) fn note_shared_matrix(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
    remarks: &mut Vec<Remark>,
) {
    let own = pass.work.draws(Draw::has_own_vertices);
    let Some(block) = interface.sees_alike.first().filter(|_| own && is_for_each_eye(resources, pass)) else { return };
    let given = pass.uniform.iter().map(|it| &it.binding).chain(pass.storage.iter().map(|it| &it.binding));
    let span = given.into_iter().find(|name| *name.text == **block).map_or(pass.name.span, |name| name.span);
    let language = pass.shader().and_then(|shader| FileLanguage::of_vertices(&shader.text));
    let by_include = |ending: &str| {
        format!("let the buffer hold a matrix for each, and choose by `eye_index` of `include/stereo{ending}`")
    };
    let help = help(language, by_include);
    let text = format!(
        "draws for each eye by `{block}`, which holds a matrix and is the same for both eyes: they see no parallax; {help}"
    );
    remarks.push(Remark { kind: NoteKind::SeenAlike, subject: pass.name.text.clone(), span, text });
}

/// Whether it draws into what each eye has of its own, for either eye alike.
fn is_for_each_eye(resources: &Resources<'_>, pass: &language::Pass) -> bool {
    let sees = resources.pipeline.views.get(pass.view.0 as usize).is_some_and(|view| view.eye.is_some());
    let targets = pass.color.iter().map(|it| &it.part).chain(pass.depth.iter().map(|it| &it.part));
    let mut targets = targets.filter(|part| part.eye.is_none());
    targets.any(|part| sees || resources.image(part.image.index).is_some_and(|image| image.image.eyes.is_some()))
}

/// What a shader could do by a shipped file, of which the ending is told, or the way out in a language that includes none.
fn help(language: Option<FileLanguage>, by_include: impl Fn(&str) -> String) -> String {
    match language.map(FileLanguage::facts) {
        None => by_include(".glsl"),
        Some(LanguageFacts { includes: Some(ending), .. }) => by_include(ending),
        Some(LanguageFacts { name, .. }) => format!("{name} isn't told of eyes: write the shader in GLSL or HLSL"),
    }
}
