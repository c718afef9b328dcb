#!/usr/bin/env bash
# Runs profile `paper` on the AgiProbot hall once for each reading of the paper's text that docs/paper.md lists, and prints the table that
# stands there. About a minute a row.
#   ci/readings.sh [OUT] [RUN OPTIONS...]      results go to OUT/NAME (default: out/readings)
set -euo pipefail
cd "$(dirname "$0")/.."
out="${1:-out/readings}"
shift || true
ci/build.sh release
source ci/score_value.sh

row() {
  local name="$1"
  shift
  build/release/harness/waretwin run scenes/agiprobot/scenario.yaml --out "$out/$name" --profile paper --detector truth \
    --set truth_detector.min_visible_share=0.8 --quiet "$@" >/dev/null
  printf '| %s | %s | %s | %.2f | %.3f | %.2f | %.3f |\n' "$name" "$(value "$out/$name" summary matched)" \
    "$(value "$out/$name" summary mapped)" "$(value "$out/$name" summary mean_iou3d)" "$(value "$out/$name" summary mean_e_trans_m)" \
    "$(value "$out/$name" summary mean_e_rot_deg)" "$(value "$out/$name" trajectory ate_rmse_m)"
}

echo '| reading | matched of 4 | mapped | mean IoU | translation (m) | yaw (deg) | ATE (m) |'
echo '|---|---|---|---|---|---|---|'
row paper "$@"
row ground_only --set mapper.segment.planes.remove=ground "$@"
row scan_to_scan --set mapper.localise.keyframe_distance_m=0 "$@"
row two_point_lines --set mapper.localise.match.lines=two_points "$@"
row projected_boxes --set mapper.associate.iou2d_mode=projected "$@"
row no_frame_gap --set mapper.associate.max_frame_gap=0 "$@"
row projected_and_no_gap --set mapper.associate.iou2d_mode=projected --set mapper.associate.max_frame_gap=0 "$@"
row literal_correlation --set mapper.associate.correlation=literal "$@"
row true_poses --poses truth "$@"
row true_depth --depth truth "$@"
row true_association --association truth "$@"
