#!/usr/bin/env bash
# Installs or checks what Burnish needs. It prints nothing when nothing is missing. A package that is there in any form
# is taken; PETSc is found by PETSC_DIR and PETSC_ARCH or by pkg-config. On Debian and Ubuntu apt installs what is
# missing, as root or with sudo. Python packages go to build/venv.
set -uo pipefail
cd "$(dirname "$0")/.."
venv=build/venv log=build/deps.log
[ -z "${PETSC_DIR:-}" ] ||
  export PKG_CONFIG_PATH="$PETSC_DIR/${PETSC_ARCH:-}/lib/pkgconfig:$PETSC_DIR/lib/pkgconfig:${PKG_CONFIG_PATH:-}"

preprocesses() { printf '%b\n' "$1" | "${CC:-mpicc}" -E -x c $2 - >/dev/null 2>&1; }
petsc_flags() { pkg-config --cflags-only-I PETSc 2>/dev/null; }
muparser_flags() { pkg-config --cflags-only-I muparser 2>/dev/null; }
petsc_prefix() { pkg-config --variable=prefix PETSc 2>/dev/null; }
petsc_variable() { sed -n "s/^$1 *= *//p" "$(petsc_prefix)/lib/petsc/conf/petscvariables" 2>/dev/null; }
reference_blas() {
  readlink -f "$(ldconfig -p 2>/dev/null | awk '$1 == "libblas.so.3" { print $NF; exit }')" | grep -q '/blas/libblas'
}
python_found() { # the first python3 that can make an environment for the pinned packages
  local python
  for python in python3 /usr/bin/python3; do
    "$python" -c 'import ensurepip, ssl, sys, venv; sys.exit(not (3, 10) <= sys.version_info < (3, 14))' 2>/dev/null &&
      echo "$python" && return
  done
  return 1
}

# Each function succeeds when the thing is there.
has_compiler() { command -v cc; }
has_pkgconfig() { command -v pkg-config; }
has_mpi() { command -v "${CC:-mpicc}"; }
has_mpirun() { command -v mpirun; }
has_petsc() {
  if [ -n "${PETSC_DIR:-}" ] && [ ! -f "$PETSC_DIR/${PETSC_ARCH:-}/lib/pkgconfig/PETSc.pc" ] &&
    [ ! -f "$PETSC_DIR/lib/pkgconfig/PETSc.pc" ]; then
    return 1
  fi
  pkg-config --exists 'PETSc >= 3.18' && preprocesses '#include <petscconf.h>\n
    #if !defined(PETSC_HAVE_MUMPS) || !defined(PETSC_HAVE_HDF5)\n#error\n#endif\n
    #if defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)\n#error\n#endif' "$(petsc_flags)"
}
has_blas() { ! reference_blas; }
has_hdf5() {
  preprocesses '#include <hdf5.h>\n#ifndef H5_HAVE_PARALLEL\n#error\n#endif' "$(petsc_variable HDF5_INCLUDE)"
}
has_mumps() { preprocesses '#include <dmumps_c.h>' "$(petsc_flags)"; }
has_metis() { preprocesses '#include <metis.h>' ''; }
has_yaml() { pkg-config --exists yaml-0.1; }
has_cjson() { pkg-config --exists libcjson; }
has_muparser() { pkg-config --exists muparser && preprocesses '#include <muParserDLL.h>' "$(muparser_flags)"; }
has_cmocka() { pkg-config --exists cmocka; }
has_gmsh() { command -v gmsh; }
has_cmake() { command -v cmake && command -v ctest; }
has_h5dump() { command -v h5dump; }
has_python() { python_found; }

declare -A packages=([compiler]="gcc libc6-dev" [pkgconfig]=pkg-config [mpi]=libopenmpi-dev [mpirun]=openmpi-bin
  [petsc]="petsc-dev libopenblas0-serial" [blas]=libopenblas0-serial [hdf5]=libhdf5-openmpi-dev
  [mumps]=libmumps-dev [metis]=libmetis-dev [yaml]=libyaml-dev
  [cjson]=libcjson-dev [muparser]=libmuparser-dev [cmocka]=libcmocka-dev [gmsh]=gmsh [cmake]=cmake
  [h5dump]=hdf5-tools [python]="python3 python3-venv")
