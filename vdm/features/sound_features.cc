#include "vdm/features/sound_features.h"

#include <stdexcept>

#include "vdm/features/cepstra_features.h"
#include "vdm/features/mel_features.h"
#include "vdm/features/phone_features.h"
#include "vdm/words/word_features.h"

namespace vdm {

std::string_view FeatureName(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kMel:
      return "mel";
    case FeatureKind::kPhones:
      return "phones";
    case FeatureKind::kCepstra:
      return "cepstra";
    case FeatureKind::kWords:
      break;
  }
  return "words";
}

std::size_t FeatureSize(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kMel:
      return LevelNormaliser::kSize;
    case FeatureKind::kPhones:
      return PhoneFeatures::kSize;
    case FeatureKind::kCepstra:
      return CepstraFeatures::kOrder;
    case FeatureKind::kWords:
      break;
  }
  return WordFeatures::kSize;
}

vm::Result<void> CanMakeFeatures(FeatureKind kind) {
  if (kind != FeatureKind::kPhones && kind != FeatureKind::kWords) return {};
  const auto model = InstalledPhoneModel();
  if (!model) return std::unexpected(model.error());
  if ((*model)->phones().size() != PhoneFeatures::kPhones) {
    return vm::Fail(vm::Errc::kBadValue, std::string(kPhoneModelFolder) + ": " +
                                             std::to_string((*model)->phones().size()) +
                                             " phones found, " +
                                             std::to_string(PhoneFeatures::kPhones) + " expected");
  }
  if (kind == FeatureKind::kWords && !InstalledWordTree()) {
    return std::unexpected(InstalledWordTree().error());
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
      return std::make_unique<CepstraFeatures>();
    case FeatureKind::kWords:
      break;
  }
  return std::make_unique<WordFeatures>(*InstalledWordTree());
}

}  // namespace vdm
