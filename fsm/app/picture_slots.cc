#include "fsm/app/picture_slots.h"

#include <string>

namespace fsm {

PictureSlots::PictureSlots(FsmCore& core)
    : core_(core),
      pictures_(
          core.clock, core.view, [this](vm::Time at) { return core_.DrawAt(at); },
          [this](vm::Time from, vm::Time to) {
            return core_.view.Swings() ||
                   core_.motion->NextMotion(from).value_or(to + vm::Time(1)) <= to;
          },
          [this](const vm::Error& error) { core_.slots.ReportError("Picture.to", error); }) {
  core_.slots.Declare(
      {.name = "Picture.fps",
       .grammar = "<int 1..60>",
       .initial = std::to_string(kPerSecond),
       .help = "Pictures a second of what Picture.to asks for, from its next setting on.",
       .on_set = core_.Command([this](const vm::SetValue& value) {
         per_second_ = static_cast<int>(value.number(0));
       })});
  core_.slots.Declare(
      {.name = "Picture.to",
       .grammar = "NONE | <file>",
       .initial = "NONE",
       .help = "unix:PATH of a socket that somebody listens at: gets pictures of the face with "
               "their times, beside any film (docs/face.md). NONE: no longer.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         if (auto sent = pictures_.SendTo(value.word(0), per_second_); !sent) {
           return std::unexpected(sent.error());
         }
         return value.word(0);
       },
       .on_inq = [this] { return pictures_.to(); },
       .saved = false});
}

}  // namespace fsm
