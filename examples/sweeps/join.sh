#!/usr/bin/env bash
#SBATCH --job-name=framewright-join
#SBATCH --output=framewright_join_%j.log
# Joins the parts of a sweep that many machines have measured. A part that is missing is an error.
#
# usage: join.sh PARTS      PARTS: how many there are
#
# The parts lie in part_1, part_2, … in the folder RESULTS (by default `results`). The joined results are in `all` in that folder.
set -euo pipefail

results=${RESULTS:-results}
parts=()
for ((part = 1; part <= $1; part++)); do
    parts+=("$results/part_$part")
done
framewright merge "${parts[@]}" -o "$results/all"
