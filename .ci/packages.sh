# Sourced by ./demo and ./test: installs what is missing from Debian or Ubuntu, saying what and why, asking nothing.
# Exits with 3, naming the command that mends it, if something is missing and can't be installed from here.

if [ "$(id -u)" -eq 0 ]; then as_root=() ; else as_root=(sudo -n) ; fi

# on_debian: whether packages can be looked up and installed here at all.
on_debian() {
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null
}

# installed PACKAGE
installed() {
    [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# need WHY PACKAGE…: installs those of the packages that are missing.
need() {
    local why=$1 package missing=()
    shift
    if ! on_debian; then
        echo "not Debian or Ubuntu, so nothing is installed here; needed ($why): the counterparts of $*"
        return
    fi
    for package; do
        installed "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    install_packages "$why" "${missing[@]}"
}

# need_if_offered WHY PACKAGE: the same for one package that not every distribution has; says so where it is absent.
need_if_offered() {
    on_debian || return 0
    installed "$2" && return
    refresh_lists
    if [ -z "$(apt-cache search --names-only "^$2\$")" ]; then
        echo "this distribution has no package $2 ($1): what needs it is skipped"
        return
    fi
    install_packages "$1" "$2"
}

install_packages() {
    local why=$1
    shift
    local by_hand="apt-get install --no-install-recommends $*"
    echo "installing $* ($why)"
    if [ ${#as_root[@]} -gt 0 ] && ! sudo -n true 2>/dev/null; then
        echo "error: that takes root, and sudo is missing or would ask; please run: sudo $by_hand" >&2
        exit 3
    fi
    refresh_lists
    if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install --yes --quiet --quiet --no-install-recommends "$@" >/dev/null; then
        echo "error: that failed; please run: $by_hand" >&2
        exit 3
    fi
}

lists_are_fresh=
refresh_lists() {
    [ -z "$lists_are_fresh" ] || return 0
    lists_are_fresh=yes
    # If this fails, the lists that are there may still do.
    "${as_root[@]}" apt-get update --quiet --quiet >/dev/null 2>&1 || true
}

need_rust() {
    command -v cargo >/dev/null && return
    if [ -r "${CARGO_HOME:-$HOME/.cargo}/env" ]; then
        # shellcheck source=/dev/null
        . "${CARGO_HOME:-$HOME/.cargo}/env"
        command -v cargo >/dev/null && return
    fi
    echo "error: there is no cargo; please install Rust 1.95 or later: https://rustup.rs" >&2
    exit 3
}

# What building and drawing take; ./test needs more.
need_to_draw() {
    need_rust
    need "to build: linker, C++ runtime, GLSL compiler" ca-certificates gcc g++ libc6-dev libshaderc-dev
    need "to draw without a GPU: Vulkan loader and lavapipe" libvulkan1 mesa-vulkan-drivers
    # Lavapipe alone, so that results don't depend on the GPU that a machine happens to have.
    if [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]; then
        local lavapipe
        for lavapipe in /usr/share/vulkan/icd.d/lvp_icd*.json; do
            if [ -r "$lavapipe" ]; then
                export VK_DRIVER_FILES=$lavapipe VK_ICD_FILENAMES=$lavapipe
            fi
        done
    fi
}
