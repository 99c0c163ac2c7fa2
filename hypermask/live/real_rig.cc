#include "hypermask/live/real_rig.h"

#include <chrono>
#include <utility>

namespace hypermask {

vm::Result<std::unique_ptr<Rig>> RealRig::Open(boost::asio::io_context& io,
                                               vm::Scheduler& scheduler, const Settings& settings,
                                               Events events) {
  constexpr double kFolderRate = 25;
  auto source = facetrack::OpenPictures(settings.camera, kFolderRate);
  if (!source) return std::unexpected(source.error());
  std::unique_ptr<RealRig> rig(new RealRig(scheduler, settings, std::move(events)));
  if (settings.screen >= 0) {
    auto window = ProjectorWindow::Open(settings.screen, settings.width, settings.height);
    if (!window) return std::unexpected(window.error());
    rig->window_ = std::move(*window);
  }
  RealRig& here = *rig;
  rig->camera_ = std::make_unique<LivePictures>(
      io, std::move(*source), facetrack::IsLive(settings.camera),
      LivePictures::Events{
          .picture =
              [&here](const fsm::Image& picture, LivePictures::Clock::time_point arrived) {
                ToGrey(picture, here.grey_);
                const auto ago =
                    std::chrono::duration_cast<vm::Time>(LivePictures::Clock::now() - arrived);
                here.events_.picture(here.grey_, here.scheduler_.Now() - ago);
              },
          .over = [&here](const std::optional<vm::Error>& error) { here.events_.over(error); }});
  return rig;
}

vm::Result<void> RealRig::Show(const fsm::Image& frame) {
  return window_ ? window_->Show(frame) : vm::Result<void>{};
}

}  // namespace hypermask
