//! Comments of a GLSL file, by what stands below them.

/// The text of the comment right above the first line that `is` accepts; empty without one.
pub(crate) fn above(text: &str, is: impl Fn(&str) -> bool) -> String {
    let mut comment: Vec<&str> = Vec::new();
    for line in text.lines().map(str::trim) {
        if is(line) {
            return comment.join(" ");
        }
        match line.strip_prefix("//") {
            Some(said) => comment.push(said.trim()),
            None => comment.clear(),
        }
    }
    String::new()
}

/// The comment above a binding of the pass.
pub(crate) fn of_binding(text: &str, binding: u32) -> String {
    above(text, |line| line.starts_with(&format!("layout(set = 0, binding = {binding}")))
}

/// The type of a member of the block of parameters, as it is declared (compiled, `bool` is `uint`), and the comment above it.
pub(crate) fn of_param<'t>(text: &'t str, name: &str) -> (&'t str, String) {
    let block = text.split_once("uniform Params {").map_or("", |(_, after)| after);
    let block = block.split_once('}').map_or("", |(inside, _)| inside);
    let ty = block.lines().find_map(|line| type_of(line.trim(), name)).unwrap_or_default();
    (ty, above(block, |line| type_of(line, name).is_some()))
}

/// The type, if a line declares `name`.
fn type_of<'t>(line: &'t str, name: &str) -> Option<&'t str> {
    line.strip_suffix(';')?.split_once(' ').filter(|(_, it)| *it == name).map(|(ty, _)| ty)
}

/// The comment above `main`, which says what the whole shader does.
pub(crate) fn of_main(text: &str) -> String {
    above(text, |line| line.starts_with("void main()"))
}

#[test]
fn a_comment_belongs_to_the_line_right_below_it() {
    let text = "// Of the first.\nfirst;\n\n// Two\n// lines.\nsecond;\n// Of nothing.\n\nthird;";
    assert_eq!(above(text, |line| line == "first;"), "Of the first.");
    assert_eq!(above(text, |line| line == "second;"), "Two lines.");
    assert_eq!(above(text, |line| line == "third;"), "");
}
