//! The language as a JSON Schema, draft 2020-12, for the JSON that [`convert`](crate::ron::convert()) makes of files.

use super::settings_file::SettingsFields;
use crate::language::compose::tables::{EXTENDING, EXTENSION, LibraryFields, PIPELINE};
use crate::language::entries::shader::LONGEST;
use crate::language::entries::work::GOES_WITH;
use crate::ron::{FieldTable, Form, PlainForm, Row, Table, Word, WordContents, Words};
use serde_json::{Map, Value, json};

/// The schema of pipelines, files of fragments and settings files.
///
/// A file that it refuses is wrong. One that it accepts may still be wrong: it knows no names in files, and no expressions.
#[must_use]
pub fn schema() -> Value {
    let mut schema = Schema::default();
    let files: Vec<Value> = FILES.iter().map(|table| schema.table(table())).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Files of Framewright, written as JSON",
        "description": RULES,
        "anyOf": files,
        "$defs": schema.definitions,
    })
}

/// How RON is written as JSON.
const RULES: &str = "RON is written as JSON so: (name: value) is {\"name\": value}; (a, b) and [a, b] are [a, b]; Word(…) is \
                     {\"Word\": …} with what stands in the parentheses; Word alone is {\"Word\": []}; {\"key\": value}, texts, \
                     numbers, true and false stay; Some(value) is the value, and a field that is None is left out.";

#[derive(Default)]
struct Schema {
    definitions: Map<String, Value>,
}

impl Schema {
    /// A reference to a definition, which is made unless it is there or being made.
    fn named(&mut self, name: &str, make: impl FnOnce(&mut Schema) -> Value) -> Value {
        if !self.definitions.contains_key(name) {
            self.definitions.insert(name.to_owned(), Value::Null);
            let made = make(self);
            self.definitions.insert(name.to_owned(), made);
        }
        json!({ "$ref": format!("#/$defs/{name}") })
    }

    /// Fields with or without the word before them.
    fn table(&mut self, table: Table) -> Value {
        let Some(word) = table.word else { return self.fields(table) };
        self.named(table.name.trim_end_matches("Fields"), |schema| {
            let fields = schema.fields(table);
            json!({ "anyOf": [fields, only(word, &fields)] })
        })
    }

    fn fields(&mut self, table: Table) -> Value {
        self.named(table.name, |schema| {
            let field = |row: &Row| {
                let mut value = schema.form(&row.form);
                value["description"] = json!(text(row.about));
                (row.name.to_owned(), value)
            };
            let properties: Map<String, Value> = table.rows.iter().map(field).collect();
            let needed: Vec<&str> = table.rows.iter().filter(|row| row.needed).map(|row| row.name).collect();
            let about = text(table.about);
            let fields = json!({
                "description": about,
                "type": "object",
                "properties": properties,
                "required": needed,
                "additionalProperties": false,
            });
            // `()` are no fields as well as no values.
            if needed.is_empty() { json!({ "anyOf": [fields, nothing()] }) } else { fields }
        })
    }

    fn words(&mut self, words: &'static Words) -> Value {
        self.named(words.name, |schema| {
            let mut all: Vec<Value> = words.or.iter().map(|or| schema.form(or)).collect();
            all.extend(words.all.iter().map(|word| schema.word(word)));
            json!({ "description": words.what, "anyOf": all })
        })
    }

    fn word(&mut self, word: &Word) -> Value {
        let takes: Vec<Value> = word
            .takes
            .iter()
            .map(|takes| match takes {
                WordContents::Nothing => nothing(),
                WordContents::Values(values) => self.tuple(values),
                WordContents::Fields(table) => self.fields(table()),
            })
            .collect();
        let mut value = only(word.word, &either(takes));
        value["description"] = json!(word.about);
        value
    }

    fn tuple(&mut self, values: &[Form]) -> Value {
        let values: Vec<Value> = values.iter().map(|value| self.form(value)).collect();
        json!({ "type": "array", "minItems": values.len(), "prefixItems": values, "items": false })
    }

