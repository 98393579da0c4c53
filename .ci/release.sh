#!/usr/bin/env bash
# Packs what a user of the command needs: the command, the compiler for its pages, shaders, pipelines, scenes, docs and licences, as
# framewright-VERSION-TARGET.tar.xz. The command needs nothing of the archive but itself: it may be moved anywhere alone.
#
# usage: .ci/release.sh [DIR]                  builds the command for release, which takes minutes; DIR is target/archives by default
#        .ci/release.sh --command FILE [DIR]   packs a command that was built
#
# The same files give the same archive. What lies in the working tree is packed, with the time of its last commit.
set -euo pipefail

command=
if [ "${1:-}" = --command ]; then
    command=$(realpath "${2:?the command to pack}")
    shift 2
fi
case "${1:-}" in
-*)
    sed -n '5,6s/^# //p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
to=$(realpath --canonicalize-missing "${1:-$(dirname "${BASH_SOURCE[0]}")/../target/archives}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

target=$(rustc --version --verbose | sed -n 's/^host: //p')
package=$(cargo pkgid --locked --offline --package framewright-cli)
name=framewright-${package##*[@#]}-$target
# Tests pack the one that they use.
module=target/what-if.wasm
[ -n "$command" ] && [ -r "$module" ] || .ci/what-if.sh >/dev/null
if [ -z "$command" ]; then
    . .ci/packages.sh
    need_rust
    need "to build: linker, C++ runtime, GLSL compiler" ca-certificates gcc g++ libc6-dev libshaderc-dev
    need "to pack" xz-utils
    # The folders that it is built in are of no concern to others.
    CARGO_ENCODED_RUSTFLAGS="--remap-path-prefix=$PWD=framewright"$'\x1f'"--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo" \
        cargo build --locked --release --package framewright-cli --target-dir target/archives/build
    command=$PWD/target/archives/build/release/framewright
fi

kept=$(mktemp --directory)
trap 'rm -r "$kept"' EXIT
packed=$kept/$name
mkdir "$packed"
install -D --mode 755 "$command" "$packed/framewright"
install --mode 644 "$module" "$packed/what-if.wasm"
git ls-files -z README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE shaders examples docs |
    xargs --null cp --parents --no-dereference --target-directory "$packed"

# The packages that the command is built of, and their licences. A folder of a package holds the texts that it brings along.
sources=(${CARGO_HOME:-$HOME/.cargo}/registry/src/*/)
lists() {
    cargo tree --locked --offline --package framewright-cli --edges normal --target "$target" --prefix none --format "$1" |
        sed 's/ (\*)$//' | sort --unique
}
licences=$packed/licences
mkdir "$licences"
{
    printf 'The packages that the command is built of. A folder beside this file holds the texts that a package brings along;\n'
    printf 'where there is none, the package has none, and its source says more.\n\n'
    lists '{p}: {l} {r}' | sed '/^framewright/d; s/ (proc-macro)//'
} >"$licences/packages.txt"
lists '{p}' | sed -n '/^framewright/!s/^\([^ ]*\) v\([^ ]*\).*/\1-\2/p' | while read -r crate; do
    for source in "${sources[@]}"; do
        find "$source$crate" -maxdepth 1 -type f \( -iname 'licen[sc]e*' -o -iname 'copying*' -o -iname 'notice*' \) \
            -exec install -D --mode 644 --target-directory "$licences/$crate" {} + 2>/dev/null || true
    done
done
# The GLSL compiler, where it is the distribution's.
for part in libshaderc-dev glslang-dev spirv-tools; do
    text=/usr/share/doc/$part/copyright
    [ ! -r "$text" ] || install -D --mode 644 "$text" "$licences/$part/copyright"
done

mkdir -p "$to"
tar --create --directory "$kept" --format ustar --sort name --owner 0 --group 0 --numeric-owner --mode u+w,go-w,a+rX \
    --mtime "@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}" "$name" | xz --threads 1 >"$to/$name.tar.xz"
echo "$to/$name.tar.xz"
