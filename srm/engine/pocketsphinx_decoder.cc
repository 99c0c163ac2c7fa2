#include <algorithm>
#include <cmath>
#include <set>

#include "srm/engine/decoder.h"
#include "srm/engine/pocketsphinx_handle.h"
#include "srm/engine/pronunciation.h"

namespace srm {
namespace {

constexpr const char* kSearch = "grammar";
constexpr int kFrameMs = 10;

/// A phonemic spelling uses the model's phonemes only.
bool IsSpelling(const std::string& text) {
  std::set<std::string> known(ModelPhonemes().begin(), ModelPhonemes().end());
  bool any = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at && !known.contains(text.substr(at, end - at))) return false;
    any = any || end > at;
    at = end + 1;
  }
  return any;
}

/// "word(2)" is the second pronunciation of a word.
std::string WithoutVariant(const std::string& word) {
  const std::size_t bracket = word.rfind('(');
  return bracket == std::string::npos || bracket == 0 ? word : word.substr(0, bracket);
}

/// A part of a result in frames of 10 ms, with the score of its sound.
struct Segment {
  int first = 0, last = 0;
  double score = 0;
  int frames() const { return last - first + 1; }
};

Segment ReadSegment(ps_seg_t* seg) {
  Segment part;
  std::int32_t sound = 0, language = 0, back = 0;
  ps_seg_frames(seg, &part.first, &part.last);
  ps_seg_prob(seg, &sound, &language, &back);
  part.score = sound;
  return part;
}

/// The phonemes that fit best, whatever is said: what a grammar's fit is measured against. Its
/// scores are told by frame.
class FreePhonemes {
 public:
  explicit FreePhonemes(DecoderPtr decoder) : decoder_(std::move(decoder)) {}
  void Begin() { ps_start_utt(decoder_.get()); }
  void Feed(const std::vector<std::int16_t>& samples) {
    ps_process_raw(decoder_.get(), samples.data(), samples.size(), FALSE, FALSE);
  }
  /// False if there is no answer.
  bool End() {
    ps_end_utt(decoder_.get());
    total_ = 0;
    by_frame_.clear();
    if (ps_get_hyp(decoder_.get(), &total_) == nullptr) return false;
    for (ps_seg_t* seg = ps_seg_iter(decoder_.get()); seg != nullptr; seg = ps_seg_next(seg)) {
      const Segment part = ReadSegment(seg);
      if (part.frames() <= 0) continue;
      const double each = part.score / part.frames();
      by_frame_.resize(static_cast<std::size_t>(part.last) + 1, each);
    }
    return true;
  }
  std::int32_t total() const { return total_; }
  /// The score of some frames, the last one included.
  double Score(int first, int last) const {
    double sum = 0;
    for (int i = std::max(first, 0); i <= last; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (at < by_frame_.size()) sum += by_frame_[at];
    }
    return sum;
  }

 private:
  const DecoderPtr decoder_;
  std::int32_t total_ = 0;
  std::vector<double> by_frame_;
};

class PocketsphinxDecoder final : public SpeechDecoder {
 public:
  PocketsphinxDecoder(std::string model, DecoderPtr main, std::unique_ptr<FreePhonemes> free)
      : model_(std::move(model)), grammar_(std::move(main)), free_(std::move(free)) {
    AddPhonemeWords(grammar_.get());
    using_ = grammar_.get();
  }

  vm::Result<void> Use(const std::vector<const Grammar*>& grammars) override {
    if (grammars.empty()) return UseDictation();
    for (const Grammar* grammar : grammars) {
      for (const std::string& word : grammar->Words()) {
        if (auto known = Know(word); !known) return known;
      }
    }
    const std::string jsgf = ToJsgf(grammars);
    if (ps_set_jsgf_string(grammar_.get(), kSearch, jsgf.c_str()) != 0 ||
        ps_set_search(grammar_.get(), kSearch) != 0) {
      return vm::Fail(vm::Errc::kBadValue, "the recogniser cannot take the grammar");
    }
    using_ = grammar_.get();
    return {};
  }

