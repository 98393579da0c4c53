//! The page on C holds its examples, word for word (EM-12).

use crate::testing::text;

#[test]
fn the_page_on_c_holds_the_examples() {
    let page = text("docs/c.md");
    for example in ["embed_minimal.c", "embed_own_device.c"] {
        let example = format!("examples/{example}");
        assert!(page.contains(&format!("```c\n{}```", text(&example))), "docs/c.md doesn't hold {example}");
    }
}
