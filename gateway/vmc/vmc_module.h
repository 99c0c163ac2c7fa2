#pragma once

#include <functional>
#include <optional>
#include <string>

#include "gateway/vmc/live_link.h"
#include "gateway/vmc/vmc_bundle.h"
#include "vm_protocol/core/module.h"

namespace gateway {

/// The module VMC: has the face tell it its frames (Frame.to) and sends each to a program that
/// draws an avatar, as one bundle, or as a packet of Live Link. On the real clock the last is sent
/// again each kAgain, so that a program that comes later, or lost one, shows the face as it is.
/// Lifetime: the scheduler outlives it. Thread: the scheduler's.
class VmcModule final : public vm::Module {
 public:
  static constexpr vm::Time kAgain{1'000'000};
  struct Options {
    std::string module_version{};
    std::string to = "127.0.0.1:39539";
    std::string id = "00000000-0000-0000-0000-000000000000";  ///< LiveLinkOptions::id
    std::function<bool()> real{};  ///< whether time passes by itself just now
    /// Where bundles go: checked when it is set. kBadValue says what was found and expected.
    std::function<vm::Result<void>(const std::string& to)> aim{};
    /// Sends one there; what cannot be sent is lost. Returns whether the system took it.
    std::function<bool(const std::string& bundle)> send{};
  };
  VmcModule(vm::Scheduler& scheduler, Options options);
  ~VmcModule() override { Shutdown(); }

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return false; }
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

 private:
  void Declare();
  void AskFace();
  void Send();

  vm::Scheduler& scheduler_;
  const Options options_;
  vm::SlotMachine slots_;
  std::string face_ = "FSM";
  bool sending_ = true;
  VmcOptions bundle_;
  bool live_link_ = false;  ///< Live Link's packets in place of bundles
  std::optional<FaceFrame> last_;
  std::uint64_t sent_ = 0;
  vm::TimerId meet_timer_ = 0, again_timer_ = 0;
  bool exit_requested_ = false;
};

}  // namespace gateway
