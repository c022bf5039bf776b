#!/bin/sh
# docs/weave.sh           renews every listing of every page from the source
# docs/weave.sh --check   changes nothing; exit 1, naming page, line and marker, where text and source differ
set -eu
cd "$(dirname "$0")/.."

case "${1-}" in
    "" | --check) mode=${1-} ;;
    *) echo "usage: docs/weave.sh [--check]" >&2; exit 2 ;;
esac

failed=0
woven=$(mktemp)
trap 'rm -f "$woven"' EXIT
for page in $(docs/pages.sh); do
    if [ "$mode" = --check ]; then
        awk -v check=1 -f docs/weave_listings.awk "$page" || failed=1
    elif ! awk -f docs/weave_listings.awk "$page" > "$woven"; then
        failed=1 # the page stays as it is
    elif ! cmp -s "$woven" "$page"; then
        cat "$woven" > "$page"
        echo "renewed $page"
    fi
done
exit $failed
