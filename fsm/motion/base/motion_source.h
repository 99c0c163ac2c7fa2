#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/motion/base/face_look.h"
#include "fsm/motion/base/track.h"

namespace fsm {

/// The contribution of one layer of movement to the face at one instant; at rest by default. Its
/// members are as those of FaceState.
struct MotionLayer {
  FaceLook look;  ///< strengths, 1 = full, and the rotation of the eyes
  std::array<float, kMouthParameters> mouth{};
  std::array<float, kMouthParameters> mouth_by_hand{};
  float seal = 0;
  float tongue = 0;
  Sided<float> blink;
  Angles head_rotation{};
  float head_forward_mm = 0;
};

/// The contributions of all sources at one instant: layers, and signals by which Mixer weights them
/// (see tables/mixing.txt). A layer that the table does not name has weight 1. A signal is the
/// greatest of the values given for it, 0 if there are none. Lifetime: names are string literals or
/// outlive this.
class MotionLayers {
 public:
  /// Returns the layer of that name, which is created at rest by the first call. Valid as long as
  /// this object.
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
  std::deque<NamedLayer> layers_;  // a deque: adding a layer keeps references valid
  std::vector<std::pair<std::string_view, double>> signals_;
};

/// A source of movement. Pure in time: the contribution depends only on the commands given and on
/// the instant, so instants may be asked for in any order, from the last command on.
/// Thread: one at a time, const calls included.
class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// Adds the contribution at `t` to layers and signals.
  virtual void Contribute(vm::Time t, MotionLayers& layers) const = 0;
  /// Returns `t` while it moves, else when it will begin to move by itself; none: still until the
  /// next command.
  virtual std::optional<vm::Time> NextMotion(vm::Time t) const {
    std::optional<vm::Time> next;
    ForEachTrack([&](const MoveTimes& track) { next = Earlier(next, track.NextMotion(t)); });
    return next;
  }
  /// Returns when the changes begun by `t` will be complete; `t` if they are.
  virtual vm::Time SettledAt(vm::Time t) const {
    vm::Time settled = t;
    ForEachTrack([&](const MoveTimes& track) { settled = std::max(settled, track.SettledAt(t)); });
    return settled;
  }
  /// Returns when everything that has an end will be over; `t` if nothing has.
  virtual vm::Time EndsAt(vm::Time t) const { return t; }

 protected:
  using TrackVisitor = std::function<void(const MoveTimes&)>;
  /// Calls the visitor for each of the tracks, from which the default implementations above compute
  /// their times.
  virtual void ForEachTrack(const TrackVisitor&) const {}

  MotionSource() = default;
  MotionSource(const MotionSource&) = default;
  MotionSource& operator=(const MotionSource&) = default;
};

}  // namespace fsm
