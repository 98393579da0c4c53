#!/usr/bin/env bash
# Another Debian beside the distribution that runs this: its lavapipe is one more driver that tests run on, and its validation layer
# one more layer. Debian 13 (trixie) has Mesa 25 and layer 1.4.309; later suites have later ones. It is a folder, entered by chroot;
# what was built outside runs in it.
#
# usage: .ci/debian.sh make [SUITE]       makes it, unless it is there: half a minute, 0.5 GB, from this machine's Debian mirror
#        .ci/debian.sh run COMMAND…       runs COMMAND in it, in the same folder, with its lavapipe as the only driver
#
# SUITE is Debian's name: trixie, forky, sid. Without one it is that of FRAMEWRIGHT_DEBIAN_SUITE, which `run` takes too, or trixie.
# `run` can be Cargo's runner: cargo test --config "target.'cfg(all())'.runner = ['$PWD/.ci/debian.sh', 'run']"
# The folder is FRAMEWRIGHT_DEBIAN, or by default ~/.cache/framewright/debian-SUITE, and may be removed at any time: what is
# mounted in it is mounted for each run alone. The mirror is the one that apt on this machine installs Debian from. Exits with 3, saying
# why, where this machine can't make it or enter it.
set -euo pipefail

suite=${FRAMEWRIGHT_DEBIAN_SUITE:-trixie}
[ "${1:-}" != make ] || suite=${2:-$suite}
root=${FRAMEWRIGHT_DEBIAN:-${XDG_CACHE_HOME:-$HOME/.cache}/framewright/debian-$suite}
packages="libstdc++6 libvulkan1 mesa-vulkan-drivers vulkan-validationlayers spirv-tools procps xvfb"
# Written first: a folder that holds anything else is never removed.
begun=$root/.made-by-framewright
# Written last, so that a folder without it is only half made.
made=$root/.made-with

fail() {
    echo "error: $1" >&2
    exit 3
}

# The mirror that this machine installs Debian from, as apt knows it. An Ubuntu has none.
mirror() {
    apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Origin: Debian' 'Label: Debian' 2>/dev/null |
        awk '/^https?:/ && !found++ { print } END { exit !found }'
}

make() {
    [ "$(id -u)" -eq 0 ] || fail "a Debian can't be made or entered without being root"
    mkdir -p "$(dirname "$root")"
    # Of two runs at once the second waits, and finds what the first has made.
    exec 9>"$root.lock"
    flock 9
    [ "$(cat "$made" 2>/dev/null)" = "$suite: $packages" ] || make_anew
    (run true) || fail "the Debian in $root can't be entered"
}

make_anew() {
    if [ -e "$root" ] && [ ! -e "$begun" ] && [ -n "$(ls -A "$root")" ]; then
        fail "$root holds something else than a Debian of Framewright: name another folder by FRAMEWRIGHT_DEBIAN"
    fi
    . "$(dirname "${BASH_SOURCE[0]}")/packages.sh"
    need "to make another Debian, whose lavapipe is later" mmdebstrap
    command -v mmdebstrap >/dev/null || fail "a Debian can't be made without mmdebstrap"
    local mirror
    mirror >/dev/null || refresh_lists
    mirror=$(mirror) || fail "apt knows no mirror of Debian on this machine (apt-get indextargets): a Debian can't be made from here"
    rm -rf "$root"
    mkdir -p "$root"
    touch "$begun"
    local log=$root.log
    echo "making Debian's $suite in $root"
    if ! install_into "$root" "$mirror" >"$log" 2>&1; then
        tail -5 "$log" >&2
        fail "Debian's $suite can't be made in $root; all of it: $log"
    fi
    rm -f "$log"
    echo "$suite: $packages" >"$made"
}

# Called where `set -e` doesn't count.
install_into() {
    # How apt reaches the mirror from this machine.
    local option options=()
    while read -r option; do
        options+=(--aptopt="$option")
    done < <(apt-config dump | grep -E '^Acquire::(https?|Check)[^ ]* ".+"')
    mmdebstrap --variant=minbase --include="ca-certificates $packages" ${options[@]+"${options[@]}"} --skip=check/empty \
        "$suite" "$1" "$2"
}

run() {
    [ -r "$made" ] || fail "there is no Debian in $root: .ci/debian.sh make $suite"
    [ "$(id -u)" -eq 0 ] || fail "a Debian can't be entered without being root"
    local top
    top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
    export VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/lvp_icd.json
    exec unshare --mount bash -euc '
        root=$1 here=$2
        shift 2
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        while [ "$1" != -- ]; do
            if [ -d "$1" ]; then mkdir -p "$root$1"; else mkdir -p "$root$(dirname "$1")" && touch "$root$1"; fi
            mount --bind "$1" "$root$1"
            shift
        done
        shift
        exec chroot "$root" env --chdir="$here" "$@"
    ' - "$root" "$PWD" "$top" ${CARGO_TARGET_DIR:+"$CARGO_TARGET_DIR"} \
        ${MESA_SHADER_CACHE_DIR:+"$MESA_SHADER_CACHE_DIR"} /tmp $(current_layer) -- "$@"
}

# The current validation layer comes from outside: it needs nothing but the C library.
current_layer() {
    local layer=/usr/lib/chromium/libVkLayer_khronos_validation.so
    [ ! -r "$layer" ] || echo "$layer"
}

what=${1:-}
shift || true
case $what,$# in
make,[01]) make ;;
run,[1-9]*) run "$@" ;;
*)
    sed -n '6,7s/^# //p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
