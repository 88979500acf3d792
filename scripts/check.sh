#!/usr/bin/env bash
# usage: scripts/check.sh BUILD [ctest options]
# Runs the tests of a build folder with ctest. The last line is `N passed, N failed`.
set -uo pipefail
build=$1 log=$1/ctest/tests.log
shift
[ -x build/venv/bin/python ] || { echo "no Python environment in build/venv: run make deps" >&2; exit 1; }
# If the caller has not chosen the kernels of OpenBLAS, the program's own advice for this processor is taken.
if [ -z "${OPENBLAS_CORETYPE+set}" ] &&
  kernels=$("$build/burnish" -version 2>/dev/null | grep -o 'OPENBLAS_CORETYPE=.*'); then
  export "$kernels"
fi
unset MAKEFLAGS MFLAGS MAKELEVEL # tests that call make are no part of the make that called this
mkdir -p "$build/ctest"
cmake -S tests -B "$build/ctest" -DBURNISH_BUILD="$(realpath "$build")" >"$build/ctest/configure.log" 2>&1 ||
  { cat "$build/ctest/configure.log" >&2; exit 1; }
ctest --test-dir "$build/ctest" --output-on-failure -j "$(env -u OMP_NUM_THREADS nproc)" "$@" | tee "$log"
status=${PIPESTATUS[0]}
awk '/ tests? failed out of / { failed = $4; total = $NF; counted = 1 }
  END { printf "%d passed, %d failed\n", total - failed, failed; exit !counted || !total }' "$log" && exit "$status"
exit 1
