#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypermask/calibrate/calibrator.h"
#include "hypermask/calibrate/delay_meter.h"
#include "hypermask/follow/mask_follower.h"
#include "hypermask/live/face_stream.h"
#include "hypermask/live/live_pictures.h"
#include "hypermask/live/rig.h"
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
  bool Busy() const override { return meter_ || taker_; }
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  void DeclareRun();
  void DeclareFace();
  void DeclareSettings();
  void DeclareCalibration();
  void DeclareTold();
  vm::Result<void> Start();
  void Stop();
  void Over(const std::optional<vm::Error>& error);
  void ResetFollower();
  void OnPicture(const Grey& picture, vm::Time arrived);
  void Follow(const Grey& picture, vm::Time arrived);
  void TellTrack(std::size_t seen, vm::Time arrived, double ahead_ms);
  void TellSecond(vm::Time now);
  void TellNoMask(vm::Time now);
  bool CalibrationFits(const Grey& picture);
  void MeasureDelay(const vm::Reply& reply);
  void Flash();
  void CancelTimers();
  void EndDelay(const vm::Result<double>& delay);
  void TakePlace(const vm::Reply& reply);
  void NextFrame();
  void EndPlace(const vm::Result<Place>& place);
  vm::Result<void> FinishCalibration(const std::string& file);
  vm::Result<void> OpenFace(const std::string& name);
  vm::Result<void> AskFace(const std::string& module);
  void Show(const fsm::Image& frame);
  void Tell(const std::string& stat);
  double Ms(vm::Time time) const { return static_cast<double>(time.count()) / 1000; }

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;

  // As the slots have it.
  std::string input_ = "NONE", stat_ = "OFF", face_from_ = "NONE";
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
  fsm::Image face_;
  std::unique_ptr<FaceStream> face_stream_;
  std::unique_ptr<LivePictures> face_film_;
  bool misfit_told_ = false, no_mask_told_ = false, ever_seen_ = false;
  std::optional<vm::Time> picture_at_;
  vm::Time mask_at_{0};
  int camera_width_ = 0, camera_height_ = 0;
  double interval_ms_ = 0;  // between pictures, lately
  double work_ms_ = 0;      // from having a picture to having shown the face, lately

  // While the delay is measured or a place is taken; else empty.
  std::optional<DelayMeter> meter_;
  std::optional<DotPattern> pattern_;
  std::optional<PlaceTaker> taker_;
  std::optional<vm::Reply> reply_;
  vm::TimerId timer_ = 0, end_timer_ = 0;  // of the next flash, of the last one
  bool flash_on_ = false;
  std::vector<Place> places_;

  // Of the second that is being counted.
  vm::Time second_{0};
  int pictures_ = 0, seen_ = 0, missed_ = 0;
  double miss_squares_ = 0;
};

}  // namespace hypermask
