#!/usr/bin/env bash
# What can be said of the container image without building it. Exit code 77: this is no Debian with package lists.
#   image_test.sh PROGRAM SOURCE_FOLDER
set -euo pipefail
program="$1" source="$2" docker="$2/ci/kubernetes/Dockerfile" job="$2/ci/kubernetes/job.yaml"
fail() { echo "FAILED: $*" >&2; exit 1; }

# Instructions are known ones, the image's user is not root, and what is copied is there.
while read -r word _; do
  case "$word" in
    FROM | WORKDIR | COPY | RUN | ENV | USER | ENTRYPOINT | CMD | '' | '#'*) ;;
    *) fail "Dockerfile: '$word' is no instruction" ;;
  esac
done < <(sed -e ':a' -e '/\\$/N; s/\\\n//; ta' "$docker")
grep -qx 'USER waretwin' "$docker" || fail "Dockerfile: the image runs as root"
[[ -e "$source/ci/install.sh" && -d "$source/scenes" ]] || fail "Dockerfile: copies what is not there"
! grep -E '^(FROM|COPY --from)' "$docker" | grep -q ':latest' || fail "Dockerfile: a base image without a version"

# As many parts as pods.
completions="$(awk '$1 == "completions:" {print $2}' "$job")"
shards="$(awk '/name: SHARDS/ {getline; gsub(/"/, "", $2); print $2}' "$job")"
[[ -n "$completions" && "$completions" == "$shards" ]] || fail "job.yaml: completions $completions, SHARDS $shards"
grep -q 'completionMode: Indexed' "$job" || fail "job.yaml: is not indexed"

command -v dpkg-query >/dev/null && command -v apt-cache >/dev/null && apt-cache show libembree3-3 >/dev/null 2>&1 ||
  { echo "skipped: no Debian package lists here (apt-get update)"; exit 77; }
# Every library that the program loads belongs to a package of the image, or to one that those depend on.
named="$(sed -n '/--no-install-recommends/,/rm -rf/p' "$docker" | grep -oE '\b(lib|zlib)[a-z0-9.+-]+' | sort -u)"
held="$(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances $named libc6 | grep -E '^[a-z0-9]' | sed 's/:.*//' | sort -u)"
loaded="$(ldd "$program" | awk '$3 ~ "^/" {print $3}' | xargs -r readlink -f)"
# The C library and the like are listed under /lib, which is the same folder: every image has them.
packages="$( (dpkg-query -S $loaded 2>/dev/null || true) | cut -d: -f1 | sort -u)"
[[ "$(wc -l <<<"$packages")" -gt 10 ]] || fail "no packages were found for the program's libraries"
missing="$(comm -23 <(echo "$packages") <(echo "$held") | tr '\n' ' ')"
[[ -z "$missing" ]] || fail "Dockerfile: the image lacks $missing"
echo "the image's packages hold all libraries of $(basename "$program")"
