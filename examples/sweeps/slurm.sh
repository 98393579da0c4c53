#!/usr/bin/env bash
#SBATCH --job-name=framewright
#SBATCH --array=1-8
#SBATCH --output=framewright_%A_%a.log
# Measures a sweep on many machines of a Slurm cluster: each task of the job array measures one part.
#
# usage: sbatch slurm.sh MEASURE…      MEASURE: what `framewright measure` takes, but for `--shard` and `-o`
#        sbatch --array=1-32 slurm.sh image_quality --scene courtyard --sweep msaa=1,4 --sweep render_scale=0.5..2:4
#
# The parts are written to part_1, part_2, … in the folder RESULTS, which all machines must share (by default `results`). A task that
# was cut off goes on where it stopped: `scontrol requeue`. When all tasks are done, join.sh joins the parts:
#        sbatch --dependency=afterok:JOB join.sh 32
set -euo pipefail

results=${RESULTS:-results}
# Tasks are numbered from where the array begins.
part=$((SLURM_ARRAY_TASK_ID - ${SLURM_ARRAY_TASK_MIN:-1} + 1))
framewright measure "$@" --shard "$part/$SLURM_ARRAY_TASK_COUNT" -o "$results/part_$part"
