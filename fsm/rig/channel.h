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

/// How far something moves a vertex at full strength, millimetres.
struct Displacement {
  std::uint32_t vertex;
  glm::vec3 by;
};

/// A number of a state by which a face moves.
struct Drive {
  enum class Kind : std::uint8_t {
    kUnit,         ///< `number`: of FACS; its strength beside the others (UnitTable::Combine)
    kAskedUnit,    ///< the same as the state has it, 0..2, before units are combined
    kMouth,        ///< `number`: index into Pose::mouth
    kSpokenMouth,  ///< what FaceState::mouth asks beyond FaceState::mouth_by_hand
    kHandMouth,    ///< `number`: index into FaceState::mouth_by_hand
    kBlink,        ///< how far lids close beyond what units ask, 0..1
    kGazeUp,       ///< of an eye, degrees
    kGazeRight     ///< of an eye, to the viewer's right, degrees
  };
  enum class WhichSide : std::uint8_t {
    kRight,
    kLeft,
    kStronger  ///< the greater of both
  };
  enum class Half : std::uint8_t {
    kWhole,
    kPositive,  ///< the value where it is above 0, else 0
    kNegative   ///< what it is below 0, as a positive number, else 0
  };
  static WhichSide OnlyOf(Side one) {
    return one == Side::kRight ? WhichSide::kRight : WhichSide::kLeft;
  }

  Kind kind;
  std::uint16_t number = 0;
  WhichSide side = WhichSide::kRight;  ///< of units, blinks and gazes
  Half half = Half::kWhole;
};

/// Displacements with one common strength: the sum of the drivers, kept within limits and scaled by
/// whether the lips are sealed. Without drivers the sum is 0. Channels add up.
struct Channel {
  struct Driver {
    Drive drive;
    float gain = 1;
  };
  std::vector<Driver> drivers;
  float least = -std::numeric_limits<float>::infinity();  ///< not above `most`
  float most = std::numeric_limits<float>::infinity();
  float open_factor = 1, sealed_factor = 1;  ///< on the strength, while lips are open and sealed
  std::vector<Displacement> moves;

  /// Whether the first driver is of that kind; false without drivers.
  bool IsLedBy(Drive::Kind kind) const {
    return !drivers.empty() && drivers.front().drive.kind == kind;
  }
};

/// The channels of the units' table for vertices of skin with these weights.
std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights);

/// Evaluates each distinct Drive once per state.
class ChannelDrives {
 public:
  explicit ChannelDrives(std::span<const Channel> channels);
  /// Adds the strength of each of the channels it was made of to `out`.
  void FindStrengths(std::span<const Channel> channels, const FaceState& state, const Pose& pose,
                     std::vector<float>& out) const;

 private:
  std::vector<Drive> drives_;
  std::vector<std::uint32_t> driver_from_;  // of each driver of each channel the index of its drive
};

}  // namespace fsm
