#include "srm/align/phone_aligner.h"

#include <utility>

#include "srm/align/pause_edges.h"
#include "srm/align/segment_collector.h"
#include "srm/engine/pronunciation.h"
#include "vm_protocol/core/lower_case.h"

namespace srm {
namespace {

constexpr const char* kSearch = "align";
constexpr std::string_view kFirstPhone = "PW_";  // a word's first phoneme

}  // namespace

struct PhoneAligner::Parts {
  DecoderPtr decoder;
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
  parts->decoder = std::move(*decoder);
  return std::unique_ptr<PhoneAligner>(new PhoneAligner(std::move(parts)));
}

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
  HearWhole(decoder, parts_->dither.Add(samples));
  Alignment alignment;
  SegmentCollector collector(samples.size());
  std::size_t words = 0;
  for (ps_seg_t* seg = ps_seg_iter(decoder); seg != nullptr; seg = ps_seg_next(seg)) {
    int first = 0, last = 0;
    ps_seg_frames(seg, &first, &last);
    const std::string word = ps_seg_word(seg);
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

}  // namespace srm
