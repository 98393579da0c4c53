#!/usr/bin/env bash
# A Debian 13 beside the distribution that runs this: its lavapipe (Mesa 25) is the third driver that tests run on, and its
# validation layer (1.4.309) the third layer. It is a folder, entered by chroot; what was built outside runs in it.
#
# usage: .ci/debian-13.sh make           makes it, unless it is there: two minutes, 1.2 GB, from this machine's Debian mirror
#        .ci/debian-13.sh run COMMAND…   runs COMMAND in it, in the same folder, with its lavapipe as the only driver
#
# `run` can be Cargo's runner: cargo test --config "target.'cfg(all())'.runner = ['$PWD/.ci/debian-13.sh', 'run']"
# The folder is FRAMEWRIGHT_DEBIAN_13, or by default ~/.cache/framewright/debian-13, and may be removed at any time: what is
# mounted in it is mounted for each run alone. Exits with 3, saying why, where this machine can't make it or enter it.
set -euo pipefail

root=${FRAMEWRIGHT_DEBIAN_13:-${XDG_CACHE_HOME:-$HOME/.cache}/framewright/debian-13}
packages="libstdc++6 libvulkan1 mesa-vulkan-drivers vulkan-validationlayers spirv-tools procps xvfb"
# Written first: a folder that holds anything else is never removed.
begun=$root/.made-by-framewright
# Written last, so that a folder without it is only half made.
made=$root/.made-with

fail() {
    echo "error: $1" >&2
    exit 3
}

# The mirror that this machine installs Debian from.
mirror() {
    local found
    found=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null |
        awk '/^URIs: .*debian\/?$/ || /^deb .*\/debian\/? / { for (i = 2; i <= NF; i++) if ($i ~ /^http/) { print $i; exit } }')
    echo "${found:-http://deb.debian.org/debian}"
}

make() {
    [ "$(id -u)" -eq 0 ] || fail "a Debian 13 can't be made or entered without being root"
    mkdir -p "$(dirname "$root")"
    # Of two runs at once the second waits, and finds what the first has made.
    exec 9>"$root.lock"
    flock 9
    [ "$(cat "$made" 2>/dev/null)" = "$packages" ] || make_anew
    (run true) || fail "the Debian 13 in $root can't be entered"
}

make_anew() {
    if [ -e "$root" ] && [ ! -e "$begun" ] && [ -n "$(ls -A "$root")" ]; then
        fail "$root holds something else than a Debian 13 of Framewright: name another folder by FRAMEWRIGHT_DEBIAN_13"
    fi
    . "$(dirname "${BASH_SOURCE[0]}")/packages.sh"
    need "to make a Debian 13, where today's lavapipe runs" debootstrap
    command -v debootstrap >/dev/null || fail "a Debian 13 can't be made without debootstrap"
    rm -rf "$root"
    mkdir -p "$root"
    touch "$begun"
    local log=$root.log
    echo "making a Debian 13 in $root"
    if ! install_into "$root" >"$log" 2>&1; then
        tail -5 "$log" >&2
        fail "a Debian 13 can't be made in $root; all of it: $log"
    fi
    rm -f "$log"
    echo "$packages" >"$made"
}

# Called where `set -e` doesn't count.
install_into() {
    debootstrap --variant=minbase --include=ca-certificates trixie "$1" "$(mirror)" &&
        cp -r /etc/apt/apt.conf.d/. "$1/etc/apt/apt.conf.d/" &&
        chroot "$1" apt-get update --quiet &&
        # shellcheck disable=SC2086 # several packages
        DEBIAN_FRONTEND=noninteractive chroot "$1" \
            apt-get install --yes --quiet --no-install-recommends $packages &&
        chroot "$1" apt-get clean
}

run() {
    [ -r "$made" ] || fail "there is no Debian 13 in $root: .ci/debian-13.sh make"
    [ "$(id -u)" -eq 0 ] || fail "a Debian 13 can't be entered without being root"
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
case $what in
make) make ;;
run) run "$@" ;;
*)
    sed -n '5,6s/^# //p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
