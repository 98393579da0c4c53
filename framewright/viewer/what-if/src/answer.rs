//! What a page asks, and what it is told: texts of JSON.

use crate::planning::{Refusal, SubjectPlan};
use crate::subject::{Choices, Subject};
use crate::view::PlanView;
use framewright_graph::difference::Differences;
use framewright_graph::plan::Detail;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A question of a page.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Question {
    subject: Subject,
    choices: Choices,
    form: AnswerForm,
}

/// What a page wants to be told.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum AnswerForm {
    /// The JSON form of the Plan, as a text.
    Plan,
    /// What its views show, and the differences from the Plan of the page.
    View,
}

/// What a page is told.
#[derive(Serialize)]
struct Answer<'a> {
    /// The version of the compiler.
    version: &'static str,
    #[serde(flatten)]
    body: AnswerBody<'a>,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum AnswerBody<'a> {
    Plan(String),
    View { plan: Box<PlanView<'a>>, differences: Option<Differences> },
    Wrong { mistakes: Value, message: String },
}

/// Answers a question: both are JSON. The question has the `subject`, `choices` for it, and the `form` of the answer: `plan` or `view`. The
/// answer has `version`, and one of `plan`, the JSON form of the Plan as a text; `view`, with the data of the page's views and the differences
/// from the Plan of the page; `wrong`, with `mistakes` as data and as a `message`.
#[must_use]
pub fn answer(question: &str) -> String {
    let read: Result<Question, _> = serde_json::from_str(question);
    match read {
        Ok(question) => answered(&question),
        Err(problem) => {
            written(wrong(&Refusal::Words(format!("the page asks what its compiler doesn't know: {problem}"))))
        }
    }
}

fn answered(question: &Question) -> String {
    let Question { subject, choices, form } = question;
    let made = match subject.planned(choices) {
        Ok(made) => made,
        Err(refusal) => return written(wrong(&refusal)),
    };
    match form {
        AnswerForm::Plan => written(match made.plan.to_json() {
            Ok(text) => AnswerBody::Plan(text),
            Err(problem) => wrong(&Refusal::Words(problem.to_string())),
        }),
        AnswerForm::View => {
            let SubjectPlan { plan, sources } = &made;
            let name = format!("{} (what if)", subject.name);
            let own = subject.planned(&subject.own).ok();
            let differences = own.map(|own| Differences::between((&subject.name, &own.plan), (&name, plan)));
            let detail = Detail { verbose: true, ..Detail::default() };
            let view = PlanView::of(&name, plan, detail, Some(sources.as_ref()));
            written(AnswerBody::View { plan: Box::new(view), differences })
        }
    }
}

fn wrong(refusal: &Refusal) -> AnswerBody<'static> {
    AnswerBody::Wrong { mistakes: refusal.data(), message: refusal.message() }
}

fn written(body: AnswerBody<'_>) -> String {
    let answer = Answer { version: env!("CARGO_PKG_VERSION"), body };
    // Numbers that JSON can't hold are refused before, and nothing else has no JSON form.
    serde_json::to_string(&answer).unwrap_or_default()
}
