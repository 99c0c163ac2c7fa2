#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"
#include "fsm/render/renderer.h"
#include "tests/support/process.h"

/// The real program under Xvfb.
namespace editor_process {

using Millis = support::Millis;
using Process = support::Process;
inline constexpr Millis kLong{120000};  // software drawing on a busy machine

/// A screen in memory for the length of a test. Without -noreset the server resets itself when its
/// last client leaves, and a program that connects meanwhile is cut off.
class Screen {
 public:
  Screen() {
    try {
      server_.emplace(std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0",
                                               "1280x800x24", "-nolisten", "tcp", "-noreset"});
      if (const auto number = server_->ReadLine()) display_ = ":" + *number;
    } catch (const std::exception&) {
    }
  }
  bool ready() const { return !display_.empty(); }
  std::vector<std::string> env() const { return {"DISPLAY=" + display_, "WAYLAND_DISPLAY="}; }

 private:
  std::optional<Process> server_;
  std::string display_;
};

class FaceEditorTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!screen_.ready()) GTEST_SKIP() << "needs Xvfb (Debian: xvfb)";
    folder_ = testing::TempDir() + "face_editor_XXXXXX";
    ASSERT_NE(mkdtemp(folder_.data()), nullptr);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  std::unique_ptr<Process> Start(std::vector<std::string> options) {
    std::vector<std::string> argv{GALATEA_BIN_DIR "/face_editor"};
    if (!finds_faces_) argv.insert(argv.end(), {"--networks", "/nowhere"});
    if (!size_.empty()) argv.insert(argv.end(), {"--size", size_});
    argv.insert(argv.end(), options.begin(), options.end());
    auto env = screen_.env();
    env.push_back("GALATEA_FACES=" + folder_ + "/faces");
    env_ = env;
    return std::make_unique<Process>(argv, Process::Options{folder_, env_});
  }
  /// Runs a script to its end.
  int RunScript(const std::string& script, std::vector<std::string> options = {}) {
    std::ofstream(folder_ + "/script.txt") << script;
    options.insert(options.end(), {"--script", folder_ + "/script.txt"});
    program_ = Start(options);
    program_->CloseInput();
    const auto code = program_->Wait(kLong);
    return code.value_or(-1);
  }
  std::string Output() {
    std::string text;
    for (const std::string& line : program_->ReadAll()) text += line + "\n";
    return text;
  }
  /// A picture drawn of a built-in head: a photo whose face can be found without other people's.
  std::string DrawnPhoto(const std::string& name = "photo.png", float turned_degrees = 0) {
    const auto head = fsm::MakeSymmetricHead("pygmalion");
    fsm::HeadVertices vertices;
    head->Evaluate({}, vertices);
    const auto context = fsm::RenderContext::MakeHeadless(400, 400);
    const auto renderer = fsm::Renderer::Make(*context);
    fsm::Scene scene;
    scene.camera.angle_degrees = turned_degrees;
    renderer->DrawVertices(*head, vertices, {}, scene);
    fsm::Image image;
    renderer->Read(image);
    const std::string path = folder_ + "/" + name;
    EXPECT_TRUE(fsm::WriteImage(image, path));
    return path;
  }
  /// The picture in a file that a script wrote.
  fsm::Image Shot(const std::string& name) {
    const auto image = fsm::ReadImage(folder_ + "/" + name);
    EXPECT_TRUE(image) << (image ? "" : image.error().text);
    return image.value_or(fsm::Image{});
  }
  static glm::vec2 PlaceIn(const std::string& text) {
    std::istringstream words(text.substr(text.find_first_of("0123456789-")));
    glm::vec2 place;
    words >> place.x >> place.y;
    return place;
  }
  /// What a command answers, over stdin.
  std::string Ask(const std::string& command) {
    program_->WriteLine(command);
    std::string answer;
    while (const auto line = program_->ReadLine(kLong)) {
      if (*line == "ok" || *line == "error") return answer;
      answer += *line;
    }
    return "no answer: " + program_->ErrorText();
  }

  /// What a command over stdin that is refused says; "" if it is not.
  std::string Refusal(const std::string& command) {
    const std::size_t said = program_->ErrorText().size();
    program_->WriteLine(command);
    while (const auto line = program_->ReadLine(kLong)) {
      if (*line == "ok") return "";
      if (*line != "error") continue;
      return program_->ErrorText().substr(said);  // written before the answer
    }
    return "";
  }
  /// The program takes what the window system has sent and draws what follows from it. Events are
  /// taken at the end of a frame, seen in the next, and answered by widgets in the one after.
  void TakeEvents() {
    for (int frame = 0; frame < 4; ++frame) Ask("wait 1");
  }

  /// Of the window. Its panels are as wide as ever, so most of a larger one is the head, which a
  /// software driver draws several times for each command; "" = as large as it usually is.
  std::string size_ = "640x480";
  /// Whether the program has the networks if they are there; it looks at its head with them at its
  /// start, which takes half a second.
  bool finds_faces_ = true;
  Screen screen_;
  std::string folder_;
  std::vector<std::string> env_;
  std::unique_ptr<Process> program_;
};

}  // namespace editor_process
