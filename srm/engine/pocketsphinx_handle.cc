#include "srm/engine/pocketsphinx_handle.h"

#include <sphinxbase/err.h>
#include <sphinxbase/fsg_model.h>
#include <sphinxbase/jsgf.h>

#include <algorithm>
#include <cmath>

namespace srm {

vm::Result<DecoderPtr> OpenDecoder(
    const std::string& model, const std::vector<std::pair<std::string, std::string>>& settings) {
  err_set_logfp(nullptr);
  std::vector<std::pair<std::string, std::string>> all = {
      {"-hmm", model + "/en-us"}, {"-logfn", "/dev/null"}, {"-remove_silence", "no"},
      {"-remove_noise", "no"},    {"-bestpath", "no"},     {"-fwdflat", "no"}};
  all.insert(all.end(), settings.begin(), settings.end());
  std::vector<char*> words = {const_cast<char*>("srm")};
  for (auto& [name, value] : all) {
    words.push_back(name.data());
    words.push_back(value.data());
  }
  cmd_ln_t* config =
      cmd_ln_parse_r(nullptr, ps_args(), static_cast<int>(words.size()), words.data(), FALSE);
  ps_decoder_t* decoder = config == nullptr ? nullptr : ps_init(config);
  if (config != nullptr) cmd_ln_free_r(config);
  err_set_logfp(nullptr);
  if (decoder == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no recognition model in '" + model +
                                                "' (Debian: pocketsphinx-en-us)");
  }
  return DecoderPtr(decoder);
}

bool SetJsgf(ps_decoder_t* decoder, const char* name, const std::string& text) {
  const std::unique_ptr<jsgf_t, void (*)(jsgf_t*)> grammar(jsgf_parse_string(text.c_str(), nullptr),
                                                           jsgf_grammar_free);
  jsgf_rule_t* rule = grammar ? jsgf_get_public_rule(grammar.get()) : nullptr;
  if (rule == nullptr) return false;
  const auto weight = static_cast<float>(cmd_ln_float_r(ps_get_config(decoder), "-lw"));
  fsg_model_t* model = jsgf_build_fsg(grammar.get(), rule, ps_get_logmath(decoder), weight);
  if (model == nullptr) return false;
  const bool set = ps_set_fsg(decoder, name, model) == 0;
  fsg_model_free(model);  // the decoder has its own hold on it
  return set;
}

void AddPhonemeWords(ps_decoder_t* decoder) {
  for (const std::string& name : ModelPhonemes()) {
    ps_add_word(decoder, (std::string(kPhonemeWord) + name).c_str(), name.c_str(), TRUE);
  }
}

std::vector<std::int16_t> Dither::Add(std::span<const std::int16_t> samples) {
  constexpr double kLeast = 3;             // of 32768
  constexpr double kForgetting = 0.99997;  // by sample: to a third within two seconds
  std::vector<std::int16_t> noisy(samples.begin(), samples.end());
  for (std::int16_t& sample : noisy) {
    state_ = state_ * 1664525u + 1013904223u;
    loudest_ = std::max(loudest_ * kForgetting, std::abs(static_cast<double>(sample)));
    const double most = std::max(kLeast, room_ * loudest_);
    const double noise = (static_cast<double>(state_ >> 8) / (1 << 23) - 1) * most;
    const long sum = std::lround(sample + noise);
    sample = static_cast<std::int16_t>(std::clamp(sum, -32768l, 32767l));
  }
  return noisy;
}

}  // namespace srm
