#!/usr/bin/env bash
# Sets up and builds if needed, and runs an agent with voice and face. Installed as galatea-agent it runs the programs
# beside it.
set -Eeuo pipefail
# No step ends it without a word. What fails in a subshell is told by the command that waits for it.
trap '[ "$BASH_SUBSHELL" -gt 0 ] || echo "run_agent: ended in line $LINENO by the failure of: $(head -n 1 <<<"$BASH_COMMAND")" >&2' ERR

usage() {
  cat <<'TEXT'
usage: scripts/run_agent.sh [options]     (installed: galatea-agent [options])

  --say TEXT         speak TEXT and end: in a window where there is a display, else into agent.mp4
  --emotion TYPE     look HAPPY, ANGRY, DISGUSTED, SAD, SURPRISED, FEARED or NEUTRAL while speaking;
                     a strength in % may follow: --emotion "HAPPY 60"
  --chat             talk with the agent, typed at the terminal: it answers by rules, offline (docs/chat.md).
                     With --out a film is made of it, with the user's part from --script FILE, a line a turn
  --web [PORT]       talk with the agent in a browser, with its voice there: opens the page, and prints its address
                     (docs/configuration.md, The page). With --dialog the dialogue is held there, from when the page is open.
                     Port 8080 without one
  --model-url URL    with --chat, --web, or a dialogue that hands over to conversation: a language model answers, asked
                     at URL (any OpenAI-compatible endpoint)
  --model NAME       its name there
  --key-file FILE    its key: the first line of a file only you can read
  --gateway [PORT]   beside the conversation or dialogue, serve the agent's voice and mouth to other programs: POST
                     /v1/audio/speech as OpenAI's API has it, lips over a WebSocket (docs/gateway.md). Port 8090 without one
  --dialog DOC.vxml  run a VoiceXML dialogue (docs/dialogs.md); what you type is what you say
  --script FILE      with --dialog or --chat: take the user's part from FILE instead of the keyboard; by default
                     DOC.txt beside DOC.vxml where a film is made
  --voice FILE.wav   the face speaks with the voice in FILE, without being told the text, and its head
                     moves with it (docs/vdm.md):
                     a film, agent.mp4 without --out
  --voice mic        it speaks with the microphone, until end of input (^D)
  --out FILE.mp4     make a film with sound instead of opening a window; FILE.mov (ProRes) and FILE.webm (VP9) are
                     transparent beside the agent, FILE.mkv (FFV1) loses nothing
  --subtitles        with --dialog or --chat, and --out: show what both say in the film; FILE.srt and FILE.vtt
                     lie beside it in any case
  --photo PHOTO      wear the face of the person in PHOTO (docs/photo.md)
  --keep-face NAME   with --photo: keep that face as NAME, for --mask NAME later
  --mask NAME        wear the face NAME: a built-in one, or one that was kept
  --size WxH         size of the window, the film or the picture in the browser (640x480)
  --speaker NAME     the voice that speaks (docs/speech.md; a wrong name lists them)
  --language CODE    the language of what is said: en, ja, de, fr, ... By default that of the text of --say as its words
                     tell it (scripts/text_languages.txt), and Japanese wherever the text is
  --stub             use the voice without sound and engine (ssm_stub)
  --config FILE      a configuration of the hub (docs/configuration.md) instead of examples/agents/
  --version          which version of the toolkit this is
  --help             this text

Without --say, --dialog, --voice and --out it is --chat.
TEXT
}

root=$(cd "$(dirname "$0")/.." && pwd)
if [ -d "$root/share/galatea/examples" ]; then
  installed=1 bin=$root/bin data=$root/share/galatea
else
  installed="" bin=$root/build/bin data=$root