  vm::Result<void> Pronounce(const std::string& word, const std::string& spoken) override {
    const auto ways = IsSpelling(spoken) ? std::vector<std::string>{spoken}
                      : IsKana(spoken)   ? PronunciationsOf(spoken)
                                         : std::vector<std::string>();
    if (ways.empty()) {
      return vm::Fail(vm::Errc::kBadValue,
                      "found '" + spoken + "', expected kana or phonemes as in G AE L AH T");
    }
    AddWays(word, ways);
    return {};
  }

  void set_most(std::size_t most) override {
    most_ = std::clamp<std::size_t>(most, 1, kMostAlternatives);
  }

  void Begin() override {
    ps_start_utt(using_);
    if (free_) free_->Begin();
    fed_ = 0;
  }

  void Feed(std::span<const std::int16_t> samples) override {
    const std::vector<std::int16_t> noisy = dither_.Add(samples);
    ps_process_raw(using_, noisy.data(), noisy.size(), FALSE, FALSE);
    if (free_) free_->Feed(noisy);
    fed_ += samples.size();
  }

  std::string Partial() override {
    std::int32_t score = 0;
    const char* text = ps_get_hyp(using_, &score);
    return text == nullptr ? "" : Cleaned(text);
  }

  Hypothesis End() override {
    ps_end_utt(using_);
    Hypothesis heard;
    std::int32_t score = 0;
    const char* text = ps_get_hyp(using_, &score);
    if (text != nullptr) heard.text = Cleaned(text);
    const bool free = free_ && free_->End();
    const double frames = std::max(1.0, static_cast<double>(fed_) / (kFramesPerMs * kFrameMs));
    heard.fit = free ? (static_cast<double>(score) - free_->total()) / frames : 0;
    heard.confidence = heard.text.empty() ? 0 : ConfidenceOf(heard.fit);
    ReadWords(heard, free);
    if (most_ > 1 && !heard.text.empty()) ReadOthers(heard, score, frames);
    return heard;
  }

 private:
  /// The language model needs beams of its own: with those of a grammar it takes ten times as long.
  vm::Result<void> UseDictation() {
    if (!dictation_) {
      const std::string file = model_ + "/en-us.lm.bin";
      auto opened = OpenDecoder(
          model_, {{"-dict", model_ + "/cmudict-en-us.dict"}, {"-lm", file}, {"-bestpath", "yes"}});
      if (!opened) {
        return vm::Fail(vm::Errc::kUnavailable, "there is no language model '" + file + "'");
      }
      dictation_ = std::move(*opened);
    }
    using_ = dictation_.get();
    return {};
  }

  vm::Result<void> Know(const std::string& word) {
    if (char* known = ps_lookup_word(grammar_.get(), word.c_str())) {
      ckd_free(known);
      return {};
    }
    const auto ways = PronunciationsOf(word);
    if (ways.empty()) {
      return vm::Fail(vm::Errc::kBadValue,
                      "no pronunciation for the word '" + word + "'; give one by Grammar.word");
    }
    AddWays(word, ways);
    return {};
  }

  void AddWays(const std::string& word, const std::vector<std::string>& ways) {
    std::size_t number = 0;
    for (const std::string& way : ways) {
      const std::string name = ++number == 1 ? word : word + "(" + std::to_string(number) + ")";
      ps_add_word(grammar_.get(), name.c_str(), way.c_str(), TRUE);
    }
  }

