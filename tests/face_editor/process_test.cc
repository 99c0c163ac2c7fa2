// The real program under Xvfb: by script, and by a mouse that the window system moves.

#include <cmath>

#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/network/face_networks.h"
#include "fsm/head/photo_head.h"
#include "fsm/image/image_file.h"
#include "tests/face_editor/editor_process.h"

namespace {

using namespace editor_process;

TEST_F(FaceEditorTest, VersionAndHelpNeedNoScreen) {
  Process version({GALATEA_BIN_DIR "/face_editor", "--version"});
  EXPECT_TRUE(version.Expect("face_editor (Galatea) "));
  EXPECT_EQ(version.Wait(), 0);
  Process help({GALATEA_BIN_DIR "/face_editor", "--help"});
  EXPECT_TRUE(help.Expect("--script"));
  EXPECT_EQ(help.Wait(), 0);
}

TEST_F(FaceEditorTest, WithoutAScreenOneSentenceSaysSo) {
  Process program({GALATEA_BIN_DIR "/face_editor"}, {"", {"DISPLAY=:7777", "WAYLAND_DISPLAY="}});
  EXPECT_EQ(program.Wait(kLong), 1);
  EXPECT_NE(program.ErrorText().find("face_editor: cannot open a window"), std::string::npos)
      << program.ErrorText();
}

TEST_F(FaceEditorTest, TheMousePostedMovesAPointAndUndoBringsItBack) {
  program_ = Start({DrawnPhoto(), "--script", "-"});
  Ask("page points");
  Ask("reach 0");
  const std::string before = Ask("get point chin");
  const glm::vec2 at = PlaceIn(Ask("where chin"));
  std::ostringstream drag;
  drag << "mouse drag " << at.x << " " << at.y << " " << at.x << " " << at.y + 30;
  Ask(drag.str());
  const std::string moved = Ask("get point chin");
  Ask("key ctrl+z");
  const std::string undone = Ask("get point chin");
  Ask("click Redo");
  const std::string redone = Ask("get point chin");
  program_->WriteLine("quit");
  EXPECT_EQ(program_->Wait(kLong), 0) << program_->ErrorText();
  EXPECT_GT(PlaceIn(moved).y, PlaceIn(before).y + 3) << before << " -> " << moved;
  EXPECT_EQ(undone, before);
  EXPECT_EQ(redone, moved);
}

TEST_F(FaceEditorTest, AMouseOfTheWindowSystemMovesAPoint) {
  Process present({"xdotool", "version"}, {"", screen_.env()});
  if (present.Wait() != 0) GTEST_SKIP() << "needs xdotool (Debian: xdotool)";
  program_ = Start({DrawnPhoto(), "--script", "-"});
  Ask("reach 0");
  const std::string before = Ask("get point chin");
  const glm::vec2 at = PlaceIn(Ask("where chin"));
  const auto at_x = std::to_string(std::lround(at.x));
  const auto xdo = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "xdotool");
    Process tool(words, {"", env_});
    ASSERT_EQ(tool.Wait(), 0) << tool.ErrorText();
    TakeEvents();
  };
  xdo({"mousemove", at_x, std::to_string(std::lround(at.y))});
  xdo({"mousedown", "1"});
  xdo({"mousemove", at_x, std::to_string(std::lround(at.y) + 15)});
  xdo({"mousemove", at_x, std::to_string(std::lround(at.y) + 40)});
  xdo({"mouseup", "1"});
  const std::string after = Ask("get point chin");
  EXPECT_GT(PlaceIn(after).y, PlaceIn(before).y + 3) << before << " -> " << after;
  // Without a window manager nobody gives the window the keyboard.
  xdo({"search", "--name", "Galatea face editor", "windowfocus"});
  // Pressed and let go between two frames.
  for (int i = 0; i < 3; ++i) {
    xdo({"key", "--delay", "0", "ctrl+z"});
    EXPECT_EQ(Ask("get point chin"), before) << i;
    xdo({"key", "--delay", "0", "ctrl+shift+z"});
    EXPECT_EQ(Ask("get point chin"), after) << i;
  }
  program_->WriteLine("quit");
  EXPECT_EQ(program_->Wait(kLong), 0) << program_->ErrorText();
}

