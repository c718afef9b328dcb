#!/usr/bin/env bash
# Puts any mapper that writes a plain list of boxes behind `waretwin run --mapper`:
#   waretwin run SCENARIO --out DIR --mapper "ci/mapper_adapter.sh {recording} {out} my_mapper --fast"     (or run --suite, or study)
# runs `my_mapper --fast RECORDING OUT`, which leaves OUT/boxes.txt with a line an object,
#   class x y z yaw dx dy dz [score]     (metres, radians; x y z the centre; # begins a comment)
# and turns that into OUT/cuboids.json. Copy it and change what your mapper does otherwise.
set -euo pipefail
if (($# < 3)); then
  echo "usage: mapper_adapter.sh RECORDING OUT COMMAND.." >&2
  exit 2
fi
recording=$1 out=$2
shift 2
"$@" "$recording" "$out"
[[ -f "$out/boxes.txt" ]] || { echo "mapper_adapter.sh: $1 left no $out/boxes.txt" >&2; exit 2; }
awk '
  function fail(what) { printf "mapper_adapter.sh: boxes.txt:%d: %s; expected: class x y z yaw dx dy dz [score]\n", NR, what > "/dev/stderr"; bad = 1; exit 2 }
  BEGIN { printf "{\"frame\":\"world\",\"objects\":[" }
  { sub(/#.*/, "") }
  NF == 0 { next }
  NF != 8 && NF != 9 { fail(NF " words") }
  $1 !~ /^[A-Za-z0-9_ -]+$/ { fail("the class is " $1) }
  { for (i = 2; i <= NF; ++i) if ($i !~ /^[-+]?[0-9]*\.?[0-9]+([eE][-+]?[0-9]+)?$/) fail($i " is no number") }
  {
    printf "%s\n{\"id\":%d,\"class\":\"%s\",\"centre\":[%.9g,%.9g,%.9g],\"yaw\":%.9g,\"size\":[%.9g,%.9g,%.9g],\"score\":%.9g}", \
      (count ? "," : ""), ++count, $1, $2, $3, $4, $5, $6, $7, $8, (NF == 9 ? $9 : 1)
  }
  END { if (!bad) print "\n]}" }
' "$out/boxes.txt" > "$out/cuboids.json.partial" && mv "$out/cuboids.json.partial" "$out/cuboids.json"
