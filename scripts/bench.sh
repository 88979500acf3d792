#!/usr/bin/env bash
# make bench: every program of tests/bench writes its raw record to out/bench/. A record has lines "row column value",
# and a line that begins with # heads a table. The tables are printed from the records.
set -euo pipefail
build=$1 out=out/bench
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
mkdir -p "$out"
records=()
sed -n 's/^model name[[:space:]]*: /processor: /p; T; q' /proc/cpuinfo >"$out/machine.txt"
echo "load: $(cut -d ' ' -f 1 /proc/loadavg) of $(getconf _NPROCESSORS_ONLN) cores when started" >>"$out/machine.txt"
for source in tests/bench/*.c; do
  name=$(basename "$source" .c)
  "$build/bench/$name" >"$out/$name.txt"
  records+=("$out/$name.txt")
done

# Prints one table for each heading. Rows and columns keep the order of their first line.
tables() {
  awk '
    function flush_table(  r, c) {
      if (!rows) return
      printf "%-8s", ""
      for (c = 1; c <= columns; c++) printf "  %*s", width[c], column[c]
      print ""
      for (r = 1; r <= rows; r++) {
        printf "%-8s", row[r]
        for (c = 1; c <= columns; c++) printf "  %*s", width[c], value[row[r], column[c]]
        print ""
      }
      split("", value); split("", seen_row); split("", seen_column)
      rows = columns = 0
    }
    /^#/ { flush_table(); print "\n" substr($0, 3); next }
    NF == 3 {
      if (!($1 in seen_row)) { seen_row[$1]; row[++rows] = $1 }
      if (!($2 in seen_column)) {
        seen_column[$2]; column[++columns] = $2; width[columns] = length($2) > 9 ? length($2) : 9
      }
      value[$1, $2] = $3
    }
    END { flush_table() }' "$@"
}
{ cat "$out/machine.txt"; tables "${records[@]}"; } | tee "$out/table.txt"
