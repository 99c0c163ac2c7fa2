#include <cmath>
#include <set>

#include "srm/engine/decoder.h"
#include "srm/engine/pocketsphinx_handle.h"
#include "srm/engine/pronunciation.h"

namespace srm {
namespace {

constexpr const char* kSearch = "grammar";
constexpr const char* kDictation = "dictation";
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
  PocketsphinxDecoder(std::string model, DecoderPtr main, DecoderPtr free)
      : model_(std::move(model)), main_(std::move(main)), free_(std::move(free)) {
    AddPhonemeWords(main_.get());
  }

  vm::Result<void> Use(const std::vector<const Grammar*>& grammars) override {
    if (grammars.empty()) return UseDictation();
    for (const Grammar* grammar : grammars) {
      for (const std::string& word : grammar->Words()) {
        if (auto known = Know(word); !known) return known;
      }
    }
    const std::string jsgf = ToJsgf(grammars);
    if (ps_set_jsgf_string(main_.get(), kSearch, jsgf.c_str()) != 0 ||
        ps_set_search(main_.get(), kSearch) != 0) {
      return vm::Fail(vm::Errc::kBadValue, "the recogniser cannot take the grammar");
    }
    dictation_ = false;
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

  void Begin() override {
    ps_start_utt(main_.get());
    if (free_) ps_start_utt(free_.get());
    fed_ = 0;
  }

  void Feed(std::span<const std::int16_t> samples) override {
    const std::vector<std::int16_t> noisy = dither_.Add(samples);
    ps_process_raw(main_.get(), noisy.data(), noisy.size(), FALSE, FALSE);
    if (free_) ps_process_raw(free_.get(), noisy.data(), noisy.size(), FALSE, FALSE);
    fed_ += samples.size();
  }

  std::string Partial() override {
    std::int32_t score = 0;
    const char* text = ps_get_hyp(main_.get(), &score);
    return text == nullptr ? "" : Cleaned(text);
  }

  Hypothesis End() override {
    ps_end_utt(main_.get());
    Hypothesis heard;
    std::int32_t score = 0;
    const char* text = ps_get_hyp(main_.get(), &score);
    if (text != nullptr) heard.text = Cleaned(text);
    ReadWords(heard);
    if (free_) {
      ps_end_utt(free_.get());
      std::int32_t free_score = 0;
      const bool scored = ps_get_hyp(free_.get(), &free_score) != nullptr;
      const double frames = std::max(1.0, static_cast<double>(fed_) / (kFramesPerMs * kFrameMs));
      heard.fit = scored ? (static_cast<double>(score) - free_score) / frames : 0;
    }
    heard.confidence = heard.text.empty() ? 0 : ConfidenceOf(heard.fit);
    return heard;
  }

 private:
  vm::Result<void> UseDictation() {
    if (!has_dictation_) {
      const std::string file = model_ + "/en-us.lm.bin";
      if (ps_set_lm_file(main_.get(), kDictation, file.c_str()) != 0) {
        return vm::Fail(vm::Errc::kUnavailable, "there is no language model '" + file + "'");
      }
      has_dictation_ = true;
    }
    ps_set_search(main_.get(), kDictation);
    dictation_ = true;
    return {};
  }

  vm::Result<void> Know(const std::string& word) {
    if (char* known = ps_lookup_word(main_.get(), word.c_str())) {
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
      ps_add_word(main_.get(), name.c_str(), way.c_str(), TRUE);
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

  void ReadWords(Hypothesis& heard) {
    for (ps_seg_t* seg = ps_seg_iter(main_.get()); seg != nullptr; seg = ps_seg_next(seg)) {
      int first = 0, last = 0;
      ps_seg_frames(seg, &first, &last);
      const std::string word = Cleaned(ps_seg_word(seg));
      if (word.empty() || word == "...") continue;
      heard.words.push_back({word, Millis(first * kFrameMs), Millis((last + 1) * kFrameMs)});
    }
  }

  const std::string model_;
  const DecoderPtr main_;
  const DecoderPtr free_;  // null = no rejection
  Dither dither_;
  std::size_t fed_ = 0;
  bool dictation_ = false;
  bool has_dictation_ = false;
};

class PocketsphinxSpotter final : public KeywordSpotter {
 public:
  explicit PocketsphinxSpotter(DecoderPtr decoder) : decoder_(std::move(decoder)) {}
  ~PocketsphinxSpotter() override {
    if (running_) ps_end_utt(decoder_.get());
  }

  vm::Result<void> Use(const std::vector<std::string>& phrases) override {
    if (running_) ps_end_utt(decoder_.get());
    running_ = false;
    phrases_ = phrases;
    return phrases.empty() ? vm::Result<void>() : Listen();
  }

  std::string Feed(std::span<const std::int16_t> samples) override {
    if (!running_) return {};
    const auto noisy = dither_.Add(samples);
    ps_process_raw(decoder_.get(), noisy.data(), noisy.size(), FALSE, FALSE);
    const char* heard = ps_get_hyp(decoder_.get(), nullptr);
    if (heard == nullptr) return {};
    std::string phrase = heard;
    while (phrase.ends_with(' ')) phrase.pop_back();
    ps_end_utt(decoder_.get());
    ps_start_utt(decoder_.get());
    return phrase;
  }

 private:
  /// All the phrases as one search; the library wants them in a file of lines.
  vm::Result<void> Listen();

  const DecoderPtr decoder_;
  Dither dither_;
  std::vector<std::string> phrases_;
  bool running_ = false;
};

vm::Result<void> PocketsphinxSpotter::Listen() {
  std::FILE* file = std::tmpfile();
  if (file == nullptr) return vm::Fail(vm::Errc::kUnavailable, "no temporary file can be made");
  for (const std::string& phrase : phrases_) {
    for (const std::string& word : WordsOf(phrase)) {
      char* known = ps_lookup_word(decoder_.get(), word.c_str());
      if (known != nullptr) {
        ckd_free(known);
        continue;
      }
      const auto ways = PronunciationsOf(word);
      if (!ways.empty()) ps_add_word(decoder_.get(), word.c_str(), ways[0].c_str(), TRUE);
    }
    // Short phrases are heard everywhere unless the threshold is high (measured: docs/speech.md).
    const bool is_short = phrase.size() < 6;
    std::fprintf(file, "%s /%s/\n", phrase.c_str(), is_short ? "1e-10" : "1e-20");
  }
  std::fflush(file);
  const std::string path = "/proc/self/fd/" + std::to_string(fileno(file));
  const bool set = ps_set_kws(decoder_.get(), "spot", path.c_str()) == 0 &&
                   ps_set_search(decoder_.get(), "spot") == 0;
  std::fclose(file);
  if (!set) return vm::Fail(vm::Errc::kBadValue, "the recogniser cannot listen for these phrases");
  ps_start_utt(decoder_.get());
  running_ = true;
  return {};
}

}  // namespace

double ConfidenceOf(double fit) { return 1 / (1 + std::exp(-(fit - kFitThreshold) / 4)); }

vm::Result<std::unique_ptr<SpeechDecoder>> OpenPocketsphinx(const PocketsphinxOptions& options) {
  // Wide beams: else quick speech ends without a result (measured: docs/speech.md).
  auto main = OpenDecoder(options.model, {{"-dict", options.model + "/cmudict-en-us.dict"},
                                          {"-beam", "1e-80"},
                                          {"-pbeam", "1e-80"},
                                          {"-wbeam", "1e-60"}});
  if (!main) return std::unexpected(main.error());
  // Narrow beams halve its work; the score changes little (measured: docs/speech.md).
  DecoderPtr free;
  if (options.rejection) {
    auto opened = OpenDecoder(options.model, {{"-allphone", options.model + "/en-us-phone.lm.bin"},
                                              {"-allphone_ci", "yes"},
                                              {"-beam", "1e-10"},
                                              {"-pbeam", "1e-10"},
                                              {"-lw", "2.0"}});
    if (!opened) return std::unexpected(opened.error());
    free = std::move(*opened);
  }
  return std::make_unique<PocketsphinxDecoder>(options.model, std::move(*main), std::move(free));
}

vm::Result<std::unique_ptr<KeywordSpotter>> OpenSpotter(const PocketsphinxOptions& options) {
  auto decoder = OpenDecoder(options.model, {{"-dict", options.model + "/cmudict-en-us.dict"}});
  if (!decoder) return std::unexpected(decoder.error());
  return std::make_unique<PocketsphinxSpotter>(std::move(*decoder));
}

}  // namespace srm
