#pragma once

#include <memory>
#include <string>

#include "hypermask/live/live_pictures.h"
#include "hypermask/live/projector_window.h"
#include "hypermask/live/rig.h"

namespace hypermask {

/// A camera that ffmpeg reads, or a film of one, and a screen; without a window nothing is shown
/// but all else is done. Thread: see Rig.
class RealRig final : public Rig {
 public:
  struct Settings {
    std::string camera{};            ///< as facetrack::OpenPictures takes it
    int screen = -1;                 ///< as ProjectorWindow::Open; -1: none
    int width = 1280, height = 720;  ///< of a window, or of what nobody sees
  };
  /// Errors: those of facetrack::OpenPictures and ProjectorWindow::Open.
  static vm::Result<std::unique_ptr<Rig>> Open(boost::asio::io_context& io,
                                               vm::Scheduler& scheduler, const Settings& settings,
                                               Events events);
  vm::Result<void> Show(const fsm::Image& frame) override;
  int projector_width() const override { return window_ ? window_->width() : settings_.width; }
  int projector_height() const override { return window_ ? window_->height() : settings_.height; }

 private:
  RealRig(vm::Scheduler& scheduler, Settings settings, Events events)
      : scheduler_(scheduler), settings_(std::move(settings)), events_(std::move(events)) {}
  vm::Scheduler& scheduler_;
  const Settings settings_;
  const Events events_;
  Grey grey_;
  std::unique_ptr<ProjectorWindow> window_;
  std::unique_ptr<LivePictures> camera_;  // last: its events use the rest
};

}  // namespace hypermask
