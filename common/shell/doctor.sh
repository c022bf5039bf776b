# Sourced by ./course: doctor, which says what this machine can run and what would mend the rest. It installs
# nothing, and its exit code is 0 whatever it finds. Expects setup.sh.
# shellcheck shell=bash

row() { printf '%-14s %s\n' "$1" "$2"; }

gpu_name() {  # of the first GPU; fails if none answers
    command -v nvidia-smi >/dev/null && nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null | head -n 1 | grep .
}

nvcc_version() {
    local nvcc
    nvcc=$(command -v nvcc || echo /usr/local/cuda/bin/nvcc)
    "$nvcc" --version 2>/dev/null | sed -n 's/.*release \([0-9.]*\).*/\1/p' | grep .
}

doctor_opengl() {
    local glinfo=$build/bin/course_glinfo reason
    (cd "$root" && quietly doctor cmake --build --preset default --target course_glinfo) || {
        row OpenGL "not built (packages below); chapters that draw with it are left out"
        return
    }
    if reason=$("$glinfo" 2>&1); then row OpenGL "${reason#OpenGL }"; else row OpenGL "none: $reason"; fi
}

doctor_windows() {
    if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        row Windows "yes, on ${WAYLAND_DISPLAY:-$DISPLAY} (--window)"
    else
        row Windows "no display (neither DISPLAY nor WAYLAND_DISPLAY is set): pictures are made headless"
    fi
}

doctor_chapters() {
    local folder why
    echo "Chapters"
    for folder in "$root"/chapters/[0-9]*/; do
        folder=$(basename "$folder")
        if built_chapters | grep -qx "$folder"; then
            printf "  %-22s runs\n" "$folder"
        else
            why=$(left_out | sed -n "s/^$folder: //p")
            printf "  %-22s left out: %s\n" "$folder" "${why:-it is not listed in chapters/CMakeLists.txt}"
        fi
    done
    left_out | grep -v '^[0-9]' | sed 's/^/  /' || true
}

doctor() {
    local missing
    row GPU "$(gpu_name || echo 'none answers')"
    row nvcc "$(nvcc_version || echo 'absent; the simulator does not need it')"
    if (cd "$root" && quietly configure cmake --preset default); then
        row "Kernels run on" "$(sed -n 's/^kernels //p' "$build/summary.txt") ($(nproc) cores)"
        doctor_opengl
        doctor_windows
        doctor_chapters
    else
        row Build "cannot be configured: $(grep -A 2 -m 1 'CMake Error' "$logs/configure.log" 2>/dev/null | tail -n 1 || true)"
    fi
    missing=$(missing_packages build docs)
    if [ -n "$missing" ]; then
        echo "Missing packages (the command that needs one installs it)"
        sed 's/^\([^ ]*\) */  \1: /' <<<"$missing"
    else
        row Packages "nothing is missing"
    fi
}
