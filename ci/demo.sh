#!/usr/bin/env bash
# Installs, builds, drives the robot through the AgiProbot hall, prints Table 6 and says where the pictures are.
#   ci/demo.sh [OUT]      results go to OUT (default: out/agiprobot)
set -euo pipefail
cd "$(dirname "$0")/.."
out="${1:-out/agiprobot}"
ci/install.sh
ci/build.sh release
# Nothing of the truth is in the loop; at two pictures a second the drive takes about two minutes.
build/release/harness/waretwin run scenes/agiprobot/scenario.yaml --out "$out" --set sensors.cameras.camera.rate_hz=2
cat "$out/table6.md"
echo
echo "Pictures and files in $out:"
find "$out" -maxdepth 2 -name '*.png' | sort | sed 's/^/  /'
echo "  $out/report.html (open it in a browser)"
