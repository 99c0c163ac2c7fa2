#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define FSM_LEAK_CHECK 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define FSM_LEAK_CHECK 1
#endif
#ifdef FSM_LEAK_CHECK
#include <sanitizer/lsan_interface.h>
#endif

#include "tests/fsm/ball_head.h"
#include "tests/fsm/render_support.h"

extern "C" char** environ;

namespace fsm {
namespace {

/// A screen in memory (Xvfb) for the length of a test; it tells its number when it is ready.
class VirtualScreen {
 public:
  VirtualScreen() {
    int ends[2];
    if (pipe(ends) != 0) return;
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    std::string number = std::to_string(ends[1]);
    std::string words[] = {"Xvfb", "-displayfd", number,      "-screen",
                           "0",    "800x600x24", "-terminate"};
    char* argv[8] = {};
    for (int i = 0; i < 7; ++i) argv[i] = words[i].data();
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    // Should the test die, nobody waits for the end of an output this server still holds.
    posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", O_WRONLY, 0);
    if (posix_spawnp(&pid_, argv[0], &quiet, nullptr, argv, environ) != 0) pid_ = 0;
    posix_spawn_file_actions_destroy(&quiet);
    close(ends[1]);
    char digit = 0;
    std::string display;
    while (read(ends[0], &digit, 1) == 1 && digit != '\n') display += digit;
    close(ends[0]);
    if (display.empty()) return;
    setenv("DISPLAY", (":" + display).c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    ready_ = true;
  }
  ~VirtualScreen() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
    unsetenv("DISPLAY");
  }
  bool ready() const { return ready_; }

 private:
  pid_t pid_ = 0;
  bool ready_ = false;
};

TEST(WindowTest, WindowAndHeadlessContextInOneProcessShowTheSamePicture) {
  const VirtualScreen screen;
  if (!screen.ready()) GTEST_SKIP() << "needs Xvfb (Debian: xvfb)";
#ifdef FSM_LEAK_CHECK
  // The window system's driver is unloaded with what it forgot, so that no name is left for a
  // suppression to match.
  const __lsan::ScopedDisabler the_drivers_leaks_are_not_ours;
#endif
  BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  Image in_window;
  Image off_screen;

  auto window = RenderContext::MakeWindow(320, 240, "test");
  EXPECT_TRUE(window->is_window());
  EXPECT_FALSE(window->close_requested());
  ASSERT_EQ(window->width(), 320);
  ASSERT_EQ(window->height(), 240);
  auto window_renderer = Renderer::Make(*window);
  auto headless = RenderContext::MakeHeadless(320, 240);
  auto headless_renderer = Renderer::Make(*headless);

  for (int turn = 0; turn < 2; ++turn) {
    window->MakeCurrent();
    window_renderer->Draw(head, vertices, {}, {});
    window->Present();
    window_renderer->Read(in_window);
    headless->MakeCurrent();
    headless_renderer->Draw(head, vertices, {}, {});
    headless_renderer->Read(off_screen);
  }
  // Drivers may round differently; more than that would be a different picture.
  ASSERT_EQ(in_window.rgba.size(), off_screen.rgba.size());
  int different = 0;
  for (std::size_t i = 0; i < off_screen.rgba.size(); ++i) {
    different += std::abs(in_window.rgba[i] - off_screen.rgba[i]) > 3;
  }
  EXPECT_LT(different, 200);
  headless_renderer.reset();
  headless.reset();
  window->MakeCurrent();
  window_renderer.reset();
}

}  // namespace
}  // namespace fsm
