//! Decisions behind a value, and the part of a condition that failed.

use crate::expression::world::{ANY, World};
use framewright_graph::base::Span;
use framewright_graph::expression::{Decision, Expression, ParsedExpression, Type, Value, WantedTypes};

fn decided(text: &str) -> String {
    let outcome = World::new().outcome(text);
    outcome.decided.iter().map(Decision::to_string).collect::<Vec<_>>().join(", ")
}

/// The part that failed and why.
fn failed(text: &str) -> (String, String) {
    let outcome = World::new().outcome(text);
    let failed = outcome.failed.clone().unwrap_or_else(|| panic!("{text} is {}", outcome.value));
    (failed.text, outcome.because())
}

#[test]
fn settings_facts_views_and_devices_decide_each_once_in_the_order_of_reading() {
    assert_eq!(decided("view.width * levels + levels"), "view.width = 1920, levels = 5");
    assert_eq!(decided("scene.has_opaque || device.local_read"), "scene.has_opaque = true");
    assert_eq!(decided("device.local_read || bloom"), "device.local_read = false, bloom = false");
    assert_eq!(decided("quality == 'high' && radius > 1"), "quality = 'high', radius = 1.5");
    assert_eq!(decided("1 + 1"), "");
    assert_eq!(decided("weights[1] + weights[i - 1] + weights[1]"), "weights[1] = 2, weights[i - 1] = 0.5");
}

#[test]
fn what_was_not_evaluated_did_not_decide() {
    assert_eq!(decided("if(hdr, levels, none)"), "hdr = true, levels = 5");
    assert_eq!(decided("bloom && hdr"), "bloom = false");
}

/// NU-6: a fact that alone decided stands alone.
#[test]
fn an_operand_that_changes_nothing_did_not_decide() {
    assert_eq!(decided("hdr && bloom"), "bloom = false");
    assert_eq!(decided("bloom || hdr"), "hdr = true");
    assert_eq!(decided("hdr && scene.has_opaque && levels > 9"), "levels = 5");
    assert_eq!(decided("hdr && scene.has_opaque && levels > 1"), "hdr = true, scene.has_opaque = true, levels = 5");
    assert_eq!(decided("(hdr || bloom) && levels > 9"), "levels = 5");
    assert_eq!(decided("if(hdr && bloom, 1, levels)"), "bloom = false, levels = 5");
    assert_eq!(decided("!(bloom || hdr && scene.has_opaque)"), "hdr = true, scene.has_opaque = true");
}

#[test]
fn indices_and_images_decide_nothing_and_parameters_pass_on_what_decided_them() {
    assert_eq!(decided("down[i - 1]"), "");
    assert_eq!(decided("strength * levels + strength"), "glow = 25, levels = 5");
    assert_eq!(decided("samples(source) * levels"), "glow = 25, levels = 5");
    assert_eq!(decided("width(source)"), "");
}

#[test]
fn of_a_conjunction_the_operand_that_fails_made_it_fail() {
    let part = |text: &str, because: &str| (text.to_owned(), because.to_owned());
    assert_eq!(failed("bloom"), part("bloom", "bloom = false"));
    assert_eq!(failed("hdr && bloom && scene.has_opaque"), part("bloom", "bloom = false"));
    assert_eq!(failed("hdr && (levels > 9 && bloom)"), part("levels > 9", "levels = 5"));
    assert_eq!(failed("hdr && !scene.has_opaque"), part("!scene.has_opaque", "scene.has_opaque = true"));
}

#[test]
fn of_a_disjunction_and_of_a_choice_the_whole_made_it_fail() {
    let part = |text: &str, because: &str| (text.to_owned(), because.to_owned());
    let either = "scene.has_transparent || bloom";
    assert_eq!(failed(either), part(either, "scene.has_transparent = false, bloom = false"));
    assert_eq!(failed(&format!("hdr && ({either})")), part(either, "scene.has_transparent = false, bloom = false"));
    assert_eq!(failed("hdr && bloom || levels == 1"), part("hdr && bloom || levels == 1", "bloom = false, levels = 5"));
    assert_eq!(failed("hdr && if(bloom, true, false)"), part("if(bloom, true, false)", "bloom = false"));
}

#[test]
fn only_conditions_fail() {
    let world = World::new();
    assert_eq!(world.outcome("hdr").failed, None);
    assert_eq!(world.outcome("0").failed, None);
    assert_eq!(world.outcome("if(bloom, 1, 2)").because(), "bloom = false");
    assert_eq!(world.outcome("hdr || bloom").because(), "hdr = true");
}

#[test]
fn the_part_that_failed_has_its_place() {
    let world = World::new();
    let expression =
        Expression::new("hdr && (bloom)", Span::new(4, 100, 114), &world, WantedTypes::BOOL).expect("right");
    let failed = expression.evaluate(&world).expect("a value").failed.expect("it fails");
    assert_eq!(failed.span, Span::new(4, 108, 113));
    assert_eq!((expression.text(), expression.span()), ("hdr && (bloom)", Span::new(4, 100, 114)));
}

#[test]
fn names_are_told_once_with_their_first_places_before_and_after_they_are_known() {
    let text = "if(hdr, down[i], down[i - 1]) == unheard.of";
    let parsed = ParsedExpression::new(text, Span::new(0, 50, 93)).expect("it parses");
    let names: Vec<(&str, u32)> = parsed.names().map(|(name, span)| (name, span.start - 50)).collect();
    assert_eq!(names, [("hdr", 3), ("down", 8), ("i", 13), ("unheard.of", 33)]);
    let expression = Expression::new("R8_UNORM == R16_SFLOAT || hdr", Span::NONE, &World::new(), ANY).expect("right");
    assert_eq!(expression.names().map(|(name, _)| name).collect::<Vec<_>>(), ["R8_UNORM", "R16_SFLOAT", "hdr"]);
    let symbols: Vec<Type> = expression.symbols().map(|symbol| symbol.ty).collect();
    assert_eq!(symbols, [Type::Bool]);
}

#[test]
fn an_expression_is_read_once_and_evaluated_with_many_values() {
    let expression = Expression::new("levels * 2", Span::NONE, &World::new(), ANY).expect("right");
    for levels in -3..3 {
        let world = World::new().with("levels", Value::Integer(levels));
        assert_eq!(expression.evaluate(&world).expect("a value").value, Value::Integer(2 * levels));
    }
}
