#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
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

#include "fsm/render/gl_functions.h"
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
#ifdef FSM_LEAK_CHECK
  // The window system's driver is unloaded with what it forgot, so that no name is left for a
  // suppression to match.
  const __lsan::ScopedDisabler the_drivers_leaks_are_not_ours_;
#endif
};

/// How many bytes of two pictures differ. Drivers may round differently; more than that would be a
/// different picture.
int DifferingBytes(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
    count += std::abs(a.rgba[i] - b.rgba[i]) > 3;
  }
  return count;
}

TEST(WindowTest, WindowAndHeadlessContextInOneProcessShowTheSamePicture) {
  const VirtualScreen screen;
  if (!screen.ready()) GTEST_SKIP() << "needs Xvfb (Debian: xvfb)";
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
    window_renderer->DrawVertices(head, vertices, {}, {});
    window->Present();
    window_renderer->Read(in_window);
    headless->MakeCurrent();
    headless_renderer->DrawVertices(head, vertices, {}, {});
    headless_renderer->Read(off_screen);
  }
  EXPECT_LT(DifferingBytes(in_window, off_screen), 200);
  headless_renderer.reset();
  headless.reset();
  window->MakeCurrent();
  window_renderer.reset();
}

TEST(WindowTest, SeveralFacesShareAWindow) {
  const VirtualScreen screen;
  if (!screen.ready()) GTEST_SKIP() << "needs Xvfb (Debian: xvfb)";
  const auto context = RenderContext::MakeWindow(64, 64, "test");
  BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  Scene left_scene, right_scene;
  left_scene.background = glm::vec3(1, 0, 0);
  right_scene.background = glm::vec3(0, 0, 1);
  auto left = Renderer::Make(*context);
  auto right = Renderer::Make(*context);
  left->SetViewport({0, 0, 32, 40});
  right->SetViewport({32, 24, 32, 40});
  FaceState turned;
  turned.head_rotation = {0, 30, 0};
  Image shared;
  for (int i = 0; i < 2; ++i) {
    left->DrawVertices(head, vertices, {}, left_scene);
    right->DrawVertices(head, vertices, turned.figure, right_scene);
  }
  right->Read(shared);

  Image window{64, 64, std::vector<std::uint8_t>(64 * 64 * 4)};
  const auto gl = GlFunctions::Load(*context);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  gl.ReadPixels(0, 0, 64, 64, GL_RGBA, GL_UNSIGNED_BYTE, window.rgba.data());
  // GL's first row is the lowest.
  using Rgba = std::array<int, 4>;
  const auto shown = [&window](int x, int y) {
    const std::uint8_t* p = &window.rgba[4 * window.Index(x, 63 - y)];
    return Rgba{p[0], p[1], p[2], p[3]};
  };
  EXPECT_EQ(shown(1, 1), (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(shown(30, 1), (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(shown(33, 25), (Rgba{0, 0, 255, 255}));
  EXPECT_EQ(shown(62, 25), (Rgba{0, 0, 255, 255}));
  EXPECT_NE(shown(33, 22), (Rgba{0, 0, 255, 255}));  // above the right pane
  EXPECT_NE(shown(16, 20), (Rgba{255, 0, 0, 255}));  // the left face

  auto alone_context = RenderContext::MakeHeadless(32, 40);
  auto alone = Renderer::Make(*alone_context);
  Image image;
  alone->DrawVertices(head, vertices, turned.figure, right_scene);
  alone->Read(image);
  EXPECT_LT(DifferingBytes(shared, image), 20);
  alone.reset();
  context->MakeCurrent();
}

}  // namespace
}  // namespace fsm
