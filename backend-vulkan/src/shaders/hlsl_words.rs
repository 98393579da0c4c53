//! What the compiler of HLSL of this program says, in the words of the shader.

use framewright_graph::base::OutsideChoice;
use framewright_graph::shader::ShaderMessage;

/// What the compiler puts before the name of a method that it doesn't know.
const OF_METHODS: &str = "__BI_";

/// The end of what the compiler says, once it has told the mistakes themselves.
const END: &str = "HLSL parsing failed";

/// The messages without the compiler's own words.
pub(super) fn plain(messages: Vec<String>) -> Vec<String> {
    let is_end = |message: &String| message.contains(END);
    let only_ends = messages.iter().all(is_end);
    let told = messages.into_iter().filter(|message| only_ends || !is_end(message));
    told.map(|message| message.replace(OF_METHODS, "")).collect()
}

/// That another compiler has better words.
pub(super) fn better_told() -> ShaderMessage {
    ShaderMessage {
        text: "DXC tells more of a mistake in HLSL".to_owned(),
        quote: None,
        limit: Some(OutsideChoice::ShaderCompiler),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_compilers_own_words_are_left_out() {
        let told = |messages: &[&str]| plain(messages.iter().map(|it| (*it).to_owned()).collect());
        let end = "a.hlsl: a.hlsl(29): error at column 10, HLSL parsing failed.";
        assert_eq!(told(&["a.hlsl:29: error: ';' : Expected", end]), ["a.hlsl:29: error: ';' : Expected"]);
        assert_eq!(told(&[end]), [end], "it said nothing else");
        assert_eq!(
            told(&["a.hlsl:24: error: '__BI_Smaple' : no matching overloaded function found"]),
            ["a.hlsl:24: error: 'Smaple' : no matching overloaded function found"]
        );
    }
}
