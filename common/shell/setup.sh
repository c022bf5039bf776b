# Sourced by ./course: what every command that builds needs. Expects $root; all messages go to standard error.
# shellcheck shell=bash

build=$root/build/default
logs=$root/build/logs

say() { echo "course: $*" >&2; }

stop() {  # exit code, one clear sentence
    local code=$1
    shift
    say "$*"
    exit "$code"
}

# Packages of the given sets that are not installed, one "name purpose..." a line.
missing_packages() {
    command -v dpkg-query >/dev/null || return 0
    local installed set name purpose
    installed=$(dpkg-query -W -f '${binary:Package} ${db:Status-Status}\n' | sed 's/:[a-z0-9]* installed$/ installed/')
    while read -r set name purpose; do
        [[ " $* " == *" $set "* ]] || continue
        grep -Fqx "$name installed" <<<"$installed" || echo "$name $purpose"
    done < <(grep -v '^#' "$root/common/packages.txt")
}

# Installs what is missing of the given sets, after saying so. Where that cannot or must not be done it says what is
# missing: it stops on a Debian that could have it, and goes on elsewhere, since the build may succeed all the same.
ensure_packages() {
    local missing names sudo=''
    missing=$(missing_packages "$@")
    if ! command -v apt-get >/dev/null; then
        command -v cmake >/dev/null && command -v ninja >/dev/null ||
            stop 2 "this is not a Debian system: please install what common/packages.txt lists (cmake, ninja, ...)"
        return 0
    fi
    [ -n "$missing" ] || return 0
    names=$(cut -d ' ' -f 1 <<<"$missing" | tr '\n' ' ')
    say "these Debian packages are missing:"
    sed 's/^\([^ ]*\) */    \1: /' <<<"$missing" >&2
    if [ "${COURSE_NO_INSTALL:-0}" = 1 ]; then
        say "COURSE_NO_INSTALL=1, so nothing is installed; going on without them"
        return 0
    fi
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || stop 2 "please install them as root: apt-get install $names"
        sudo=sudo
    fi
    say "installing them with apt-get"
    mkdir -p "$logs"
    local install=(env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends)
    # Package lists may be absent (containers) or old: a first failure is answered by fetching them anew.
    # shellcheck disable=SC2086  # $names is a list, $sudo may be empty
    $sudo "${install[@]}" $names >"$logs/apt.log" 2>&1 </dev/null ||
        { $sudo apt-get -q update && $sudo "${install[@]}" $names; } >>"$logs/apt.log" 2>&1 </dev/null ||
        stop 2 "could not install them (see build/logs/apt.log); by hand: ${sudo:+sudo }apt-get update && ${sudo:+sudo }apt-get install $names"
}

# Runs a command quietly: its output goes to a log, whose last "[12/90] ..." is shown on a terminal.
quietly() {  # NAME COMMAND...
    local log=$logs/$1.log
    shift
    mkdir -p "$logs"
    if [ -t 2 ]; then
        "$@" 2>&1 </dev/null | tee "$log" | awk '/^\[[0-9]+\/[0-9]+\]/ { printf "\r\033[K%s", substr($0, 1, 79); fflush() } END { printf "\r\033[K" }' >&2
    else
        "$@" >"$log" 2>&1 </dev/null
    fi
}

# Configures with the plain preset. The files that CMake writes say what is built here and what is left out.
configure() {
    ensure_packages build
    if [ ! -f "$build/build.ninja" ]; then say "configuring (cmake --preset default)"; fi
    (cd "$root" && quietly configure cmake --preset default) || {
        grep -A 4 'CMake Error' "$logs/configure.log" | head -n 12 >&2
        stop 1 "could not configure; all output: build/logs/configure.log"
    }
}

build_targets() {  # none: everything
    say "building${1:+: $*} (cmake --build --preset default)"
    (cd "$root" && quietly build cmake --build --preset default ${1:+--target "$@"}) || {
        grep -E -m 3 -A 4 'error[: ]|undefined reference' "$logs/build.log" | cut -c 1-160 >&2
        stop 1 "the build failed; all output: build/logs/build.log"
    }
}

# Chapters that are built here ("05_spatial_grid"), and "what: why" of what is left out.
built_chapters() { sed -n 's/^chapter //p' "$build/summary.txt"; }
left_out() { sed -n 's/^left out //p' "$build/summary.txt"; }

# The folder name of a chapter given as 5, 05 or 05_spatial_grid; exit code 2 if there is none.
chapter_folder() {
    local number=$1 match
    if [[ $number =~ ^[0-9]$ ]]; then number=0$number; fi
    match=$(cd "$root/chapters" && find . -maxdepth 1 -type d \( -name "${number}_*" -o -name "$number" \) | cut -c 3-)
    if [[ ! $number =~ ^[0-9]{2}(_[a-z0-9_]+)?$ || -z $match ]]; then
        stop 2 "there is no chapter '$1'; there are: $(cd "$root/chapters" && echo [0-9]*/ | tr -d /)"
    fi
    echo "$match"
}