fi
photo="" say="" says="" emotion="" out="" config="" voice=ssm dialog="" script="" subtitles="" heard="" chat="" web="" model_url="" model="" key_file=""
gateway="" mask="" keep_face="" size="" speaker="" language=""
started_in=$PWD
fail() {
  echo "run_agent: $1" >&2
  exit 2
}
version() {
  if [ -n "$installed" ]; then
    "$bin/agent_manager" --version | sed 's/^agent_manager/galatea-agent/'
  else
    sed -n 's/^project(galatea VERSION \([0-9.]*\).*/run_agent (Galatea) \1/p' "$root/CMakeLists.txt"
  fi
}
absolute() { case $1 in /*) echo "$1" ;; *) echo "$PWD/$1" ;; esac; }
while [ $# -gt 0 ]; do
  case $1 in
    --photo | --say | --emotion | --out | --config | --dialog | --script | --voice | --model-url | --model | --key-file | \
      --mask | --keep-face | --size | --speaker | --language)
      [ $# -ge 2 ] || fail "$1 needs a value"
      case $1 in
        --photo) photo=$(absolute "$2") ;;
        --say) say=$2 says=1 ;;
        --emotion) emotion=$2 ;;
        --out) out=$(absolute "$2") ;;
        --config) config=$(absolute "$2") ;;
        --dialog) dialog=$(absolute "$2") ;;
        --script) script=$(absolute "$2") ;;
        --model-url) model_url=$2 ;;
        --model) model=$2 ;;
        --mask) mask=$2 ;;
        --keep-face) keep_face=$2 ;;
        --size) size=$2 ;;
        --speaker) speaker=$2 ;;
        --language) language=$2 ;;
        --key-file) key_file=$(absolute "$2") ;;
        --voice) heard=$2; [ "$2" = mic ] || heard=$(absolute "$2") ;;
      esac
      shift 2
      ;;
    --chat) chat=1; shift ;;
    --web)
      web=8080
      if [[ ${2:-} =~ ^[0-9]+$ ]]; then web=$2; shift; fi
      shift
      ;;
    --gateway)
      gateway=8090
      if [[ ${2:-} =~ ^[0-9]+$ ]]; then gateway=$2; shift; fi
      shift
      ;;
    --stub) voice=ssm_stub; shift ;;
    --subtitles) subtitles=1; shift ;;
    --help | -h) usage; exit 0 ;;
    --version) version; exit 0 ;;
    *) fail "unknown option '$1'; --help lists them" ;;
  esac
done
case $say in *$'\n'*) say=${say//$'\n'/ } ;; esac
[ -z "$says" ] || [[ $say =~ [^[:space:]] ]] || fail "--say: the text is empty"
case $out in "" | *.mp4 | *.mov | *.webm | *.mkv) ;; *) fail "--out '$out': expected a name that ends in .mp4, .mov, .webm or .mkv" ;; esac
case $subtitles$out in 1*.mov | 1*.webm | 1*.mkv) fail "--subtitles are put into .mp4 only; FILE.srt lies beside the film" ;; esac
[ -z "$out" ] || [ -d "$(dirname "$out")" ] || fail "--out: there is no folder '$(dirname "$out")'"
[ -z "$out" ] || [ -w "$(dirname "$out")" ] || fail "--out: the folder '$(dirname "$out")' cannot be written to"
[ -z "$out" ] || [ ! -e "$out" ] || [ -f "$out" ] || fail "--out: '$out' is a folder or a device; expected the name of a file"
[ -z "$out" ] || [ ! -e "$out" ] || [ -w "$out" ] || fail "--out: '$out' cannot be written to"
[ -z "$photo" ] || [ -r "$photo" ] || fail "--photo: cannot read '$photo'"
[ -z "$config" ] || [ -z "$photo$mask$size$speaker$language" ] ||
  fail "--config excludes --photo, --mask, --size, --speaker and --language: put them into the configuration"
[ -z "$photo" ] || [ -z "$mask" ] || fail "--photo and --mask exclude each other"
[ -z "$keep_face" ] || [ -n "$photo" ] || fail "--keep-face needs --photo"
for name in "$mask" "$keep_face" "$speaker"; do
  [[ $name =~ ^[A-Za-z0-9_.-]*$ ]] || fail "'$name': expected a name of letters, digits, - and _"
done
[[ -z $size || $size =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || fail "--size '$size': expected WIDTHxHEIGHT, such as 640x480"
for side in ${size/x/ }; do  # kMaxImageSide of fsm
  [ ${#side} -le 4 ] && [ "$side" -ge 16 ] && [ "$side" -le 8192 ] || fail "--size '$size': the face (fsm) is 16 to 8192 pixels wide and high"
done
[[ $language =~ ^[a-z]*(-[a-z]+)?$ ]] || fail "--language '$language': expected a code, such as en, ja or de"
[ -z "$speaker$language" ] || [ -z "$heard" ] || fail "--speaker and --language are not for --voice, which has its own"
[ -z "$config" ] || [ -r "$config" ] || fail "--config: cannot read '$config'"
{ [ -z "$dialog" ] || [ -r "$dialog" ]; } && [ ! -d "$dialog" ] || fail "--dialog: cannot read '$dialog'"
# Whether it is correct is found by task_manager, which tells the place; a picture or a film needs no hub for its no.
[ -z "$dialog" ] || tr -d '\000' <"$dialog" | LC_ALL=C grep -aE '<([A-Za-z_][A-Za-z0-9_.-]*:)?vxml([[:space:]/>]|$)' >/dev/null ||
  fail "--dialog: '$dialog' is no VoiceXML document: it has no element <vxml>"
[ -z "$script" ] || [ -r "$script" ] || fail "--script: cannot read '$script'"
[ -z "$dialog" ] || [ -z "$say" ] || fail "--dialog and --say exclude each other"
[ -n "$say$dialog$heard$out" ] || chat=1
[ -z "$chat" ] || [ -z "$say$dialog$heard" ] || fail "--chat excludes --say, --dialog and --voice"
# A dialogue that lends its user to the module that converses.
lends=""
[ -z "$dialog" ] || ! grep -q 'builtin:chat' "$dialog" || lends=1
[ -z "$model_url" ] || [ -n "$chat$lends" ] || fail "--model-url needs --chat, or a dialogue with <object classid=\"builtin:chat\">"
[ -z "$web" ] || ! [[ $model_url =~ ^http://(127\.0\.0\.1|localhost):$web(/|$) ]] ||
  fail "--model-url $model_url: this agent's own page is at that port; --web PORT takes another"
[ -z "$model_url" ] || [ -z "$config" ] || fail "--model-url and --config exclude each other: put it into the configuration"
[ -z "$model$key_file" ] || [ -n "$model_url" ] || fail "--model and --key-file need --model-url"
[ -z "$model_url" ] || [ -n "$model" ] || fail "--model-url needs --model"
[ -z "$script" ] || [ -n "$dialog$chat" ] || fail "--script needs --dialog or --chat"
[ -z "$chat" ] || [ -n "$script" ] || [ -z "$out" ] || fail "--out with --chat needs the user's part: --script FILE"
[ -z "$web" ] || [ -z "$say$heard$out$script" ] || fail "--web excludes --say, --voice, --out and --script"
[ -z "$gateway" ] || [ -z "$say$heard$out" ] || fail "--gateway excludes --say, --voice and --out"
[ -z "$gateway" ] || [ "$gateway" -le 65535 ] || fail "--gateway '$gateway': expected a port, up to 65535"
[ -z "$web" ] || [ "$web" -le 65535 ] || fail "--web '$web': expected a port, up to 65535"
if [ -n "$subtitles" ] && { [ -z "$dialog$chat" ] || [ -z "$out" ]; }; then fail "--subtitles needs --dialog or --chat, and --out"; fi
[ -z "$heard" ] || [ -z "$say$dialog" ] || fail "--voice excludes --say and --dialog"
[ -z "$heard" ] || [ "$heard" = mic ] || [ -r "$heard" ] || fail "--voice: cannot read '$heard'"
[ "$heard" != mic ] || [ -z "$out" ] || fail "--voice mic lives in a window; --out needs --voice FILE.wav"
if [ -n "$heard" ] && [ "$heard" != mic ] && [ -z "$out" ]; then out=$started_in/agent.mp4; fi
if [ -n "$dialog" ] && [ -n "$out" ] && [ -z "$script" ]; then
  script=${dialog%.*}.txt
  [ -r "$script" ] || fail "--out with --dialog needs the user's part: --script FILE (there is no '$script')"
fi
emotion=${emotion^^}
case ${emotion%% *} in
  "" | HAPPY | ANGRY | DISGUSTED | SAD | SURPRISED | FEARED | NEUTRAL) ;;
  *) fail "--emotion '$emotion': expected HAPPY, ANGRY, DISGUSTED, SAD, SURPRISED, FEARED or NEUTRAL" ;;
esac
if [[ $emotion == *" "* ]] && { ! [[ ${emotion#* } =~ ^[0-9]{1,3}$ ]] || [ "${emotion#* }" -gt 100 ]; }; then
  fail "--emotion '$emotion': the strength is a number from 0 to 100"
fi

# The programs that this start needs.
needed() {
  local names=$data/examples/agents/agent.json left_out=""
  [ -z "$chat" ] || names=$data/examples/agents/chat.json
  [ -z "$heard" ] || names=$data/examples/agents/voice.json
  # In a browser the ear is the one that takes sound.
  [ -z "$web" ] || left_out=srm_stub
  [ -z "$config" ] || { names=$config left_out=""; }
  echo agent_manager ssm_espeak
  grep -o 'build/bin/[a-z_]*' "$names" | cut -d/ -f3 | grep -vx "$left_out" || true
  [ "$voice" = ssm ] || echo "$voice"
  [ -z "$web" ] || echo srm
  [ -z "$dialog" ] || echo task_manager
  [ -z "$lends" ] || echo chat
  [ -z "$gateway" ] || echo gateway
  [ -z "$photo" ] || echo face_fit
}

# Builds what is named WHAT and consists of TARGETS. The first time that takes minutes, so it tells how far it is: at a
# terminal in one line that changes, else in a line every half minute.
build() { # WHAT TARGETS [cmake options...]
  local log line done total seconds left shown=-30 lines="\n"
  log=$(mktemp)
  while IFS= read -r line; do
    echo "$line" >>"$log"
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\ +([0-9]+)[0-9.]*\]\ (.*)$ ]] || continue
    done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]} seconds=${BASH_REMATCH[3]} line=${BASH_REMATCH[4]##* }
    [ "$done" -gt 0 ] || continue
    [ ! -t 2 ] && [ $((seconds - shown)) -lt 30 ] && continue
    shown=$seconds
    left=""
    # The first steps are slow ones, from which more would be promised than comes.
    [ "$seconds" -lt 10 ] || [ $((4 * done)) -lt "$total" ] || left=", about $((seconds * (total - done) / done / 60 + 1)) min left"
    [ ! -t 2 ] || lines="\r\033[K"
    printf "run_agent: building $1, %d of %d: %s%s$lines" "$done" "$total" "${line%%/CMakeFiles/*}" "$left" >&2
  done < <(NINJA_STATUS='[%f/%t %e] ' "$root/scripts/build.sh" --only "$2" "$root/build" "${@:3}" </dev/null 2>&1 || echo "build.sh: failed")
  [ ! -t 2 ] || [ "$shown" -lt 0 ] || printf '\r\033[K' >&2
  if [ "$(tail -n 1 "$log")" = "build.sh: failed" ]; then
    cat "$log" >&2
    rm -f "$log"
    fail "the build failed"
  fi
  rm -f "$log"
}

# First, since it may lack npm or the net.
[ -z "$photo" ] || "$data/scripts/face_networks.sh" </dev/null || fail "the networks that find faces in photos are not there"

# What is typed meanwhile is for the agent: nothing before it reads it.
if [ -z "$installed" ]; then
  cd "$root"
  first=""
  if [ ! -x "$bin/agent_manager" ]; then
    first=1
    echo "run_agent: the first start installs what is missing and compiles what it needs: 3 to 6 minutes on two cores, once" >&2
    "$root/scripts/setup.sh" --hub </dev/null
    # The rest is installed while the compiler works on the hub and the conversation.
    setup_log=$(mktemp)
    "$root/scripts/setup.sh" </dev/null >"$setup_log" 2>&1 &
    setup=$!
    trap 'wait "$setup" || true; rm -f "$setup_log"' EXIT  # a package is not left half installed
    build "the hub" "agent_manager chat" "-DGALATEA_PARTS=vm_protocol;agent_manager;chat"
    wait "$setup" || { cat "$setup_log" >&2; fail "what building the rest and running need could not be installed"; }
    rm -f "$setup_log"
    trap - EXIT
  else
    "$root/scripts/setup.sh" </dev/null
  fi
  build "what this start needs" "$(needed | tr '\n' ' ')"
  [ -z "$first" ] || [ -x "$bin/face_track" ] ||
    echo "run_agent: built what this needs; scripts/build.sh --programs builds the other programs" >&2
fi

# A display counts only if a window can really be opened on it.
has_display() { [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && "$bin/fsm" --window --slots-markdown </dev/null >/dev/null 2>&1; }
if [ -n "$out" ]; then
  film=1
elif has_display; then
  film=""
elif [ -n "$say" ]; then
  film=1
  out="$started_in/agent.mp4"
else
  film=""
fi

work=$(mktemp -d)
hub="" gateway_program="" dialog_program=""
cleanup() {
  for program in $hub $gateway_program $dialog_program; do
    kill "$program" 2>/dev/null || true
    wait "$program" 2>/dev/null || true
  done
  rm -rf "$work"
}
trap cleanup EXIT

# Beside the agent such films show nothing.
clear_background() { case $out in *.mov | *.webm) echo "to @FSM set Background = transparent" ;; esac; }

# Runs the hub on a script until the film is there, and tells a terminal meanwhile how long it has taken.
draw() {
  local began=$SECONDS
  "$hub_program" --config "$config" --log "$work/log" <"$work/script" >"$work/said" &
  hub=$!
  while kill -0 "$hub" 2>/dev/null; do
    [ ! -t 2 ] || printf '\r\033[Krun_agent: drawing, %d s (a second of the film takes about one)' $((SECONDS - began)) >&2
    sleep 0.2
  done
  [ ! -t 2 ] || printf '\r\033[K' >&2
  local failed=0
  wait "$hub" || failed=1
  hub=""
  [ "$failed" = 0 ] || { cat "$work/said" >&2; fail "the hub ended with an error"; }
}

# Puts FILM.srt into the film.
show_subtitles() {
  mv "$out" "$work/film.mp4"
  cp "${out%.mp4}.srt" "$work/film.srt"
  (cd "$work" && ffmpeg -v error -y -i film.mp4 -vf "subtitles=film.srt:force_style='Fontsize=16,MarginV=12'" \
    -c:v libx264 -crf 16 -pix_fmt yuv420p -c:a copy -movflags +faststart "$out") </dev/null || fail "the subtitles could not be put into the film"
}

# What a module says to a question, without its quotes.
asks() { # QUESTION PROGRAM...
  echo "inq $1" | "${@:2}" 2>/dev/null | sed -n "s/^rep $1 = //p" | tr -d '"' | tail -n 1
}

if [ -n "$photo" ]; then
  [ -n "$keep_face" ] || export GALATEA_FACES=$work/faces
  mask=${keep_face:-photo}
  "$bin/face_fit" "$photo" --name "$mask" </dev/null | sed '/^face_fit: wrote /d' >&2 || fail "no face could be made from the photo"
  [ -z "$keep_face" ] || echo "run_agent: kept as --mask $keep_face" >&2
elif [ -n "$mask" ]; then
  masks=$(asks MaskSet "$bin/fsm" --headless)
  [[ ,$masks, == *,"$mask",* ]] || fail "--mask '$mask': there is no such face; there are ${masks//,/ }"
fi
if [ "$heard" = mic ] && [ -z "$config" ]; then
  error=$(echo "set Input = portaudio" | timeout 30 "$bin/vdm" --clock real 2>&1 >/dev/null | sed -n 's/^vdm: error: [A-Z_]* \(.*\) (in: .*/\1/p') || true
  [ -z "$error" ] || fail "--voice mic: $error"
fi
if [ -n "$say" ] && [ -z "$language$speaker" ]; then
  language=$(python3 - "$data/scripts/text_languages.txt" "$say" <<'PYTHON'
import re, sys
words = re.findall(r"[^\W\d_]+", sys.argv[2].lower())
hits = {}
for code, *known in (line.split() for line in open(sys.argv[1], encoding="utf-8") if not line.startswith("#")):
    hits[code] = [word for word in words if word in known]
best = max(hits, key=lambda code: len(hits[code]))  # the first of equals
count = len(hits[best])
# English unless another language has more of the words, some share of them, and more than one short word.
if count > len(hits["en"]) and count * 4 >= len(words) and (count > 1 or len(hits[best][0]) > 3):
    print(best)
PYTHON
  )
  [ -z "$language" ] || echo "run_agent: the text looks like '$language'; --language en reads it as English" >&2
fi
# The men among the built-in people have a man's voice; Japanese finds its own.
case $mask in pygmalion | memnon) case $language in "" | en | ja) [ -n "$heard" ] || speaker=${speaker:-rms} ;; esac ;; esac
if [ -n "$language$speaker" ] && [ "$voice" = ssm ] && [ -z "$config" ]; then
  speakers=$(asks Speaker.all "$bin/ssm" --sink null)
  # English and Japanese texts find their voices themselves.
  case $language in "" | en | ja) ;; *) speaker=${speaker:-espeak-$language} ;; esac
  if [ -n "$speaker" ] && [[ " $speakers " != *" $speaker "* ]]; then
    fail "there is no voice '$speaker'; there are $speakers"
  fi
