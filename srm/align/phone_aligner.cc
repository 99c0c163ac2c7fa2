#include "srm/align/phone_aligner.h"

#include <utility>

#include "srm/align/pause_edges.h"
#include "srm/engine/pocketsphinx_handle.h"
#include "srm/engine/pronunciation.h"
#include "vm_protocol/core/lower_case.h"

namespace srm {
namespace {

constexpr int kFrameMs = 10;
constexpr const char* kSearch = "align";
constexpr std::string_view kFirstPhone = "PW_";  // a word's first phoneme
// Frames are counted from their first sample, but what they hold lies around their middle, half a
// window (25.6 ms) later; 8 ms leave no bias against flite's own times.
constexpr Millis kHalfWindow{8};

bool IsFiller(std::string_view word) {
  return word.empty() || word[0] == '<' || word[0] == '[' || word[0] == '+' || word == "SIL";
}

}  // namespace

struct PhoneAligner::Parts {
  std::string model;
  DecoderPtr decoder;
  DecoderPtr guesser;  // opened when first needed
  Dither dither;

  std::vector<std::string> Ways(const std::string& word) {
    std::vector<std::string> ways;
    for (int variant = 1; variant < 10; ++variant) {
      const std::string name = variant == 1 ? word : word + "(" + std::to_string(variant) + ")";
      char* found = ps_lookup_word(decoder.get(), name.c_str());
      if (found == nullptr) break;
      ways.emplace_back(found);
      ckd_free(found);
    }
    return ways.empty() ? PronunciationsOf(word) : ways;
  }

  /// A word as alternatives of phoneme words; empty if it cannot be said.
  std::string WordRule(const std::string& word) {
    std::string rule;
    for (const std::string& way : Ways(word)) {
      std::string phones;
      for (std::size_t at = 0; at < way.size();) {
        const std::size_t end = std::min(way.find(' ', at), way.size());
        phones +=
            std::string(at == 0 ? kFirstPhone : kPhonemeWord) + way.substr(at, end - at) + " ";
        at = end + 1;
      }
      rule += (rule.empty() ? "( " : "| ") + phones;
    }
    return rule.empty() ? rule : rule + ") ";
  }

