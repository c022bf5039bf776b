#!/bin/sh
# docs/build.sh: makes the site of the course, build/docs/html/index.html. It needs no network, neither to be
# made nor to be read, and the folder html/ can be moved. Exit 1: Doxygen warned (build/docs/warnings.txt).
set -eu
cd "$(dirname "$0")/.."

mathjax=/usr/share/javascript/mathjax
if ! command -v doxygen > /dev/null || ! [ -d $mathjax ]; then
    echo "docs: Doxygen or MathJax is missing (Debian: doxygen libjs-mathjax)" >&2
    exit 2
fi

COURSE_PAGES=$(docs/pages.sh | tr '\n' ' ')
COURSE_SOURCES=$(find common chapters -name '*.h' -o -name '*.cuh' -o -name '*.cu' -o -path 'chapters/*.cpp' |
    LC_ALL=C sort | tr '\n' ' ')
export COURSE_PAGES COURSE_SOURCES

rm -rf build/docs
mkdir -p build/docs/html/mathjax
(cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = build/docs"; echo "INPUT = $COURSE_PAGES $COURSE_SOURCES") | doxygen -

# Doxygen 1.9 puts a space between a bracket and a formula.
sed -i 's/( \\(/(\\(/g' build/docs/html/*.html

# Pictures keep their folders, since two chapters may use one name.
find chapters common docs -name '*.png' -o -name '*.jpg' -o -name '*.svg' | while read -r picture; do
    mkdir -p "build/docs/html/pictures/$(dirname "$picture")"
    cp "$picture" "build/docs/html/pictures/$picture"
done

# Of MathJax only what turns TeX into SVG: about 3 MB of 54, and no fonts to load, which file:// would refuse.
for part in MathJax.js extensions/tex2jax.js extensions/MathEvents.js extensions/MathZoom.js extensions/TeX \
    jax/input/TeX jax/element jax/output/SVG/config.js jax/output/SVG/jax.js \
    jax/output/SVG/autoload jax/output/SVG/fonts/TeX; do
    mkdir -p "build/docs/html/mathjax/$(dirname $part)"
    cp -rL "$mathjax/$part" "build/docs/html/mathjax/$(dirname $part)/"
done

if [ -s build/docs/warnings.txt ]; then
    cat build/docs/warnings.txt >&2
    exit 1
fi
echo "docs: build/docs/html/index.html"
