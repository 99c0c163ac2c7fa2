#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// The slots of backgrounds, drawing style, camera, lamps, size of the view, and SaveImage.
class SceneSlots final : public ModulePart {
 public:
  /// `backgrounds`: names and files of the configuration. `first`: the initial one; if empty, the
  /// first of `backgrounds`, or the plain one. Throws std::runtime_error if `first` cannot be
  /// shown. `core` outlives this.
  SceneSlots(FsmCore& core, std::vector<std::pair<std::string, std::string>> backgrounds,
             const std::string& first);
  void Reset() override;

 private:
  Scene FirstScene() const;  // with the original's measures and colours if FsmCore::original
  void DeclareBackgrounds();
  void DeclareView();
  void DeclareCamera();
  void DeclareLight(const std::string& name, const std::string& what,
                    DirectionalLight Scene::*lamp);
  void DeclareSaveImage();
  vm::Result<void> SetBackground(const std::string& name);
  void StorePlain();  // if the first background could not be shown
  void ShowBackground(bool transparent);
  vm::Result<void> FillScreen(bool fill);
  vm::Result<void> ResetSize();

  FsmCore& core_;
  std::vector<std::pair<std::string, std::string>> backgrounds_;
  std::string first_;  // the initial background

  bool transparent_ = false;
  bool background_enabled_ = true;
  int start_width_, start_height_;  // of the view
  bool fills_screen_ = false;
};

}  // namespace fsm
