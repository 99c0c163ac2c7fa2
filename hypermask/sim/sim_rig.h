#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "hypermask/live/rig.h"
#include "hypermask/sim/movement.h"
#include "hypermask/sim/stage.h"

namespace hypermask {

/// What of the simulated stage may be chosen.
struct SimSettings {
  Movement::Kind movement = Movement::Kind::kSway;
  std::uint32_t seed = 1;
  double delay_ms = 100;  ///< of the whole chain, half of it before the program and half behind
  double rate = 60;       ///< pictures of the camera and of the projector a second
  /// Each so many seconds the upper left marker is covered for half a second, and then all; 0: not.
  double cover_each_s = 0;

  /// "MOVEMENT [delay=MS] [seed=N] [rate=HZ] [cover=SECONDS]". Error: kBadValue.
  static vm::Result<SimSettings> Parse(const std::string& text);
};

/// A bit for each marker that is covered at that time.
unsigned CoveredMarkers(const SimSettings& settings, double seconds);

/// A camera and a projector on the simulated stage. All its time is the scheduler's, so that on a
/// virtual clock every run is the same. Limits: kMostFrames frames are on their way.
class SimRig final : public Rig {
 public:
  static constexpr std::size_t kMostFrames = 128;

  SimRig(vm::Scheduler& scheduler, const MaskLayout& layout, const SimSettings& settings,
         Events events);
  ~SimRig() override;
  vm::Result<void> Show(const fsm::Image& frame) override;
  int projector_width() const override { return stage_.projector.lens.width; }
  int projector_height() const override { return stage_.projector.lens.height; }
  void TakeFilterOff(bool off) override { filter_off_ = off; }
  std::optional<double> Miss(const PlaneMap& map, double shown_s) const override;

 private:
  struct Shown {
    vm::Time from;
    fsm::Image frame;
  };
  /// Seconds on the movement's own clock.
  double SecondsAt(vm::Time time) const;
  void Expose();
  /// What is lit now; null: nothing yet.
  const fsm::Image* Lit();

  vm::Scheduler& scheduler_;
  const SimSettings settings_;
  const Events events_;
  Stage stage_;
  const StageCamera camera_;
  const Movement movement_;
  const vm::Time begun_, camera_delay_, projector_delay_;
  bool filter_off_ = false;
  std::uint32_t pictures_ = 0;
  std::deque<Shown> shown_;
  std::deque<std::pair<vm::TimerId, Grey>> arriving_;  // oldest first
  vm::TimerId timer_ = 0;
};

}  // namespace hypermask
