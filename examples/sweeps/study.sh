#!/usr/bin/env bash
# Measures the sweeps of docs/trade-offs.md: each is a folder in DIR. A run that was cut off goes on where it stopped.
#
# usage: study.sh DIR [SWEEP…]      SWEEP: edges, scale, light, formats, depth, curves, motion, smoothing, shadows or eyes; all by default
set -euo pipefail

results=${1:?usage: study.sh DIR [SWEEP…]}
shift
asked=" ${*:-all} "
scenes='@scene=spheres_and_cubes,courtyard,passing'

# The sweep `name` by these arguments of `framewright measure`.
sweep() {
    local name=$1
    shift
    if [[ $asked == " all " || $asked == *" $name "* ]]; then
        echo "== $name"
        framewright measure "$@" --size 320x180 -o "$results/$name"
    fi
}

sweep edges image_quality --scene spheres_and_cubes --sweep "$scenes" --sweep msaa=1,4 --sweep render_scale=1,2
sweep scale image_quality --scene spheres_and_cubes --sweep "$scenes" --set msaa=1 \
    --sweep render_scale=0.5,1,1.5,2,3,4 --sweep filter=bilinear,area,catmull_rom
sweep light image_quality --scene spheres_and_cubes --sweep "$scenes" --sweep msaa=1,4 --sweep light_resolve=Average,Weighted \
    --sweep mapped=pixels,samples
sweep formats image_quality --scene spheres_and_cubes --sweep "$scenes" --sweep hdr=true,false \
    --sweep color_precision=Smallest,Balanced,Exact --sweep depth_precision=Smallest,Balanced,Exact
sweep depth image_quality --scene spheres_and_cubes --sweep "$scenes" --set depth_stripes=blended \
    --sweep depth_resolve=DepthOnly,SampleZero,Min,Max,Average,Samples
sweep curves image_quality --scene spheres_and_cubes --sweep "$scenes" \
    --sweep tone_mapping=clip,reinhard,reinhard_luminance,white_point,filmic,neutral
sweep motion temporal --scene passing --flicker 16 --sweep taa=false,true --sweep render_scale=1,2
sweep smoothing deferred --scene spheres_and_cubes --sweep "$scenes" --sweep anti_aliasing=false,true
sweep shadows shadows --scene courtyard --sweep cascades=1,2,4 --sweep shadow_taps=1,3,7 --sweep shadow_size=512,1024,2048
sweep eyes image_quality --scene spheres_and_cubes --sweep "$scenes" --sweep @stereo=off,multi-pass,double-wide,instanced,multiview
