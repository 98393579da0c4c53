//! Values of expressions.

use crate::expression::world::World;
use framewright_graph::expression::{Origin, Value};
use framewright_graph::frame::{BufferIndex, ImageIndex};
use framewright_graph::vulkan::Format;

fn value(text: &str) -> Value {
    World::new().outcome(text).value
}

fn integer(text: &str) -> i64 {
    match value(text) {
        Value::Integer(value) => value,
        other => panic!("{text} is {other}"),
    }
}

fn number(text: &str) -> f64 {
    match value(text) {
        Value::Number(value) => value,
        other => panic!("{text} is {other}"),
    }
}

fn holds(text: &str) -> bool {
    match value(text) {
        Value::Bool(value) => value,
        other => panic!("{text} is {other}"),
    }
}

fn image(text: &str) -> u32 {
    match value(text) {
        Value::Image(ImageIndex(value)) => value,
        other => panic!("{text} is {other}"),
    }
}

#[test]
fn literals_are_themselves() {
    assert_eq!(integer("12"), 12);
    assert_eq!(integer(" -12 "), -12);
    assert_eq!(integer("9223372036854775807"), i64::MAX);
    assert_eq!(integer("-9223372036854775808"), i64::MIN);
    assert_eq!([number("0.5"), number("1e-3"), number("2E+2"), number("-1.5e1")], [0.5, 0.001, 200.0, -15.0]);
    assert!(holds("true") && !holds("false"));
    assert_eq!(value("'high & low'"), Value::Text("high & low".into()));
    assert_eq!(value("''"), Value::Text("".into()));
}

#[test]
fn names_and_formats_stand_for_their_values() {
    assert_eq!(integer("levels"), 5);
    assert_eq!(integer("view.width"), 1920);
    assert!(holds("scene.has_opaque"));
    assert_eq!(image("source"), 0);
    assert_eq!(value("lights"), Value::Buffer(BufferIndex(3)));
    assert_eq!(value("R16G16B16A16_SFLOAT"), Value::Format(Format::R16G16B16A16_SFLOAT));
    assert_eq!(value("if(hdr, R16_SFLOAT, R8_UNORM)"), Value::Format(Format::R16_SFLOAT));
}

#[test]
fn a_declared_name_comes_before_a_format_of_that_name() {
    let mut world = World::new();
    world.add("R8_UNORM", Origin::Setting, Value::Integer(8));
    assert_eq!(world.outcome("R8_UNORM + 1").value, Value::Integer(9));
}

#[test]
fn operators_bind_as_everywhere() {
    assert_eq!(integer("1 + 2 * 3"), 7);
    assert_eq!(integer("(1 + 2) * 3"), 9);
    assert_eq!(integer("10 - 3 - 2"), 5);
    assert_eq!(integer("7 % 4 * 2"), 6);
    assert_eq!(integer("-2 * -3 - -1"), 7);
    assert_eq!(integer("- -levels - 1"), 4);
    assert_eq!(number("12 / 2 / 3"), 2.0);
    assert!(holds("1 + 1 == 2 && 2 < 3"));
    assert!(holds("true || false && false"));
    assert!(!holds("(true || false) && false"));
    assert!(holds("!false == true"));
    assert!(holds("!!hdr"));
}

#[test]
fn whole_numbers_stay_whole_except_when_divided() {
    assert_eq!(number("7 / 2"), 3.5);
    assert_eq!(number("6 / 2"), 3.0);
    assert_eq!(integer("floor(7 / 2)"), 3);
    assert_eq!(integer("floor(-7 / 2)"), -4);
    assert_eq!(integer("ceil(7 / 2)"), 4);
    assert_eq!([integer("round(2.5)"), integer("round(-2.5)"), integer("round(levels)")], [3, -3, 5]);
    assert_eq!(integer("floor(-9223372036854775808.0)"), i64::MIN);
    assert_eq!(number("levels * 0.5"), 2.5);
    assert_eq!(integer("abs(-3)"), 3);
    assert_eq!(number("abs(-3.5)"), 3.5);
}

