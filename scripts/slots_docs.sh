#!/usr/bin/env bash
# Writes docs/reference/slots.md from what the programs declare:  scripts/slots_docs.sh BIN_FOLDER [FILE]
set -euo pipefail
bin=$1
file=${2:-$(cd "$(dirname "$0")/.." && pwd)/docs/reference/slots.md}
{
  echo "# Slots"
  echo
  echo "Made from the declarations in the programs by \`cmake --build build --target slots_docs\`; a test checks that it is"
  echo "current. How values are written: [protocol.md](../protocol.md). Every program explains itself by \`inq Slots\` and"
  echo "\`inq NAME.help\`."
  for program in fsm ssm ssm_stub srm srm_stub vdm face_track hypermask chat vmc agent_manager; do
    echo
    echo "## $program"
    echo
    "$bin/$program" --slots-markdown
  done
} >"$file"
