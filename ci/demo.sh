#!/usr/bin/env bash
# Installs, builds, drives the robot through the AgiProbot hall, prints Table 6 and says where the pictures are.
#   ci/demo.sh [OUT]      results go to OUT (default: out/agiprobot)
set -euo pipefail
cd "$(dirname "$0")/.."
out="${1:-out/agiprobot}"
ci/install.sh
ci/build.sh release
build/release/harness/waretwin run scenes/agiprobot/scenario.yaml --out "$out" --profile paper --detector truth
cat "$out/table6.md"
echo
echo "Pictures and files in $out:"
find "$out" -maxdepth 2 -name '*.png' | sort | sed 's/^/  /'
echo "  $out/report.html (open it in a browser)"
