#include "pyramid.hlsl"
