#include "srm/core/ear.h"

#include <algorithm>
#include <utility>

namespace srm {

Ear::Ear(std::unique_ptr<SpeechDecoder> decoder, std::unique_ptr<KeywordSpotter> spotter,
         Endpointer::Settings settings, Events events)
    : decoder_(std::move(decoder)),
      spotter_(std::move(spotter)),
      events_(std::move(events)),
      endpointer_(settings,
                  {.begin = [this] { OnBegin(); },
                   .sound = [this](std::span<const std::int16_t> samples) { OnSound(samples); },
                   .end = [this] { OnEnd(); },
                   .complete = [this] { return IsComplete(); }}) {}

void Ear::Feed(std::span<const std::int16_t> samples) {
  if (spotter_) {
    if (const std::string phrase = spotter_->Feed(samples); !phrase.empty()) {
      events_.spotted(phrase);
    }
  }
  // In pieces, so that the time of a beginning is known to 10 ms.
  while (!samples.empty() && recognizing_) {
    const auto piece = samples.first(std::min<std::size_t>(samples.size(), 10 * kFramesPerMs));
    fed_ += piece.size();
    endpointer_.Feed(piece);
    samples = samples.subspan(piece.size());
  }
  fed_ += samples.size();
}

void Ear::OnBegin() {
  decoder_->Begin();
  decoding_ = true;
  utterance_.clear();
  partial_.clear();
  last_partial_ = 0;
  events_.began();
}

void Ear::OnSound(std::span<const std::int16_t> samples) {
  if (!decoding_) return;
  if (utterance_.empty()) {
    start_ =
        Millis(static_cast<std::int64_t>((fed_ - std::min(fed_, samples.size())) / kFramesPerMs));
  }
  utterance_.insert(utterance_.end(), samples.begin(), samples.end());
  if (utterance_.size() - last_partial_ >= kPartialSamples) Decode();
}

void Ear::Decode() {
  if (last_partial_ < utterance_.size()) {
    decoder_->Feed(std::span(utterance_).subspan(last_partial_));
  }
  last_partial_ = utterance_.size();
  std::string text = decoder_->Partial();
  if (text.empty() || text == partial_) return;
  partial_ = std::move(text);
  events_.partial(partial_);
}

/// The words must not have changed in the last piece of silence.
bool Ear::IsComplete() {
  if (!decoding_ || !events_.whole) return false;
  const std::string before = partial_;
  Decode();
  return decoding_ && !partial_.empty() && partial_ == before && events_.whole(partial_);
}

void Ear::OnEnd() {
  if (!std::exchange(decoding_, false)) return;
  if (last_partial_ < utterance_.size()) {
    decoder_->Feed(std::span(utterance_).subspan(last_partial_));
  }
  Heard heard{.hypothesis = decoder_->End(),
              .start = start_,
              .length = Millis(static_cast<std::int64_t>(utterance_.size() / kFramesPerMs))};
  heard.longest = heard.length >= endpointer_.settings().longest;
  heard.sound = std::exchange(utterance_, {});
  events_.ended(heard);
}

void Ear::Finish() { endpointer_.Finish(); }

void Ear::Reset() {
  endpointer_.Reset();
  if (std::exchange(decoding_, false)) decoder_->Abandon();
  utterance_.clear();
}

vm::Result<void> Ear::Use(const std::vector<const ear::Grammar*>& grammars) {
  if (!decoding_) return decoder_->Use(grammars);
  decoder_->Abandon();
  auto used = decoder_->Use(grammars);
  decoder_->Begin();
  decoder_->Feed(std::span(utterance_).first(last_partial_));
  return used;
}

vm::Result<void> Ear::Spot(const std::vector<std::string>& phrases) {
  if (!spotter_) return vm::Fail(vm::Errc::kUnavailable, "there is no engine for spotting phrases");
  return spotter_->Use(phrases);
}

void Ear::set_recognizing(bool recognizing) {
  if (!recognizing) Reset();
  recognizing_ = recognizing;
}

}  // namespace srm