fi
if [ -z "$config" ]; then
  config=$work/agent.json
  source=$data/examples/agents/agent.json
  [ -z "$film" ] || source=$data/examples/agents/film.json
  [ -z "$chat" ] || source=$data/examples/agents/chat.json
  [ -z "$heard" ] || source=$data/examples/agents/voice.json
  [ -z "$heard" ] || [ -z "$film" ] || source=$data/examples/agents/voice_film.json
  sed -e "s#\"../macros/#\"$data/examples/macros/#" -e 's#\["build/bin/#["#' "$source" >"$config"
  if [ -n "$chat" ] && [ -n "$film" ]; then
    sed -i -e '0,/{/s#{#{"clock": "virtual",#' -e 's#"--sink", "auto"#"--sink", "null"#' -e 's#\["fsm"#["fsm", "--headless"#' "$config"
  fi
  # In a browser the face needs no window, and the voice would sound twice.
  if [ -n "$web" ]; then
    sed -i -e 's#"--sink", "auto"#"--sink", "null"#' -e 's#\["fsm"#["fsm", "--headless"#' "$config"
    # The ear that takes sound, where it has a model.
    if echo "set Listen = START" | timeout 30 "$bin/srm" --strict >/dev/null 2>&1; then
      sed -i -e 's#\["srm_stub"#["srm", "--live"#' "$config"
    elif [ -z "$installed" ]; then
      "$root/scripts/build.sh" --only srm_stub </dev/null >&2 || fail "the build failed"
    fi
  fi
  if [ -n "$lends" ]; then
    sed -i -e 's#{"name": "FSM"#{"name": "CHAT", "command": ["chat", "--no-listen"], "after": ["SSM", "SRM"]},\n    &#' "$config"
  fi
  if [ -n "$model_url" ]; then
    python3 -c 'import json, sys; json.dump(dict(zip(sys.argv[1::2], sys.argv[2::2])), sys.stdout)' \
      url "$model_url" model "$model" ${key_file:+key_file "$key_file"} >"$work/chat.json"
    sed -i -e "s#\[\"chat\"#&, \"--config\", \"$work/chat.json\"#" "$config"
  fi
  if [ "$voice" = ssm_stub ]; then
    sed -i -e 's#\["ssm"[^]]*\]#["ssm_stub"]#' "$config"
  fi
  if [ -z "$film$web" ] && ! has_display; then
    sed -i -e 's#\["fsm"#["fsm", "--headless"#' "$config"
  fi
  add() { # PROGRAM OPTION VALUE, unless VALUE is empty
    [ -z "$3" ] || sed -i -e "s#\[\"$1\"#&, \"$2\", \"$3\"#" "$config"
  }
  add fsm --mask "$mask"
  add fsm --size "$size"
  add ssm --speaker "$speaker"
  sed -i -e "s#\(\"command\": \[\"\)#\1$bin/#" "$config"
