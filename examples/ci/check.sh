#!/usr/bin/env bash
# Checks pipelines before a change lands: all their variants, their budgets, what they draw, and what the validation layer says of it.
# Reports, pictures and pages are left in a folder, also where something is wrong.
#
# usage: check.sh PIPELINE.ron…            checks pipelines
#        check.sh --accept PIPELINE.ron…   does so too, and takes the pictures that are drawn now as the right ones
#
# Files of the pipeline NAME.ron:
#        goldens/NAME.png     the picture that it must draw; --accept writes it
#        budgets/NAME.ron     upper bounds for its Plans, if there are any
#
# Variables, with what they are by default:
#        SCENE     spheres_and_cubes      the scene that is drawn, a file or a shipped one
#        SIZE      320x180                the size of the picture
#        MAX_FLIP  0.01                   the most that a picture may differ, as a mean of FLIP
#        VARIANTS  --all-variants         what `framewright check` is asked; with many settings: "--all-variants --pairwise"
#        REPORTS   sarif junit            the forms of reports that are written
#        GOLDENS   goldens                the folder of right pictures
#        BUDGETS   budgets                the folder of budgets
#        RESULTS   framewright-results    the folder of reports, pictures and pages
#
# Exit codes are those of framewright: 0 all is well, 1 something is wrong, 2 the command line is, 3 something isn't installed. Of
# several the largest.
set -euo pipefail

accept=
if [ "${1:-}" = --accept ]; then
    accept=yes
    shift
fi
if [ $# -eq 0 ]; then
    sed -n '5,6s/^# //p' "$0" >&2
    exit 2
fi
if ! command -v framewright >/dev/null; then
    echo "error: there is no command framewright: install.sh, beside this file, installs it" >&2
    exit 3
fi

scene=${SCENE:-spheres_and_cubes} size=${SIZE:-320x180} goldens=${GOLDENS:-goldens} results=${RESULTS:-framewright-results}
read -ra variants <<<"${VARIANTS:---all-variants}"
read -ra reports <<<"${REPORTS-sarif junit}"

# Lavapipe alone, unless another driver is asked for: pictures must not depend on the GPU that a machine happens to have.
if [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]; then
    for lavapipe in /usr/share/vulkan/icd.d/lvp_icd*.json; do
        export VK_DRIVER_FILES=$lavapipe VK_ICD_FILENAMES=$lavapipe
    done
fi

worst=0
# attempt WHAT COMMAND…: runs a command, says what came of it, and keeps the worst exit code.
attempt() {
    local what=$1 code=0
    shift
    "$@" || code=$?
    ended "$what" "$code"
}

# ended WHAT CODE: the last line about something that was checked.
ended() {
    [ "$2" -le "$worst" ] || worst=$2
    if [ "$2" -eq 0 ]; then echo "fine: $1"; else echo "FAILED (exit code $2): $1"; fi
    return "$2"
}

# check_one PIPELINE NAME
check_one() {
    local pipeline=$1 name=$2 form report
    local check=(framewright check "$pipeline" --size "$size")
    if [ -e "${BUDGETS:-budgets}/$name.ron" ]; then check+=(--budget "${BUDGETS:-budgets}/$name.ron"); fi

    attempt "$name: variants and budget" "${check[@]}" "${variants[@]}" || true
    for form in ${reports[@]+"${reports[@]}"}; do
        report=$results/$form/$name.$form
        if [ "$form" = junit ]; then report=$results/junit/$name.xml; fi
        mkdir -p "$results/$form"
        # What is wrong was said above. Without an answer there is no report.
        "${check[@]}" "${variants[@]}" --format "$form" >"$report" 2>/dev/null || [ -s "$report" ] || rm "$report"
    done

    # What can't be compiled with its defaults can't be drawn either.
    framewright check "$pipeline" --size "$size" >/dev/null 2>&1 || return 0
    draw "$pipeline" "$name"
    attempt "$name: page" framewright inspect "$pipeline" --scene "$scene" --size "$size" --capture --format html \
        -o "$results/pages/$name.html" || true
}

# draw PIPELINE NAME: draws under the validation layer, and holds the picture against the right one.
draw() {
    local pipeline=$1 name=$2
    local right=$goldens/$name.png picture=$results/pictures/$name.png map=$results/pictures/$name.difference.png
    attempt "$name: drawn, and nothing said by the validation layer" framewright run "$pipeline" --scene "$scene" --size "$size" \
        --validate -o "$picture" --report "$results/reports/$name.json" || true
    if [ ! -e "$picture" ]; then return; fi
    if [ -n "$accept" ]; then
        mkdir -p "$goldens"
        cp "$picture" "$right"
        echo "written: $right"
    elif [ ! -e "$right" ]; then
        ended "$name: there is no right picture $right; \`check.sh --accept $pipeline\` makes it of what is drawn now" 1 || true
    elif attempt "$name: picture" framewright compare "$right" "$picture" --max-flip "${MAX_FLIP:-0.01}" --heatmap "$map"; then
        rm "$map"
    fi
}

# Nothing of an earlier run is taken for this one's.
rm -rf "$results"
mkdir -p "$results/pictures" "$results/pages" "$results/reports"
declare -A seen
for pipeline; do
    # A file of such a name isn't meant as an option.
    case $pipeline in -*) pipeline=./$pipeline ;; esac
    name=$(basename "$pipeline" .ron)
    if [ -n "${seen[$name]:-}" ]; then
        echo "error: ${seen[$name]} and $pipeline have the same name, and would write the same files" >&2
        exit 2
    fi
    seen[$name]=$pipeline
    check_one "$pipeline" "$name"
done
exit "$worst"