declare -A meaning=([compiler]="a C compiler" [pkgconfig]="pkg-config" [mpi]="MPI: mpicc" [mpirun]="MPI: mpirun"
  [petsc]="PETSc 3.18 or newer, real double, with MUMPS and HDF5${PETSC_DIR:+ (PETSC_DIR=$PETSC_DIR has none)}"
  [blas]="an optimised BLAS (libblas.so.3 is the reference BLAS: MUMPS 6 times slower)"
  [hdf5]="parallel HDF5, the one of PETSc, with headers" [mumps]="MUMPS with its C header, the one of PETSc"
  [metis]="METIS" [yaml]="libyaml" [cjson]="cJSON" [muparser]="muParser" [cmocka]="cmocka" [gmsh]="gmsh" [cmake]="cmake and ctest"
  [h5dump]="HDF5 tools" [python]="Python 3.10 to 3.13 with venv")
order="compiler pkgconfig mpi mpirun petsc blas hdf5 mumps metis yaml cjson muparser cmocka gmsh cmake h5dump python"

missing() {
  local thing
  for thing in $order; do "has_$thing" >/dev/null 2>&1 || echo "$thing"; done
}

watched() { # runs a command into the log; shows every ten seconds where it is
  local pid count=0
  "$@" >>"$log" 2>&1 &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    sleep 0.5
    count=$((count + 1))
    [ $((count % 20)) -ne 0 ] || printf '%8d s  %.70s\n' $((count / 2)) "$(tail -n 1 "$log")"
  done
  wait "$pid"
}

install_missing() { # through apt; $*: names of things
  local as_root="" thing names=()
  for thing in "$@"; do
    [ "$thing" = petsc ] && [ -n "${PETSC_DIR:-}" ] && continue
    names+=(${packages[$thing]})
  done
  [ ${#names[@]} -gt 0 ] || return 0
  [ "$(id -u)" = 0 ] || as_root="sudo"
  [ -z "$as_root" ] || command -v sudo >/dev/null ||
    { echo "make deps: neither root nor sudo; to be installed: ${names[*]}" >&2; return 1; }
  echo "make deps: installing ${names[*]}"
  apt_install() {
    watched $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${names[@]}"
  }
  if ls /var/lib/apt/lists/*_Packages* >/dev/null 2>&1; then apt_install && return; fi
  watched $as_root apt-get update
  apt_install || { tail -n 20 "$log" >&2; return 1; }
}

make_environment() {
  [ -x $venv/bin/python ] && $venv/bin/python -c '' 2>/dev/null &&
    cmp -s scripts/requirements.txt $venv/requirements.txt && return
  echo "make deps: Python packages into $venv"
  rm -rf $venv
  watched "$(python_found)" -m venv $venv &&
    watched $venv/bin/python -m pip install --disable-pip-version-check -r scripts/requirements.txt &&
    cp scripts/requirements.txt $venv/ || { tail -n 20 "$log" >&2; return 1; }
}

mkdir -p build
: >"$log"
lacking=$(missing)
for round in first second; do # the second round is for the reference BLAS, which packages of the first may bring
  [ -n "$lacking" ] && command -v apt-get >/dev/null || break
  install_missing $lacking || exit 1
  hash -r
  lacking=$(missing)
done
if [ -n "$lacking" ]; then
  echo "make deps: missing:" >&2
  for thing in $lacking; do echo "  ${meaning[$thing]}" >&2; done
  cat >&2 <<'END'
On a cluster these come as modules or through spack:
  module load gcc openmpi petsc metis gmsh cmake python
  spack install petsc+mumps+hdf5+metis gmsh libyaml cjson muparser cmocka cmake
Set PETSC_DIR (and PETSC_ARCH) when pkg-config does not find PETSc, PKG_CONFIG_PATH for libyaml, cJSON,
muParser and cmocka.
END
  exit 1
fi
make_environment
