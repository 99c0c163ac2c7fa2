#!/usr/bin/env bash
# The hub's page before axe-core, which looks for what keeps people out: contrast, names, roles, order.
#     scripts/page_access.sh FOLDER [BIN]
# installs axe-core by npm into FOLDER, which must lie outside of the repository, starts an agent of stubs and has Chromium
# show the page: conversation and engineer's view, light and dark, 400, 820 and 1280 pixels wide, English and Japanese.
# Prints what is found, leaves a picture of each view in FOLDER, and ends with 1 if anything was found.
set -euo pipefail
. "$(dirname "$0")/npm_folder.sh"
browser=$(command -v chromium || command -v chromium-headless-shell) || {
  echo "page_access: no chromium here (Debian package chromium-headless-shell or chromium)" >&2
  exit 2
}
npm install --no-fund --no-audit axe-core >/dev/null
echo "axe-core $(node -p 'require("./node_modules/axe-core/package.json").version')"

work=$(mktemp -d)
hub=
finish() {
  [ -z "$hub" ] || kill "$hub" 2>/dev/null || true
  wait || true
  rm -rf "$work"
}
trap finish EXIT
cat >"$work/hub.json" <<END
{"modules": [{"name": "SSM", "command": ["$bin/ssm_stub"]}, {"name": "SRM", "command": ["$bin/srm_stub"]},
 {"name": "FSM", "command": ["$bin/fsm", "--headless", "--size", "320x240"]}, {"name": "CHAT", "command": ["$bin/chat"]}]}
END
"$bin/agent_manager" --config "$work/hub.json" --no-console --web 0 --web-role owner 2>"$work/hub.log" &
hub=$!
for _ in $(seq 200); do
  address=$(grep -o 'http://[^ ]*' "$work/hub.log" | head -n 1) || true
  [ -z "$address" ] || break
  sleep 0.1
done
[ -n "$address" ] || { cat "$work/hub.log" >&2; exit 1; }

found=0
# The face moves in the picture; what axe would say of it is said by the page's own description.
judge='axe.run().then(r => r.violations.map(v => `${v.impact} ${v.id}: ${v.help}\n` +
  v.nodes.slice(0, 5).map(n => `    ${n.target} ${(n.failureSummary || "").split("\n").slice(1).join(" ")}\n`).join("")).join(""))'
for language in en ja; do
  steps=("wait:document.querySelector('#link.on')" "script:node_modules/axe-core/axe.min.js")
  for scheme in light dark; do
    for width in 400 820 1280; do
      steps+=("scheme:$scheme" "size:${width}x1000")
      for tab in talk engineer; do
        steps+=("do:document.querySelector('#$tab-tab').click()"
          "do:new Promise(done => setTimeout(done, 300))"
          "print:'== $language $scheme $width $tab'" "print:$judge" "picture:$language-$scheme-$width-$tab.png")
      done
    done
  done
  python3 "$root/tests/support/browse.py" "$browser" "$work/profile-$language" "$address" "--lang=$language" \
    "--accept-lang=$language" "${steps[@]}" | tee "$work/said"
  ! grep -qv -e '^==' -e '^$' "$work/said" || found=1
done
exit "$found"
