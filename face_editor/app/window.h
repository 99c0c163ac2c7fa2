#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fsm/image/image_file.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/renderer.h"
#include "vm_protocol/core/result.h"

struct GLFWwindow;

namespace editor {

/// The window with its widgets (Dear ImGui) and its GL context, which is current throughout.
/// Thread: the main one. The constructor throws std::runtime_error if there is no display.
class Window {
 public:
  Window(int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes events, waiting for one at most so long; true if there was one.
  bool Wait(double seconds);
  /// `seconds`: since the frame before, for what blinks and fades.
  void BeginFrame(float seconds);
  /// Everything drawn after this and before EndFrame lies under the widgets.
  void Clear();
  /// Shows the frame, and writes it to `picture` if that is not "". Error: kUnavailable.
  vm::Result<void> EndFrame(const std::string& picture = "");
  bool close_requested() const { return context_->close_requested(); }
  /// As its button does, or takes that back.
  void RequestClose(bool close);

  fsm::RenderContext& context() { return *context_; }
  /// Frame buffer pixels for each unit of the window's coordinates.
  float scale() const;

  /// A picture to draw with ImGui; the old one of that number is replaced. 0 makes a new one.
  unsigned Upload(unsigned texture, const fsm::Image& image);

  /// A hand of its own in place of the mouse: what tests move.
  struct Hand {
    float x = 0, y = 0;
    bool down[3] = {};
    float wheel = 0;  ///< of the next frame
  };
  std::optional<Hand> hand;
  /// A letter pressed with Ctrl, or repeated, lower case.
  struct Shortcut {
    char key = 0;
    bool shift = false;
  };
  /// Those since the last call, in order. Each comes from the event that tells of it: widgets see
  /// only which keys are down when a frame begins, and short presses lie between two frames.
  std::vector<Shortcut> TakeShortcuts() { return std::exchange(shortcuts_, {}); }
  /// A key held during the next frame, as ctrl+z; letters are lower case.
  std::string key;
  /// Text typed in the next frame.
  std::string typed;
  /// The file dropped on the window last, until it is taken.
  std::string dropped;

 private:
  void ApplyHand();
  vm::Result<void> Write(const std::string& path);

  std::unique_ptr<fsm::RenderContext> context_;
  GLFWwindow* window_ = nullptr;
  fsm::GlFunctions gl_;
  std::string held_;
  std::vector<Shortcut> shortcuts_;
};

}  // namespace editor
