#!/usr/bin/env bash
# Installs the Debian 12 packages that building and running the toolkit needs, with --tests also those
# that only tests use. Does nothing (and asks for no password) if all of them are there.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config ccache python3
  libboost1.81-dev libcli11-dev nlohmann-json3-dev libfmt-dev libglm-dev
  libssl-dev zlib1g-dev libmosquitto-dev
  libmozjs-102-dev libexpat1-dev libcurl4-openssl-dev libutf8proc-dev
  libeigen3-dev libopencv-imgproc-dev
  libosmesa6-dev libegl-dev libglfw3-dev libimgui-dev fonts-dejavu-core fonts-vlgothic libgl-dev libpng-dev libjpeg-dev ffmpeg
  flite1-dev portaudio19-dev libsndfile1-dev
  libespeak-ng-dev espeak-ng-data open-jtalk open-jtalk-mecab-naist-jdic libmecab-dev mecab-naist-jdic libhtsengine-dev
  libpocketsphinx-dev pocketsphinx-en-us libspeexdsp-dev
  liboscpack-dev
)
# The framework, servers, screens, a browser and recordings for the tests.
[ "${1:-}" != --tests ] || packages+=(
  libgtest-dev openssl mosquitto mosquitto-clients iproute2 xvfb xdotool chromium-headless-shell pocketsphinx-testdata liblo-tools
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "setup: installing ${missing[*]}" >&2
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup: run as root once, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq >&2
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >&2
