#!/bin/sh
# Makes the pictures of docs/gallery.md anew; those of the README are made from them, but for the cat (one nib) and the raccoon
# (whirls 4). Needs drypoint on the path (or in DRYPOINT), rsvg-convert and ImageMagick.
#
#   docs/gallery.sh           accepts today's pictures
#   docs/gallery.sh --check   compares them with the accepted ones: root mean square difference of both, blurred as the eye does
#                             at arm's length (0 the same, 1 black for white). Those above 0.02 are shown side by side in gallery-check/, and the
#                             exit status is 1. Each drawing is also drawn again from its recipe, which must give the same bytes.
set -e
cd "$(dirname "$0")/.."
D=${DRYPOINT:-drypoint}
S=samples
ACCEPTED=docs/pictures/gallery
OUT=$ACCEPTED
MOST=0.02
WORK=$(mktemp -d)
if [ "$1" = --check ]; then
    OUT=$WORK/gallery
    cp $S/*.jpg $S/*.png docs/*-pens.toml "$WORK"
fi
mkdir -p "$OUT"

# NAME: a drawing that its recipe does not give again is an error.
redone() {
    [ "$OUT" != "$ACCEPTED" ] || return 0
    "$D" redo "$WORK/$1.svg" --quiet -o "$WORK/again.svg"
    cmp "$WORK/$1.svg" "$WORK/again.svg" || { echo "$1: its recipe gives another drawing" >&2; exit 1; }
}

# NAME PHOTO OPTIONS...: a drawing as a grey PNG, 760 pixels wide.
ink() {
    name=$1 photo=$2
    shift 2
    "$D" draw "$photo" --quiet -o "$WORK/$name.svg" "$@"
    redone "$name"
    rsvg-convert -w 1520 -b white -o "$WORK/$name.png" "$WORK/$name.svg"
    convert "$WORK/$name.png" -colorspace gray -scale 50% -depth 4 -define png:compression-level=9 "$OUT/$name.png"
}

# NAME PHOTO OPTIONS...: a painting as a small picture.
painting() {
    name=$1 photo=$2
    shift 2
    "$D" draw "$photo" --quiet -o "$WORK/$name.svg" --style glass "$@"
    redone "$name"
    rsvg-convert -w 1000 -b white -o "$WORK/$name.png" "$WORK/$name.svg"
    convert "$WORK/$name.png" -resize 50% "$WORK/$name.jpg"
}

# NAME PHOTO PENS OPTIONS...: a drawing in the pens of a file in docs/, as inks on paper look from afar.
coloured() {
    name=$1 photo=$2 pens=$3
    shift 3
    "$D" draw "$photo" --quiet -o "$WORK/$name.svg" --colours "docs/$pens-pens.toml" "$@"
    redone "$name"
    rsvg-convert -w 2400 -b white -o "$WORK/$name.png" "$WORK/$name.svg"
    convert "$WORK/$name.png" -colorspace RGB -resize 760x -colorspace sRGB -quality 85 "$OUT/$name.jpg"
}

# Portraits are drawn as anybody would draw them: by what is found in the photograph.
BUST="--mask subject=$S/bust-mask-subject.png"

ink hedcut-hopper $S/grace-hopper.jpg
ink hedcut-light $S/bust-light.png
ink hedcut-brown $S/bust-brown.png
ink hedcut-dark $S/bust-dark.png

"$D" --version >/dev/null
cargo run --quiet --release --example fields -- "$WORK"
for field in circular saddle; do
    ink grid-$field "$WORK/$field.png" --style grid --size 90x90mm --mask edges="$WORK/$field-edges.png" \
        --set lines=off --set isophotes=0
done
ink grid-hopper $S/grace-hopper.jpg --style grid
ink grid-hatching $S/grace-hopper.jpg --style grid --set size_max=0
ink grid-tiles $S/grace-hopper.jpg --style grid --set primitive=tile
ink grid-dark $S/bust-dark.png --style grid
ink grid-astronaut $S/astronaut-cutout.png --style grid
ink grid-coffee $S/coffee.png --style grid

DEPTH="--depth $S/bust-depth.png $BUST"
ink engrave-bust $S/bust-light.png $DEPTH --style engrave --pitch 0.45mm --set displacement=5mm --set cross_angle=60
ink engrave-hopper $S/grace-hopper.jpg --crop 22%,2%,56%,58% --style engrave --size 90x120mm --pitch 0.4mm
ink engrave-hopper-depth $S/grace-hopper.jpg --depth $S/grace-hopper-depth.png --crop 22%,2%,56%,58% --style engrave \
    --size 90x120mm --pitch 0.4mm --set cross_angle=60
ink engrave-coffee $S/coffee.png --style engrave --size 120x80mm --pitch 0.45mm --set regions=superpixels --set overlap=0.2mm \
    --set cross_angle=60
ink engrave-stipple $S/bust-light.png $DEPTH --style engrave --size 60x80mm --set look=stipple

for bust in light brown dark; do
    ink charcoal-$bust $S/bust-$bust.png --style charcoal
done
ink charcoal-hopper $S/grace-hopper.jpg --style charcoal
ink charcoal-astronaut $S/astronaut-cutout.png --style charcoal

# Each angle is a row, each reach of the whirls a column, beside the photograph.
for animal in raccoon.jpg chelsea.png; do
    which=${animal%.*}
    for angle in 0 45 90; do
        for whirls in 0.8 1.7 4; do
            painting $which-$angle-$whirls $S/$animal --size 60x60mm --set angle=$angle --set whirls=$whirls
        done
    done
    montage "$WORK/$which"-*-*.jpg -tile 3x3 -geometry +6+6 -quality 88 "$OUT/glass-$which.jpg"
    convert $S/$animal -resize 500x "$OUT/photograph-$which.jpg"
done
painting glass-astronaut $S/astronaut.jpg --set detail=0.06
convert "$WORK/glass-astronaut.png" -quality 88 "$OUT/glass-astronaut.jpg"
ink glass-one-pen $S/astronaut.jpg --style glass --set colors=mono

coloured colour-raccoon $S/raccoon.jpg four --size 120x90mm
coloured colour-raccoon-lines $S/raccoon.jpg four --size 120x90mm --style engrave
coloured colour-astronaut $S/astronaut.jpg four --background keep --pitch 0.45mm
coloured colour-coffee $S/coffee.png four --size 120x90mm --style engrave
for pens in three eight; do
    coloured colour-raccoon-$pens $S/raccoon.jpg $pens --size 120x90mm
    coloured colour-astronaut-$pens $S/astronaut.jpg $pens --background keep --pitch 0.45mm
    coloured colour-coffee-$pens $S/coffee.png $pens --size 120x90mm --style engrave
done
TONED="--paper #c9b28f"
coloured colour-raccoon-toned $S/raccoon.jpg toned --size 120x90mm $TONED
coloured colour-astronaut-toned $S/astronaut.jpg toned --style charcoal $TONED
coloured colour-coffee-toned $S/coffee.png toned --size 120x90mm --style engrave $TONED

for preset in wsj-column wsj-large book banknote charcoal-loose poster pen-0.1 pen-0.5-one-hour scraperboard; do
    ink preset-$preset $S/grace-hopper.jpg --preset $preset
done

status=0
if [ "$OUT" != "$ACCEPTED" ]; then
    for picture in "$ACCEPTED"/*; do
        name=$(basename "$picture")
        # Pictures of another size, or none, are wholly unlike.
        convert "$picture" -colorspace gray -blur 0x3 "$WORK/before.png"
        convert "$OUT/$name" -colorspace gray -blur 0x3 "$WORK/after.png" 2>/dev/null || true
        unlike=$(compare -metric RMSE "$WORK/before.png" "$WORK/after.png" null: 2>&1 | sed 's/.*(\(.*\)).*/\1/') || true
        case $unlike in [0-9]*) ;; *) unlike=1 ;; esac
        echo "$unlike $name"
        if [ "$(echo "$unlike $MOST" | awk '{ print ($1 > $2) }')" = 1 ]; then
            mkdir -p gallery-check
            montage "$picture" "$OUT/$name" -tile 2x1 -geometry +8+8 "gallery-check/$name" 2>/dev/null || true
            status=1
        fi
    done
fi
rm -r "$WORK"
exit $status