  /// Fillers and stand-ins for any word are left out of a text.
  static std::string Cleaned(const std::string& text) {
    std::string clean;
    bool any = false;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      const std::string word = WithoutVariant(text.substr(at, end - at));
      at = end + 1;
      const bool filler = word.empty() || word[0] == '<' || word[0] == '[' || word[0] == '+';
      const bool stand_in = word.starts_with(kPhonemeWord);
      if (filler || (stand_in && any)) continue;
      any = stand_in;
      clean += (clean.empty() ? "" : " ") + (stand_in ? std::string("...") : word);
    }
    return clean;
  }

  void ReadWords(Hypothesis& heard, bool free) {
    for (ps_seg_t* seg = ps_seg_iter(using_); seg != nullptr; seg = ps_seg_next(seg)) {
      const Segment part = ReadSegment(seg);
      const std::string word = Cleaned(ps_seg_word(seg));
      if (word.empty() || word == "..." || part.frames() <= 0) continue;
      const double fit =
          free ? (part.score - free_->Score(part.first, part.last)) / part.frames() : 0;
      heard.words.push_back({word, Millis(part.first * kFrameMs),
                             Millis((part.last + 1) * kFrameMs), free ? ConfidenceOf(fit) : 1});
    }
  }

  /// The next best texts, each once, by the lattice; their fit differs as their scores do.
  void ReadOthers(Hypothesis& heard, std::int32_t best, double frames) {
    constexpr int kMostPaths = 200;  // many differ in silences only
    std::set<std::string> known = {heard.text};
    ps_nbest_t* path = ps_nbest(using_);
    for (int i = 0; path != nullptr && i < kMostPaths; ++i, path = ps_nbest_next(path)) {
      std::int32_t score = 0;
      const char* text = ps_nbest_hyp(path, &score);
      std::string clean = text == nullptr ? "" : Cleaned(text);
      if (clean.empty() || !known.insert(clean).second) continue;
      const double fit = heard.fit + std::min(0.0, (static_cast<double>(score) - best) / frames);
      heard.others.push_back({std::move(clean), ConfidenceOf(fit)});
      if (heard.others.size() + 1 >= most_) break;
    }
    if (path != nullptr) ps_nbest_free(path);
  }

  const std::string model_;
  const DecoderPtr grammar_;
  DecoderPtr dictation_;                      // opened when first needed
  const std::unique_ptr<FreePhonemes> free_;  // null = no rejection
  ps_decoder_t* using_ = nullptr;             // one of the two
  Dither dither_;
  std::size_t fed_ = 0;
  std::size_t most_ = 1;
};

}  // namespace

double ConfidenceOf(double fit) { return 1 / (1 + std::exp(-(fit - kFitThreshold) / 4)); }

vm::Result<std::unique_ptr<SpeechDecoder>> OpenPocketsphinx(const PocketsphinxOptions& options) {
  // Wide beams: else quick speech ends without a result (measured: docs/speech.md).
  auto main = OpenDecoder(options.model, {{"-dict", options.model + "/cmudict-en-us.dict"},
                                          {"-beam", "1e-80"},
                                          {"-pbeam", "1e-80"},
                                          {"-wbeam", "1e-60"}});
  if (!main) return std::unexpected(main.error());
  // Free phonemes without a language model of theirs, the sound looked at every 30 ms: a third of
  // the work, and what is in the grammar stands as clear of what is not (docs/speech.md).
  std::unique_ptr<FreePhonemes> free;
  if (options.rejection) {
    auto opened = OpenDecoder(
        options.model,
        {{"-allphone_ci", "yes"}, {"-beam", "1e-10"}, {"-pbeam", "1e-10"}, {"-ds", "3"}});
    if (!opened) return std::unexpected(opened.error());
    if (ps_set_allphone_file(opened->get(), kSearch, nullptr) != 0 ||
        ps_set_search(opened->get(), kSearch) != 0) {
      return vm::Fail(vm::Errc::kUnavailable, "the recogniser has no search for phonemes");
    }
    free = std::make_unique<FreePhonemes>(std::move(*opened));
  }
  return std::make_unique<PocketsphinxDecoder>(options.model, std::move(*main), std::move(free));
}

}  // namespace srm
