#!/usr/bin/env bash
# Makes the pictures of README.md and examples/README.md anew.
set -euo pipefail
cd "$(dirname "$0")/.."
bahn=${BAHN:-target/release/bahn}
out=docs/pictures
mkdir -p "$out"
for program in examples/*.H; do
    name=$(basename "$program" .H)
    # A program that others call has no blank of its own.
    [ "$name" = NUT ] && continue
    "$bahn" test "$program" --tools examples/tools.tsv --view 3d --image "$out/$name.png" >/dev/null
    echo "$out/$name.png"
done
"$bahn" test examples/housing.H --view plan --image "$out/housing-plan.png" >/dev/null
"$bahn" test examples/pockets.H --view three-planes --image "$out/pockets-planes.png" >/dev/null
"$bahn" test examples/three-tools.H --tools examples/tools.tsv --color tool --toolpath \
    --image "$out/three-tools-path.png" >/dev/null
"$bahn" test examples/dial.H --path "$out/dial.svg" >/dev/null
"$bahn" test examples/bead.nc --path "$out/bead.svg" >/dev/null
# A hole of machines/mill/programs/INDEX.H with the table clamped for it, on the machine.
recording=$(mktemp -d)
trap 'rm -rf "$recording"' EXIT
"$bahn" run INDEX.H --machine machines/mill --fresh --record "$recording/index.csv" \
    --signals Z.actual,Z.lag,C.actual,C.lag,path.speed,M2045,M2482,O17 >/dev/null
"$bahn" scope "$recording/index.csv" --from 20 --to 36 --title "INDEX.H: drilling, rotary table clamped with M10" \
    -o "$out/scope.png" >/dev/null
echo "$out/scope.png"
"$bahn" run CIRCLE.H --machine machines/mill --fresh --record "$recording/circle.csv" \
    --signals X.nominal,X.actual,Y.nominal,Y.actual >/dev/null
"$bahn" scope "$recording/circle.csv" --circle X,Y --title "CIRCLE.H: radius 40 mm at F3000 in both directions" \
    -o "$out/round.png" >/dev/null
echo "$out/round.png"
# The strobes of the knee mill with a TNC 155: a change of gear, then M13.
"$bahn" run BLOCK.H --machine machines/mill-tnc155 --fresh --record "$recording/strobes.csv" \
    --signals A7,A8,A11,A15,A18,A20,A21,E17,S.volts >/dev/null
"$bahn" scope "$recording/strobes.csv" --from 82.1 --to 85.4 \
    --title "BLOCK.H: gear 2, then M13 with the ramp of the spindle" -o "$out/tnc155-strobes.png" >/dev/null
echo "$out/tnc155-strobes.png"
# A model is digitized, and machined again from the digitized program: both, and how far the copy is off.
copy=$(mktemp -d)
trap 'rm -rf "$recording" "$copy"' EXIT
cp examples/digitizing/* "$copy"
"$bahn" test "$copy/MODEL.H" --tools "$copy/tools.tsv" --resolution 0.1 --digitized "$copy" --mesh "$copy/model.stl" \
    --view 3d --image "$out/digitized.png" >/dev/null
"$bahn" test "$copy/AGAIN.H" --tools "$copy/tools.tsv" --resolution 0.1 --view 3d --image "$out/digitized-again.png" >/dev/null
"$bahn" test "$copy/AGAIN.H" --tools "$copy/tools.tsv" --resolution 0.1 --compare "$copy/model.stl" --color deviation \
    --view plan --image "$out/digitized-deviation.png" >/dev/null
echo "$out/digitized-deviation.png"
# The page of a test run in a browser, where there is one.
cargo build --quiet --locked -p bahn-browser --example picture
picture=${CARGO_TARGET_DIR:-target}/debug/examples/picture
"$bahn" test examples/housing.H --html "$copy/page.html" >/dev/null
"$picture" "$copy/page.html" "$out/page.png" 1400x900 "js:bahn.seek(bahn.end * 0.62)" >/dev/null
echo "$out/page.png"
# A bead of glue with a slow valve: where functions are output, and where the path waits for them.
"$bahn" technology examples/technology/glue.nc --channel examples/technology/glue.lis \
    --plc examples/technology/slow-valve.txt --image "$out/glue.png" >/dev/null
echo "$out/glue.png"
