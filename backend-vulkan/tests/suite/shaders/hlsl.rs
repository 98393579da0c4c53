//! Files in HLSL: bindings of both stages, and entry points that are misspelt.

use super::*;
use framewright_graph::shader::FileLanguage;
use framewright_vulkan::ShaderCompilers;
use rspirv::dr::Operand;
use rspirv::spirv::Decoration;

/// No register is written, so the compiler numbers what each stage uses from 0 on.
const TWO_STAGES: &str = "
Texture2D<float4> high;
Texture2D<float4> both;
Texture2D<float4> low;
SamplerState smooth;
cbuffer Shift { float4 shift; };
float4 VSMain(uint number : SV_VertexID) : SV_Position { return high.Load(int3(number, 0, 0)) + both.Load(0) + shift; }
float4 PSMain(float4 at : SV_Position) : SV_Target { return low.Sample(smooth, at.xy) + both.Sample(smooth, at.xy) + shift; }
float4 PSLow(float4 at : SV_Position) : SV_Target { return low.Load(int3(at.xy, 0)); }
";

fn folder(name: &str, text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(name), text).expect("a file");
    folder
}

/// The bindings of set 0 that SPIR-V decorates, each with the number of variables there.
fn decorated(spirv: &[u32]) -> Vec<u32> {
    let module = rspirv::dr::load_words(spirv).expect("SPIR-V");
    let bindings = module.annotations.iter().filter_map(|it| match it.operands[..] {
        [_, Operand::Decoration(Decoration::Binding), Operand::LiteralBit32(binding)] => Some(binding),
        _ => None,
    });
    let mut bindings: Vec<u32> = bindings.collect();
    bindings.sort_unstable();
    bindings
}

#[test]
fn both_stages_without_registers_have_each_name_at_a_binding_of_its_own() {
    let folder = folder("two.hlsl", TWO_STAGES);
    let fragments =
        [("PSMain", vec!["both", "high", "low", "params", "smooth"]), ("PSLow", vec!["both", "high", "low", "params"])];
    for (fragment, wanted) in fragments {
        let name = format!("vertex two.hlsl:VSMain, fragment two.hlsl:{fragment}");
        let draw = Draw::Vertices { count: 3, instances: 1 };
        let shader = library(folder.path()).compiled(&name, draw, &Variant::default()).expect("both fit");
        let places: Vec<(u32, u32)> = shader.interface.bindings.iter().map(|it| (it.set, it.binding)).collect();
        let mut apart = places.clone();
        apart.dedup();
        assert_eq!(places, apart, "{fragment}");
        let mut names: Vec<&str> = shader.interface.bindings.iter().map(|it| &*it.name).collect();
        names.sort();
        assert_eq!(names, wanted, "{fragment}");
        // The modules say the same.
        let of_stages = [&shader.vertex, shader.fragment.as_ref().expect("colours")].map(|spirv| decorated(spirv));
        let mut all: Vec<u32> = of_stages.concat();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all, places.iter().map(|(_, binding)| *binding).collect::<Vec<_>>(), "{fragment}");
    }
}

#[test]
fn a_misspelt_entry_point_is_told_with_the_one_that_was_meant() {
    let folder = folder("two.hlsl", TWO_STAGES);
    fs::write(folder.path().join("two.slang"), TWO_STAGES).expect("a file");
    // Whatever compiles it, and where nothing does.
    let mut fails = ShaderCompilers::default();
    fails.set(FileLanguage::Slang, "sh -c \"echo no; exit 1\" {entry} {input} {output}").expect("a command");
    for (compilers, file) in
        [(ShaderCompilers::default(), "two.hlsl"), (fails, "two.slang"), (ShaderCompilers::default(), "two.slang")]
    {
        let mut library = library(folder.path()).with_compilers(compilers);
        let name = format!("fragment {file}:PSMian");
        match library.draw_shader(&name, Draw::FullScreen, &Variant::default()) {
            Err(ShaderProblem::EntryPoint { named, of_stage, .. }) => {
                assert_eq!((named.as_deref(), &of_stage[..]), (Some("PSMian"), &["PSMain".to_owned()][..]), "{file}");
            }
            other => panic!("{file}: {other:?}"),
        }
        // A name that nothing resembles is the compiler's to complain of.
        let other = library.draw_shader(&format!("fragment {file}:glow"), Draw::FullScreen, &Variant::default());
        assert!(!matches!(other, Ok(_) | Err(ShaderProblem::EntryPoint { .. })), "{other:?}");
    }
}
