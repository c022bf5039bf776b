#!/bin/sh
# docs/self_test.sh: the checks of this folder find what they are for. Each mistake is made in a small tree of its
# own, and the check must name its page and line.
set -eu
tools=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failed=0

mkdir -p "$tree/docs" "$tree/chapters/01_one"
cp "$tools"/*.awk "$tools"/*.sh "$tree/docs/"
cd "$tree"
readme=chapters/01_one/README.md

# A tree with nothing to find: a listing with another one nested in it, a picture with its command, links.
reset() {
    printf '# Front\n\n[one](chapters/01_one/)\n' > README.md
    printf 'namespace one {\n    //! [outer]\n    int f() {\n        //! [inner]\n        return 1;\n        //! [inner]\n    }\n    //! [outer]\n}\n' > chapters/01_one/one.h
    printf '# One\n\n<!-- listing: one.h outer -->\n<!-- /listing -->\n\n![p](p.png)\n<!-- made by: ./course run 1 -->\n' > $readme
    : > chapters/01_one/p.png
    docs/weave.sh > woven.txt
}

check() { docs/weave.sh --check && awk -f docs/markdown.awk -f docs/check_pages.awk README.md $readme; }

# must_say TEXT: the check fails, and says TEXT.
must_say() {
    if check > said.txt 2>&1 || ! grep -qF "$1" said.txt; then
        echo "docs/self_test.sh: the check should have said: $1" >&2
        sed 's/^/    it said: /' said.txt >&2
        failed=1
    fi
    reset
}

reset
printf '```cpp\nint f() {\n    return 1;\n}\n```\n' > expected.txt
if ! check > said.txt 2>&1 || ! sed -n '4,8p' $readme | cmp -s - expected.txt; then
    echo "docs/self_test.sh: a right page was found wrong, or a listing is not what it should be" >&2
    cat said.txt $readme >&2
    failed=1
fi

sed -i 's/return 1/return 2/' chapters/01_one/one.h;  must_say "$readme:6: listing outer differs from chapters/01_one/one.h"
sed -i 's/return 1/return 2/' $readme;                must_say "$readme:6: listing outer differs"
sed -i 's/^}$/}\nint g();/' $readme;                  must_say "$readme:8: listing outer differs"
sed -i '7d' $readme;                                  must_say "$readme:7: listing outer differs"
sed -i '/outer/d' chapters/01_one/one.h;              must_say "$readme:3: listing outer: chapters/01_one/one.h has 0 lines"
sed -i '8d' chapters/01_one/one.h;                    must_say "has 1 lines \"//! [outer]\", expected 2"
sed -i '3,7d' chapters/01_one/one.h;                  must_say "nothing stands between its markers"
rm chapters/01_one/one.h;                             must_say "$readme:3: listing outer: there is no file chapters/01_one/one.h"
sed -i '/\/listing/d' $readme;                        must_say "$readme:3: listing outer has no <!-- /listing -->"
sed -i '4,8d' $readme;                                must_say "$readme:3: listing outer: no fenced block stands here yet"
printf '\n```cpp\nint pasted;\n```\n' >> $readme;     must_say "$readme:14: code that is not a listing"
sed -i '/made by/d' $readme;                          must_say "$readme:11: chapters/01_one/p.png has no command beside it"
rm chapters/01_one/p.png;                             must_say "$readme:11: there is no chapters/01_one/p.png"
: > chapters/01_one/q.png;                            must_say "chapters/01_one/q.png:1: no page shows this picture"
rm chapters/01_one/q.png
echo '@RESULT@' >> $readme;                           must_say "$readme:13: @RESULT@ is not filled in"
echo '[x](../02/)' >> $readme;                        must_say "$readme:13: there is no chapters/02"
echo '# Front' > README.md;                           must_say "README.md:1: no link to chapters/01_one/README.md"

# The filter for Doxygen: what is code stays, what is GitHub's is turned into Doxygen's, line by line.
cat > $readme << 'END'
# One `f`

Cost \$5, $a_i$ and $`b`$, `$c$`, [`main`](main.cu), [front](../../README.md), [here](#a-part), [gone](x.txt).
**How large is $h$?** "Any $h$", *says `f`*. 2 * 3 \* 4

```math
x < y
```

```sh
echo $HOME $USER
```

## A part!
END
cat > expected.txt << 'END'
# One f {#chapters_01_one}

Cost $5, \f$a_i\f$ and \f$b\f$, `$c$`, [main](@ref chapters/01_one/main.cu), [front](@ref index), [here](@ref chapters_01_one-a-part), gone.
<strong>How large is \f$h\f$?</strong> &quot;Any \f$h\f$&quot;, <em>says `f`</em>. 2 * 3 \* 4

\f[x < y \f]



```sh
echo $HOME $USER
```

## A part! {#chapters_01_one-a-part}
END
COURSE_PAGES="README.md $readme" COURSE_SOURCES=chapters/01_one/main.cu \
    awk -f docs/markdown.awk -f docs/page_filter.awk "$tree/$readme" | head -14 > said.txt
if ! diff expected.txt said.txt >&2; then
    echo "docs/self_test.sh: the filter gives something else (> is what it gave)" >&2
    failed=1
fi

exit $failed
