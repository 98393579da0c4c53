//! Bounds on length and depth, and that nothing recurses beyond them.

use crate::expression::world::{ANY, World};
use framewright_graph::base::Span;
use framewright_graph::expression::{Expression, LONGEST_TEXT, MOST_NESTED, Value};

/// Reads and evaluates on a stack of 256 KiB, which recursion along the text would overflow.
fn on_a_small_stack(text: String) -> Result<Value, String> {
    let run = move || {
        let world = World::new();
        let expression = Expression::new(&text, Span::NONE, &world, ANY);
        let outcome = expression.and_then(|expression| expression.evaluate(&world));
        outcome.map(|outcome| outcome.value).map_err(|errors| errors[0].message.clone())
    };
    let thread = std::thread::Builder::new().stack_size(256 << 10).spawn(run).expect("a thread");
    thread.join().expect("no panic")
}

#[test]
fn an_expression_as_long_as_allowed_is_read_and_a_longer_one_is_not() {
    let long = format!("1{}", "+1".repeat(2047));
    assert_eq!(on_a_small_stack(format!("{long} ")), Ok(Value::Integer(2048)));
    assert_eq!(long.len() + 1, LONGEST_TEXT);
    assert_eq!(
        on_a_small_stack(format!("{long}  ")),
        Err("this expression has 4097 bytes; 4096 are allowed".to_owned())
    );
    let any = format!("false{}", "||false".repeat(500));
    assert_eq!(on_a_small_stack(any), Ok(Value::Bool(false)));
    let all = format!("true{}", "&&true".repeat(600));
    assert_eq!(on_a_small_stack(all), Ok(Value::Bool(true)));
}

#[test]
fn nesting_as_deep_as_allowed_is_read_and_deeper_is_not() {
    let too_deep = Err(format!("this is nested more than {MOST_NESTED} deep"));
    let kinds: [(&dyn Fn(usize) -> String, Value); 4] = [
        (&|depth| format!("{}1{}", "(".repeat(depth), ")".repeat(depth)), Value::Integer(1)),
        (&|depth| format!("{}levels", "-".repeat(depth)), Value::Integer(5)),
        (&|depth| format!("{}hdr", "!".repeat(depth)), Value::Bool(true)),
        (&|depth| format!("{}1{}", "min(2,".repeat(depth), ")".repeat(depth)), Value::Integer(1)),
    ];
    for (text, value) in kinds {
        assert_eq!(on_a_small_stack(text(MOST_NESTED)), Ok(value.clone()));
        assert_eq!(on_a_small_stack(text(MOST_NESTED + 1)), too_deep);
        assert_eq!(on_a_small_stack(text(500)), too_deep);
    }
    let steep = format!("{}1{}", "true&&1<0+1*(".repeat(MOST_NESTED), ")".repeat(MOST_NESTED));
    assert!(on_a_small_stack(steep).is_err_and(|message| message.contains("needs a number")));
    let indices = format!("{}0{}", "weights[".repeat(400), "]".repeat(400));
    assert_eq!(on_a_small_stack(indices), too_deep);
    let choices = format!("{}1{}", "if(true, ".repeat(MOST_NESTED), ", 0)".repeat(MOST_NESTED));
    assert_eq!(on_a_small_stack(choices), Ok(Value::Integer(1)));
}
