#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/rig/face_state.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// Computes the drivers of a head's shapes when it is baked: given the weights of the
/// shapes in some states, finds gains of numbers of the state that reproduce these weights.
class DriveFit {
 public:
  using Weights = std::vector<float>;  ///< of every shape

  explicit DriveFit(std::size_t shapes) : drivers_(shapes) {}

  /// Adds drivers by a number that both sides have. `weights` returns the weights of the shapes
  /// where that number is `full` on the raised sides (right, left or both), and 0 elsewhere. All
  /// three are reproduced, whether a shape follows one side, the sum of both or the greater of
  /// them.
  void AddSided(const Drive& drive, float full,
                const std::function<Weights(const Sided<bool>& raised)>& weights);
  void Add(std::size_t shape, const Drive& drive, float gain);

  /// Moves out the drivers of every shape.
  std::vector<std::vector<Channel::Driver>> ReleaseDrivers() { return std::move(drivers_); }

 private:
  std::vector<std::vector<Channel::Driver>> drivers_;
};

/// Fits gains from the mouth's parameters to shapes by least squares; raising and lowering a
/// parameter have separate gains. Starts from the gains of AddParameters and changes them as little
/// as possible so that every viseme is reproduced. The change is slightly damped because visemes
/// may be nearly equal.
class MouthFit {
 public:
  using Weights = DriveFit::Weights;

  explicit MouthFit(std::size_t shapes) : gain_(shapes) {}

  /// Sets the gains of each parameter acting alone from `weights`, which returns those of the
  /// shapes in a state. Without this call they are 0.
  void AddParameters(const std::function<Weights(const FaceState&)>& weights);
  void AddViseme(const std::array<float, kMouthParameters>& mouth, Weights weights);
  /// Adds the gains to `fit` as drivers of that kind.
  void AddTo(DriveFit& fit, Drive::Kind kind) const;

 private:
  static constexpr std::size_t kHalves = 2 * kMouthParameters;
  using Halves = std::array<double, kHalves>;  // raised, then lowered, relative to full strength
  static Halves Split(const std::array<float, kMouthParameters>& mouth);

  struct KnownMouth {
    std::array<float, kMouthParameters> mouth;
    Weights weights;
  };
  struct Equations;
  void AddEquation(const KnownMouth& viseme, double importance, Equations& equations) const;

  std::vector<Halves> gain_;  // indexed by shape; of each parameter acting alone
  std::vector<KnownMouth> known_;
};

}  // namespace fsm
