#!/usr/bin/env bash
# Formatting and static analysis: clang-format on all sources, clang-tidy on those that changed since BASE (default: all of them).
#   ci/lint.sh [BASE]
set -euo pipefail
cd "$(dirname "$0")/.."
ci/install.sh --tools
[[ -f build/release/compile_commands.json ]] || cmake --preset release >/dev/null
mapfile -t sources < <(git ls-files '*.h' '*.cpp')
clang-format --dry-run --Werror "${sources[@]}"
if (($# > 0)); then
  mapfile -t units < <(git diff --name-only --diff-filter=d "$1" -- '*.cpp')
else
  mapfile -t units < <(git ls-files '*.cpp')
fi
((${#units[@]} == 0)) || printf '%s\n' "${units[@]}" | grep -v '^tests/fuzz/' | xargs -P 2 -n 4 clang-tidy --quiet -p build/release
