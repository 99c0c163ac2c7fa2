#include "face_editor/app/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

namespace editor {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void Style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.TabRounding = 4;
  style.WindowBorderSize = 0;
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.WindowPadding = {10, 10};
  style.Colors[ImGuiCol_WindowBg] = {0.13F, 0.14F, 0.15F, 1};
  style.Colors[ImGuiCol_TextDisabled] = {0.62F, 0.64F, 0.66F, 1};
}

/// Key codes of keys that scripts can press; 0 if it is none.
int KeyCode(const std::string& name) {
  if (name.size() == 1 && name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
  constexpr std::pair<const char*, int> kKeys[] = {
      {"left", GLFW_KEY_LEFT},     {"right", GLFW_KEY_RIGHT}, {"up", GLFW_KEY_UP},
      {"down", GLFW_KEY_DOWN},     {"enter", GLFW_KEY_ENTER}, {"escape", GLFW_KEY_ESCAPE},
      {"delete", GLFW_KEY_DELETE}, {"tab", GLFW_KEY_TAB},     {"backspace", GLFW_KEY_BACKSPACE}};
  for (const auto& [word, code] : kKeys) {
    if (name == word) return code;
  }
  return 0;
}

}  // namespace

Window::Window(int width, int height)
    : context_(fsm::RenderContext::MakeWindow(width, height, "Galatea face editor")),
      // The context is current on this thread, so it is its window that is returned.
      window_(glfwGetCurrentContext()),
      gl_(fsm::GlFunctions::Load(*context_)) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // pages are laid out by us
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  std::error_code code;
  if (std::filesystem::exists(kFont, code)) io.Fonts->AddFontFromFileTTF(kFont, 15);
  Style();
  glfwSetWindowUserPointer(window_, this);
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    if (count > 0) static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped = paths[0];
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int pressed, int, int action, int mods) {
    if (action == GLFW_RELEASE || (mods & GLFW_MOD_CONTROL) == 0) return;
    // By what is written on the key where that is known, as on a German keyboard.
    const char* const name = pressed == GLFW_KEY_UNKNOWN ? nullptr : glfwGetKeyName(pressed, 0);
    const char letter = name != nullptr && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0'
                            ? name[0]
                        : pressed >= GLFW_KEY_A && pressed <= GLFW_KEY_Z
                            ? static_cast<char>('a' + (pressed - GLFW_KEY_A))
                            : '\0';
    if (letter != '\0')
      static_cast<Window*>(glfwGetWindowUserPointer(window))
          ->shortcuts_.push_back({letter, (mods & GLFW_MOD_SHIFT) != 0});
  });
  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the callbacks set before, too
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  context_->MakeCurrent();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Window::Wait(double seconds) {
  const double start = glfwGetTime();
  if (seconds <= 0) {
    glfwPollEvents();
    return false;
  }
  glfwWaitEventsTimeout(seconds);
  return glfwGetTime() - start < 0.9 * seconds;
}

void Window::RequestClose(bool close) { glfwSetWindowShouldClose(window_, close ? 1 : 0); }

float Window::scale() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  return width > 0 ? static_cast<float>(context_->width()) / static_cast<float>(width) : 1;
}

void Window::ApplyHand() {
  ImGuiIO& io = ImGui::GetIO();
  if (hand) {
    io.MousePos = {hand->x, hand->y};
    std::copy(std::begin(hand->down), std::end(hand->down), std::begin(io.MouseDown));
    io.MouseWheel = std::exchange(hand->wheel, 0.0F);
  }
  const auto press = [&io](const std::string& keys, bool down) {
    std::size_t at = 0;
    for (std::size_t plus = 0; plus != std::string::npos; at = plus + 1) {
      plus = keys.find('+', at);
      const std::string word = keys.substr(at, plus == std::string::npos ? plus : plus - at);
      if (word == "ctrl") io.KeyCtrl = down;
      if (word == "shift") io.KeyShift = down;
      if (const int code = KeyCode(word); code > 0) io.KeysDown[code] = down;
    }
  };
  if (!held_.empty()) press(held_, false);
  held_ = std::exchange(key, "");
  if (!held_.empty()) press(held_, true);
  if (const std::size_t last = held_.rfind('+'); io.KeyCtrl && last + 2 == held_.size())
    shortcuts_.push_back({held_.back(), io.KeyShift});
  io.AddInputCharactersUTF8(std::exchange(typed, "").c_str());
}

void Window::BeginFrame(float seconds) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ApplyHand();
  ImGui::GetIO().DeltaTime = std::max(seconds, 1e-4F);
  ImGui::NewFrame();
}

void Window::Clear() {
  ImGui::Render();
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.Viewport(0, 0, context_->width(), context_->height());
  gl_.ClearColor(0.13F, 0.14F, 0.15F, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
}

vm::Result<void> Window::EndFrame(const std::string& picture) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  // Read before it is shown: afterwards the buffer may hold anything.
  auto written = picture.empty() ? vm::Result<void>() : Write(picture);
  context_->Present();
  return written;
}

vm::Result<void> Window::Write(const std::string& path) {
  fsm::Image frame{context_->width(), context_->height(), {}};
  const auto row = static_cast<std::size_t>(frame.width) * 4;
  const auto rows = static_cast<std::size_t>(frame.height);
  std::vector<std::uint8_t> upside_down(row * rows);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE, upside_down.data());
  frame.rgba.resize(upside_down.size());
  for (std::size_t y = 0; y < rows; ++y) {
    std::copy_n(&upside_down[(rows - 1 - y) * row], row, &frame.rgba[y * row]);
  }
  for (std::size_t i = 3; i < frame.rgba.size(); i += 4) frame.rgba[i] = 255;
  return fsm::WriteImage(frame, path);
}

unsigned Window::Upload(unsigned texture, const fsm::Image& image) {
  if (texture == 0) gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, image.rgba.data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.BindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

}  // namespace editor
