#!/bin/sh
# The pages of the site, in course order: the front page, the chapters by number, then what they stand on.
set -eu
cd "$(dirname "$0")/.."
export LC_ALL=C # globs in the order of their bytes
for page in README.md chapters/*/README.md common/README.md common/*/README.md docs/*.md; do
    if [ -f "$page" ]; then echo "$page"; fi
done
