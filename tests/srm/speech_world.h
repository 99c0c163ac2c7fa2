#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "srm/engine/decoder.h"
#include "ssm/flite/flite_engine.h"
#include "tests/ssm/spoken.h"

/// The real decoder, and speech made by our own voice.
namespace speech_world {

inline const srm::PocketsphinxOptions kOptions;
inline bool HasModel() {
  return access((kOptions.model + "/cmudict-en-us.dict").c_str(), R_OK) == 0;
}

using Speech = ssm_test::Spoken;

inline Speech Say(const std::string& text, const std::string& voice = "slt") {
  static const auto engine = ssm::MakeFliteEngine();
  return ssm_test::Speak(*engine, {{.text = text, .voice = voice}});
}

class RecognitionTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasModel()) GTEST_SKIP() << "the model is not installed (pocketsphinx-en-us)";
    auto opened = srm::OpenPocketsphinx(kOptions);
    ASSERT_TRUE(opened) << opened.error().text;
    decoder_ = std::move(*opened);
  }
  srm::Hypothesis Hear(const std::vector<std::int16_t>& samples) {
    decoder_->Begin();
    for (std::size_t at = 0; at < samples.size(); at += 1600) {
      decoder_->Feed(
          std::span(samples).subspan(at, std::min<std::size_t>(1600, samples.size() - at)));
    }
    return decoder_->End();
  }
  void Use(std::string_view text) {
    auto grammar = ear::ParseGrammar(text);
    ASSERT_TRUE(grammar) << grammar.error().text;
    grammar_ = std::make_unique<ear::Grammar>(std::move(*grammar));
    auto used = decoder_->Use({grammar_.get()});
    ASSERT_TRUE(used) << used.error().text;
  }
  std::unique_ptr<srm::SpeechDecoder> decoder_;
  std::unique_ptr<ear::Grammar> grammar_;
};

}  // namespace speech_world
