#!/usr/bin/env bash
# Runs the unit tests of the plain C kernels under valgrind. These are the tests that start neither MPI nor PETSc. They
# are built for a processor that valgrind knows. The status is 1 after a bad access, a jump on an undefined value or a
# leak.
set -uo pipefail
build=build/valgrind failed=0 tests=()
command -v valgrind >/dev/null ||
  { echo "make valgrind: valgrind is missing (Debian: apt install valgrind)" >&2; exit 1; }
for source in tests/unit/test_*.c; do
  grep -qE 'PetscInitialize|MPI_Init' "$source" || tests+=("$build/tests/$(basename "$source" .c)")
done
make -s -j "$(env -u OMP_NUM_THREADS nproc)" BUILD="$build" ARCH=x86-64-v3 CFLAGS='-O1 -g' "${tests[@]}" || exit 1
for test in "${tests[@]}"; do
  if valgrind -q --leak-check=full --error-exitcode=66 "$test" >"$build/log" 2>&1; then
    echo "clean $(basename "$test")"
  else
    failed=$((failed + 1))
    cat "$build/log"
  fi
done
echo "valgrind: $((${#tests[@]} - failed)) clean, $failed not"
[ $failed -eq 0 ]
