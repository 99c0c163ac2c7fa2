#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "vdm/features/sound_features.h"
#include "vdm/net/time_delay_net.h"
#include "vm_protocol/core/result.h"

namespace vdm {

inline constexpr std::size_t kMouthParameters = 17;
/// The mouth parameters and the height of the tongue's tip.
inline constexpr std::size_t kShapeNumbers = kMouthParameters + 1;

/// What turns a sound's features into a mouth: a network and what its outputs mean. The outputs
/// are, in this order: the shape, each number less its mean and over its scale; the logit of closed
/// lips; a logit for each sound (their softmax is how likely each is). A plain value.
struct MouthNet {
  FeatureKind features = FeatureKind::kMel;
  std::array<float, kShapeNumbers> means{};
  std::array<float, kShapeNumbers> scales{};
  std::vector<std::string> sounds{};  ///< names of the classes of sounds
  TimeDelayNet net{};

  std::size_t closure_row() const { return kShapeNumbers; }
  std::size_t first_sound_row() const { return kShapeNumbers + 1; }
};

/// The text of a network. Lines: words between blanks, `#` begins a comment.
///
///   features mel|phones|cepstra|words
///   sounds NAME...
///   means NUMBER x 18              mouth parameters and tongue
///   scales NUMBER x 18
///   layer INPUTS OUTPUTS relu|linear OFFSET...
///   row BIAS SCALE WEIGHTS         OUTPUTS of them; WEIGHTS is the base64 of a signed byte for
///   each
///                                  weight, which is SCALE * byte, -127 <= byte <= 127
///
/// Limits: 4 MiB, 8 layers, 16 offsets within +-64, 1024 numbers in a vector, 64 sounds. Errors:
/// kBadValue "NAME:LINE: ..." saying what was found and expected.
vm::Result<MouthNet> ParseMouthNet(const std::string& name, std::string_view text);
/// The reverse. Weights are rounded to 8 bits a row; ParseMouthNet(FormatMouthNet(n)) formats to
/// the same text.
std::string FormatMouthNet(const MouthNet& net);

/// The networks the program carries, trained on all voices (docs/vdm.md).
const MouthNet& ShippedNet(FeatureKind features);

}  // namespace vdm
