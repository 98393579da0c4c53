#!/usr/bin/env bash
# Builds the compiler as a module of WebAssembly, which pages of `framewright inspect --what-if` carry, and names it. It lies beside the
# folders that the command is built in, where the command looks for it.
#
# usage: .ci/what-if.sh [FILE]    FILE is target/what-if.wasm by default
#
# Installs Rust's library for WebAssembly where it is missing. The same files give the same module.
set -euo pipefail

case "${1:-}" in
-*)
    sed -n '5p' "${BASH_SOURCE[0]}" | sed 's/^# //' >&2
    exit 2
    ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
to=$(realpath --canonicalize-missing "${1:-target/what-if.wasm}")

. .ci/packages.sh
need_rust
target=wasm32-unknown-unknown
if ! [ -d "$(rustc --print target-libdir --target "$target")" ]; then
    rustup target add "$target" >/dev/null 2>&1 || {
        echo "error: Rust's library for $target can't be fetched from here; please run: rustup target add $target" >&2
        exit 3
    }
fi

# Files nest deeper than the stack of a module has room for by default. The folders that it is built in are of no concern to others.
CARGO_ENCODED_RUSTFLAGS="-Clink-arg=-zstack-size=8388608"$'\x1f'"--remap-path-prefix=$PWD=framewright"$'\x1f'"--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
    cargo rustc --locked --quiet --package framewright-what-if --lib --crate-type cdylib --profile what-if --target "$target" \
    --target-dir target/what-if
mkdir -p "$(dirname "$to")"
cp "target/what-if/$target/what-if/framewright_what_if.wasm" "$to.new"
mv "$to.new" "$to"
echo "$to"
