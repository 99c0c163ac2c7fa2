#include <cstdio>

#include "srm/engine/decoder.h"
#include "srm/engine/pocketsphinx_handle.h"
#include "srm/engine/pronunciation.h"

namespace srm {
namespace {

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
    for (const std::string& word : ear::WordsOf(phrase)) {
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

vm::Result<std::unique_ptr<KeywordSpotter>> OpenSpotter(const PocketsphinxOptions& options) {
  auto decoder = OpenDecoder(options.model, {{"-dict", options.model + "/cmudict-en-us.dict"}});
  if (!decoder) return std::unexpected(decoder.error());
  return std::make_unique<PocketsphinxSpotter>(std::move(*decoder));
}

}  // namespace srm
