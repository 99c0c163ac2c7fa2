#include <algorithm>
#include <cmath>
#include <set>

#include "ear/grammar/grammar_limits.h"
#include "srm/engine/decoder.h"
#include "srm/engine/feature_mean.h"
#include "srm/engine/fit_allowance.h"
#include "srm/engine/free_phonemes.h"
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

class PocketsphinxDecoder final : public SpeechDecoder {
 public:
  PocketsphinxDecoder(std::string model, DecoderPtr main, std::unique_ptr<FreePhonemes> free)
      : model_(std::move(model)),
        grammar_(std::move(main)),
        free_(std::move(free)),
        mean_(grammar_.get()) {
    AddPhonemeWords(grammar_.get());
    using_ = grammar_.get();
  }

  vm::Result<void> Use(const std::vector<const ear::Grammar*>& grammars) override {
    if (grammars.empty()) return UseDictation();
    std::size_t parts = 0;
    for (const ear::Grammar* grammar : grammars) parts += grammar->expanded_parts();
    for (const ear::Grammar* grammar : grammars) {
      if (const std::size_t row = LongestOptionalRow(*grammar); row > kMaxOptionalRow) {
        return vm::Fail(vm::Errc::kLimit,
                        ear::RuleLabel(grammar->root()) + ": " + std::to_string(row) +
                            " parts in a row that may be left out, expected at most " +
                            std::to_string(kMaxOptionalRow));
      }
    }
    if (parts > ear::kMaxExpandedParts) {
      return vm::Fail(vm::Errc::kLimit, "the active grammars have " + std::to_string(parts) +
                                            " parts when written out, expected at most " +
                                            std::to_string(ear::kMaxExpandedParts));
    }
    for (const ear::Grammar* grammar : grammars) {
      for (const std::string& word : grammar->Words()) {
        if (auto known = Know(word); !known) return known;
      }
    }
    const std::string jsgf = ToJsgf(grammars);
    if (!SetJsgf(grammar_.get(), kSearch, jsgf) || ps_set_search(grammar_.get(), kSearch) != 0) {
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
    mean_.Begin();
    ps_start_utt(using_);
    if (free_) free_->Begin();
    fed_ = 0;
    utterance_.clear();
  }

  void Feed(std::span<const std::int16_t> samples) override {
    const bool grammar = using_ == grammar_.get();
    const std::vector<std::int16_t> noisy = (grammar ? room_ : dither_).Add(samples);
    ps_process_raw(using_, noisy.data(), noisy.size(), FALSE, FALSE);
    if (free_) free_->Feed(noisy);
    fed_ += samples.size();
    if (grammar && fed_ <= kMostAgainFrames) {
      utterance_.insert(utterance_.end(), noisy.begin(), noisy.end());
    }
  }

  std::string Partial() override {
    std::int32_t score = 0;
    const char* text = ps_get_hyp(using_, &score);
    return text == nullptr ? "" : Cleaned(text);
  }

  Hypothesis End() override {
    ps_end_utt(using_);
    const bool free = free_ && free_->End();
    mean_.End();
    const bool grammar = using_ == grammar_.get();
    noise_ = grammar ? NoiseAllowance(Clearness(utterance_)) : kDictationAllowance;
    Hypothesis heard = Read(free);
    const double above = heard.fit - kFitThreshold;
    const bool doubtful = heard.text.empty() || (above < kDoubt && above > -kHopeless);
    if (!doubtful || utterance_.size() != fed_ || fed_ == 0) return heard;
    Hypothesis again = HearAgain();
    if (again.text.empty()) return heard;
    // Other words are those that fit better; the same ones keep the fit that is worth more.
    const double worth = again.fit - kSecondLook;
    const bool better = again.text == heard.text ? worth > heard.fit
                                                 : heard.text.empty() || again.fit > heard.fit + 1;
    if (!better) return heard;
    again.fit = worth;
    again.confidence = ConfidenceOf(worth);
    return again;
  }

  void Abandon() override {
    ps_end_utt(using_);
    if (free_) static_cast<void>(free_->End());
    mean_.Forget();
  }

 private:
  static constexpr double kLatticeScale = 1024;
  static constexpr double kDictationAllowance = 15;  // its words are less than the best phonemes
  static constexpr double kRoom = 1.0 / 290;         // 40 dB below speech
  static constexpr std::size_t kMostAgainFrames = 30u * 1000 * kFramesPerMs;
  /// What is looked at again: fits from so much below the threshold to so little above it.
  static constexpr double kHopeless = 12, kDoubt = 10;
  /// The better of two looks fits better by chance as well, also what is not in the grammar: that
  /// is taken off the second (docs/speech.md).
  static constexpr double kSecondLook = 5;

  /// The mean of all sound so far is not that of this utterance where a room, a microphone or a
  /// noise is new. So what fits badly is decoded again with its own mean, which is known now: of 90
  /// phrases in changing noise 87 were right without and 90 with it (docs/speech.md).
  Hypothesis HearAgain() {
    mean_.UseOwn();
    ps_start_utt(using_);
    ps_process_raw(using_, utterance_.data(), utterance_.size(), FALSE, FALSE);
    ps_end_utt(using_);
    const bool free = free_ && free_->Again(utterance_);
    mean_.UseAll();
    return Read(free);
  }

  Hypothesis Read(bool free) {
    Hypothesis heard;
    std::int32_t score = 0;
    const char* text = ps_get_hyp(using_, &score);
    if (text != nullptr) heard.text = Cleaned(text);
    heard.fit = free ? FitOfSpeech() : 0;
    heard.confidence = heard.text.empty() ? 0 : ConfidenceOf(heard.fit);
    ReadWords(heard, free);
    const double frames = std::max(1.0, static_cast<double>(fed_) / (kFramesPerMs * kFrameMs));
    if (most_ > 1 && !heard.text.empty()) ReadOthers(heard, score, frames);
    return heard;
  }

  /// By frame, over those that one of the two takes for speech: pauses fit whatever is said. What
  /// noise and brevity do to it is evened out.
  double FitOfSpeech() {
    double fit = 0;
    int frames = 0;
    for (ps_seg_t* seg = ps_seg_iter(using_); seg != nullptr; seg = ps_seg_next(seg)) {
      const Segment part = ReadPart(seg);
      const bool filler = IsFiller(ps_seg_word(seg));
      for (int i = part.first; i <= part.last; ++i) {
        if (filler && free_->Silent(i)) continue;
        fit += part.score / part.frames() - free_->Score(i, i);
        ++frames;
      }
    }
    return fit / std::max(1, frames) + LengthAllowance(frames) + noise_;
  }

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
      clean += (clean.empty() ? "" : " ") + (stand_in ? std::string(ear::kNotUnderstood) : word);
    }
    return clean;
  }

  /// The engine tells scores out of a lattice, which only dictation makes, 1024 times as large.
  Segment ReadPart(ps_seg_t* seg) const {
    Segment part = ReadSegment(seg);
    if (using_ == dictation_.get()) part.score /= kLatticeScale;
    return part;
  }

  void ReadWords(Hypothesis& heard, bool free) {
    for (ps_seg_t* seg = ps_seg_iter(using_); seg != nullptr; seg = ps_seg_next(seg)) {
      const Segment part = ReadPart(seg);
      const std::string word = Cleaned(ps_seg_word(seg));
      if (word.empty() || word == ear::kNotUnderstood || part.frames() <= 0) continue;
      const double fit =
          free ? (part.score - free_->Score(part.first, part.last)) / part.frames() + noise_ : 0;
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
  FeatureMean mean_;                          // of grammar_
  ps_decoder_t* using_ = nullptr;             // one of the two
  Dither room_{kRoom};                        // for grammars; dictation hears worse with it
  Dither dither_;
  std::size_t fed_ = 0;
  std::vector<std::int16_t> utterance_;  // as it was fed; up to kMostAgainFrames
  double noise_ = 0;                     // what is allowed to it
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
        {{"-allphone_ci", "yes"}, {"-beam", "1e-20"}, {"-pbeam", "1e-20"}, {"-ds", "1"}});
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