#[test]
fn remainders_are_never_negative() {
    assert_eq!([integer("7 % 3"), integer("-7 % 3"), integer("7 % -3"), integer("-7 % -3")], [1, 2, 1, 2]);
    assert_eq!(integer("-9223372036854775808 % -1"), 0);
    assert_eq!(number("-0.5 % 2"), 1.5);
}

#[test]
fn whole_numbers_meet_numbers_as_numbers_even_where_the_whole_one_is_chosen() {
    assert_eq!(number("if(true, 1, 0.5)"), 1.0);
    assert_eq!(number("if(false, 0.5, 1)"), 1.0);
    assert_eq!(number("min(1, 2.5)"), 1.0);
    assert_eq!(number("max(3, 2.5, 1)"), 3.0);
    assert_eq!(number("clamp(9, 0.5, 4)"), 4.0);
    assert_eq!(number("weights[1]"), 2.0);
    assert!(holds("1 == 1.0 && 1 < 1.5 && 2.5 >= 2"));
    assert_eq!(number("if(true, 9223372036854775807, 0.5) + 1"), 9_223_372_036_854_775_808.0);
    assert_eq!(number("min(9223372036854775807, 1e300) + 1"), 9_223_372_036_854_775_808.0);
    let world = World::new().with("radius", Value::Integer(3));
    assert_eq!(world.outcome("radius").value, Value::Number(3.0));
}

#[test]
fn functions_are_those_of_mathematics() {
    assert_eq!([integer("min(3, 1, 2)"), integer("max(3, 1, 2)")], [1, 3]);
    assert_eq!([integer("clamp(7, 0, 4)"), integer("clamp(-7, 0, 4)"), integer("clamp(2, 0, 4)")], [4, 0, 2]);
    assert_eq!([number("sqrt(9)"), number("exp2(3)"), number("log2(8)"), number("pow(2, -1)")], [3.0, 8.0, 3.0, 0.5]);
    assert_eq!(number("pow(-2, 3)"), -8.0);
    assert_eq!(number("pow(0, 0)"), 1.0);
    assert_eq!(integer("floor(log2(max(view.width, 1)))"), 10);
}

#[test]
fn equality_is_of_any_two_values_of_one_type() {
    assert!(holds("quality == 'high' && quality != 'low'"));
    assert!(holds("hdr == true && hdr != bloom"));
    assert!(holds("R8_UNORM == R8_UNORM && R8_UNORM != R16_SFLOAT"));
    assert!(holds("down[0] != source && down[0] == down[i - 1]"));
    assert!(holds("lights == lights"));
}

#[test]
fn elements_are_counted_from_0() {
    assert_eq!([image("down[0]"), image("down[2]"), image("down[i - 1]"), image("down[i % 3]")], [1, 3, 1, 2]);
    assert_eq!(image("if(i == 0, source, down[i - 1])"), 1);
    let first = World::new().with("i", Value::Integer(0));
    assert_eq!(first.outcome("if(i == 0, source, down[i - 1])").value, Value::Image(ImageIndex(0)));
}

#[test]
fn images_tell_their_properties() {
    assert_eq!([integer("width(source)"), integer("height(source)")], [1920, 1024]);
    assert_eq!([integer("mips(down[1])"), integer("layers(source)"), integer("samples(source)")], [3, 6, 4]);
    assert_eq!(integer("max(1, floor(width(down[i]) / 2))"), 240);
}

#[test]
fn only_what_is_needed_is_evaluated() {
    assert!(!holds("none != 0 && 1 / none > 0"));
    assert!(holds("none == 0 || 1 / none > 0"));
    assert_eq!(number("if(none == 0, 0.0, 1 / none)"), 0.0);
    assert_eq!(number("if(none != 0, 1 / none, 0.0)"), 0.0);
    assert!(!holds("false && 1 / none > 0 || false"));
    assert_eq!(integer("if(false, if(true, width(later), 1), if(true, 2, width(later)))"), 2);
}

#[test]
fn blanks_and_line_breaks_do_not_matter() {
    assert_eq!(integer("\n\t min ( levels ,\r\n 3 ) "), 3);
    assert_eq!(integer("1+2*levels-1"), 10);
    assert_eq!(image("down [ 1 ]"), 2);
}
