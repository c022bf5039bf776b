# Sourced by ./course: gpu-check, everything that needs a real GPU, in one go and with its results in one folder.
# Each part's result is written before the next begins, so that a machine that goes away leaves what was done.
# Expects setup.sh, doctor.sh and report.sh.
# shellcheck shell=bash

gpu_build=$root/build/gpu-check

# Runs one part, says how it went and how long it took, and goes on whatever happened.
part() {  # NAME SECONDS_AT_MOST COMMAND...
    local name=$1 limit_s=$2 start=$SECONDS result=ok
    shift 2
    if ! command -v "$1" >/dev/null; then
        printf '%-28s         not run: there is no %s here\n' "$name" "$1" | tee -a "$results/summary.txt"
        return
    fi
    timeout -k 5 "$limit_s" "$@" >"$results/$name.log" 2>&1 </dev/null || result="FAILED (exit code $?), see $name.log"
    if [ "$result" != ok ]; then failed_parts+=("$name"); fi
    printf '%-28s %4d s  %s\n' "$name" $((SECONDS - start)) "$result" | tee -a "$results/summary.txt"
}

describe_device() {
    local commit
    commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo unknown)
    nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm --format=csv,noheader,nounits | head -n 1 |
        awk -F ', ' -v cuda="$(nvcc_version)" -v commit="$commit" '{
            printf "{\"device\": \"%s\", \"driver\": \"%s\", \"memory_MiB\": %d, \"max_clock_MHz\": %d, ", $1, $2, $3, $4
            printf "\"cuda\": \"%s\", \"commit\": \"%s\"}\n", cuda, commit }'
}

cuda_chapters() {  # those whose program launches kernels
    local chapter
    for chapter in $(sed -n 's/^chapter //p' "$gpu_build/summary.txt"); do
        if [ -f "$root/chapters/$chapter/main.cu" ]; then echo "$chapter"; fi
    done
}

register_report() {  # as the compiler told it during the build
    grep -E "ptxas info +: (Compiling|Used)|spill" "$results/build.log" | c++filt >"$results/registers.txt" || true
}

gpu_check() {
    local results=$root/out/gpu-check chapter tool kind name failed_parts=()
    case ${1:-} in
        '') ;;
        --out) results=$(realpath -m "${2:?gpu-check --out needs a folder}") ;;
        *) stop 2 "gpu-check knows only --out DIR, not '$1'" ;;
    esac
    gpu_name >/dev/null || stop 2 "no GPU answers on this machine (nvidia-smi names none), and gpu-check needs one"
    nvcc_version >/dev/null || stop 2 "there is a GPU but no nvcc; gpu-check needs the CUDA Toolkit"
    PATH=$PATH:/usr/local/cuda/bin
    ensure_packages build
    mkdir -p "$results"
    cd "$root" || exit
    describe_device | tee "$results/device.json"
    : >"$results/summary.txt"

    part configure 60 cmake --preset gpu -B "$gpu_build" -DCOURSE_WINDOW=OFF -DCMAKE_CUDA_ARCHITECTURES=native \
        -DCMAKE_CUDA_FLAGS=-Xptxas=-v
    part build 240 cmake --build "$gpu_build" --clean-first  # all of it: the compiler reports what it compiles
    [ ${#failed_parts[@]} = 0 ] || stop 1 "without a build there is nothing to check; see $results/${failed_parts[0]}.log"

    COURSE_REQUIRE_GPU=1 part tests 180 ctest --test-dir "$gpu_build" --output-on-failure --no-tests=error -LE 'proof|bench' \
        --timeout 120 --output-junit "$results/tests.xml"
    for chapter in $(cuda_chapters); do
        for tool in memcheck racecheck; do
            part "${tool}_$chapter" 60 compute-sanitizer --tool "$tool" --error-exitcode 1 \
                "$gpu_build/bin/ch$chapter" --particles 600 --steps 3 --out "$results/scratch"
        done
    done
    rm -rf "$results/scratch"
    # Registers and spills of every kernel, then the measurements of the programs themselves and their pictures.
    register_report
    for chapter in $(cuda_chapters); do
        part "run_$chapter" 120 "$gpu_build/bin/ch$chapter" --out "$results/$chapter" --csv "$results/$chapter.csv"
    done
    part run_10_large 120 "$gpu_build/bin/ch10_water_sph" --particles 131072 --steps 2000 \
        --out "$results/10_water_sph_large" --csv "$results/10_water_sph_large.csv"
    for chapter in $(cuda_chapters); do
        while read -r kind name; do
            part "${kind}_${chapter}_$name" 60 "$gpu_build/bin/ch$chapter" "--$kind" "$name" --quick --out "$results/report/$chapter"
        done < <(measurements_of "$gpu_build" "$chapter")
    done
    if command -v gnuplot >/dev/null; then
        part report 60 "$gpu_build/bin/course_report" "$results/report" "$results/report.html"
    fi
    part gallery 30 "$gpu_build/bin/course_gallery" "$results"
    echo "results: $results"
    [ ${#failed_parts[@]} = 0 ] || stop 1 "failed: ${failed_parts[*]}"
}
