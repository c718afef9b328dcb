#!/usr/bin/env bash
# Runs profile `paper` on the AgiProbot hall with each effect of the sensors and of the drive switched off in turn, and prints the table that
# stands in docs/sensors.md. Half a minute a row.
#   ci/sensor_effects.sh [OUT] [RUN OPTIONS...]      results go to OUT/NAME (default: out/sensor_effects)
set -euo pipefail
cd "$(dirname "$0")/.."
out="${1:-out/sensor_effects}"
shift || true
ci/build.sh release
source ci/score_value.sh

row() {
  local name="$1"
  shift
  local dir="$out/$name"
  build/release/harness/waretwin run scenes/agiprobot/scenario.yaml --out "$dir" --profile paper --detector truth \
    --set truth_detector.min_visible_share=0.8 --quiet "$@" >/dev/null
  printf '| %s | %s | %s | %.3f | %.3f | %.2f | %.3f | %.3f | %.4f | %.0f | %.0f |\n' "$name" "$(value "$dir" summary matched)" \
    "$(value "$dir" summary mapped)" "$(value "$dir" summary mean_iou3d)" "$(value "$dir" summary mean_e_trans_m)" \
    "$(value "$dir" summary mean_e_rot_deg)" "$(value "$dir" depth valid_share)" "$(value "$dir" depth object_missing_share)" \
    "$(value "$dir" depth flying_share)" "$(value "$dir" depth median_abs_error_m)e3" "$(value "$dir" depth p95_abs_error_m)e3"
}

echo '| without | matched of 4 | mapped | mean IoU | translation (m) | yaw (deg) | valid | conveyor missing | flying | median error (mm) | 95 % (mm) |'
echo '|---|---|---|---|---|---|---|---|---|---|---|'
row nothing "$@"
for effect in lens_distortion noise wiggle mixed_pixels motion multipath invalidation; do
  row "$effect" --set "sensors.cameras.camera.time_of_flight.$effect=false" "$@"
done
colour=()
for effect in lens_distortion rolling_shutter motion_blur noise vignetting white_balance; do
  colour+=(--set "sensors.cameras.camera.colour.$effect=false")
done
row colour "${colour[@]}" "$@"
row laser_width --set sensors.lasers.laser.spot.mixed=false "$@"
row laser_dropouts --set sensors.lasers.laser.spot.dropouts=false "$@"
row laser_noise --set sensors.lasers.laser.noise.enabled=false "$@"
row wheels --set robot.drive.model=exact "$@"
row gaussian --set sensors.cameras.camera.preset=azure_kinect_gaussian "$@"
row all_error --depth truth "$@"
