#!/usr/bin/env bash
# usage: scripts/fuzz.sh SECONDS [scene] [mesh]
# Runs libFuzzer on the readers, one after the other, for SECONDS each. Files that it finds are left in out/fuzz/READER.
# Those worth keeping go to tests/fuzz/READER, which make check replays. The status is 1 after a crash, a hang or a
# refusal without a message.
set -euo pipefail
seconds=$1 build=build/fuzz status=0
shift
[ $# -gt 0 ] || set -- scene mesh
command -v clang >/dev/null || { echo "make fuzz: clang is missing (Debian: apt install clang)" >&2; exit 1; }
# -O0: with optimisation clang takes many minutes for the element kernels, which the readers do not need.
# detect_leaks=0: the fuzzers count the readers' own leaks; those of MPI do not matter here.
export OMPI_CC=clang MPICH_CC=clang ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
sanitizers="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined"
make -s -j "$(env -u OMP_NUM_THREADS nproc)" BUILD="$build" CPPFLAGS=-DFUZZER \
  CFLAGS="-O0 -g -fno-omit-frame-pointer $sanitizers" LDLIBS=-fsanitize=fuzzer \
  "$build"/tests/fuzz_scene "$build"/tests/fuzz_mesh
for reader in "$@"; do
  mkdir -p out/fuzz/"$reader"
  seeds=(tests/fuzz/"$reader")
  [ "$reader" = scene ] && seeds+=(tests/input tests/scenes runs)
  # The dictionary has every word in quotes of the table of keys and of the reader.
  grep -ohE '"[A-Za-z_$][A-Za-z_]*"' src/scene/schemakeys.c src/mesh/gmshfile.c | sort -u >out/fuzz/words
  timeout $((seconds + 120)) "$build"/tests/fuzz_"$reader" -max_total_time="$seconds" -timeout=10 \
    -rss_limit_mb=8192 -max_len=16384 -dict=out/fuzz/words -artifact_prefix=out/fuzz/"$reader"- \
    -print_final_stats=1 out/fuzz/"$reader" "${seeds[@]}" || status=1
done
exit $status
