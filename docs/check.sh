#!/bin/sh
# docs/check.sh: the text agrees with the code, every link leads somewhere, every picture has its command and is
# shown somewhere, and Doxygen has nothing to warn of. Says all it finds; exit 1 if that is anything.
set -eu
cd "$(dirname "$0")/.."
failed=0

docs/self_test.sh || failed=1 # the checks below can fail

docs/weave.sh --check || failed=1

# shellcheck disable=SC2046 # one word a page: paths have no spaces
awk -f docs/markdown.awk -f docs/check_pages.awk $(docs/pages.sh) || failed=1

docs/build.sh || failed=1

if [ $failed = 0 ]; then echo "docs: nothing to mend"; fi
exit $failed
