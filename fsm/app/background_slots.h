#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots of what is behind the agent.
class BackgroundSlots final : public SlotGroup {
 public:
  /// `backgrounds`: names and files of the configuration. `first`: the initial one; if empty, the
  /// first of `backgrounds`, or the plain one. Throws std::runtime_error if `first` cannot be
  /// shown. `core` outlives this.
  BackgroundSlots(FsmCore& core, std::vector<std::pair<std::string, std::string>> backgrounds,
                  const std::string& first);
  void RestoreInitial() override;

 private:
  void Declare();
  vm::Result<void> Set(const std::string& name);
  void StorePlain();  // if the first background could not be shown
  /// Returns the background of a name, a picture file or a colour.
  vm::Result<Background> Find(const std::string& name) const;
  void Show();

  FsmCore& core_;
  std::vector<std::pair<std::string, std::string>> backgrounds_;
  std::string first_;  // the initial background
  Background background_ = kPlainBackground;
  bool enabled_ = true;
};

}  // namespace fsm
