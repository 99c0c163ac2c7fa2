# For scripts that try our doors by packages of npm, which are never installed into the repository. To be sourced with the
# script's own words, FOLDER [BIN]: sets root, folder and bin, makes FOLDER and enters it. Without words the script's head is
# printed, which explains it.
if [ $# -lt 1 ]; then
  sed -n '2,/^set /{/^#/s/^# \?//p}' "$0"
  exit 2
fi
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
bin=$(cd "${2:-$root/build/bin}" && pwd)
case "$folder/" in "$root"/*)
  echo "$(basename "$0" .sh): '$1' lies in the repository; expected a folder outside of it" >&2
  exit 2
  ;;
esac
cd "$folder"
[ -f package.json ] || echo '{"private": true}' >package.json
