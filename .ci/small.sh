#!/usr/bin/env bash
# What the library costs a program of ten lines: seconds to build it from nothing, and bytes of what is built. Run it by hand on a quiet
# machine.
#
# usage: .ci/small.sh [FEATURES…]     each a list with commas; by default none, those for files, and all
set -euo pipefail
repository=$(cd "$(dirname "$0")/.." && pwd)
place=$(mktemp --directory)
trap 'rm -r "$place"' EXIT
mkdir "$place/src"
cp "$repository/Cargo.lock" "$place"
cat >"$place/src/main.rs" <<'RUST'
use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let device = Device::open(&DeviceOptions::default())?;
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(&device, "forward", RendererOptions::default())?;
    renderer.set_scene(&scene);
    renderer.set_extent([640, 360])?;
    let plan = renderer.prepare()?.plan;
    let mut objects = SceneDrawSource::for_plan(&device, &scene, [640, 360], plan)?;
    renderer.frame(&mut objects)?;
    Ok(())
}
RUST
[ $# -gt 0 ] || set -- "" gltf,pictures,texture-files gltf,pictures,texture-files,shader-compiler,spirv-validator
printf '| %s | %s | %s | %s |\n|---|---|---|---|\n' features seconds "seconds of processors" "MB, stripped"
for features; do
    list=$(sed 's/[^,][^,]*/"&"/g' <<<"$features")
    cat >"$place/Cargo.toml" <<TOML
[package]
name = "ten-lines"
version = "0.1.0"
edition = "2024"
[dependencies]
framewright = { path = "$repository/framewright", default-features = false, features = [$list] }
[workspace]
TOML
    rm -rf "$place/target"
    cargo fetch --quiet --manifest-path "$place/Cargo.toml"
    began=$SECONDS
    processors=$( (TIMEFORMAT='%U %S'; time cargo build --quiet --offline --release --manifest-path "$place/Cargo.toml") 2>&1 |
        awk 'NF == 2 && $1 ~ /^[0-9.]+$/ { print int($1 + $2); next } { print > "/dev/stderr" }')
    wall=$((SECONDS - began))
    strip -o "$place/stripped" "$place/target/release/ten-lines"
    bytes=$(stat --format %s "$place/stripped")
    printf '| %s | %d | %d | %s |\n' "${features:-none}" "$wall" "$processors" "$(awk "BEGIN { printf \"%.1f\", $bytes / 1e6 }")"
done
