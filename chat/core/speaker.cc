#include "chat/core/speaker.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "chat/text/table_lines.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/utf8.h"

namespace chat {
namespace {

using std::chrono::milliseconds;

constexpr vm::Time kLongestSentence = milliseconds(300'000);
constexpr vm::Time kHeardLimit = milliseconds(1000);

double NumberIn(const std::string& text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// STOP alone would be the macro's word for silence.
std::string NotStop(std::string text) {
  if (vm::LowerCase(text) == "stop") text += '.';
  return text;
}

}  // namespace

std::string HeardPart(std::string_view text, std::string_view words) {
  const std::string small = vm::LowerCase(text);
  std::size_t end = 0;
  for (const std::string_view word : SplitAt(words, " ")) {
    const std::size_t at = small.find(vm::LowerCase(word), end);
    if (at == std::string::npos) return std::string(words);
    end = at + word.size();
  }
  return std::string(text.substr(0, end));
}

Speaker::Speaker(vm::Scheduler& clock, HubLine& hub, Names names, Hooks hooks)
    : clock_(clock), hub_(hub), names_(std::move(names)), hooks_(std::move(hooks)) {}

Speaker::~Speaker() { clock_.Cancel(stop_timer_); }

void Speaker::Begin() {
  heard_.clear();
  queue_.clear();
  no_more_ = false;
}

void Speaker::Perform(const Cue& cue) {
  for (const vm::Message& message : cue) hub_.Say(message);
}

void Speaker::Add(Sentence sentence, bool counts) {
  if (no_more_ || stopping_) return;
  Piece piece{.sentence = std::move(sentence), .counts = counts, .spoken = {}, .mark = {}};
  piece.mark = "chat" + std::to_string(++last_mark_) + "x";
  std::size_t at = 0, number = 0;
  const std::string& text = piece.sentence.text;
  for (const auto& placed : piece.sentence.within) {
    piece.spoken += text.substr(at, placed.at - at) + "<BOOKMARK MARK=\"" + piece.mark +
                    std::to_string(number++) + "\"/>";
    at = placed.at;
  }
  piece.spoken += text.substr(at);
  piece.spoken = NotStop(std::move(piece.spoken));
  queue_.push_back(std::move(piece));
  if (!current_) return Next();
  PrepareNext();
}

void Speaker::NoMore() {
  no_more_ = true;
  if (!current_ && queue_.empty() && !stopping_) hooks_.done();
}

/// What has no words happens at once; the first with words goes to the voice.
void Speaker::Next() {
  prepared_ = false;
  while (!queue_.empty() && !current_) {
    Piece piece = std::move(queue_.front());
    queue_.pop_front();
    for (const Cue& cue : piece.sentence.before) Perform(cue);
    if (!piece.sentence.HasWords()) {
      for (const auto& placed : piece.sentence.within) Perform(placed.cue);
      continue;
    }
    hooks_.begins(piece.sentence.text);
    current_ = std::move(piece);
  }
  if (!current_) {
    if (no_more_) hooks_.done();
    return;
  }
  sounded_ = false;
  spoken_ms_ = 0;
  const unsigned number = ++piece_;
  if (voiceless_) {
    clock_.Post([this, number] {
      if (number == piece_) OnSpoken("");
    });
    return;
  }
  hub_.Ask(vm::To(names_.macros, vm::Set("Speak", current_->spoken)), kLongestSentence,
           [this, number](const vm::Result<std::string>& answer) {
             if (number == piece_) OnSpoken(answer);
           });
}

void Speaker::PrepareNext() {
  if (!sounded_ || prepared_ || voiceless_ || stopping_) return;
  const auto next =
      std::ranges::find_if(queue_, [](const Piece& piece) { return piece.sentence.HasWords(); });
  if (next == queue_.end()) return;
  prepared_ = true;
  hub_.Say(vm::To(names_.voice, vm::Set("Text.next", next->spoken)));
}

void Speaker::OnVoice(const vm::Message& message) {
  if (message.slot == "Speak.len") spoken_ms_ = NumberIn(message.value);
  if (message.slot == "Speak.dur") whole_ms_ = NumberIn(message.value);
  if (!current_) return;
  if (message.slot == "Speak.stat" && message.value == "SPEAKING" && !sounded_) {
    sounded_ = true;
    hooks_.sounds();
    PrepareNext();
  }
  if (message.slot != "Speak.mark" || !message.value.starts_with(current_->mark)) return;
  const auto number =
      static_cast<std::size_t>(NumberIn(message.value.substr(current_->mark.size())));
  auto& within = current_->sentence.within;
  if (number < within.size()) Perform(std::exchange(within[number].cue, {}));
}

void Speaker::TakeHeard(const std::string& text) {
  if (text.empty() || !current_->counts) return;
  // Japanese has no blank between sentences.
  const bool blank = !heard_.empty() && static_cast<unsigned char>(heard_.back()) < 0x80;
  heard_ += (blank ? " " : "") + text;
}

void Speaker::EndPiece() {
  current_.reset();
  ++piece_;
  if (stopping_) return FinishStop();
  Next();
}

void Speaker::OnSpoken(const vm::Result<std::string>& answer) {
  const bool stopped = !answer && answer.error().code == vm::Errc::kStopped;
  if (!stopped) {
    // What cannot be spoken is still to be read, by whoever shows Reply.sentence.
    TakeHeard(current_->sentence.text);
    // A voice that does not tell of its bookmarks leaves some.
    for (const auto& placed : current_->sentence.within) Perform(placed.cue);
    if (!answer) hooks_.failed(answer.error());
    return EndPiece();
  }
  ++piece_;
  queue_.clear();
  no_more_ = true;
  const bool by_others = !stopping_;
  if (by_others) stopping_ = hooks_.stopped;
  if (!sounded_) return EndPiece();
  AskWhatWasHeard();
}

void Speaker::AskWhatWasHeard() {
  const unsigned number = piece_;
  hub_.Ask(vm::To(names_.voice, vm::Inq("Speak.spoken")), kHeardLimit,
           [this, number](const vm::Result<std::string>& words) {
             if (number != piece_ || !current_) return;
             const std::string& text = current_->sentence.text;
             if (words) {
               TakeHeard(HeardPart(text, *words));
             } else if (whole_ms_ > 0) {
               // A voice that tells only times: as much of the words as of the time, whole words.
               const double part = std::clamp(spoken_ms_ / whole_ms_, 0.0, 1.0);
               const auto bytes = static_cast<std::size_t>(part * static_cast<double>(text.size()));
               std::string_view head = vm::CutUtf8(text, bytes);
               if (bytes < text.size() && head.contains(' '))
                 head = head.substr(0, head.rfind(' '));
               TakeHeard(std::string(head));
             }
             EndPiece();
           });
}

void Speaker::Stop(std::function<void()> then) {
  queue_.clear();
  no_more_ = true;
  if (stopping_) {  // under way already
    stopping_ = std::move(then);
    return;
  }
  stopping_ = std::move(then);
  stop_timer_ = clock_.After(current_ ? kPatience : vm::Time(0), [this] {
    stop_timer_ = 0;
    FinishStop();
  });
  if (current_ && !voiceless_) hub_.Say(vm::To(names_.macros, vm::Set("Speak", "STOP")));
}

void Speaker::FinishStop() {
  clock_.Cancel(std::exchange(stop_timer_, 0));
  current_.reset();
  ++piece_;
  if (const auto then = std::exchange(stopping_, {})) then();
}

}  // namespace chat
