#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/motion/action_units.h"
#include "fsm/motion/track.h"

namespace fsm {

/// What one layer of movement asks of the face at one instant; at rest when it is made.
struct MotionLayer {
  ActionUnits units;                            ///< 1 = full strength, and where the eyes go
  std::array<float, kMouthParameters> mouth{};  ///< as FaceState::mouth
  std::array<float, kMouthParameters> mouth_by_hand{};  ///< as FaceState::mouth_by_hand
  float seal = 0;                                       ///< of the lips, 0..1
  float tongue = 0;                                     ///< height of its tip, 0..1
  Angles head{};
  float head_forward_mm = 0;
  float lids_shut = 0;  ///< 0..1
};

/// What all sources ask of the face at one instant: layers, and signals by which the mixer weighs
/// them (see tables/mixing.txt). A layer that the table does not name counts in full; a signal that
/// nobody gives is 0, of one that several give the greatest counts. Names are string literals or
/// outlive it.
class MotionLayers {
 public:
  /// The layer of that name, at rest when it is asked for first; valid as long as this.
  MotionLayer& Layer(std::string_view name) {
    const auto found = std::ranges::find(layers_, name, &NamedLayer::first);
    return found != layers_.end() ? found->second
                                  : layers_.emplace_back(name, MotionLayer{}).second;
  }
  void AddSignal(std::string_view signal, double value01) {
    signals_.emplace_back(signal, value01);
  }

  using NamedLayer = std::pair<std::string_view, MotionLayer>;
  const std::deque<NamedLayer>& all() const { return layers_; }
  double Signal(std::string_view name) const {
    double greatest = 0;
    for (const auto& [signal, value01] : signals_) {
      if (signal == name) greatest = std::max(greatest, value01);
    }
    return greatest;
  }

 private:
  std::deque<NamedLayer> layers_;  // which moves none when one is added
  std::vector<std::pair<std::string_view, double>> signals_;
};

/// One source of movement. Pure in time: what it asks follows from the commands it was given and
/// from the instant, so instants may be asked for in any order, from the last command on.
/// Thread: none of its own; not even const calls may run at once.
class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// Adds what it asks at `t` to its layers.
  virtual void Contribute(vm::Time t, MotionLayers& layers) const = 0;
  /// `t` while it moves, else when it will begin to by itself; none = it is still until a command.
  virtual std::optional<vm::Time> NextActivity(vm::Time t) const {
    std::optional<vm::Time> next;
    ForEachTrack([&](const MoveTimes& track) { next = Earlier(next, track.NextActivity(t)); });
    return next;
  }
  /// When the changes begun by `t` will have settled; `t` if they have.
  virtual vm::Time SettledAt(vm::Time t) const {
    vm::Time settled = t;
    ForEachTrack([&](const MoveTimes& track) { settled = std::max(settled, track.SettledAt(t)); });
    return settled;
  }
  /// When everything in it that has an end will be over; `t` if it is.
  virtual vm::Time FiniteEnd(vm::Time t) const { return t; }

 protected:
  using TrackVisitor = std::function<void(const MoveTimes&)>;
  /// Shows the tracks it consists of: they answer for the times above.
  virtual void ForEachTrack(const TrackVisitor&) const {}

  MotionSource() = default;
  MotionSource(const MotionSource&) = default;
  MotionSource& operator=(const MotionSource&) = default;
};

}  // namespace fsm
