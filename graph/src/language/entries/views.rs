//! `views`: the cameras, sizes and settings with which the parts of a frame are drawn.

use super::values::optional;
use super::{list, presets, sizes};
use crate::base::{Code, Diagnostic, Label, OutsideChoice, shown_number};
use crate::fields;
use crate::frame::change::{Action, Change};
use crate::frame::{self, Allowances, Jitter, ViewIndex};
use crate::language::inputs::Surroundings;
use crate::language::model::{Choice, LARGEST_SIZE, Setting, View, times};
use crate::language::scope::{
    Context, DecidedValue, Evaluator, FieldValue, FieldValueTuple, ScopeValues, all, combined,
};
use crate::ron::{FieldTable, Form, Leaf, Name, Names, PlainForm, Reader, Word, WordContents, Words};

fields! {
    /// A view: a picture from one place, with a size and values of settings of its own.
    ///
    /// ```ron
    /// (name: "preview", size: Scaled(0.25), camera: "top", allows_msaa: false, set: {"bloom": false})
    /// ```
    struct ViewFields<'src> as "View" {
        /// Its name, which images, buffers, passes and uses give in their `view`.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// Width and height; `Output` if left out. The first view always has `Output`.
        size: Option<Leaf<'src>> => Form::Words(&SIZES),
        /// The scene's camera of that name; the scene's own if left out.
        camera: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// The value of `view.allows_msaa` in conditions; true if left out.
        allows_msaa: Option<Leaf<'src>> => Form::Truth,
        /// The value of `view.allows_hdr` in conditions; true if left out.
        allows_hdr: Option<Leaf<'src>> => Form::Truth,
        /// The value of `view.allows_scale` in conditions; true if left out.
        allows_scale: Option<Leaf<'src>> => Form::Truth,
        /// The number of frames, 1 to 256, after which shifts of its picture by parts of a texel repeat; 1, no shift, if left
        /// out.
        jitter: Option<Leaf<'src>> => JITTER,
        /// The size of the picture in whose texels the shifts are counted. `Output` is the view's size, and the default.
        jitter_size: Option<Leaf<'src>> => Form::Words(&SIZES),
        /// Values of settings within it, in place of the user's choices.
        set: Option<Leaf<'src>> => presets::SET,
    }
}

/// The number of frames over which a picture is shifted.
const JITTER: Form = Form::Whole(1, frame::LONGEST_JITTER as i64);

/// The views of a pipeline.
pub(crate) const VIEWS: Form = Form::List(&Form::Fields(ViewFields::<'static>::table));

/// The name of a view.
pub(crate) const NAME: Form = Form::Plain(PlainForm::Name);

static SIZES: Words = Words {
    name: "ViewSize",
    what: "the size of a view",
    or: &[],
    all: &[
        Word::alone("Output", "The frame's."),
        Word::new(
            "Scaled",
            &[WordContents::Values(&[Form::Number])],
            &["Scaled(0.5)"],
            "The frame's, times a number above 0; rounded down, at least 1.",
        ),
        Word::new(
            "Fixed",
            &[WordContents::Values(&[sizes::EXTENT, sizes::EXTENT])],
            &["Fixed(640, 360)"],
            "This many pixels.",
        ),
    ],
};

/// The views that a pipeline's file says, the main one first; none if it names none.
pub(crate) struct ViewEntries {
    names: Names,
    /// `None` where one couldn't be read.
    list: Vec<Option<FieldValue<SetView>>>,
}

/// A view, and the values that settings have within it.
type SetView = (View, Vec<Option<DecidedValue>>);

/// The inputs of expressions in a view.
pub(crate) struct ViewInputs<'a> {
    pub(crate) surroundings: Surroundings<'a>,
    /// Values of settings.
    pub(crate) values: Vec<Option<DecidedValue>>,
}

/// The views of a pipeline with all values put in; `None` where one has a mistake.
pub(crate) struct Views<'a>(Vec<Option<(View, ViewInputs<'a>)>>);

