#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <utility>

#include "ssm/flite/flite_engine.h"
#include "vdm/train/corpus.h"

namespace vdm {

/// What the voice rms of flite makes of a text.
inline Take Spoken(const std::string& text) {
  const auto engine = ssm::MakeFliteEngine();
  const std::atomic<bool> cancelled{false};
  auto plan = engine->Plan({{.text = text, .voice = "rms"}}, cancelled);
  EXPECT_TRUE(plan);
  ssm::SampleBuffer buffer(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  EXPECT_TRUE(engine->Render(*plan, buffer));
  const auto ready = buffer.Ready();
  return {"rms", {ready.begin(), ready.end()}, std::move(plan->phonemes)};
}

}  // namespace vdm
