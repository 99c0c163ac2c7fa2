#pragma once

#include <array>
#include <string>
#include <string_view>

#include "vdm/net/time_delay_net.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// Where the head is turned and how far the brows are raised.
struct HeadPose {
  /// Degrees: down, to the viewer's right, tilt to the viewer's right.
  std::array<float, 3> angles{};
  float brow = 0;  ///< strength of AU 1 and 2, 0 .. 1

  bool operator==(const HeadPose&) const = default;
};

/// What moves a head by the prosody of a voice: a network of three layers (S. Kawamoto, T.
/// Yotsukura, S. Morishima, S. Nakamura, Automatic head-movement control for emotional speech,
/// SIGGRAPH 2006 posters). Its 34 inputs are, in this order: of this instant and ten before it,
/// kApart hops of 10 ms apart, the newest first, the pitch, the power and the position in the
/// phrase; then the factor of emotion, 0 calm to 1 lively. Its four outputs are down, right, tilt
/// and brow, each less its mean and over its scale. A plain value.
struct HeadNet {
  static constexpr std::size_t kInstants = 11, kApart = 2;
  /// Numbers of one instant, and of all: with no sounds the papers' 34.
  static constexpr std::size_t InstantSize(std::size_t sounds) { return 3 + sounds; }
  static constexpr std::size_t Inputs(std::size_t sounds) {
    return kInstants * InstantSize(sounds) + 1;
  }
  static constexpr std::size_t kOutputs = 4;

  std::size_t sounds = 0;  ///< classes of sounds of the mouth's network it hears of; 0: none
  std::array<float, kOutputs> means{};
  std::array<float, kOutputs> scales{};
  /// Deviations of a pose of the head that each phrase has by chance: down, right, tilt, degrees.
  std::array<float, 3> pose{};
  TimeDelayNet net{};
};

/// The text of such a network. Lines: words between blanks, `#` begins a comment.
///
///   sounds COUNT
///   means NUMBER x 4
///   scales NUMBER x 4
///   pose NUMBER x 3
///   layer INPUTS OUTPUTS relu|linear
///   row BIAS WEIGHT...               OUTPUTS of them
///
/// Limits: 1 MiB, 4 layers of 1024 units. Errors: kBadValue "NAME:LINE: ...".
vm::Result<HeadNet> ParseHeadNet(const std::string& name, std::string_view text);
/// The reverse, with six digits.
std::string FormatHeadNet(const HeadNet& net);

/// The networks the program carries (docs/vdm.md says what they learned from): by prosody and
/// sounds, and by prosody alone, the papers'.
const HeadNet& ShippedHeadNet(bool by_prosody_alone);

}  // namespace vdm