impl ViewEntries {
    /// Reads a list of views in the context of the frame; `settings` are those that views may set. `removed` is the first
    /// view that is no longer there.
    pub(crate) fn read(
        context: &mut Context<'_>,
        settings: &[Option<Setting>],
        list: Option<Leaf<'_>>,
        removed: Option<&Change>,
    ) -> ViewEntries {
        let (mut names, before) = (Names::new("view", Code::UNKNOWN_VIEW), context.reader.errors.len());
        let fields: Vec<Option<ViewFields<'_>>> = list::entries(context.reader, list, "`views`", "view", &mut names);
        if let Some(list) = list.filter(|_| fields.is_empty() && context.reader.errors.is_empty()) {
            context.reader.wrong(
                Code::NO_VIEWS,
                list,
                "a frame without views shows nothing",
                "leave `views` out: there is one then",
            );
        }
        let mut views = Vec::with_capacity(fields.len());
        for (number, fields) in fields.into_iter().enumerate() {
            views.push(fields.and_then(|fields| context.view(settings, number == 0, &fields)));
            if number == 0 {
                since_removed(&mut context.reader.errors[before..], removed);
            }
        }
        ViewEntries { names, list: views }
    }

    /// The view that `leaf` names.
    pub(crate) fn find(&self, reader: &mut Reader, leaf: Leaf<'_>) -> Option<ViewIndex> {
        let name = reader.reference(leaf, "a view")?;
        if self.list.is_empty() && self.names.complete() {
            let unknown = Diagnostic::unknown_name(Code::UNKNOWN_VIEW, "view", &name.text).at(name.span);
            reader.report(unknown.help(format!(
                "list the views of the frame, the main one first: `views: [(name: \"main\"), (name: \"{}\")]`",
                name.text
            )));
            return None;
        }
        self.names.find(reader, &name).and_then(|at| u32::try_from(at).ok()).map(ViewIndex)
    }
}

impl<'a> Views<'a> {
    /// No views: all is drawn for one view, of the frame's size.
    pub(crate) const fn none() -> Views<'a> {
        Views(Vec::new())
    }

    /// Puts in the values of views; `surroundings` belong to the frame.
    pub(crate) fn new(
        entries: &ViewEntries,
        surroundings: &Surroundings<'a>,
        evaluator: &mut Evaluator<'_, '_>,
    ) -> Views<'a> {
        let views = entries.list.iter().map(|entry| {
            let (view, values) = evaluator.put_in(entry)?;
            let surroundings = Surroundings { extent: view.extent, allows: view.allows, ..*surroundings };
            Some((view, ViewInputs { surroundings, values }))
        });
        Views(views.collect())
    }

    /// The inputs of expressions in a view; `None`: the frame's inputs.
    pub(crate) fn inputs(&self, view: ViewIndex) -> Option<&ViewInputs<'a>> {
        self.0.get(view.0 as usize)?.as_ref().map(|(_, inputs)| inputs)
    }

    /// The name of a view, unless it is the main one.
    pub(crate) fn name(&self, view: ViewIndex) -> Option<&Name> {
        let (view, _) = self.0.get(view.0 as usize).filter(|_| view != ViewIndex::default())?.as_ref()?;
        Some(&view.name)
    }

    /// All views; `None` if one has a mistake.
    pub(crate) fn into_list(self) -> Option<Vec<View>> {
        self.0.into_iter().map(|view| view.map(|(view, _)| view)).collect()
    }
}

/// Adds to mistakes in the first view that another one was the first before it was removed.
fn since_removed(errors: &mut [Diagnostic], removed: Option<&Change>) {
    let Some(Change { span, action: Action::Remove { name, .. } }) = removed else { return };
    for error in errors.iter_mut().filter(|error| error.message == FIRST_IS_THE_FRAMES) {
        error.labels.push(Label::new(*span, format!("`{name}` is removed here")));
    }
}

/// The message about a first view with a size.
const FIRST_IS_THE_FRAMES: &str = "the first view has the size of the frame";

/// The size of the frame, or of the view at hand.
fn own_size() -> FieldValue<[u32; 2]> {
    FieldValue::computed(|evaluator| Some(evaluator.scope.surroundings.extent))
}

