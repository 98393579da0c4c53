#!/usr/bin/env bash
# Modules of many compilers, read by Framewright and by two other readers: `tests/compilers/corpus.sh TOOLS FOLDER [FRAMEWRIGHT]`.
#
# TOOLS is a folder that fetch.sh filled; naga may lie in TOOLS/bin. FOLDER gets all that is made, which isn't kept. FRAMEWRIGHT is a folder
# of pipelines beside those of this checkout, whose shaders are taken too. It takes Debian's glslang-tools, spirv-cross and spirv-tools,
# and about ten minutes. docs/spirv-readers.md has what came of it.
set -e
here=$(cd "$(dirname "$0")" && pwd)
checkout=$(cd "$here/../.." && pwd)
tools=$(cd "${1:?"which tools?"}" && pwd)
mkdir -p "${2:?"which folder?"}"
folder=$(cd "$2" && pwd)
export PATH="$tools:$tools/bin:$PATH" folder
cd "$checkout"
# One build for all: what the whole workspace turns on is on.
cargo build --locked --workspace --bin framewright
cargo build --locked --manifest-path tests/compilers/Cargo.toml --target-dir "$folder/target"
mkdir -p "$folder/base" "$folder/text" "$folder/own/tests"

# Shaders with the macros of passes, by shaderc. Pipelines that are mistakes have none.
stages() {
    (cd "$1" && timeout 60 "$checkout/target/debug/framewright" check "$2" ${3:-} --no-cache --precompiled "$folder/base" >> "$folder/check.log" 2>&1) || true
}
cp -r examples "$folder/own"
cp -r tests/pipelines "$folder/own/tests"
cp -r tests/shaders/* "$folder/own/tests/pipelines"
# Those of examples in all variants, as far as there is time; those of tests and others as they stand, also for two eyes.
for pipeline in examples/pipelines/*.ron; do stages "$folder/own" "$pipeline" --all-variants; done
for pipeline in tests/pipelines/*.ron; do stages "$folder/own" "$pipeline"; stages "$folder/own" "$pipeline" --stereo=auto; done
if [ -n "$3" ]; then
    find "$(cd "$3" && pwd)" -name '*.ron' | while read -r pipeline; do stages "$(dirname "$pipeline")" "$(basename "$pipeline")"; done
fi

# Each stage by each compiler: as it is, by way of GLSL, of HLSL and of WGSL.
one() {
    local base=$1 name stage profile word
    name=$(basename "$base" .spv)
    case "$name" in
        *.vert.*) stage=vert word=vertex profile=vs_6_0 ;;
        *.frag.*) stage=frag word=fragment profile=ps_6_0 ;;
        *.comp.*) stage=comp word=compute profile=cs_6_0 ;;
        *) return 0 ;;
    esac
    local modules=$folder/modules text=$folder/text/$name
    cp "$base" "$modules/shaderc/$name.spv"
    {
        spirv-cross -V "$base" --output "$text.$stage" &&
            {
                glslangValidator -V --target-env vulkan1.3 -S "$stage" -o "$modules/glslang/$name.spv" "$text.$stage"
                glslangValidator -gVS -V --target-env vulkan1.1 -S "$stage" -o "$modules/glslang_lines/$name.spv" "$text.$stage"
                slangc "$text.$stage" -lang glsl -O0 -stage "$word" -entry main -target spirv -o "$modules/slangc_glsl/$name.spv"
            }
        spirv-cross --hlsl --shader-model 60 "$base" --output "$text.hlsl" &&
            {
                glslangValidator -D -V --target-env vulkan1.3 -S "$stage" -e main -o "$modules/glslang_hlsl/$name.spv" "$text.hlsl"
                dxc -spirv -fspv-target-env=vulkan1.3 -T "$profile" -E main -Fo "$modules/dxc/$name.spv" "$text.hlsl"
                dxc -spirv -fspv-target-env=vulkan1.1 -O0 -Zi -fspv-reflect -T "$profile" -E main -Fo "$modules/dxc_debug/$name.spv" "$text.hlsl"
                slangc "$text.hlsl" -O0 -stage "$word" -entry main -target spirv -fvk-use-entrypoint-name -o "$modules/slangc_hlsl/$name.spv"
            }
        # naga takes no image with its sampler: HLSL has them apart.
        if [ -e "$modules/glslang_hlsl/$name.spv" ]; then
            naga "$modules/glslang_hlsl/$name.spv" "$text.wgsl" && naga "$text.wgsl" "$modules/naga_wgsl/$name.spv"
            spirv-cross -V "$modules/glslang_hlsl/$name.spv" --output "$text.naga" &&
                naga --input-kind glsl --shader-stage "$stage" "$text.naga" "$modules/naga_glsl/$name.spv"
        fi
    } > "$folder/text/$name.log" 2>&1 < /dev/null
    return 0
}
export -f one
for compiler in shaderc glslang glslang_lines glslang_hlsl slangc_glsl slangc_hlsl dxc dxc_debug naga_glsl naga_wgsl; do
    rm -rf "$folder/modules/$compiler" "$folder/modules/$compiler"_stripped
    mkdir -p "$folder/modules/$compiler" "$folder/modules/$compiler"_stripped
done
find "$folder/base" -name '*.spv' | sort | xargs -P 2 -I BASE bash -c 'one BASE'
# Texts that people wrote: they hold several entry points.
for text in tests/shaders/spirv/*.slang examples/hlsl/*.slang; do
    slangc "$text" -target spirv -O0 -fvk-use-entrypoint-name -o "$folder/modules/slangc_hlsl/$(basename "$text").spv"
done
for text in tests/shaders/spirv/*.wgsl; do naga "$text" "$folder/modules/naga_wgsl/$(basename "$text").spv"; done
# Each without names. spirv-opt would do it, but Debian's doesn't know Slang, and crashes on what DXC writes for debuggers.
python3 - "$folder" <<'END'
import glob, os, struct, sys
# Sources, names, strings, lines, and what is said of the process: what spirv-opt's --strip-debug takes out.
NOTES = {2, 3, 4, 5, 6, 7, 8, 317, 330}
for path in glob.glob(sys.argv[1] + "/modules/*/*.spv"):
    folder, name = os.path.split(path)
    if folder.endswith("_stripped"):
        continue
    data = open(path, "rb").read()
    words = struct.unpack("<%dI" % (len(data) // 4), data)
    instructions, at = [], 5
    while at < len(words):
        instructions.append(words[at : at + (words[at] >> 16)])
        at += words[at] >> 16
    text = lambda it: b"".join(struct.pack("<I", word) for word in it).split(b"\0")[0]
    notes = {it[1] for it in instructions if it[0] & 0xFFFF == 11 and text(it[2:]).startswith(b"NonSemantic")}
    kept = list(words[:5])
    for it in instructions:
        op = it[0] & 0xFFFF
        if op in NOTES or op == 11 and it[1] in notes or op == 12 and it[3] in notes:
            continue
        kept += it
    open("%s_stripped/%s" % (folder, name), "wb").write(struct.pack("<%dI" % len(kept), *kept))
END

export FRAMEWRIGHT_CORPUS=$folder
cargo test --locked --workspace --lib shaders::corpus -- --ignored --nocapture
"$folder/target/debug/reflections" "$folder"
