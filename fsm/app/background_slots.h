#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots of what is behind the agent.
class BackgroundSlots final : public Activity {
 public:
  /// `backgrounds`: names and files of the configuration. `first`: the initial one; if empty, the
  /// first of `backgrounds`, or the plain one. Throws std::runtime_error if `first` cannot be
  /// shown. `core` outlives this.
  BackgroundSlots(FsmCore& core, std::vector<std::pair<std::string, std::string>> backgrounds,
                  const std::string& first);
  void Reset() override;

 private:
  void Declare();
  vm::Result<void> Set(const std::string& name);
  void StorePlain();  // if the first background could not be shown
  void Show(bool transparent);

  FsmCore& core_;
  std::vector<std::pair<std::string, std::string>> backgrounds_;
  std::string first_;  // the initial background
  bool transparent_ = false;
  bool enabled_ = true;
};

}  // namespace fsm
