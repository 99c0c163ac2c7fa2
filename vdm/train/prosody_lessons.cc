#include "vdm/train/prosody_lessons.h"

#include <fmt/format.h>

#include "vdm/train/distortion.h"

namespace vdm {
namespace {

constexpr std::size_t kSentences = 6;  // in a talk

std::string Learned(const HeadPlan& plan, const std::vector<HeadLesson>& lessons,
                    const std::string& from, const Progress& progress) {
  const HeadNet net = LearnHead(plan, lessons, [&](std::size_t epoch, double error) {
    if (epoch % 10 == 0) progress(fmt::format("epoch {}: error {:.4f}", epoch, error));
  });
  return "# What moves the head with a voice (docs/vdm.md). Learned from " + from + ".\n" +
         FormatHeadNet(net);
}

}  // namespace

vm::Result<std::string> TeachHead(const HeadPlan& plan, const std::vector<Take>& takes,
                                  const fsm::MotionTables& tables, const Progress& progress) {
  const Dice dice(plan.seed);
  const std::vector<Talk> talks = TalksOf(takes, kSentences, dice.For(0));
  if (talks.empty()) {
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("fewer than {} sentences of one voice found", kSentences));
  }
  std::vector<HeadLesson> lessons;
  for (std::size_t n = 0; n < talks.size(); ++n) {
    Dice chance = dice.For(1 + n);
    for (const bool plain : {true, false}) {
      const auto emotion = static_cast<float>(chance.Below(3)) / 2;
      const HeadTruth truth = TextDrivenHead(talks[n], emotion, tables, chance.Next());
      if (plain) {
        lessons.push_back(MakeHeadLesson(talks[n].voice, talks[n].samples, emotion, plan.sounds,
                                         plan.late_ms, truth));
        continue;
      }
      const HeardSpeech heard = Distorted(talks[n].samples, chance.For(0));
      lessons.push_back(
          MakeHeadLesson(talks[n].voice, heard.samples, emotion, plan.sounds, plan.late_ms,
                         [&](double ms) { return truth((ms - heard.start_ms) * heard.speed); }));
    }
    if (n % 20 == 19) progress(fmt::format("{} of {} talks heard", n + 1, talks.size()));
  }
  return Learned(plan, lessons, "synthetic speech and what the face does with its text", progress);
}

vm::Result<std::string> TeachHead(const HeadPlan& plan, const std::string& list,
                                  const Progress& progress) {
  const auto lessons = ReadHeadLessons(list, plan.sounds, plan.late_ms);
  if (!lessons) return std::unexpected(lessons.error());
  return Learned(plan, *lessons, fmt::format("{} recordings", lessons->size()), progress);
}

}  // namespace vdm
