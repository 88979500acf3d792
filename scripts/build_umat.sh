#!/usr/bin/env bash
# usage: scripts/build_umat.sh SOURCE LIBRARY
# Compiles a UMAT routine (.f, .for, .f90 with gfortran, .c with gcc) to a shared library for `law: umat`. Lines with
# INCLUDE 'ABA_PARAM.INC' find one that makes reals double precision. XIT ends the run as a crash does.
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: $0 SOURCE LIBRARY" >&2; exit 2; }
source=$1 library=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '      implicit real*8(a-h,o-z)\n      parameter (nprecd=2)\n' > "$work/ABA_PARAM.INC"
cp "$work/ABA_PARAM.INC" "$work/aba_param.inc"
printf '#include <stdlib.h>\nvoid xit_(void)\n{\n  abort();\n}\n' > "$work/xit.c"
gcc -O2 -fPIC -c -o "$work/xit.o" "$work/xit.c"
case $source in
*.c) gcc -O2 -fPIC -shared -o "$library" "$source" "$work/xit.o" -lm ;;
*.f | *.for | *.F | *.f90) gfortran -O2 -fPIC -shared -I"$work" -o "$library" "$source" "$work/xit.o" ;;
*) echo "$0: $source: allowed: a source with the suffix .f, .for, .f90 or .c" >&2; exit 1 ;;
esac