impl Context<'_> {
    fn view(
        &mut self,
        settings: &[Option<Setting>],
        main: bool,
        fields: &ViewFields<'_>,
    ) -> Option<FieldValue<SetView>> {
        let name = self.reader.name(fields.name, "a view");
        if let Some(about) = fields.about {
            self.reader.words(about, "a description");
        }
        let extent = match fields.size {
            Some(leaf) if main => {
                if !leaf.is_broken() {
                    let wrong = Diagnostic::new(Code::MAIN_VIEW_SIZE, leaf.span(), FIRST_IS_THE_FRAMES)
                        .help("leave `size` out");
                    self.reader.report(wrong.choice(OutsideChoice::OutputSize));
                }
                None
            }
            Some(leaf) => self.view_size(leaf),
            None => Some(own_size()),
        };
        let camera = optional(fields.camera, |leaf| self.reader.reference(leaf, "a camera"));
        let allows = [fields.allows_msaa, fields.allows_hdr, fields.allows_scale];
        let allows = allows.map(|leaf| optional(leaf, |leaf| self.truth(leaf).map(FieldValue::alone)));
        let set = fields.set.map_or_else(|| Some(Vec::new()), |leaf| presets::set(self.reader, leaf, settings));
        let jitter = self.jitter(fields);
        let (name, extent, camera, allows) = (name?, extent?, camera?, all(allows)?);
        let (set, jitter) = (set?, jitter?);
        Some(FieldValue::computed(move |evaluator| {
            let frame = evaluator.scope.surroundings;
            let extent = extent.evaluate(evaluator);
            let allows = allows.evaluate(evaluator);
            let mut values = evaluator.scope.values.to_vec();
            for Choice { setting, value, .. } in &set {
                if let Some(slot) = values.get_mut(*setting) {
                    *slot = Some(value.clone().into());
                }
            }
            // Evaluated even where something else is wrong, so that all mistakes are told.
            let seen = Surroundings { extent: extent.unwrap_or(frame.extent), ..*frame };
            let scope = ScopeValues { values: &values, surroundings: &seen, ..evaluator.scope };
            let jitter = jitter.evaluate(&mut Evaluator::new(evaluator.reader, scope, evaluator.lenient));
            let [msaa, hdr, scale] = allows?;
            let allows = Allowances {
                msaa: msaa.unwrap_or(frame.allows.msaa),
                hdr: hdr.unwrap_or(frame.allows.hdr),
                scale: scale.unwrap_or(frame.allows.scale),
            };
            let (name, camera) = (name.clone(), camera.clone());
            Some((View { name, extent: extent?, camera, allows, jitter: jitter?, eye: None }, values))
        }))
    }

    /// The shifts of a view's picture.
    fn jitter(&mut self, fields: &ViewFields<'_>) -> Option<FieldValue<Option<Jitter>>> {
        let range = 1..=i64::from(frame::LONGEST_JITTER);
        let length = |leaf| self.whole::<u16>(leaf, "number of shifts", range);
        let length = fields.jitter.map_or(Some(FieldValue::Constant(1)), length);
        let extent = fields.jitter_size.map_or_else(|| Some(own_size()), |leaf| self.view_size(leaf));
        let jitter = |(length, extent)| (length > 1).then(|| Jitter::halton(length, extent));
        Some(combined((length?, extent?), jitter))
    }

    fn view_size(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<[u32; 2]>> {
        let (word, rest) = self.reader.one_of(leaf, &SIZES)?;
        match word {
            "Output" => self.reader.bare(word, rest).map(|()| own_size()),
            "Fixed" => Some(combined(self.fixed(leaf, rest)?, |extent| extent)),
            _ => {
                let [by]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "Scaled(0.5)")?;
                // While a file is read no frame is known; then this is no mistake.
                combined((self.scale(by)?, own_size()), |of| of).checked(self.reader, |(factor, frame), _| {
                    times(frame, factor.value).map_err(|[width, height]| {
                        let message = format!("the view would be {width}×{height}; {LARGEST_SIZE} texels are allowed");
                        let wrong = Diagnostic::new(Code::SIZE_OUTSIDE, factor.span, message);
                        let because = factor.because.map_or_else(|| shown_number(factor.value), |it| it.to_string());
                        wrong.remark(format!("{because} times {}×{}", frame[0], frame[1]))
                    })
                })
            }
        }
    }
}
