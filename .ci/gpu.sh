#!/usr/bin/env bash
# Tests and measurements on a GPU, on a machine that has no Rust and no network: all that they need travels in one archive.
#
# usage: .ci/gpu.sh pack FILE.tar.xz         builds and packs
#        .ci/gpu.sh run FOLDER [PART…]       there, in the unpacked archive: device, tests, random, pictures, times, study;
#                                            all by default. Results come into FOLDER, a summary to standard output. What fails
#                                            is told there, and not by the exit code.
#
# The Vulkan loader there finds the GPU's driver, or VK_DRIVER_FILES names it; FRAMEWRIGHT_TEST_DEVICE names a device. Test programs
# know files by the path of the checkout that they were built in: `run` links that path to where the archive lies. PROFILE=dev packs a
# command that was built in less time.
set -euo pipefail
cd "$(dirname "$0")/.."
# What the archive holds beside the checkout.
packed=.packed
# Most seconds that a program may take there.
limit=${LIMIT:-900}

# What is drawn on both machines and compared: a name, and arguments of `framewright run`.
pictures() {
    local pipeline stereo degrees
    for pipeline in auto_exposure deferred deferred_mobile dynamic_resolution forward forward_overlay image_quality post shadows snow \
        soft_focus temporal; do
        echo "$pipeline $pipeline"
        for degrees in 90 180 270; do echo "$pipeline-$degrees $pipeline --rotate $degrees"; done
    done
    for pipeline in forward deferred image_quality shadows; do
        for stereo in multi-pass double-wide instanced multiview; do
            echo "$pipeline-$stereo $pipeline --stereo $stereo"
        done
        for samples in 1 4; do echo "$pipeline-msaa-$samples $pipeline --set msaa=$samples"; done
    done | grep -v '^deferred-msaa'
    for resolve in DepthOnly SampleZero Min Max Average Samples; do
        echo "depth-$resolve image_quality --set msaa=4 --set depth_stripes=blended --set depth_resolve=$resolve"
    done
}

# draw NAME ARGUMENT…: a picture into $to, and what was said. A device that lacks something says so with 3.
draw() {
    local name=$1 status=0
    shift
    timeout "$limit" "$command" run "$@" --scene courtyard --size 320x180 --frames 3 --validate \
        --report "$to/$name.json" -o "$to/$name.png" >"$to/$name.log" 2>&1 </dev/null || status=$?
    echo "$status" >"$to/$name.status"
}

draw_all() {
    export command to limit
    export -f draw
    mkdir -p "$to"
    pictures | xargs --max-procs "$(nproc)" --max-args 1 --delimiter '\n' bash -c 'draw $1' -
}

pack() {
    local file=$1 program
    . .ci/packages.sh
    need_to_draw
    rm -rf "$packed"
    mkdir -p "$packed/programs"
    local profile=${PROFILE:-release}
    # With the features of the tests, so that all is built once.
    cargo test --locked --workspace --no-run --quiet --profile "$profile" --test suite
    command=$packed/framewright
    strip -o "$command" "target/${profile/#dev/debug}/framewright"
    cargo test --locked --workspace --no-run --message-format=json-render-diagnostics |
        sed -n 's|.*"manifest_path":"[^"]*/\([^/"]*\)/Cargo.toml".*"kind":\["\(test\)"\].*"name":"\([^"]*\)","src_path".*"executable":"\([^"]*\)".*|\1\t\3\t\4|p' |
        while IFS=$'\t' read -r package test program; do
            case $package.$test in
            backend-vulkan.* | tests.suite | framewright.suite) strip -o "$packed/programs/$package.$test" "$program" ;;
            esac
        done
    strip -o "$packed/programs/random_pipelines" target/debug/random_pipelines
    # A test starts an example, which lies beside the folder of the test programs.
    mkdir "$packed/examples"
    strip -o "$packed/examples/embed_own_device" target/debug/examples/embed_own_device
    cp /usr/lib/chromium/libVkLayer_khronos_validation.so "$packed/"
    pwd >"$packed/built-in"
    to=$packed/pictures draw_all
    # Of the pages the one that a test reads.
    git ls-files -z | grep -zv '^docs/\|^cli/tests/' >"$packed/files"
    printf 'docs/numbers.md\0' >>"$packed/files"
    # Programs have most of their code in common.
    XZ_OPT="--lzma2=preset=4,dict=256MiB" tar --create --xz --file "$file" --transform 's|^|framewright/|' --null --files-from "$packed/files" "$packed"
    ls -lh "$file"
}

# The name of the first device that is no software driver.
gpu() {
    "$command" devices --format json | sed -n 's/^ *"name": "\(.*\)",$/\1/p' | grep -vi 'llvmpipe\|swiftshader' | head -1
}

