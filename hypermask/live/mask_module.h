#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypermask/follow/mask_follower.h"
#include "hypermask/live/face_source.h"
#include "hypermask/live/measurement.h"
#include "hypermask/live/rig.h"
#include "hypermask/live/track_figures.h"
#include "hypermask/project/calibration.h"
#include "hypermask/project/face_warp.h"
#include "vm_protocol/core/module.h"

namespace hypermask {

/// The module that projects the agent's face onto a mask (MASK):
///
///   OFF --Run = START--> LOOKING --a mask--> FOLLOWING --lost--> LOOKING
///                         either --Delay = MEASURE--> MEASURING --> LOOKING
///                         either --Calibrate = PLACE--> CALIBRATING --> LOOKING
///
/// Thread: the scheduler's.
class MaskModule final : public vm::Module {
 public:
  /// What a rig is made of.
  struct RigWish {
    std::string input{};  ///< the slot Input's value
    int screen = -1;      ///< RealRig::Settings::screen
    MaskLayout layout{};
  };
  struct Options {
    std::string module_version{};
    /// Errors: as those of RealRig::Open and SimSettings::Parse.
    std::function<vm::Result<std::unique_ptr<Rig>>(const RigWish& wish, Rig::Events events)> open{};
    boost::asio::io_context* io = nullptr;  ///< of the face's pictures; null: there are none
  };
  /// After so long without a mask it is said once that there is none.
  static constexpr vm::Time kNoMask{3'000'000};

  MaskModule(vm::Scheduler& scheduler, Options options);
  ~MaskModule() override { Shutdown(); }

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return measurement_.Busy(); }
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  void DeclareRun();
  void DeclareMask();
  void DeclareSettings();
  void DeclareCalibration();
  void DeclareTold();
  vm::Result<void> Start();
  void Stop();
  void Over(const std::optional<vm::Error>& error);
  void ResetFollower();
  /// How far ahead of a picture the mask's place is foretold. What is shown between two pictures is
  /// to be right in the middle of that time.
  double AheadMs() const { return delay_ms_ + figures_.work_ms() + figures_.interval_ms() / 2; }
  void OnPicture(const Grey& picture, vm::Time arrived);
  void Follow(const Grey& picture, vm::Time arrived);
  void TellTrack(std::size_t seen, vm::Time arrived);
  void TellNoMask(vm::Time now);
  bool CalibrationFits(const Grey& picture);
  /// Whether camera and projector can be taken for a measurement now; why not is answered.
  bool CanMeasure(const vm::Reply& reply) const;
  void BeginMeasurement(const std::string& stat);
  void EndMeasurement();
  void MeasureDelay(const vm::Reply& reply);
  void TakePlace(const vm::Reply& reply);
  vm::Result<void> FinishCalibration(const std::string& file);
  void SetFace(const fsm::Image& picture);
  void Show(const fsm::Image& frame);
  void Tell(const std::string& stat);

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;

  // As the slots have it.
  std::string input_ = "NONE", stat_ = "OFF";
  int screen_ = -1;
  MaskLayout layout_ = MaskLayout::Default();
  Prediction prediction_ = Prediction::kBank;
  Form form_ = Form::kSpace;
  double delay_ms_ = 100, field_degrees_ = 45;
  SpotSearch spots_{};
  std::optional<Calibration> calibration_;
  bool on_ = false, exit_requested_ = false;

  std::unique_ptr<Rig> rig_;
  std::vector<std::unique_ptr<Rig>> retired_;  // ended by one of their events
  vm::TimerId retire_timer_ = 0;
  unsigned run_ = 0;  // counts rigs, so that a late event of one before is known
  std::optional<MaskFollower> follower_;
  std::optional<FaceWarp> warp_;
  bool misfit_told_ = false, no_mask_told_ = false, ever_seen_ = false;
  vm::Time mask_at_{0};
  int camera_width_ = 0, camera_height_ = 0;
  std::vector<Place> places_;

  FaceSource face_;
  Measurement measurement_;
  TrackFigures figures_;
};

}  // namespace hypermask
