#!/usr/bin/env bash
# Drives the same run again and again, at one thread and at all in turn, and fails where its digest is ever another: a gate that flickers is no gate.
#   ci/repeats.sh [N] [RUN OPTIONS]      N times (default: 20), by default the AgiProbot hall with the shipped detector, 40 frames
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
times=20
[[ "${1:-}" =~ ^[0-9]+$ ]] && { times=$1; shift; }
[[ $# -gt 0 ]] || set -- "$root"/scenes/agiprobot/scenario.yaml --frames 40 --set sensors.cameras.camera.rate_hz=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for ((i = 1; i <= times; ++i)); do
  "$root"/build/release/harness/waretwin run "$@" --out "$folder/run" --threads $((i % 2)) --quiet | grep '^digest' | tee -a "$folder/digests"
done
[[ $(sort -u "$folder/digests" | wc -l) -eq 1 ]] || { echo "not all of $times digests are equal" >&2; exit 1; }
echo "$times runs, one digest"
