struct Post { factor: f32, tint: vec3f }
@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var linear_clamp: sampler;
@group(0) @binding(2) var<uniform> post: Post;
@group(0) @binding(3) var<storage, read_write> counts: array<u32>;

@fragment fn tinted(@location(0) uv: vec2f) -> @location(0) vec4f {
    return vec4f(textureSample(source, linear_clamp, uv).rgb * post.factor * post.tint, 1.0);
}

@fragment fn first_texel(@location(0) uv: vec2f) -> @location(0) vec4f {
    return textureLoad(source, vec2i(0), 0) * post.factor;
}

@compute @workgroup_size(64) fn count(@builtin(global_invocation_id) id: vec3u) { counts[id.x] = id.x * 2u; }

@compute @workgroup_size(8, 4) fn clear(@builtin(global_invocation_id) id: vec3u) { counts[id.x] = 0u; }
