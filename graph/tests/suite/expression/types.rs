//! The types that places want, and the type of the whole expression, which doesn't depend on values.

use crate::expression::world::{ANY, World};
use framewright_graph::base::Span;
use framewright_graph::expression::{Expression, Type, Value, WantedTypes};

fn ty(text: &str, wanted: WantedTypes<'_>) -> Option<Type> {
    Expression::new(text, Span::NONE, &World::new(), wanted).ok().map(|expression| expression.ty())
}

#[test]
fn every_place_takes_what_it_wants_and_nothing_else() {
    let texts = ["hdr", "levels", "radius", "quality", "R8_UNORM", "source", "lights"];
    let taken = |wanted: WantedTypes<'_>| texts.map(|text| ty(text, wanted).is_some());
    assert_eq!(taken(WantedTypes::BOOL), [true, false, false, false, false, false, false]);
    assert_eq!(taken(WantedTypes::INTEGER), [false, true, false, false, false, false, false]);
    assert_eq!(taken(WantedTypes::NUMBER), [false, true, true, false, false, false, false]);
    assert_eq!(taken(WantedTypes::FORMAT), [false, false, false, false, true, false, false]);
    assert_eq!(taken(WantedTypes::IMAGE), [false, false, false, false, false, true, false]);
    assert_eq!(taken(WantedTypes::BUFFER), [false, false, false, false, false, false, true]);
    assert_eq!(taken(WantedTypes::RESOURCE), [false, false, false, false, false, true, true]);
    assert_eq!(taken(WantedTypes::PARAMETER), [true, true, true, false, false, false, false]);
    assert_eq!(taken(ANY), [true; 7]);
}

#[test]
fn a_whole_number_becomes_a_number_where_only_a_number_is_wanted() {
    assert_eq!(ty("levels", WantedTypes::NUMBER), Some(Type::Number));
    assert_eq!(ty("levels", WantedTypes::PARAMETER), Some(Type::Integer));
    let world = World::new();
    let expression = Expression::new("levels + 1", Span::NONE, &world, WantedTypes::NUMBER).expect("right");
    assert_eq!(expression.evaluate(&world).expect("a value").value, Value::Number(6.0));
}

#[test]
fn what_is_never_evaluated_is_checked_too() {
    for text in ["true || levels", "false && 'x'", "if(true, 1, hdr)", "if(true, 1, 1 + hdr)", "true || nowhere == 1"] {
        assert_eq!(ty(text, ANY), None, "{text}");
    }
}

#[test]
fn a_mistake_that_was_reported_already_is_not_reported_again() {
    let world = World::new();
    for text in
        ["broken", "broken + 1", "!broken", "broken[0]", "if(broken, 1, 2)", "min(1, broken) < 3", "down[broken]"]
    {
        let errors = Expression::new(text, Span::NONE, &world, WantedTypes::PARAMETER).err();
        assert!(text.starts_with("down") || errors.as_ref().is_some_and(Vec::is_empty), "{text}: {errors:?}");
    }
    let expression = Expression::new("width(lone[0])", Span::NONE, &world, ANY).expect("right");
    assert_eq!(expression.evaluate(&world).err(), Some(Vec::new()));
}

#[test]
fn a_value_of_another_type_than_was_declared_is_a_mistake_not_a_crash() {
    let expression = Expression::new("levels + 1", Span::NONE, &World::new(), ANY).expect("right");
    for odd in [Value::Bool(true), Value::Text("x".into()), Value::Number(1.0)] {
        let errors = expression.evaluate(&World::new().with("levels", odd)).expect_err("no whole number");
        assert_eq!(errors[0].message, "this has a value of another type than was declared");
    }
    let expression = Expression::new("radius", Span::NONE, &World::new(), ANY).expect("right");
    assert!(expression.evaluate(&World::new().with("radius", Value::Number(f64::NAN))).is_err());
}
