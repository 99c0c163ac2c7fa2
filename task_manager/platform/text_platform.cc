#include "task_manager/platform/text_platform.h"

#include <algorithm>
#include <utility>

#include "task_manager/grammar/text.h"

namespace vxml {

Millis DurationOf(const Segment& segment) {
  switch (segment.kind) {
    case Segment::Kind::kText: {
      long long ms = 0;
      for (const char32_t sign : vm::SignsOf(segment.text)) {
        const bool wide = srgs::IsUnspaced(sign);
        ms += wide ? TextPlatform::kMsPerCharacter : TextPlatform::kMsPerLetter;
      }
      return Millis(ms);
    }
    case Segment::Kind::kAudio:
      return Millis(TextPlatform::kMsPerAudio);
    case Segment::Kind::kPause:
      return segment.pause;
    case Segment::Kind::kMark:
    case Segment::Kind::kCommand:
      return Millis(0);
  }
  return Millis(0);
}

Millis DurationOf(const Prompt& prompt) {
  Millis total(0);
  for (const Segment& segment : prompt.segments) total += DurationOf(segment);
  return total;
}

namespace {

Millis Total(const std::vector<Prompt>& prompts) {
  Millis total(0);
  for (const Prompt& prompt : prompts) total += DurationOf(prompt);
  return total;
}

std::vector<std::string> AudioList(const Prompt& prompt) {
  std::vector<std::string> list;
  for (const Segment& segment : prompt.segments) {
    if (segment.kind == Segment::Kind::kAudio) list.push_back(segment.text);
  }
  return list;
}

}  // namespace

TextPlatform::TextPlatform(CommandSource commands, std::function<void(const std::string&)> write)
    : commands_(std::move(commands)), write_(std::move(write)) {}

void TextPlatform::Report(std::string_view type, const JsonLine& fields) {
  JsonLine head;
  head.Number("t", static_cast<double>(now_.count())).Text("type", type).Add(fields);
  write_(head.str());
}

std::optional<Command> TextPlatform::Next() {
  if (pushed_back_) return std::exchange(pushed_back_, std::nullopt);
  auto command = commands_();
  if (!command && !std::exchange(ran_out_, true)) Report("script_end", {});
  return command;
}

const Prompt* TextPlatform::PromptAt(const std::vector<Prompt>& prompts, Millis time) {
  for (const Prompt& prompt : prompts) {
    const Millis length = DurationOf(prompt);
    if (time < length) return &prompt;
    time -= length;
  }
  return nullptr;
}

void TextPlatform::ReportCommand(const std::string& text, Millis wait, bool parallel) {
  JsonLine command;
  command.Text("line", text);
  if (parallel || wait.count() > 0) {
    command.Number("after_ms", static_cast<double>(wait.count()));
  }
  Report("command", command);
}

void TextPlatform::PlayUntil(const std::vector<Prompt>& prompts, Millis until) {
  const Millis start = now_;
  const Millis end = start + until;
  bool silent = false;
  for (const Prompt& prompt : prompts) {
    if (silent || now_ > end) {
      for (const Segment& segment : prompt.segments) {
        if (segment.native) ReportCommand(segment.text, Millis(0), false);
      }
      continue;
    }
    const Millis length = DurationOf(prompt);
    const bool cut = now_ + length > end;
    JsonLine line;
    line.Text("text", prompt.text).Bool("bargein", prompt.bargein);
    line.Number("ms", static_cast<double>(length.count()));
    if (cut) line.Number("heard_ms", static_cast<double>((end - now_).count()));
    if (!prompt.language.empty()) line.Text("lang", prompt.language);
    if (const auto feelings = prompt.Feelings(); !feelings.empty()) {
      line.List("feelings", feelings);
    }
    if (const auto audio = AudioList(prompt); !audio.empty()) line.List("audio", audio);
    line.Text("ssml", prompt.ssml);
    if (!prompt.text.empty() || length.count() > 0) Report("prompt", line);
    const Millis prompt_start = now_;
    Millis parallel(0);
    for (const Segment& segment : prompt.segments) {
      if (silent) {  // the face comes to rest, but no mark is reached
        if (segment.kind == Segment::Kind::kCommand && segment.pause.count() == 0) {
          ReportCommand(segment.text, Millis(0), false);
        }
        continue;
      }
      const Millis after = now_ + DurationOf(segment);
      if (segment.kind == Segment::Kind::kCommand) {
        parallel += segment.pause;
        ReportCommand(segment.text, segment.parallel ? parallel : segment.pause, segment.parallel);
      } else if (segment.kind == Segment::Kind::kMark) {
        mark_ = segment.text;
        mark_at_ = now_;
        JsonLine mark;
        mark.Text("name", segment.text);
        Report("mark", mark);
      }
      silent = after > end;
      now_ = std::min(after, end);
    }
    if (!silent) now_ = prompt_start + length;
  }
}

bool TextPlatform::Play(const std::vector<Prompt>& prompts) {
  PlayUntil(prompts, Total(prompts));
  return true;
}

namespace {

/// What is no input at all (silence, a hang-up) counts as a match.
bool Matches(const Command& command, const Listen& listen) {
  if (command.kind == Command::Kind::kNoMatch) return false;
  if (command.hypotheses.empty()) return true;
  const std::string& text = command.hypotheses.front().text;
  if (command.kind == Command::Kind::kSay) return listen.accepts && listen.accepts(text);
  if (command.kind != Command::Kind::kDtmf || !listen.keys) return true;
  for (std::size_t size = 1; size <= text.size(); ++size) {
    if (listen.keys(text.substr(0, size)).complete) return true;
  }
  return false;
}

}  // namespace

bool TextPlatform::Heard(const std::vector<Prompt>& prompts, const Command& command,
                         const Listen& listen) {
  const char* why = nullptr;
  bool hotword = listen.hotword;
  const bool speech =
      command.kind == Command::Kind::kSay || command.kind == Command::Kind::kNoMatch;
  if (speech && !listen.voice) why = "inputmodes";
  if (command.kind == Command::Kind::kDtmf && !listen.dtmf) why = "inputmodes";
  if (command.at && *command.at < Total(prompts) && command.kind != Command::Kind::kHangup) {
    const Prompt* playing = PromptAt(prompts, *command.at);
    if (playing && !playing->bargein) why = "bargein";
    hotword = playing ? playing->bargein && playing->hotword : hotword;
  }
  // VoiceXML 2.0 section 4.1.5.1: with hotword there is no nomatch, in the timeout period neither.
  if (!why && hotword && !Matches(command, listen)) why = "hotword";
  if (!why) return true;
  JsonLine line;
  line.Text("input", command.hypotheses.empty() ? "" : command.hypotheses.front().text);
  line.Text("why", why);
  Report("ignored", line);
  return false;
}

Input TextPlatform::Collect(const std::vector<Prompt>& prompts, const Listen& listen) {
  if (interactive_ && !prompts.empty()) {  // who types has to see the question first
    Play(prompts);
    return Collect({}, listen);
  }
  const Millis total = Total(prompts);
  std::optional<Command> command = Next();
  while (command && !Heard(prompts, *command, listen)) command = Next();
  if (!interactive_) mark_.clear();
  Input input;
  if (!command) {
    PlayUntil(prompts, total);
    input.kind = Input::Kind::kHangup;
    return input;
  }
  const bool waits = command->kind == Command::Kind::kSilence;
  const Millis at = waits ? total + listen.timeout : command->at.value_or(total + kReaction);
  const Millis start = now_;
  PlayUntil(prompts, std::min(at, total));
  if (!waits && command->at && at > total + listen.timeout) {  // it comes too late for this turn
    pushed_back_ = command;
    pushed_back_->at = at - total - listen.timeout;
    command->kind = Command::Kind::kSilence;
    now_ = start + total + listen.timeout;
  } else {
    now_ = std::max(now_, start + at);
  }
  if (!mark_.empty()) {
    input.mark = mark_;
    input.mark_time = now_ - mark_at_;
  }
  switch (command->kind) {
    case Command::Kind::kSilence:
      input.kind = Input::Kind::kSilence;
      break;
    case Command::Kind::kHangup:
      input.kind = Input::Kind::kHangup;
      break;
    case Command::Kind::kTooLong:
      input.kind = Input::Kind::kTooLong;
      now_ += listen.max_speech;
      break;
    case Command::Kind::kNoMatch:
      input.kind = Input::Kind::kSpeech;
      break;
    case Command::Kind::kDtmf: {
      const Input keys = TakeKeys(*command, listen);
      input.kind = keys.kind;
      input.hypotheses = keys.hypotheses;
      input.termchar = keys.termchar;
      break;
    }
    case Command::Kind::kSay:
    case Command::Kind::kRecord:
    case Command::Kind::kTransfer:
      input.kind = Input::Kind::kSpeech;
      input.hypotheses = command->hypotheses;
      if (!input.hypotheses.empty()) {
        Segment words;
        words.text = input.hypotheses.front().text;
        input.recorded = DurationOf(words);
      }
      break;
  }
  return input;
}

/// Keys one by one (VoiceXML 2.0 appendix D): until nothing can follow, the termchar, or a pause.
Input TextPlatform::TakeKeys(const Command& command, const Listen& listen) {
  Input input;
  input.kind = Input::Kind::kDtmf;
  const std::string all = command.hypotheses.front().text;
  std::string keys;
  std::size_t i = 0;
  bool ended = false;
  for (; i < all.size() && !ended; ++i) {
    if (i > 0) {
      if (command.gap > listen.interdigit_timeout) break;
      now_ += command.gap;
    }
    const std::string key(1, all[i]);
    const KeysState before = keys.empty() ? KeysState{} : listen.keys(keys);
    const KeysState after = listen.keys(keys + key);
    if (key == listen.termchar && !keys.empty() &&
        (before.complete || (!after.complete && !after.can_continue))) {
      input.termchar = key;
      ended = true;
      continue;
    }
    keys += key;
    if (after.can_continue) continue;
    ended = true;  // nothing can follow: a match or none
    if (after.complete && listen.term_timeout.count() > 0) {
      const bool term_follows = i + 1 < all.size() &&
                                std::string(1, all[i + 1]) == listen.termchar &&
                                command.gap <= listen.term_timeout;
      now_ += term_follows ? command.gap : listen.term_timeout;
      if (term_follows) {
        input.termchar = listen.termchar;
        ++i;
      }
    }
  }
  if (!ended) now_ += listen.interdigit_timeout;
  if (i < all.size()) {  // typed ahead
    pushed_back_ = command;
    pushed_back_->at = Millis(0);
    pushed_back_->hypotheses = {{all.substr(i), 1.0}};
  }
  input.hypotheses = {{keys, 1.0}};
  return input;
}

void TextPlatform::Native(const std::string& line) {
  JsonLine command;
  command.Text("line", line);
  Report("command", command);
}

void TextPlatform::Fetching(const std::string& uri, bool begins) {
  if (uri.empty()) return;
  JsonLine line;
  line.Text("audio", uri).Bool("begins", begins);
  Report("fetchaudio", line);
}

}  // namespace vxml
