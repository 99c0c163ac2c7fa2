#include "hypermask/live/projector_window.h"

#include <fmt/format.h>
#define GLFW_INCLUDE_GLEXT
#include <GLFW/glfw3.h>

namespace hypermask {
namespace {

std::unexpected<vm::Error> Unavailable(const std::string& what) {
  const char* why = nullptr;
  glfwGetError(&why);
  return vm::Fail(vm::Errc::kUnavailable, what + (why ? fmt::format(" ({})", why) : ""));
}

}  // namespace

vm::Result<std::unique_ptr<ProjectorWindow>> ProjectorWindow::Open(int screen, int width,
                                                                   int height) {
  if (glfwInit() != GLFW_TRUE) return Unavailable("there is no display to project on");
  GLFWmonitor* monitor = nullptr;
  if (screen > 0) {
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    if (screen > count) {
      glfwTerminate();
      return vm::Fail(vm::Errc::kUnavailable,
                      fmt::format("there is no screen {}, there are {}", screen, count));
    }
    monitor = monitors[screen - 1];
    const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
    width = mode->width;
    height = mode->height;
    glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // it stays when another window is used
  }
  glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
  GLFWwindow* const window = glfwCreateWindow(width, height, "Galatea hypermask", monitor, nullptr);
  if (!window) {
    auto failed = Unavailable("no window can be opened to project in");
    glfwTerminate();
    return failed;
  }
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
  if (monitor) glfwSetInputMode(window, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
  return std::unique_ptr<ProjectorWindow>(new ProjectorWindow(window, width, height));
}

ProjectorWindow::ProjectorWindow(GLFWwindow* window, int width, int height)
    : window_(window), width_(width), height_(height) {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glEnable(GL_TEXTURE_2D);
}

ProjectorWindow::~ProjectorWindow() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

vm::Result<void> ProjectorWindow::Show(const fsm::Image& frame) {
  glfwPollEvents();
  if (glfwGetKey(window_, GLFW_KEY_ESCAPE) == GLFW_PRESS || glfwWindowShouldClose(window_)) {
    return vm::Fail(vm::Errc::kUnavailable, "the projector's window was closed");
  }
  glfwMakeContextCurrent(window_);
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  glViewport(0, 0, width, height);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE,
                  frame.rgba.data());
  glBegin(GL_TRIANGLE_STRIP);
  for (const auto& [x, y] : {std::pair{-1, 1}, {-1, -1}, {1, 1}, {1, -1}}) {
    glTexCoord2i((x + 1) / 2, (1 - y) / 2);
    glVertex2i(x, y);
  }
  glEnd();
  glfwSwapBuffers(window_);
  return {};
}

}  // namespace hypermask