fi
hub_program=$bin/agent_manager

if [ "$heard" = mic ]; then
  # The console stays open, for what is typed and until its end.
  {
    echo "to @VDM set Head.auto = ON"
    echo "to @VDM set Input = portaudio"
    echo "to @VDM set Run = START"
    cat
  } | "$hub_program" --config "$config"
  exit
fi
if [ -n "$heard" ]; then
  # The face shows a sound Delay after it was heard, which begins 300 ms into the film: 160 ms, with which the head is in
  # time with the mouth. Lips that are 40 ms ahead of the sound look natural, as with a text.
  ffmpeg -loglevel error -y -i "$heard" -af "adelay=500:all=1" "$work/sound.wav" </dev/null || fail "--voice: '$heard' is no sound ffmpeg reads"
  {
    clear_background
    echo "to @VDM set Head.auto = ON"
    echo "to @VDM set Delay = 160"
    echo "to @VDM set#input Input = wav:$heard"
    [ -z "$emotion" ] || echo "to @FSM set FaceExp = ${emotion%% *} 1 $([[ $emotion == *" "* ]] && echo "${emotion#* }" || echo 100) 0"
    echo "to @FSM set#film Record = $out"
    echo "set Wait = 300"
    echo "to @VDM set#said Run = START"
    echo "set Wait = IDLE"
    echo "set Wait = 300"
    echo "to @FSM set Record.sound = $work/sound.wav"
    echo "to @FSM set#film Record = STOP"
    echo "set Wait = IDLE"
  } >"$work/script"
  draw
  if error=$(grep -m 1 -E 'rep#(input|said|film) [A-Za-z.]+\.error' "$work/said"); then
    fail "${error#*error = }"
  fi
  echo "run_agent: wrote $out"
  exit 0
fi
if [ -z "$say$dialog$chat" ] && [ -n "$film" ]; then
  say="Hello, my name is Galatea."
fi
if [ -n "$say" ]; then
  # One script for both ways: the film is made on the virtual clock, the window lives on the real one.
  {
    clear_background
    [ -z "$film" ] || echo "to @AM-MCL set#film Record = $out"
    echo "to @FSM set FaceExp.onset = NATURAL"
    [ -z "$film" ] && echo "set Wait = 600" || echo "set Wait = 300"
    [ -z "$emotion" ] || echo "to @AM-MCL set Emotion = $emotion"
    [ -z "$emotion" ] || echo "set Wait = 300"
    echo "to @AM-MCL set#said Speak = $say"
    echo "set Wait = IDLE"
    echo "set Wait = 700"
    [ -z "$film" ] || echo "to @AM-MCL set#film Record = STOP"
    echo "set Wait = IDLE"
  } >"$work/script"
  if [ -n "$film" ]; then
    draw
  else
    "$hub_program" --config "$config" <"$work/script" >"$work/said" || { cat "$work/said" >&2; fail "the hub ended with an error"; }
  fi
  if error=$(grep -m 1 -E 'rep#(said|film) [A-Za-z.]+\.error' "$work/said"); then
    fail "${error#*error = }"
  fi
  [ -z "$film" ] || echo "run_agent: wrote $out"
  exit 0
fi

if [ -n "$chat" ] && [ -n "$film" ]; then
  # A film of a conversation: on the virtual clock, each line of the user's when the one before has been answered.
  {
    clear_background
    echo "to @AM-MCL set#film Record = $out"
    echo "to @FSM set FaceExp.onset = NATURAL"
    echo "to @SRM set Input.wordtime = 250"
    echo "set Wait = 500"
    while IFS= read -r line || [ -n "$line" ]; do
      case $line in "" | "#"*) continue ;; esac
      echo "to @SRM set#heard Input.text = $line"
      echo "set Wait = IDLE"
      echo "set Wait = 500"
    done <"$script"
    echo "to @AM-MCL set#film Record = STOP"
    echo "set Wait = IDLE"
  } >"$work/script"
  draw
  if error=$(grep -m 1 -E 'rep#(heard|film) [A-Za-z.]+\.error' "$work/said"); then
    fail "${error#*error = }"
  fi
  sed -n -e 's/^From @CHAT rep Heard = /You: /p' -e 's/^From @CHAT rep Reply.sentence = /Galatea: /p' "$work/said"
  python3 "$data/scripts/subtitles.py" "$work/log" "$out"
  [ -z "$subtitles" ] || show_subtitles
  echo "run_agent: wrote $out"
  exit 0
