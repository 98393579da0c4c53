#!/usr/bin/env bash
# Measures the sweeps of docs/trade-offs.md: each is a folder in DIR. A run that was cut off goes on where it stopped.
#
# usage: study.sh DIR [SWEEP…]      SWEEP: edges, scale, light_shown, light_averaged, formats, depth, curves, motion,
#                                  smoothing, shadows, splits, lens or eyes; all by default
set -euo pipefail

results=$(realpath -m "${1:?usage: study.sh DIR [SWEEP…]}")
shift
asked=" ${*:-all} "
cd "$(dirname "$0")"
scenes='@scene=spheres_and_cubes,courtyard,passing'

# The sweep `name` by these arguments of `framewright measure`.
sweep() {
    local name=$1
    shift
    if [[ $asked == " all " || $asked == *" $name "* ]]; then
        echo "== $name"
        framewright measure "$@" -o "$results/$name"
    fi
}

# One pipeline with the three scenes.
quality() {
    local name=$1
    shift
    sweep "$name" image_quality --scene spheres_and_cubes --sweep "$scenes" --size 320x180 "$@"
}

sweep edges image_quality --scene spheres_and_cubes --sweep "$scenes,one_unlit_cube.ron" --size 320x180 \
    --sweep msaa=1,4,8 --sweep render_scale=1,2
quality scale --set msaa=1 --sweep render_scale=0.5,1,1.5,2,3,4 --sweep filter=bilinear,area,catmull_rom
# What is averaged first, light or what is shown of it, is a choice here: all choices are held against both.
for order in light_shown light_averaged; do
    sweep "$order" "$order.ron" --scene spheres_and_cubes --sweep "$scenes,bright_cubes.ron" --size 320x180 --sweep msaa=1,4 \
        --sweep light_resolve=Average,Weighted --sweep mapped=pixels,samples
done
quality formats --sweep hdr=true,false --sweep color_precision=Smallest,Balanced,Exact \
    --sweep depth_precision=Smallest,Balanced,Exact
quality depth --set depth_stripes=blended --sweep depth_resolve=DepthOnly,SampleZero,Min,Max,Average,Samples
quality curves --sweep tone_mapping=clip,reinhard,reinhard_luminance,white_point,filmic,neutral
quality eyes --sweep @stereo=off,multi-pass,double-wide,instanced,multiview
sweep motion temporal --scene passing --size 320x180 --flicker 16 --sweep taa=false,true --sweep render_scale=1,2
sweep smoothing deferred --scene spheres_and_cubes --sweep "$scenes" --size 320x180 --sweep anti_aliasing=false,true
sweep shadows shadows --scene courtyard --size 960x540 --sweep msaa=1,4 --sweep cascades=1,2,4 --sweep shadow_size=512,1024,2048
sweep splits shadows --scene courtyard --size 960x540 --sweep cascades=2,4 --sweep logarithmic=0,0.5,0.85,1
sweep lens lens.ron --scene spheres_and_cubes --size 320x180 --sweep lens_radius=2,4,6,8,12