TEST_F(FaceEditorTest, AFaceIsBuiltOfPointsThatWereDraggedAndWorn) {
  if (const auto networks = facefit::FaceNetworks::Load(""); !networks) {
    GTEST_SKIP() << networks.error().text;
  }
  ASSERT_EQ(RunScript("open " + DrawnPhoto() +
                      "\ndrag mouth 0 5\nbuild anna\n"
                      "set slider jaw_width 2\nsave identity berta\nquit\n"),
            0)
      << program_->ErrorText();
  EXPECT_EQ(Output(), folder_ + "/faces/anna\n" + folder_ + "/faces/berta\n");
  std::ifstream file(folder_ + "/faces/anna/face.txt");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_GT(fsm::ReadPhotoHead("face.txt", text).points.size(), 100U);
  for (const char* name : {"anna", "berta"}) {
    ASSERT_EQ(
        RunScript("wait\nscreenshot " + folder_ + "/" + name + ".png\nquit\n", {"--mask", name}), 0)
        << program_->ErrorText();
  }
  EXPECT_NE(fsm::ReadImage(folder_ + "/anna.png")->rgba,
            fsm::ReadImage(folder_ + "/berta.png")->rgba);
}

TEST_F(FaceEditorTest, WithoutTheNetworksPointsAreSetByHand) {
  ASSERT_EQ(RunScript("open " + DrawnPhoto() + "\nmessage\ndrag chin 0 5\nsave points " + folder_ +
                          "/points.txt\nbuild anna\n",
                      {"--networks", "/nowhere"}),
            1);
  EXPECT_TRUE(Output().starts_with("The networks that find faces are not installed"));
  EXPECT_NE(program_->ErrorText().find("script.txt:5: The networks"), std::string::npos)
      << program_->ErrorText();
  std::ifstream file(folder_ + "/points.txt");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_TRUE(facefit::ParseHandPoints("points.txt", text));
}

TEST_F(FaceEditorTest, EveryPageIsDrawn) {
  size_ = "";
  std::string script = "open " + DrawnPhoto() + "\nwait\n";
  for (const char* page :
       {"points", "units", "fields", "expressions", "mouth", "motions", "identity"}) {
    script += std::string("page ") + page + "\nwait\nscreenshot " + folder_ + "/" + page + ".png\n";
  }
  ASSERT_EQ(RunScript(script + "quit\n"), 0) << program_->ErrorText();
  std::vector<std::vector<std::uint8_t>> seen;
  for (const char* page :
       {"points", "units", "fields", "expressions", "mouth", "motions", "identity"}) {
    const auto image = fsm::ReadImage(folder_ + "/" + page + ".png");
    ASSERT_TRUE(image) << image.error().text;
    EXPECT_EQ(image->width, 1280);
    for (const auto& other : seen) EXPECT_NE(other, image->rgba) << page;
    seen.push_back(image->rgba);
  }
}

