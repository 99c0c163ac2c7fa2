#pragma once

#include <memory>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

struct GLFWwindow;

namespace hypermask {

/// The projector's picture: a window that fills a whole screen, or an ordinary one. Thread: the one
/// that opened it, the program's first. One at a time.
class ProjectorWindow {
 public:
  /// `screen`: 1 = the first one; 0 = a window of `width` x `height` on the desktop. Error:
  /// kUnavailable: no display, no such screen, no OpenGL.
  static vm::Result<std::unique_ptr<ProjectorWindow>> Open(int screen, int width, int height);
  ~ProjectorWindow();
  ProjectorWindow(const ProjectorWindow&) = delete;

  /// Shows it at the screen's next refresh, for which it waits. Error: kUnavailable once somebody
  /// has closed the window (Escape does).
  vm::Result<void> Show(const fsm::Image& frame);
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  ProjectorWindow(GLFWwindow* window, int width, int height);
  GLFWwindow* const window_;
  const int width_, height_;
  unsigned texture_ = 0;
};

}  // namespace hypermask
