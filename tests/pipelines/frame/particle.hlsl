struct Particle {
    float4 place;
    float4 speed;
};