TEST_F(FaceEditorTest, FieldsAreMovedWithTheMouseAndTheHeadFollowsAtOnce) {
  finds_faces_ = false;
  size_ = "960x800";
  const std::string shot = "screenshot " + folder_ + "/";
  const std::string script =
      "page fields\nwait\nchoose unit 28\nclick unit\nclick 29 Jaw thrust\nget rows 29\n"
      "click row 1 degrees\nget rows 29\n" +
      shot + "jaw.png\nclick Undo\nget rows 29\n" + shot +
      "undone.png\nclick Add row\nget rows 29\n" + shot + "away.png\nmouse move 810 310\n" + shot +
      "dots.png\nclick remove row 2\nget rows 29\nquit\n";
  ASSERT_EQ(RunScript(script), 0) << program_->ErrorText();
  std::istringstream lines(Output());
  std::vector<std::string> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(line);
  ASSERT_EQ(answers.size(), 6U);
  EXPECT_EQ(answers[0], "1: jaw 29 0 9");
  EXPECT_EQ(answers[1], "1: jaw 29 11.5 9") << "the middle of the slider";
  EXPECT_EQ(answers[2], answers[0]);
  EXPECT_EQ(answers[4], "2: field 29 25 -42 15 15 both 0 1 0");
  EXPECT_EQ(answers[5], answers[0]);
  // About mouth and chin, left of the page.
  const auto differ = [this](const std::string& one, const std::string& other) {
    const fsm::Image a = Shot(one), b = Shot(other);
    std::size_t count = 0;
    for (std::size_t y = 480; y < 680; ++y) {
      for (std::size_t x = 140; x < 340; ++x) {
        const std::size_t i = 4 * (y * 960 + x);
        if (std::abs(a.rgba[i] - b.rgba[i]) > 8) ++count;
      }
    }
    return count;
  };
  EXPECT_GT(differ("jaw.png", "undone.png"), 200U) << "the mouth was open";
  EXPECT_GT(differ("away.png", "dots.png"), 100U) << "dots say what the field under it moves";
}

TEST_F(FaceEditorTest, WidgetsChangeWhatIsEdited) {
  size_ = "640x800";
  finds_faces_ = false;
  ASSERT_EQ(RunScript("page expressions\nclick expression\nclick SAD\nclick 2\nclick Remove\n"
                      "get expression SAD 2\nclick Undo\nget expression SAD 2\n"
                      "page units\nclick AU 12L\nget look\n"
                      "page mouth\nclick o\nclick outer edge up\nget mouth o\n"
                      "page motions\nclick Another key frame\nget motion NOD 1\nquit\n"),
            0)
      << program_->ErrorText();
  std::istringstream lines(Output());
  std::vector<std::string> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(line);
  ASSERT_EQ(answers.size(), 7U);
  EXPECT_EQ(answers[0], "1:1 4:0.7 7:0.4 15:0.9 17:0.8 25:0.2") << "what was the third";
  EXPECT_EQ(answers[1], "1:0.6 4:0.3 15:0.4");
  EXPECT_EQ(answers[2], "12:0.5") << "the middle of the slider, both sides together";
  EXPECT_TRUE(answers[3].starts_with("0 5 ")) << answers[3];
  EXPECT_EQ(answers[6], "400 0 0 0");
}

TEST_F(FaceEditorTest, ClosingAsksWhenSomethingIsNotSaved) {
  finds_faces_ = false;
  EXPECT_EQ(RunScript("close\nget look\n"), 0) << "nothing to ask: " << program_->ErrorText();
  ASSERT_EQ(RunScript("set slider jaw_width 1\nclose\nclick Go on editing\nget unsaved\n"
                      "close\nclick Close without saving\nget nothing\n"),
            0)
      << program_->ErrorText();
  EXPECT_EQ(Output(), "identity\n");
}

TEST_F(FaceEditorTest, ASavedTableIsReadByTheFace) {
  finds_faces_ = false;
  ASSERT_EQ(RunScript("set mouth a 12 15\nset expression HAPPY 1 12 0.5\nset key NOD 1 1 90 8 0 0\n"
                      "save tables " +
                      folder_ + "/tables\nget unsaved\nquit\n"),
            0)
      << program_->ErrorText();
  EXPECT_EQ(Output(), "3 tables written to " + folder_ + "/tables\nnothing\n");
  ASSERT_EQ(RunScript("get expression HAPPY 1\nget motion NOD 1\nquit\n",
                      {"--tables", folder_ + "/tables"}),
            0);
  EXPECT_EQ(Output(), "12:0.5\n90 8 0 0\n200 0 0 0\n");
}

TEST_F(FaceEditorTest, AScriptStopsAtItsFirstMistakeAndNamesTheLine) {
  EXPECT_EQ(RunScript("page units\n\nset AU 99 10\nquit\n"), 1);
  EXPECT_NE(program_->ErrorText().find("script.txt:3: '99' is not an action unit"),
            std::string::npos)
      << program_->ErrorText();
}

}  // namespace