run() {
    local to_folder part
    to_folder=$(realpath -m "$1")
    shift
    command=$PWD/$packed/framewright
    [ -x "$command" ] || fail "there is no $packed here: .ci/gpu.sh run belongs into an unpacked archive"
    link_checkout
    mkdir -p "$to_folder" "$packed/layer"
    sed "s|\"/usr/lib/chromium|\"$PWD/$packed|" tests/layer/VkLayer_khronos_validation.json >"$packed/layer/VkLayer_khronos_validation.json"
    export VK_LAYER_PATH=$PWD/$packed/layer FRAMEWRIGHT_SEED=${FRAMEWRIGHT_SEED:-1}
    [ -n "${FRAMEWRIGHT_TEST_DEVICE:-}" ] || FRAMEWRIGHT_TEST_DEVICE=$(gpu) || fail "the Vulkan loader finds no GPU; VK_DRIVER_FILES can name its driver's manifest"
    export FRAMEWRIGHT_TEST_DEVICE
    [ $# -gt 0 ] || set -- device tests random pictures times study
    for part; do
        printf '\n== %s on %s\n' "$part" "$FRAMEWRIGHT_TEST_DEVICE"
        mkdir -p "$to_folder/$part"
        "on_gpu_$part" "$to_folder/$part"
    done
}

fail() {
    echo "error: $1" >&2
    exit 3
}

link_checkout() {
    local built_in
    built_in=$(cat "$packed/built-in")
    [ "$built_in" = "$PWD" ] && return
    [ ! -L "$built_in" ] || [ ! -e "$built_in/.packed" ] || rm "$built_in"
    [ ! -e "$built_in" ] || fail "$built_in is there: test programs would read its files"
    mkdir -p "$(dirname "$built_in")" && ln -s "$PWD" "$built_in" || fail "$built_in can't be linked to $PWD"
}

on_gpu_device() {
    "$command" devices
    "$command" devices --format json >"$1/devices.json"
    "$command" devices --save "$1/device.ron" --device "$FRAMEWRIGHT_TEST_DEVICE"
}

on_gpu_tests() {
    local program name
    for program in "$packed"/programs/*.*; do
        name=$(basename "$program")
        program=$(realpath "$program")
        local filter=()
        case $name in
        tests.suite) filter=(drawn::) ;;
        framewright.suite) filter=(--skip examples:: --skip page::) ;;
        esac
        (cd "${name%%.*}" && timeout "$limit" "$program" ${filter[@]+"${filter[@]}"} >"$1/$name.log" 2>&1) || true
        echo "$name: $(grep '^test result' "$1/$name.log" || tail -1 "$1/$name.log")"
        sed -n 's/^test \(.*\) \.\.\. FAILED$/    failed: \1/p' "$1/$name.log"
    done
}

on_gpu_random() {
    local queues
    for queues in "" "--queues shared" "--queues handed-over"; do
        # shellcheck disable=SC2086 # none or two words
        timeout "$limit" "$packed/programs/random_pipelines" --driver gpu --count "${PIPELINES:-200}" $queues --write "$1" 2>&1 | tail -60 || true
    done
}

on_gpu_pictures() {
    local name line flip status
    to=$1 draw_all
    pictures | while read -r line; do
        name=${line%% *}
        status=$(cat "$1/$name.status")
        flip=-
        if [ -r "$1/$name.png" ] && [ -r "$packed/pictures/$name.png" ]; then
            flip=$("$command" compare "$1/$name.png" "$packed/pictures/$name.png" --metric flip 2>&1 | tail -1) || true
        fi
        printf '%-32s ended with %s; %s\n' "$name" "$status" "$flip"
        [ "$status" = 0 ] || grep -m 2 'error' "$1/$name.log" || true
    done
}

# Costs alone, at the sizes that people play at.
on_gpu_times() {
    local size
    for size in 1920x1080 3840x2160; do
        for sweep in "forward msaa=1,2,4,8" "shadows msaa=1,4,8 --sweep shadow_size=1024,4096" "image_quality msaa=1,4,8" \
            "deferred anti_aliasing=false,true" "deferred @stereo=off,multi-pass,instanced,multiview"; do
            # shellcheck disable=SC2086 # a pipeline and options
            timeout "$limit" "$command" measure ${sweep%% *} --scene courtyard --size "$size" --sweep ${sweep#* } --reference none --frames 65 \
                -o "$1/$size-${sweep//[^a-z]/}" 2>&1 | tail -20 || true
        done
    done
}

on_gpu_study() {
    PATH=$PWD/$packed:$PATH timeout "$((10 * limit))" examples/sweeps/study.sh "$1" 2>&1 | tail -40 || true
}

what=${1:-}
shift || true
case $what,$# in
pack,1 | run,[1-9]) "$what" "$@" ;;
*)
    sed -n '4,8s/^# //p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
