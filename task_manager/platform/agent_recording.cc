// Recordings: the ear keeps the sound of what is said in the session's folder.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <utility>

#include "task_manager/platform/agent_platform.h"
#include "vm_protocol/core/file_kind.h"

namespace vxml {
namespace {

constexpr Millis kKeySound{1000};  // a script's key without a sound: as on the text platform
constexpr Millis kLongestRecording{600'000};
constexpr Millis kShortestRecording{100};

/// What the ear writes; `plain` is the media type without parameters.
bool IsWav(const std::string& type) {
  const std::string plain = type.substr(0, type.find(';'));
  return plain == "audio/x-wav" || plain == "audio/wav" || plain == "audio/vnd.wave";
}

constexpr double kBeepHz = 1000;
constexpr Millis kBeep{200};

/// A beep as a Sun audio file, 16 bit at 16 kHz: its header is six big-endian numbers.
std::string BeepSound() {
  std::string file(".snd\0\0\0\x18\xff\xff\xff\xff\0\0\0\3\0\0\x3e\x80\0\0\0\1", 24);
  for (int i = 0; i < kBeep.count() * 16; ++i) {
    const double wave = 6000 * std::sin(2 * std::numbers::pi * kBeepHz * i / 16000);
    const auto sample = static_cast<std::uint16_t>(static_cast<std::int16_t>(wave));
    file += {static_cast<char>(sample >> 8), static_cast<char>(sample & 0xFF)};
  }
  return file;
}

/// The piece up to the next blank.
std::string TakeWord(std::string& text) {
  const std::size_t end = std::min(text.find(' '), text.size());
  std::string word = text.substr(0, end);
  text.erase(0, end + 1);
  return word;
}

long NumberOf(const std::string& text) {
  long number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

AgentPlatform::~AgentPlatform() {
  KeepSounds(false);
  for (const std::string& macro : macros_) hub_.Send("to @AM-MCL del " + macro);
  hub_.StopListening();
}

/// False: the ear cannot.
bool AgentPlatform::KeepSounds(bool keep) {
  if (keep == keeps_) return keep;
  std::string folder = "NONE";
  if (keep) {
    auto made = sounds_kept_.Folder();
    if (!made) return false;
    folder = *made;
  }
  const auto answer = hub_.Ask("to @" + options_.ear + " set Listen.keep = " + folder, kAnswer);
  keeps_ = keep && answer.has_value();
  return keeps_;
}

/// MS BYTES WHOLE|CUT FILE; the file may have blanks in its name.
void AgentPlatform::OnSound(const std::string& told) {
  if (!keeps_) return;
  std::string rest = told;
  KeptSound kept;
  kept.length = Millis(NumberOf(TakeWord(rest)));
  kept.bytes = static_cast<std::size_t>(NumberOf(TakeWord(rest)));
  kept.cut = TakeWord(rest) == "CUT";
  kept.uri = "recording:" + std::to_string(++recording_count_);
  if (recording_order_.size() == kMaxRecordings) {
    recordings_.erase(recording_order_.front());
    recording_order_.pop_front();
  }
  recordings_[kept.uri] = rest;
  recording_order_.push_back(kept.uri);
  sound_ = std::move(kept);
}

void AgentPlatform::AddSound(Input& input) {
  if (!sound_) return;
  input.recorded = sound_->length;
  input.recorded_bytes = sound_->bytes;
  input.recording = sound_->uri;
  input.recording_cut = sound_->cut;
  sound_.reset();
}

vm::Result<std::string> AgentPlatform::Recording(const std::string& uri) const {
  const auto found = recordings_.find(uri);
  if (found == recordings_.end()) return Platform::Recording(uri);
  if (auto fit = vm::CheckReadable(found->second); !fit) return std::unexpected(fit.error());
  std::ifstream file(found->second, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) return vm::Fail(vm::Errc::kUnavailable, found->second + ": cannot be read");
  return bytes;
}

/// Sets it and returns what was there before; "" if the ear does not have it.
std::string AgentPlatform::EarSetting(const std::string& slot, const std::string& value) {
  if (value.empty()) return "";
  const std::string to_ear = "to @" + options_.ear;
  const auto before = hub_.Ask(to_ear + " inq " + slot, kAnswer);
  if (!before) return "";
  static_cast<void>(hub_.Ask(to_ear + " set " + slot + " = " + value, kAnswer));
  return *before;
}

void AgentPlatform::Beep() {
  if (const auto file = sounds_kept_.FileOf("beep.au", BeepSound())) PlayFile(*file, false);
}

/// The script's next line is what is said to the recording.
void AgentPlatform::RecordScripted(const std::optional<Command>& command,
                                   const RecordRequest& request) {
  using Kind = Command::Kind;
  if (!command || command->kind == Kind::kHangup) return Hear(Input::Kind::kHangup, {});
  const std::string to_ear = "to @" + options_.ear + " set ";
  const auto sound = [&](Millis length) {
    const Millis limit = length + Millis(60'000);
    static_cast<void>(hub_.Ask(to_ear + "Input.sound = " + std::to_string(length.count()), limit));
  };
  if (command->kind == Kind::kSay) {
    Pause(kReaction);
    static_cast<void>(hub_.Ask(to_ear + "Input.text = " + command->hypotheses.front().text,
                               request.max_time + Millis(60'000)));
    return;
  }
  if (command->kind != Kind::kRecord && command->kind != Kind::kDtmf) {
    return Pause(request.listen.timeout);
  }
  const bool keys = command->kind == Kind::kDtmf;
  Pause(kReaction);
  sound(keys ? kKeySound : command->duration);
  const std::string key = keys ? command->hypotheses.front().text.substr(0, 1) : command->word;
  if (!key.empty()) Hear(Input::Kind::kDtmf, {{key, 1.0}});
}

/// Until somebody has said something, ended it by a key or gone; or nobody began in time.
void AgentPlatform::AwaitRecording(const RecordRequest& request) {
  const auto ready = [&] {
    while (!heard_.empty() && heard_.front().kind == Input::Kind::kDtmf &&
           !Ends(heard_.front(), request)) {
      heard_.pop_front();
    }
    return !heard_.empty() || TypedOver();
  };
  hub_.LetCutIn(HubLink::CutIn::kAll);
  if (heard_.empty() && !hearing_) hub_.TakeTyped();
  if (hub_.WaitFor([&] { return ready() || hearing_; }, request.listen.timeout) && !ready()) {
    const Millis most = request.max_time + request.final_silence + kAnswer;
    if (!hub_.WaitFor(ready, most)) EndUtterance();
  }
  hub_.LetCutIn(HubLink::CutIn::kNone);
}

/// A key ends the recording if a grammar takes it, and any does with dtmfterm.
bool AgentPlatform::Ends(const Input& key, const RecordRequest& request) const {
  const std::string& pressed = key.hypotheses.front().text;
  return request.dtmf_term || (request.listen.keys && request.listen.keys(pressed).complete);
}

void AgentPlatform::PressKey(const Input& key, const RecordRequest& request,
                             RecordResult& result) const {
  if (!Ends(key, request)) return;
  result.termchar = key.hypotheses.front().text.substr(0, 1);
  if (!request.listen.keys || !request.listen.keys(result.termchar).complete) return;
  result.kind = RecordResult::Kind::kInput;
  result.input = key;
  result.input.hypotheses.front().text = result.termchar;
}

/// Ends what is being said; its result is there then. Nobody may be speaking.
void AgentPlatform::EndUtterance() {
  static_cast<void>(hub_.Ask("to @" + options_.ear + " set Listen.end = NOW", kAnswer));
}

/// The next input with a sound, put into the result. False: there is none.
bool AgentPlatform::TakeSound(RecordResult& result) {
  if (heard_.empty() || heard_.front().recording.empty()) return false;
  Input said = std::move(heard_.front());
  heard_.pop_front();
  result.duration = said.recorded;
  result.bytes = said.recorded_bytes;
  result.uri = said.recording;
  result.reached_max = said.recording_cut;
  if (result.kind == RecordResult::Kind::kRecorded) result.input = std::move(said);
  return true;
}

/// What came of it: a sound, and perhaps a key or words that a grammar takes.
RecordResult AgentPlatform::Recorded(const RecordRequest& request) {
  RecordResult result;
  if (TakeSound(result)) {
    // A script's key comes with the sound it ends.
    const bool key = !heard_.empty() && heard_.front().kind == Input::Kind::kDtmf;
    if (key && !result.reached_max) PressKey(heard_.front(), request, result);
    if (key) heard_.pop_front();
    const std::string words =
        result.input.hypotheses.empty() ? "" : result.input.hypotheses.front().text;
    if (result.termchar.empty() && request.listen.accepts && request.listen.accepts(words)) {
      result.kind = RecordResult::Kind::kInput;
    }
    return result;
  }
  result.kind = RecordResult::Kind::kSilence;
  if (hub_.gone() || (heard_.empty() && TypedOver())) {
    result.kind = RecordResult::Kind::kHangup;
  }
  if (heard_.empty()) return result;
  const Input first = std::move(heard_.front());
  heard_.pop_front();
  if (first.kind == Input::Kind::kHangup) {
    result.kind = RecordResult::Kind::kHangup;
    EndUtterance();
    TakeSound(result);
  } else if (first.kind == Input::Kind::kDtmf) {
    EndUtterance();
    result.kind = RecordResult::Kind::kRecorded;
    PressKey(first, request, result);
    if (!TakeSound(result)) result.kind = RecordResult::Kind::kSilence;
  } else if (first.kind == Input::Kind::kSpeech) {  // typed, and the ear has no sound of it
    JsonLine line;
    line.Text("input", first.hypotheses.empty() ? "" : first.hypotheses.front().text);
    line.Text("why", "no sound");
    Report("ignored", line);
  }
  return result;
}

RecordResult AgentPlatform::Record(const std::vector<Prompt>& prompts,
                                   const RecordRequest& request) {
  RecordResult result;
  result.kind = RecordResult::Kind::kHangup;
  if (!Play(prompts)) return result;
  result.kind = RecordResult::Kind::kBadFormat;
  if (!IsWav(request.type)) return result;
  heard_.clear();
  sound_.reset();
  UseGrammars(request.listen);
  result.kind = RecordResult::Kind::kUnsupported;
  if (!KeepSounds(true)) return result;
  const Millis longest = std::clamp(request.max_time, kShortestRecording, kLongestRecording);
  const std::string longest_before = EarSetting("Listen.longest", std::to_string(longest.count()));
  const std::string silence_before =
      EarSetting("Listen.silence", std::to_string(request.final_silence.count()));
  attends_ = request.listen.attention;
  if (request.beep) Beep();
  if (options_.script) {
    RecordScripted(Next(), request);
  } else {
    AwaitRecording(request);
  }
  result = Recorded(request);
  EarSetting("Listen.longest", longest_before);
  EarSetting("Listen.silence", silence_before);
  JsonLine line;
  line.Number("ms", static_cast<double>(result.duration.count())).Text("termchar", result.termchar);
  if (!result.uri.empty()) Report("recorded", line);
  return result;
}

}  // namespace vxml
