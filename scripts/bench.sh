#!/usr/bin/env bash
# make bench: every program of tests/bench writes its raw record (lines "name value unit") to out/bench/; the table is printed from there.
set -euo pipefail
build=$1 out=out/bench
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
shopt -s nullglob
sources=(tests/bench/*.c)
[ ${#sources[@]} -gt 0 ] || { echo "make bench: not available yet" >&2; exit 1; }
mkdir -p "$out"
for source in "${sources[@]}"; do
  name=$(basename "$source" .c)
  "$build/bench/$name" >"$out/$name.txt"
done
for record in "$out"/*.txt; do
  echo "$(basename "$record" .txt)"
  awk '!/^#/ && NF { printf "  %-40s %12s %s\n", $1, $2, $3 }' "$record"
done | tee "$out/table.txt"
