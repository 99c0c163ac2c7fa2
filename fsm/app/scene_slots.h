#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fsm/app/fsm_core.h"

namespace fsm {

/// What is around the face: backgrounds, the way it is drawn, camera and lamps, the size of the
/// view, and single pictures of it (SaveImage).
class SceneSlots final : public ModulePart {
 public:
  /// `backgrounds`: names and files of the configuration; its first, or else the plain one, is
  /// shown at the start where `first` is empty. Throws std::runtime_error where `first` cannot be
  /// shown. `core` outlives this.
  SceneSlots(FsmCore& core, std::vector<std::pair<std::string, std::string>> backgrounds,
             const std::string& first);
  void Reset() override;
  /// The size cannot be changed while this says so (a film is recorded).
  void set_size_locked(std::function<bool()> locked) { size_locked_ = std::move(locked); }

 private:
  Scene FirstScene() const;  // with the original's measures and colours where they are asked for
  void DeclareBackgrounds();
  void DeclareView();
  void DeclareCamera();
  void DeclareLight(const std::string& name, const std::string& what,
                    DirectionalLight Scene::*lamp);
  void DeclareSaveImage();
  vm::Result<void> SetBackground(const std::string& name);
  void StorePlain();  // where the first background could not be shown
  void ShowBackground(bool transparent);
  vm::Result<void> FillScreen(bool fill);
  vm::Result<void> ResetSize();

  FsmCore& core_;
  std::vector<std::pair<std::string, std::string>> backgrounds_;
  std::string first_;  // shown at the start

  bool transparent_ = false;
  bool background_enabled_ = true;
  int start_width_, start_height_;  // of the view
  bool fills_screen_ = false;
  std::function<bool()> size_locked_;
};

}  // namespace fsm
