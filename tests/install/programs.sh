#!/usr/bin/env bash
# programs.sh BUILD_FOLDER: what is installed is whole: every program starts and has a manual page, the voice finds its
# helper, and galatea-agent makes a film from the installed files alone.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$1" --component programs --prefix "$work/prefix" >/dev/null
bin=$work/prefix/bin
cd "$work"
for program in "$bin"/*; do
  name=${program##*/}
  # The helper of the voice has no options; ssm says below whether it works.
  [ "$name" = ssm_espeak ] || "$program" --help >/dev/null || { echo "$name --help fails"; exit 1; }
  case $name in
    ssm_espeak) ;;
    *) "$program" --version 2>/dev/null | grep -q "^$name (Galatea) " || { echo "$name --version fails"; exit 1; } ;;
  esac
  [ "$name" = ssm_espeak ] || [ -s "$work/prefix/share/man/man1/$name.1" ] || { echo "$name has no manual page"; exit 1; }
done
[ -s "$work/prefix/share/doc/galatea/docs/protocol.md" ] || { echo "the documents are missing"; exit 1; }
if [ -x "$bin/ssm_espeak" ]; then
  printf 'set Text = こんにちは\ninq Text.pho\n' | "$bin/ssm" --sink null | grep -q 'ch\[[0-9]*\] i\[' ||
    { echo "no Japanese"; exit 1; }
fi
"$bin/galatea-agent" --say 'Guten Tag, wie geht es?' --size 160x120 --mask pygmalion --out "$work/film.mp4" 2>"$work/said" ||
  { cat "$work/said"; exit 1; }
[ ! -x "$bin/ssm_espeak" ] || grep -q "looks like 'de'" "$work/said" || { cat "$work/said"; exit 1; }
[ -s "$work/film.mp4" ] || { echo "no film"; exit 1; }
! "$bin/galatea-agent" --say hi --mask nobody --out "$work/none.mp4" 2>"$work/said"
grep -q "there is no such face; there are galatea" "$work/said" || { cat "$work/said"; exit 1; }
