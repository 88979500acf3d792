#!/usr/bin/env bash
# usage: scripts/portability.sh PREFIX_OF_NEWER_PETSC (or set PETSC_NEW)
# Runs make check with three builds of PETSc: Debian's, a newer one, and Debian's with 64-bit indices. Each has its own
# build folder, which is made anew. A warning of the compiler, for example of something deprecated, is a failure.
set -uo pipefail
cd "$(dirname "$0")/.."
newer=${1:-${PETSC_NEW:-}}
[ -n "$newer" ] || { echo "usage: $0 PREFIX_OF_NEWER_PETSC (or PETSC_NEW)" >&2; exit 1; }
unset PETSC_DIR PETSC_ARCH
failed=0

check() { # name, PETSC_DIR
  local build=build/petsc-$1
  rm -rf "$build"
  mkdir -p "$build"
  if ! PETSC_DIR=$2 make -j"$(env -u OMP_NUM_THREADS nproc)" BUILD="$build" all tests >"$build/make.log" 2>&1; then
    grep -E 'error|Error' "$build/make.log" | head >&2
    echo "$1: does not build, see $build/make.log"; failed=1; return
  fi
  if grep -n 'warning:' "$build/make.log"; then echo "$1: warnings"; failed=1; fi
  if PETSC_DIR=$2 make BUILD="$build" check >"$build/check.log" 2>&1; then echo "$1: $(tail -n 1 "$build/check.log")"
  else echo "$1: $(grep passed, "$build/check.log"), see $build/check.log"; failed=1; fi
}

if [ ! -e /usr/lib/petsc64 ] && [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
  mkdir -p build
  DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends libpetsc64-real-dev \
    >build/petsc64.log 2>&1 || tail -n 5 build/petsc64.log >&2
fi
check debian "$(pkg-config --variable=prefix PETSc)"
check newer "$newer"
if [ -e /usr/lib/petsc64 ]; then check int64 /usr/lib/petsc64
else echo "int64: libpetsc64-real-dev is not installed"; failed=1; fi
exit $failed