    fn form(&mut self, form: &Form) -> Value {
        match form {
            Form::Anything | Form::Open(_) => json!({}),
            Form::Plain(plain) => self.plain(*plain),
            Form::Truth => json!({ "anyOf": [{ "type": "boolean" }, self.expression("true or false")] }),
            Form::Whole(least, most) => {
                let number = json!({ "type": "integer", "minimum": least, "maximum": most });
                json!({ "anyOf": [number, self.expression("a whole number")] })
            }
            Form::Listed(numbers) => json!({ "enum": numbers }),
            Form::Number => json!({ "anyOf": [{ "type": "number" }, self.expression("a number")] }),
            Form::Expression(what) | Form::Reference(what) => self.expression(what),
            Form::Fields(table) => self.table(table()),
            Form::Words(words) => self.words(words),
            Form::Choice(what, words) => {
                let name: String = what.split_once(' ').map_or(*what, |(_, noun)| noun).replace([' ', '\''], "_");
                let all: Vec<Value> = words().into_iter().map(|word| json!({ word: [] })).collect();
                self.named(&name, |_| json!({ "description": what, "enum": all }))
            }
            Form::Tuple(values) => self.tuple(values),
            Form::Several(of, least, most) => {
                json!({ "type": "array", "minItems": least, "maxItems": most, "items": self.form(of) })
            }
            Form::List(of) => json!({ "type": "array", "items": self.form(of) }),
            Form::Map(_, of) => json!({ "type": "object", "additionalProperties": self.form(of) }),
            Form::Either(forms) => either(forms.iter().map(|form| self.form(form)).collect()),
        }
    }

    fn plain(&mut self, plain: PlainForm) -> Value {
        let name = |letters: &str| {
            let pattern = format!("^[\\p{{Alphabetic}}_][\\p{{Alphabetic}}\\p{{N}}{letters}]*$");
            json!({ "type": "string", "pattern": pattern, "maxLength": 64 })
        };
        match plain {
            PlainForm::Truth => json!({ "type": "boolean" }),
            PlainForm::Whole => json!({ "type": "integer" }),
            PlainForm::Number => json!({ "type": "number" }),
            PlainForm::Text => json!({ "type": "string" }),
            PlainForm::Name => self.named("name", |_| name("_")),
            PlainForm::Outside => self.named("outside_name", |_| name("_\\-")),
            PlainForm::Shader => self.named("shader_name", |_| {
                let pattern = "\\.(spv|hlsl|slang|wgsl)(:[^ ,]+)?$";
                let file = json!({ "type": "string", "pattern": pattern, "maxLength": LONGEST });
                json!({ "anyOf": [name("_\\-"), file] })
            }),
        }
    }

    fn expression(&mut self, what: &str) -> Value {
        json!({ "description": format!("a name or an expression for {what}"), "type": "string", "minLength": 1 })
    }
}

/// An object with this one member.
fn only(name: &str, value: &Value) -> Value {
    json!({ "type": "object", "properties": { name: value }, "required": [name], "additionalProperties": false })
}

fn nothing() -> Value {
    json!({ "type": "array", "maxItems": 0 })
}

fn either(mut forms: Vec<Value>) -> Value {
    if forms.len() == 1 { forms.remove(0) } else { json!({ "anyOf": forms }) }
}

/// Lines of documentation as one text, without examples.
fn text(lines: &[&str]) -> String {
    let lines = lines.iter().map(|line| line.trim()).take_while(|line| !line.starts_with("```"));
    lines.collect::<Vec<_>>().join(" ").trim().to_owned()
}

/// The kinds of file: pipelines, pipelines that extend others, extensions, files of fragments, settings files.
pub const FILES: [fn() -> Table; 5] =
    [|| PIPELINE, || EXTENDING, || EXTENSION, LibraryFields::<'static>::table, SettingsFields::<'static>::table];

/// The kinds of work beside which a field of a pass has a meaning; `None`: all.
#[must_use]
pub fn goes_with(field: &str) -> Option<&'static [&'static str]> {
    GOES_WITH.iter().find(|(known, _)| *known == field).map(|(_, words)| *words)
}