  void Process(ps_decoder_t* with, const std::vector<std::int16_t>& samples) {
    const auto noisy = dither.Add(samples);
    ps_start_utt(with);
    ps_process_raw(with, noisy.data(), noisy.size(), FALSE, TRUE);
    ps_end_utt(with);
  }
};

PhoneAligner::PhoneAligner(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
PhoneAligner::~PhoneAligner() = default;

vm::Result<std::unique_ptr<PhoneAligner>> PhoneAligner::Open(const std::string& model) {
  auto decoder = OpenDecoder(model, {{"-dict", model + "/cmudict-en-us.dict"},
                                     {"-beam", "1e-80"},
                                     {"-pbeam", "1e-80"},
                                     {"-wbeam", "1e-60"}});
  if (!decoder) return std::unexpected(decoder.error());
  AddPhonemeWords(decoder->get());
  for (const std::string& name : ModelPhonemes()) {
    ps_add_word(decoder->get(), (std::string(kFirstPhone) + name).c_str(), name.c_str(), TRUE);
  }
  auto parts = std::make_unique<Parts>();
  parts->model = model;
  parts->decoder = std::move(*decoder);
  return std::unique_ptr<PhoneAligner>(new PhoneAligner(std::move(parts)));
}

namespace {

/// Collects the segments of a decoder, one behind the other, from 0 to the end of the sound.
class Collector {
 public:
  explicit Collector(std::size_t samples)
      : end_(static_cast<std::int64_t>(samples / kFramesPerMs)) {}

  void Add(std::string name, int first_frame) {
    const Millis start =
        first_frame == 0 ? Millis{0} : std::min(Millis(first_frame * kFrameMs) + kHalfWindow, end_);
    Close(start);
    if (name == "pau" && !list_.empty() && list_.back().name == "pau") return;
    list_.push_back({std::move(name), Millis{0}});
    at_ = start;
  }
  Millis at() const { return at_; }
  vm::PhonemeList Finish() {
    Close(end_);
    if (list_.empty()) list_.push_back({"pau", end_});
    std::erase_if(list_, [](const vm::Phoneme& p) { return p.duration.count() == 0; });
    return std::move(list_);
  }
  Millis end() const { return end_; }

 private:
  void Close(Millis until) {
    if (list_.empty()) {
      if (until.count() > 0) list_.push_back({"pau", until});
    } else {
      list_.back().duration += until - Total();
    }
  }
  Millis Total() const { return vm::TotalDuration(list_); }

  const Millis end_;
  Millis at_{0};
  vm::PhonemeList list_;
};

}  // namespace

vm::Result<Alignment> PhoneAligner::Align(const std::vector<std::int16_t>& samples,
                                          const std::string& text) {
  std::vector<std::string> said;
  std::string rules;
  for (const std::string& word : ear::WordsOf(text)) {
    std::string rule = parts_->WordRule(word);
    if (rule.empty()) continue;
    said.push_back(word);
    rules += rule;
  }
  if (said.empty()) {
    return vm::Fail(vm::Errc::kBadValue, "there is no word to say in '" + text.substr(0, 60) + "'");
  }
  ps_decoder_t* decoder = parts_->decoder.get();
  const std::string jsgf = "#JSGF V1.0;\ngrammar a;\npublic <a> = " + rules + ";\n";
  if (!SetJsgf(decoder, kSearch, jsgf) || ps_set_search(decoder, kSearch) != 0) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the text cannot be aligned: '" + text.substr(0, 60) + "'");
  }
  parts_->Process(decoder, samples);
  Alignment alignment;
  Collector collector(samples.size());
  std::size_t words = 0;
  for (ps_seg_t* seg = ps_seg_iter(decoder); seg != nullptr; seg = ps_seg_next(seg)) {
    int first = 0, last = 0;
    ps_seg_frames(seg, &first, &last);
    const std::string_view word = ps_seg_word(seg);
    const bool filler = IsFiller(word);
    if (word == "(NULL)" || last < first) continue;
    collector.Add(filler ? "pau" : vm::LowerCase(word.substr(3)), first);
    if (!alignment.words.empty() && alignment.words.back().end.count() == 0 &&
        (filler || word.starts_with(kFirstPhone))) {
      alignment.words.back().end = collector.at();
    }
    if (word.starts_with(kFirstPhone) && words < said.size()) {
      alignment.words.push_back({said[words++], collector.at(), Millis{0}});
    }
  }
  if (words < said.size()) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the text does not fit the sound: '" + text.substr(0, 60) + "'");
  }
  if (alignment.words.back().end.count() == 0) alignment.words.back().end = collector.end();
  alignment.phonemes = collector.Finish();
  PlacePauses(alignment, samples);
  return alignment;
}

vm::Result<Alignment> PhoneAligner::Guess(const std::vector<std::int16_t>& samples) {
  if (!parts_->guesser) {
    auto opened = OpenDecoder(parts_->model, {{"-allphone", parts_->model + "/en-us-phone.lm.bin"},
                                              {"-allphone_ci", "yes"},
                                              {"-beam", "1e-20"},
                                              {"-pbeam", "1e-20"},
                                              {"-lw", "2.0"}});
    if (!opened) return std::unexpected(opened.error());
    parts_->guesser = std::move(*opened);
  }
  ps_decoder_t* decoder = parts_->guesser.get();
  parts_->Process(decoder, samples);
  Collector collector(samples.size());
  for (ps_seg_t* seg = ps_seg_iter(decoder); seg != nullptr; seg = ps_seg_next(seg)) {
    int first = 0, last = 0;
    ps_seg_frames(seg, &first, &last);
    const std::string_view word = ps_seg_word(seg);
    collector.Add(IsFiller(word) ? "pau" : vm::LowerCase(word), first);
  }
  Alignment guess{.phonemes = collector.Finish()};
  PlacePauses(guess, samples);
  return guess;
}

}  // namespace srm
