#include "vdm/features/sound_features.h"

#include <stdexcept>

#include "vdm/features/cepstra_features.h"
#include "vdm/features/mel_features.h"
#include "vdm/features/phone_features.h"

namespace vdm {

std::string_view FeatureName(FeatureKind kind) {
  return kind == FeatureKind::kMel ? "mel" : kind == FeatureKind::kPhones ? "phones" : "cepstra";
}

std::size_t FeatureSize(FeatureKind kind) {
  return kind == FeatureKind::kMel      ? LevelNormaliser::kSize
         : kind == FeatureKind::kPhones ? PhoneFeatures::kSize
                                        : CepstraFeatures::kOrder;
}

vm::Result<void> CanMakeFeatures(FeatureKind kind) {
  if (kind != FeatureKind::kPhones) return {};
  const auto model = InstalledPhoneModel();
  if (!model) return std::unexpected(model.error());
  if ((*model)->phones().size() != PhoneFeatures::kPhones) {
    return vm::Fail(vm::Errc::kBadValue, std::string(kPhoneModelFolder) + ": " +
                                             std::to_string((*model)->phones().size()) +
                                             " phones found, " +
                                             std::to_string(PhoneFeatures::kPhones) + " expected");
  }
  return {};
}

std::unique_ptr<SoundFeatures> MakeFeatures(FeatureKind kind, float warp) {
  if (auto can = CanMakeFeatures(kind); !can) throw std::runtime_error(can.error().text);
  switch (kind) {
    case FeatureKind::kMel:
      return std::make_unique<MelFeatures>(warp);
    case FeatureKind::kPhones:
      return std::make_unique<PhoneFeatures>(warp, *InstalledPhoneModel());
    case FeatureKind::kCepstra:
      break;
  }
  return std::make_unique<CepstraFeatures>();
}

}  // namespace vdm
