#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "ssm/voice/speech_engine.h"

/// What an engine makes of a text, and how loud it is.
namespace ssm_test {

inline const std::atomic<bool> kNever{false};

struct Spoken {
  ssm::SpeechPlan plan{};
  std::vector<std::int16_t> samples{};
};

/// The plan and its sound; checks that they have one length.
inline Spoken Speak(ssm::SpeechEngine& engine, const std::vector<ssm::SpeechSpan>& spans) {
  auto plan = engine.Plan(spans, kNever);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().text);
  if (!plan) return {};
  ssm::SampleBuffer samples(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  auto rendered = engine.Render(*plan, samples);
  EXPECT_TRUE(rendered) << (rendered ? "" : rendered.error().text);
  EXPECT_TRUE(samples.complete());
  const auto ready = samples.Ready();
  return {std::move(*plan), {ready.begin(), ready.end()}};
}

inline double Rms(std::span<const std::int16_t> samples) {
  double sum = 0;
  for (const std::int16_t sample : samples) sum += static_cast<double>(sample) * sample;
  return samples.empty() ? 0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

}  // namespace ssm_test
