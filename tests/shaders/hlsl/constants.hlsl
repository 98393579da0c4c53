// The HLSL of tests/shaders/constants.comp, but for the size of its workgroups, which HLSL can't leave open.
[[vk::constant_id(1)]] const uint FACTOR = 1;
[[vk::constant_id(2)]] const bool DOUBLED = false;
[[vk::constant_id(3)]] const float SHARE = 0.0;
[[vk::constant_id(4)]] const int BIAS = 0;
RWStructuredBuffer<uint> numbers : register(u0);

[numthreads(16, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    numbers[id.x] = 16 * FACTOR * (DOUBLED ? 2 : 1) + uint(SHARE * 8.0) + uint(BIAS);
}
