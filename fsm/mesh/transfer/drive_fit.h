#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// Finds, while a head is baked, by which numbers of a state each of its targets (shapes) is
/// driven: the targets' weights in some states are given, and drivers that say the same are made of
/// them.
class DriveFit {
 public:
  using Weights = std::vector<float>;  ///< of every target

  explicit DriveFit(std::size_t targets) : drivers_(targets) {}

  /// A number that both sides have. `weights` says what the targets are where it is `full` on the
  /// right side, on the left, or on both, and 0 elsewhere; all three are met, whether a target goes
  /// with one side, with the sum of both or with the stronger one.
  void AddSided(const Drive& drive, float full,
                const std::function<Weights(bool right, bool left)>& weights);
  void Add(std::size_t target, const Drive& drive, float gain);

  /// The drivers of every target; they are moved out.
  std::vector<std::vector<Channel::Driver>> TakeDrivers() { return std::move(drivers_); }

 private:
  std::vector<std::vector<Channel::Driver>> drivers_;
};

/// Least-squares gains from the mouth's parameters, raised and lowered apart, to targets. Starts
/// from the answers of AddParameters and changes them as little as possible so that every viseme is
/// reproduced. The change is slightly damped because visemes may be nearly the same.
class MouthFit {
 public:
  using Weights = DriveFit::Weights;

  explicit MouthFit(std::size_t targets) : gain_(targets) {}

  /// What each parameter asks by itself; without this, nothing.
  void AddParameters(const std::function<Weights(const FaceState&)>& weights);
  void AddViseme(const std::array<float, kMouthParameters>& mouth, Weights weights);
  /// `kind`: by which drive the parameters come.
  void AddTo(DriveFit& fit, Drive::Kind kind) const;

 private:
  static constexpr std::size_t kHalves = 2 * kMouthParameters;
  using Halves = std::array<double, kHalves>;  // raised, then lowered, in parts of full strength
  static Halves Split(const std::array<float, kMouthParameters>& mouth);

  struct KnownMouth {
    std::array<float, kMouthParameters> mouth;
    Weights weights;
  };
  struct Equations;
  void Demand(const KnownMouth& viseme, double importance, Equations& equations) const;

  std::vector<Halves> gain_;  // by target, as each parameter asks by itself
  std::vector<KnownMouth> known_;
};

}  // namespace fsm
