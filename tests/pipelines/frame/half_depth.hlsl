#include "found.hlsl"

Texture2D<float> source;
SamplerState near;

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 { return found_in(source, near, source_st, uv); }
