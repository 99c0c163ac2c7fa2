#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/face/weight_sums.h"
#include "vdm/net/mouth_net.h"
#include "vm_protocol/core/scheduler.h"

namespace gateway {

/// The face at one instant, as the face's slot Frame.to tells it. Degrees: down, to the viewer's
/// right, tilted towards it.
struct FaceFrame {
  vm::Time at{0};  ///< on the face's clock
  std::array<float, vdm::kMouthParameters> mouth{};
  float seal = 0, tongue = 0;
  std::array<float, 3> head{};
  std::array<float, 2> left_eye{}, right_eye{};
  float left_lid = 0, right_lid = 0;         ///< closed by so much, 0 to 1
  static constexpr std::size_t kUnits = 47;  ///< FACS; others are passed over
  std::array<float, 2 * kUnits> units{};     ///< by number, left and right
};
/// Reads `MS NUMBER... UNIT:STRENGTH...`. kBadValue says what was found and expected.
vm::Result<FaceFrame> ParseFaceFrame(std::string_view text);

/// The ways in which VMC's receivers name what moves a face.
enum class VmcNames { kVrm0, kVrm1, kPerfectSync };

/// Tables that make weights of frames. Constant.
class FaceWeights {
 public:
  /// Tables as gateway/tables/ has them: vowels.txt, vrm0.txt, vrm1.txt, face_arkit.txt. kBadValue
  /// "NAME:LINE: ...".
  static vm::Result<FaceWeights> Read(std::string_view vowels, std::string_view vrm0,
                                      std::string_view vrm1, std::string_view arkit);
  /// The tables the program carries.
  static const FaceWeights& Built();

  const std::vector<std::string>& Names(VmcNames names) const { return Sums(names).names; }
  /// Beside the names.
  std::vector<float> Of(const FaceFrame& frame, VmcNames names) const;
  /// Shares of a, i, u, e, o, each from 0 to 1: a mixture of few vowels whose jaw, corners and
  /// protrusion come near the mouth's; less as far as the lips are sealed.
  std::array<float, 5> Vowels(const FaceFrame& frame) const;

 private:
  using Vowel = std::array<float, 3>;  // over the scale of each number
  const WeightSums& Sums(VmcNames names) const { return sums_[static_cast<std::size_t>(names)]; }
  std::array<Vowel, 5> vowels_{};
  std::array<WeightSums, 3> sums_{};
};

}  // namespace gateway
