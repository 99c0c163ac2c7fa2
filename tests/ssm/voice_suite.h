#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ssm/flite/flite_engine.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/voice_world.h"

/// The adapter suite: everything a client may rely on, against every engine. Its tests stand in
/// voice_*_test.cc, by theme.
namespace ssm_test {

using Lines = std::vector<std::string>;
inline constexpr const char* kText =
    "Hello, my name is Galatea, and this is a sentence of some length.";

struct EngineCase {
  const char* name;
  std::unique_ptr<ssm::SpeechEngine> (*make)();
};

class VoiceSuite : public testing::TestWithParam<EngineCase> {
 protected:
  VoiceWorld world_{GetParam().make()};

  long Prepare(const std::string& text = kText) {
    world_.Tell("set Text = " + text);
    world_.Lines();
    return std::stol(world_.Ask("Text.dur"));
  }
};

inline auto AllEngines() {
  return testing::Values(EngineCase{"Stub", ssm_stub::MakeRuleEngine},
                         EngineCase{"Flite", ssm::MakeFliteEngine});
}
inline std::string EngineName(const testing::TestParamInfo<EngineCase>& one) {
  return one.param.name;
}

}  // namespace ssm_test
