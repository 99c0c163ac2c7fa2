#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "fsm/render/context_switch.h"

namespace fsm {
namespace {

std::string LastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// GLFW is initialized once for all windows; the last window to close terminates it. Windows belong
/// to the main thread.
int open_windows = 0;

void OpenLibrary() {
  if (open_windows == 0 && !glfwInit()) {
    throw std::runtime_error("cannot open a window: " + LastGlfwError());
  }
  ++open_windows;
}

void CloseLibrary() {
  if (--open_windows == 0) glfwTerminate();
}

class WindowContext : public SwitchedContext {
 public:
  WindowContext(int width, int height, const std::string& title) {
    OpenLibrary();
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    // The renderer has its own depth buffer and samples.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_SAMPLES, 0);
    // Some drivers return exactly the version asked for; compute shaders need 4.3.
    for (const int major : {4, 3}) {
      glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
      glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
      window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
      if (window_) break;
    }
    if (!window_) {
      const std::string reason = LastGlfwError();
      CloseLibrary();
      throw std::runtime_error("cannot open a window with OpenGL 3.3: " + reason);
    }
    MakeCurrent();
    // The caller's frame clock sets the pace; waiting here for vertical sync would stall its input.
    glfwSwapInterval(0);
  }
  ~WindowContext() override {
    auto* other = Leave();
    glfwDestroyWindow(window_);
    CloseLibrary();
    Resume(other);
  }
  WindowContext(const WindowContext&) = delete;
  WindowContext& operator=(const WindowContext&) = delete;

  std::string description() const override { return "a window"; }
  void* GetProcAddress(const char* name) override {
    return reinterpret_cast<void*>(glfwGetProcAddress(name));
  }
  int width() const override { return Size().first; }
  int height() const override { return Size().second; }
  bool is_window() const override { return true; }
  void Present() override {
    glfwSwapBuffers(window_);
    glfwPollEvents();
  }
  void SetFullScreen(bool full) override {
    if (full == (glfwGetWindowMonitor(window_) != nullptr)) return;
    if (!full) {
      glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3],
                           GLFW_DONT_CARE);
      return;
    }
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode) return;
    glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
    glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  }
  void Move(int x, int y) override { glfwSetWindowPos(window_, x, y); }
  void Resize(int width, int height) override {
    SetFullScreen(false);
    // GLFW sets the size in screen coordinates, one of which is several pixels on a dense screen.
    const auto [pixels_wide, pixels_high] = Size();
    int wide = 0;
    int high = 0;
    glfwGetWindowSize(window_, &wide, &high);
    glfwSetWindowSize(window_, Scaled(width, wide, pixels_wide), Scaled(height, high, pixels_high));
    glfwPollEvents();
  }
  bool close_requested() const override { return glfwWindowShouldClose(window_) != 0; }

 private:
  void Bind() override { glfwMakeContextCurrent(window_); }
  void Release() override { glfwMakeContextCurrent(nullptr); }

  /// Returns pixels * coordinates / all, but at least 1.
  static int Scaled(int pixels, int coordinates, int all) {
    return std::max(1, static_cast<int>(std::lround(1.0 * pixels * coordinates / all)));
  }

  /// Returns at least 1 x 1: a minimised window has no pixels, but drawing must go on.
  std::pair<int, int> Size() const {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {width > 0 ? width : 1, height > 0 ? height : 1};
  }

  GLFWwindow* window_ = nullptr;
  int windowed_[4] = {};  // position and size before full screen
};

}  // namespace

std::unique_ptr<RenderContext> RenderContext::MakeWindow(int width, int height,
                                                         const std::string& title) {
  return std::make_unique<WindowContext>(width, height, title);
}

}  // namespace fsm
