#include "ssm/voice/layered_engine.h"

#include <utility>

#include "ssm/voice/layers.h"

namespace ssm {
namespace {

/// A plan of the engine below whose sound is changed.
struct LayeredDetail : SpeechPlan::Detail {
  SpeechPlan plan;
  std::vector<SoundPart> parts;
};

}  // namespace

bool LayeredEngine::Prompt(const std::vector<SpeechSpan>& spans) const {
  return engine_->Prompt(PartLayers(spans).spans);
}

vm::Result<SpeechPlan> LayeredEngine::Plan(const std::vector<SpeechSpan>& spans,
                                           const std::atomic<bool>& cancelled) {
  const Layers layers = PartLayers(spans);
  auto plan = engine_->Plan(layers.spans, cancelled);
  if (!plan) return plan;
  auto detail = std::make_shared<LayeredDetail>();
  SpeechPlan whole = LayOver(layers, *plan, detail->parts);
  if (!detail->parts.empty()) {
    detail->plan = std::move(*plan);
    whole.detail = std::move(detail);
  }
  return whole;
}

vm::Result<void> LayeredEngine::Render(const SpeechPlan& plan, SampleBuffer& samples) {
  const auto* detail = dynamic_cast<const LayeredDetail*>(plan.detail.get());
  if (detail == nullptr) return engine_->Render(plan, samples);
  SampleBuffer own(ToFrames(vm::TotalDuration(detail->plan.phonemes)));
  if (auto made = engine_->Render(detail->plan, own); !made) return made;
  if (samples.cancelled()) return vm::Fail(vm::Errc::kStopped, "stopped while sound was made");
  samples.Append(MakeSound(own.Ready(), detail->parts));
  samples.Finish();
  return {};
}

}  // namespace ssm
