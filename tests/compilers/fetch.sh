#!/usr/bin/env bash
# Fetches compilers of HLSL and Slang, which the tests use where they find them: `tests/compilers/fetch.sh FOLDER`, then
# `PATH=FOLDER:$PATH cargo test …`. It takes pip, a C++ compiler and about 120 MB. slangc comes from PyPI's slangtorch, DXC's library from
# PyPI's source package compushady. glslangValidator is Debian's glslang-tools, naga comes from `cargo install naga-cli`.
set -e
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:?"which folder?"}
mkdir -p "$folder/packages"
cd "$folder"
pip download --quiet --no-deps --dest packages slangtorch
pip download --quiet --no-deps --no-binary compushady --dest packages compushady
python3 -c 'import glob, zipfile; zipfile.ZipFile(glob.glob("packages/slangtorch-*.whl")[0]).extractall("slang")'
chmod +x slang/slangtorch/bin/slangc
ln -sf slang/slangtorch/bin/slangc slangc
tar --extract --gzip --file packages/compushady-*.tar.gz --strip-components=3 --wildcards '*/backends/dxcapi.h' '*/backends/WinAdapter.h' '*/backends/libdxcompiler_x86_64.so*'
library=$(echo "$PWD"/libdxcompiler_x86_64.so*)
c++ -std=c++17 "-I$PWD" "-DDXC_LIBRARY=\"$library\"" -o dxc "$here/dxc.cpp" -ldl
"./dxc" --version