fi

# A conversation or a dialogue: the hub in the background, what the user types at as one of its clients.
{
  clear_background
  echo "to @FSM set FaceExp.onset = NATURAL"
  [ -z "$chat" ] || [ -z "$language" ] || echo "to @CHAT set Language = $language"
} >"$work/first"
"$hub_program" --config "$config" --listen "unix:$work/hub" --listen-role owner --no-console --do "$work/first" ${web:+--web "$web" --web-role owner} 2>"$work/hub.log" &
hub=$!
# Waits until a command succeeds: as long as PROGRAM (a process) lives, 30 s at most.
await() { # PROGRAM COMMAND...
  for _ in $(seq 600); do
    "${@:2}" && return 0
    kill -0 "$1" 2>/dev/null || break
    sleep 0.05
  done
  "${@:2}"
}
if ! await "$hub" test -S "$work/hub"; then
  grep -q "Address already in use" "$work/hub.log" && fail "port $web is taken, perhaps by another agent; --web PORT takes another"
  cat "$work/hub.log" >&2
  fail "the hub did not start"
fi
if [ -n "$gateway" ]; then
  # A voice of its own, so that what other programs have it say is not heard here.
  "$bin/gateway" --at "tcp:127.0.0.1:$gateway" \
    ${mask:+--mask "$mask"} --voice "$bin/$voice" --sink null --clock virtual ${speaker:+--speaker "$speaker"} >"$work/gateway" &
  gateway_program=$!
  await "$gateway_program" test -s "$work/gateway" || fail "the gateway did not start"
  address=$(cat "$work/gateway")
  echo "run_agent: lips at $address"
  address=${address/#ws:/http:}
  echo "run_agent: speech at ${address/v1\/mouth/v1/audio/speech}"
fi
if [ -n "$web" ]; then
  # The hub says it after its socket is there.
  await "$hub" grep -q 'http://[^ ]* *$' "$work/hub.log" || { cat "$work/hub.log" >&2; fail "the hub has not told the address of its page"; }
  address=$(grep -o -m 1 'http://[^ ]*' "$work/hub.log")
  echo "run_agent: talk with it at $address"
  if [ -n "$dialog" ]; then
    # As often as the page asks for it, first when it is opened.
    "$data/scripts/web_dialog.py" --connect "unix:$work/hub" --name DIALOG -- \
      "$bin/task_manager" "$dialog" --connect "unix:$work/hub" <&0 &
    dialog_program=$!
    echo "run_agent: the dialogue begins when the page is open"
  fi
  echo "run_agent: ^C ends it"
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open >/dev/null; then
    xdg-open "$address" >/dev/null 2>&1 </dev/null || true
  fi
  wait "$hub" || { cat "$work/hub.log" >&2; exit 1; }
  exit 0
fi
[ -n "$out" ] || has_display || echo "run_agent: no display, so no window; --out FILE.mp4 makes films" >&2
if [ -n "$dialog" ]; then
  options=()
  [ -z "$script" ] || options+=(--script "$script" --transcript text)
  [ -z "$out" ] || options+=(--out "$out")
  "$bin/task_manager" "$dialog" --connect "unix:$work/hub" "${options[@]}" || {
    ended=$?
    # 2: the document could not be loaded, which it has said.
    [ "$ended" = 2 ] || cat "$work/hub.log" >&2
    exit "$ended"
  }
  [ -z "$subtitles" ] || show_subtitles
  [ -z "$out" ] || echo "run_agent: wrote $out"
  exit 0
fi
python3 "$data/examples/typed_chat.py" "$work/hub" || { cat "$work/hub.log" >&2; exit 1; }
