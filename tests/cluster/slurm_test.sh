#!/usr/bin/env bash
# A study as a Slurm job array on a real slurmctld and slurmd on this machine: one task is killed and submitted again, and the results are
# byte for byte those of one process. Exit code 77: Slurm is not installed (ctest then says "skipped").
#   slurm_test.sh PROGRAM SOURCE_FOLDER
set -euo pipefail
program="$(realpath "$1")" source="$(realpath "$2")"
for tool in slurmctld slurmd sbatch squeue scontrol scancel; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed (ci/install.sh --cluster)"; exit 77; }
done
((EUID == 0)) || { echo "skipped: slurmd starts other users' tasks and wants to be root"; exit 77; }

folder="$(mktemp -d)"
daemons=()
cleanup() {
  for process in "${daemons[@]}"; do kill "$process" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap cleanup EXIT
fail() { echo "FAILED: $*" >&2; tail -n 20 "$folder"/*.log >&2 || true; exit 1; }
# Until the command succeeds; a minute unless told otherwise.
wait_for() {
  local what="$1" seconds="$2"; shift 2
  for ((i = 0; i < seconds * 10; ++i)); do "$@" >/dev/null 2>&1 && return 0; sleep 0.1; done
  fail "$what did not come about in $seconds s"
}

# Two free ports, so that tests side by side do not meet.
port() { echo $((20000 + (RANDOM % 20000))); }
host="$(hostname -s)"
memory="$(awk '/MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)"
sed -e "s|@HOST@|$host|g; s|@FOLDER@|$folder|g; s|@USER@|$(id -un)|g; s|@CPUS@|$(nproc)|g; s|@MEMORY@|$memory|g" \
  -e "s|@CTLD_PORT@|$(port)|; s|@SLURMD_PORT@|$(port)|" "$source/ci/slurm/slurm.conf.in" >"$folder/slurm.conf"
export SLURM_CONF="$folder/slurm.conf"
mkdir -p "$folder/state" "$folder/spool"
slurmctld -D -i -f "$SLURM_CONF" >"$folder/slurmctld.out" 2>&1 & daemons+=($!)
slurmd -D -N "$host" -f "$SLURM_CONF" >"$folder/slurmd.out" 2>&1 & daemons+=($!)
wait_for "an idle node" 60 sh -c 'sinfo -h -o %t | grep -qx idle'

cat >"$folder/study.yaml" <<'YAML'
study:
  name: array
  halls: {room: {generate: {style: flat, seed: 3, coverage: 0}}}
  seeds: [1, 2, 3]
  run: {detector: truth, poses: truth, depth: truth, frames: 12, set: [simulation.colour=false]}
  vary: {height: {key: sensors.cameras.camera.mount.z_m, values: [1.0, 1.2, 1.5]}}
  coverage: {floor_spacing_m: 0.2, points_per_object: 200, place_spacing_m: 1}
YAML
cd "$folder"
"$program" study study.yaml --out whole --quiet >whole.txt
export WARETWIN="$program"
submit() { sbatch --parsable --cpus-per-task=1 --mem=0 --output="$folder/task-%a.log" "$@" "$source/ci/slurm/waretwin.sbatch" study study.yaml --out array; }
units() { ls array/units 2>/dev/null | grep -c '\.json$' || true; }

job="$(submit --array=0-1 --no-requeue)"
# Coverage of four candidates, then the drives of both tasks; the second task dies in the middle of one. Of three drives that are done
# one at least is its own: the two go at the same pace.
wait_for "three drives" 90 sh -c '[ "$(ls array/units 2>/dev/null | grep -c "\.json$")" -ge 7 ]'
victim="$(pgrep -f -- "--out array --shard 1/2" | head -n 1 || true)"
[[ -n "$victim" ]] || fail "the second task was not there to be killed"
kill -9 "$victim"
done_then="$(units)"
wait_for "the end of the array" 120 sh -c "! squeue -h -j $job 2>/dev/null | grep -q ."
[[ ! -e array/results.json ]] || fail "the results are there although a task was killed"
echo "killed with $done_then units done; the other task left $(units)"

again="$(WARETWIN_SHARDS=2 submit --array=1)"
wait_for "the task that was submitted again" 120 sh -c "! squeue -h -j $again 2>/dev/null | grep -q ."
[[ -e array/results.json ]] || fail "the results are not there: $(cat task-1.log)"
grep -q "were there already" task-1.log || fail "the second try did not take what the first had done"
for name in results.json results.csv runs.csv study.md; do
  cmp "whole/$name" "array/$name" || fail "$name is not that of one process"
done
"$program" study study.yaml --out array --merge --quiet >/dev/null || fail "--merge"
cmp whole/results.json array/results.json || fail "merged results are not those of one process"
[[ "$(ls whole/units | sort)" == "$(ls array/units | sort)" ]] || fail "units were doubled or lost"
echo "the array's results are those of one process, byte for byte; $(units) units"
