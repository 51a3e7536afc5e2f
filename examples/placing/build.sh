#!/bin/sh
# Draws three portraits and places them: an HTML page, and a Typst and a LaTeX document where these programs are. The pictures of what
# came out are in the folder given, or in ./placed. Needs drypoint on the path (or in DRYPOINT).
set -e
here=$(cd "$(dirname "$0")" && pwd)
samples=$here/../../samples
out=${1:-placed}
D=${DRYPOINT:-drypoint}
mkdir -p "$out"
cp "$here/page.typ" "$here/page.tex" "$out"
cd "$out"
"$D" draw "$samples/grace-hopper.jpg" --quiet --embed --size 50x65mm -o one.svg
"$D" draw "$samples/astronaut.jpg" --quiet --embed --size 50x65mm --crop head -o two.svg
"$D" draw "$samples/bust-light.png" --quiet --embed --size 50x65mm --style grid -o three.svg
"$D" draw "$samples/grace-hopper.jpg" --quiet --size 50x65mm -o one.pdf
awk '
    function put(file,   line) { while ((getline line < file) > 0) print line }
    /@ONE@|@TWO@|@THREE@/ {
        name = index($0, "@ONE@") ? "one" : index($0, "@TWO@") ? "two" : "three"
        split($0, parts, /@[A-Z]+@/)
        print parts[1]; put(name ".svg"); print parts[2]; next
    }
    { print }
' "$here/page.html" > page.html
# No id stands twice.
twice=$(grep -o ' id="[^"]*"' page.html | sort | uniq -d)
[ -z "$twice" ] || { echo "ids that stand twice: $twice" >&2; exit 1; }
for browser in chromium chromium-browser google-chrome; do
    if command -v $browser >/dev/null; then
        $browser --headless --no-sandbox --disable-gpu --screenshot=page.png --window-size=800,420 "file://$PWD/page.html" 2>/dev/null
        break
    fi
done
# The compiler, or the Python package that holds it.
if command -v typst >/dev/null; then
    typst compile page.typ typst.pdf
elif python3 -c "import typst" 2>/dev/null; then
    python3 -c "import typst; typst.compile('page.typ', output='typst.pdf')"
fi
if command -v pdflatex >/dev/null; then pdflatex -interaction=batchmode page.tex >/dev/null; fi
ls
