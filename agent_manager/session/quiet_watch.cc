#include "agent_manager/session/quiet_watch.h"

#include <memory>
#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"

namespace am {

namespace {

constexpr vm::Time kAskAgain = std::chrono::milliseconds(30);

}  // namespace

QuietWatch::QuietWatch(vm::Scheduler& clock, Hub& hub, std::function<bool()> busy_here)
    : clock_(clock), hub_(hub), busy_here_(std::move(busy_here)) {}

void QuietWatch::Ask() {
  if (quiet_ || asking_) return;
  asking_ = true;
  struct Round {
    std::size_t open;
    bool busy = false;
  };
  auto modules = hub_.clocks().WithClock();
  std::erase_if(modules,
                [this](PeerKey module) { return hub_.directory().RoleOf(module) == Role::kGuest; });
  const auto round = std::make_shared<Round>(Round{modules.size() + 1});
  const auto answered = [this, round](const vm::Result<std::string>& answer) {
    round->busy = round->busy || (answer && *answer == "BUSY");
    if (--round->open > 0) return;
    clock_.After(round->busy ? kAskAgain : vm::Time(0), [this, round] {
      asking_ = false;
      quiet_ = !round->busy && !busy_here_() && hub_.idle();
      Ask();
    });
  };
  for (const PeerKey module : modules)
    hub_.Ask(own_name::kHub, vm::To(hub_.directory().NameOf(module), vm::Inq("Clock.busy")),
             answered);
  answered("IDLE");
}

}  // namespace am
