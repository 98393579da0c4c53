#!/usr/bin/env bash
# Makes the modules of this folder anew: by glslang 12.0 (Debian's glslang-tools), naga 30 (`cargo install naga-cli`), SPIRV-Tools, slangc
# 2026.14 (PyPI's slangtorch) and DXC 1.7 (its library is in PyPI's source package compushady).
set -e
cd "$(dirname "$0")"
glslangValidator -D -V --target-env vulkan1.3 -S frag -e PSMain -o post_hlsl.spv post.hlsl
glslangValidator -D -V --target-env vulkan1.0 -S vert -e VSMain -o post_hlsl_vertices.spv post.hlsl
spirv-opt --strip-debug post_hlsl.spv -o post_stripped.spv
naga post.wgsl post_wgsl.spv
glslangValidator -V --target-env vulkan1.0 -o old_block.spv old_block.comp
glslangValidator -V --target-env vulkan1.3 -o sized_by_constants.spv sized_by_constants.comp
glslangValidator -D -V --target-env vulkan1.3 -S frag -e main -o sampled_twice.spv sampled_twice.hlsl
glslangValidator -gVS -V --target-env vulkan1.3 -o with_lines.spv ../spirv_tinted.frag
slangc post.slang -target spirv -O0 -fvk-use-entrypoint-name -o post_slang.spv
slangc bytes.slang -target spirv -O0 -fvk-use-entrypoint-name -o bytes_slang.spv
dxc -spirv -fspv-target-env=vulkan1.3 -T ps_6_0 -E PSMain -Fo post_dxc.spv post.hlsl
dxc -spirv -fspv-target-env=vulkan1.3 -T cs_6_0 -E CSCull -fspv-debug=vulkan-with-source -fspv-reflect -Zi -Fo append_dxc.spv append.hlsl
glslangValidator -g -D -V --target-env vulkan1.3 -S frag -e PSMain -o discard_text.spv discard.hlsl
glslangValidator -gVS -D -V --target-env vulkan1.3 -S frag -e PSMain -o discard_gvs.spv discard.hlsl
dxc -spirv -fspv-target-env=vulkan1.3 -T ps_6_0 -E PSMain -Zi -Fo discard_dxc.spv discard.hlsl
dxc -spirv -fspv-target-env=vulkan1.3 -T ps_6_0 -E PSMain -fspv-debug=vulkan -Fo discard_dxc_set.spv discard.hlsl
dxc -spirv -fspv-target-env=vulkan1.3 -T vs_6_0 -E VSMain -Fo mesh_dxc.spv mesh.hlsl
glslangValidator -D -V --target-env vulkan1.3 -S frag -e PSMain -o kernel.spv kernel.hlsl
glslangValidator -D -V --target-env vulkan1.3 -S vert -e VSMain -o pushed_draw_vertices.spv pushed_draw.hlsl
glslangValidator -D -V --target-env vulkan1.3 -S frag -e PSMain -o pushed_draw.spv pushed_draw.hlsl
