#!/usr/bin/env bash
# Installs what a build needs on Debian 12. Does nothing, quickly, where all is there. Needs root or sudo.
#   ci/install.sh             what the build and the tests need
#   ci/install.sh --tools     also clang-format and clang-tidy
#   ci/install.sh --peers     also what benchmarks are compared with (Open3D)
#   ci/install.sh --cluster   also Slurm, for the test that runs a job array
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libembree-dev libtinygltf-dev libeigen3-dev libopencv-dev libpcl-dev libbullet-dev
  libtbb-dev libyaml-cpp-dev nlohmann-json3-dev libcli11-dev libspdlog-dev librandom123-dev
  libgtest-dev libbenchmark-dev zlib1g-dev libssl-dev libtinyxml2-dev
  liboctomap-dev  # optional: without it no octomap.bt is written
  # optional: without them no ROS bags are read or written; python3-rosbag is for the test that holds ours against ROS's own reader
  librosbag-storage-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev libtf2-dev python3-rosbag
  libceres-dev    # optional: without it no camera is calibrated
  libtorch-dev    # optional: without it no detector is trained
  darknet         # optional: tests hold trained detectors against it
  chromium        # optional: tests use the report page in it
)
# Optional: without them report.html is a plain page. Node from elsewhere will do, and would not go together with Debian's npm.
command -v node >/dev/null && command -v npm >/dev/null || packages+=(nodejs npm)
for argument in "$@"; do
  case "$argument" in
    --tools) packages+=(clang-format clang-tidy) ;;
    --peers) packages+=(libopen3d-dev) ;;
    --cluster) packages+=(slurmctld slurmd slurm-client) ;;
    *) echo "install.sh: unknown option '$argument'; expected --tools, --peers or --cluster" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null)" == "install ok installed" ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "install.sh: all ${#packages[@]} packages are there"
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || { echo "install.sh: needs root or sudo to install: ${missing[*]}" >&2; exit 2; }
  as_root=(sudo)
fi
echo "install.sh: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
