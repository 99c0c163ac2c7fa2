#include "vdm/features/sound_features.h"

#include "vdm/features/cepstra_features.h"
#include "vdm/features/mel_features.h"

namespace vdm {

std::string_view FeatureName(FeatureKind kind) {
  return kind == FeatureKind::kMel ? "mel" : "cepstra";
}

std::unique_ptr<SoundFeatures> MakeFeatures(FeatureKind kind, float warp) {
  if (kind == FeatureKind::kMel) return std::make_unique<MelFeatures>(warp);
  return std::make_unique<CepstraFeatures>();
}

}  // namespace vdm
