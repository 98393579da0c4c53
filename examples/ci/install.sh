#!/usr/bin/env bash
# Installs what check.sh needs on Debian or Ubuntu: lavapipe, which draws without a GPU, validation layers, and the command framewright.
# The command is built, since nothing is released yet. That takes Rust 1.95 or later (https://rustup.rs) and some minutes.
#
# usage: install.sh FOLDER           builds the command from a checkout of Framewright
#        install.sh ADDRESS COMMIT   builds it from this commit of a Git repository of Framewright
set -euo pipefail

if [ $# -eq 0 ] || [ $# -gt 2 ]; then
    sed -n '5,6s/^# //p' "$0" >&2
    exit 2
fi
if ! command -v cargo >/dev/null; then
    echo "error: there is no cargo; please install Rust 1.95 or later: https://rustup.rs" >&2
    exit 3
fi
if [ "$(id -u)" -eq 0 ]; then as_root=() ; else as_root=(sudo -n) ; fi

packages=(
    # To build: a linker, a C++ runtime, the GLSL compiler.
    ca-certificates gcc g++ libc6-dev libshaderc-dev
    # To draw and to validate.
    libvulkan1 mesa-vulkan-drivers vulkan-validationlayers
)
"${as_root[@]}" apt-get update --quiet
# The current validation layer, which sees hazards of dynamic rendering. Ubuntu has no such package: there it has to be brought along,
# and VK_LAYER_PATH must name the folder of its manifest.
if [ -n "$(apt-cache search --names-only '^chromium-common$')" ]; then
    packages+=(chromium-common)
else
    echo "warning: no package chromium-common: the distribution's own validation layer may not see hazards of attachments"
fi
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --quiet --no-install-recommends "${packages[@]}"

if [ $# -eq 2 ]; then
    cargo install --locked --git "$1" --rev "$2" framewright-cli
else
    cargo install --locked --path "$1/cli"
fi
