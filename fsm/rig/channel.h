#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/skin_weights.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

struct Pose;

/// How far a channel displaces a vertex at full strength, in millimetres.
struct Displacement {
  std::uint32_t vertex;
  glm::vec3 offset;
};

/// Names a value of a state that drives the face.
struct Drive {
  enum class Kind : std::uint8_t {
    kUnit,           ///< action unit `number`, as it acts (UnitCombiner)
    kCommandedUnit,  ///< action unit `number` as the state has it, 0..2, uncombined
    kMouth,          ///< `number`: index into Pose::mouth
    kSpokenMouth,    ///< the part of FaceState::mouth beyond mouth_by_hand: speech
    kHandMouth,      ///< `number`: index into FaceState::mouth_by_hand
    kBlink,          ///< how far the lids close beyond what action units ask for, 0..1
    kGazeUp,         ///< upward gaze of an eye, degrees
    kGazeRight,      ///< gaze of an eye to the viewer's right, degrees
    kResidual        ///< `number`: index into FaceState::residuals
  };
  enum class WhichSide : std::uint8_t {
    kRight,
    kLeft,
    kStronger  ///< the greater of both sides
  };
  enum class Half : std::uint8_t {
    kWhole,
    kPositive,  ///< the value where it is above 0, else 0
    kNegative   ///< the absolute value where it is below 0, else 0
  };
  static WhichSide OnlyOf(Side one) {
    return one == Side::kRight ? WhichSide::kRight : WhichSide::kLeft;
  }

  Kind kind;
  std::uint16_t number = 0;
  WhichSide side = WhichSide::kRight;  ///< used by units, blinks and gazes
  Half half = Half::kWhole;
};

/// A blend shape: displacements that share one strength. The strength is the sum over the drivers
/// (0 without drivers), clamped, then scaled by whether the lips are sealed. Channels add up.
struct Channel {
  struct Driver {
    Drive drive;
    float gain = 1;
  };
  std::vector<Driver> drivers;
  float min = -std::numeric_limits<float>::infinity();  ///< must not exceed `max`
  float max = std::numeric_limits<float>::infinity();
  float open_factor = 1, sealed_factor = 1;  ///< on the strength, for open and for sealed lips
  std::vector<Displacement> moves;

  /// Tells whether the first driver is of that kind; false without drivers.
  bool IsLedBy(Drive::Kind kind) const {
    return !drivers.empty() && drivers.front().drive.kind == kind;
  }
};

/// Makes the channels of the action units for skin vertices with these weights.
std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights);

/// Evaluates each distinct Drive once per state.
class ChannelStrengths {
 public:
  explicit ChannelStrengths(std::span<const Channel> channels);
  /// Appends to `out` one strength for each of `channels`, the ones given to the constructor.
  void ComputeStrengths(std::span<const Channel> channels, const FaceState& state, const Pose& pose,
                        std::vector<float>& out) const;

 private:
  std::vector<Drive> drives_;
  std::vector<std::uint32_t> driver_from_;  // drive index by channel and driver
};

}  // namespace fsm
