// Files opened in the real program: heads from elsewhere, by the dialog, and damaged ones.

#include <cmath>
#include <cstdlib>

#include "face_fit/find/network/face_networks.h"
#include "fsm/asset/asset_writer.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "tests/face_editor/editor_process.h"
#include "tests/support/test_data.h"

namespace {

using namespace editor_process;

class EditorFilesTest : public FaceEditorTest {
 protected:
  /// A head with four shapes of its own.
  std::string WriteHead() {
    const auto head = fsm::MakeSymmetricHead("pygmalion");
    std::vector<fsm::ExportedShape> shapes;
    for (const auto& [name, unit] : {std::pair("jawOpen", 26U),
                                     {"mouthSmileLeft", 12U},
                                     {"browOuterUpLeft", 2U},
                                     {"eyeBlinkLeft", 45U}}) {
      shapes.push_back({name, {}});
      shapes.back().state.asymmetry = 0;
      shapes.back().state.au.left[unit] = 1;
      if (unit == 26) shapes.back().state.au.right[unit] = 1;
    }
    std::ofstream(folder_ + "/head.glb", std::ios::binary) << fsm::WriteAsset(*head, shapes);
    return folder_ + "/head.glb";
  }
  std::string Lines(std::initializer_list<std::string> lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
  static std::string Bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string Shoot(const std::string& name) { return "screenshot " + folder_ + "/" + name; }
};

TEST_F(EditorFilesTest, AHeadFromElsewhereIsShownAndMovedByUnits) {
  size_ = "960x800";
  finds_faces_ = false;
  const std::string head = WriteHead();
  ASSERT_EQ(RunScript(Lines({"page units", "wait", Shoot("rest.png"), "set AU 26 100",
                             Shoot("open.png"), "set row 26 1 degrees 2", Shoot("little.png"),
                             "undo", "undo", Shoot("again.png"), "quit"}),
                      {"--head", head}),
            0)
      << program_->ErrorText();
  const auto rest = Shot("rest.png");
  const auto differs = [&rest](const fsm::Image& image) {
    std::size_t count = 0;  // of the preview
    for (std::size_t y = 100; y < 740; ++y) {
      for (std::size_t x = 0; x < 480; ++x) {
        const std::size_t i = 4 * (y * 960 + x);
        if (std::abs(image.rgba[i] - rest.rgba[i]) > 12) ++count;
      }
    }
    return count;
  };
  EXPECT_GT(differs(Shot("open.png")), 1500U);
  EXPECT_LT(differs(Shot("little.png")), differs(Shot("open.png")) / 2);
  EXPECT_EQ(differs(Shot("again.png")), 0U);
}

TEST_F(EditorFilesTest, AHeadMovedByItsOwnShapesFollowsTheUnitsThatAreEdited) {
  size_ = "960x800";
  finds_faces_ = false;
  const std::string head = WriteHead();
  // Without our extension it is a glTF file whose shapes have ARKit's names.
  std::string bytes = Bytes(head);
  for (std::size_t at; (at = bytes.find("GALATEA_head")) != std::string::npos;) bytes[at] = 'X';
  std::ofstream(head, std::ios::binary) << bytes;
  ASSERT_EQ(
      RunScript(Lines({"page units", "wait", Shoot("rest.png"), "set AU 26 100", Shoot("open.png"),
                       "set row 26 1 degrees 2", "wait", Shoot("little.png"), "quit"}),
                {"--head", head}),
      0)
      << program_->ErrorText();
  const auto moved = [&](const std::string& name) {
    const fsm::Image rest = Shot("rest.png"), image = Shot(name);
    std::size_t count = 0;
    for (std::size_t i = 0; i < rest.rgba.size(); ++i) {
      if (i / 4 % 960 < 480 && std::abs(image.rgba[i] - rest.rgba[i]) > 12) ++count;
    }
    return count;
  };
  EXPECT_GT(moved("open.png"), 1500U);
  EXPECT_LT(moved("little.png"), moved("open.png") / 2);
}

TEST_F(EditorFilesTest, AHeadWithoutPointsSaysWhatItLacks) {
  finds_faces_ = false;
  std::ofstream(folder_ + "/cone.obj") << "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n"
                                          "f 2 3 4\n";
  ASSERT_EQ(RunScript(Lines({"message", "quit"}), {"--head", folder_ + "/cone.obj"}), 0)
      << program_->ErrorText();
  EXPECT_NE(Output().find("only head, eyes and jaw move"), std::string::npos);
}

TEST_F(EditorFilesTest, AFaceOfAConfigurationOfTheOriginalIsShown) {
  finds_faces_ = false;
  const auto original = support::Original();
  if (!original.Has()) GTEST_SKIP() << original.Missing();
  const std::string data = original / "data";
  std::ofstream(folder_ + "/config.txt")
      << "MaskFile anna " << DrawnPhoto() << " " << data << "/fheadv2.pnt\nMaskFile gone no.png "
      << data << "/fheadv2.pnt\nDEF_WFM_PNT " << data << "/fheadv2.pnt\nDEF_WFM_LNK " << data
      << "/fheadv2.lnk\nU_TEETH_OBJ_NAME " << data << "/teethUpper.obj\nL_TEETH_OBJ_NAME " << data
      << "/teethLower.obj\nM_WALL_TEXTURE " << data << "/mouthwall.bmp\n";
  const std::string config = folder_ + "/config.txt";
  ASSERT_EQ(RunScript(Lines({"message", Shoot("original.png"), "quit"}), {"--head", config}), 0)
      << program_->ErrorText();
  EXPECT_TRUE(Output().starts_with("Face 'anna' of ")) << Output();
  ASSERT_EQ(RunScript(Lines({"wait", Shoot("ours.png"), "quit"})), 0);
  EXPECT_NE(Shot("original.png").rgba, Shot("ours.png").rgba);
  EXPECT_EQ(RunScript("quit\n", {"--head", config, "--mask", "nobody"}), 1);
  EXPECT_NE(program_->ErrorText().find("has no face 'nobody'; it has anna"), std::string::npos)
      << program_->ErrorText();
}

TEST_F(EditorFilesTest, TheDialogOpensFilesOfItsKindAndWalksFolders) {
  finds_faces_ = false;
  std::filesystem::create_directory(folder_ + "/inner");
  const std::string photo = DrawnPhoto();
  std::filesystem::rename(photo, folder_ + "/inner/me.png");
  std::ofstream(folder_ + "/notes.md") << "x";
  ASSERT_EQ(
      RunScript(Lines({"click browse photo", "click file name", "type " + folder_, "key enter",
                       Shoot("dialog.png"), "click inner/", "click Open", "click me.png",
                       "click Open", "wait", "message", "get point chin", "quit"})),
      0)
      << program_->ErrorText();
  EXPECT_NE(Output().find("chin "), std::string::npos) << Output();
  EXPECT_EQ(RunScript(Lines({"click browse photo", "click file name", "type " + folder_,
                             "key enter", "click notes.md"})),
            1)
      << "it is no photo and not listed";
}

TEST_F(EditorFilesTest, TheDialogAsksBeforeItReplacesAFile) {
  size_ = "640x600";
  finds_faces_ = false;
  std::ofstream(folder_ + "/mine.txt") << "mine";
  const std::string open =
      "page mouth\nset mouth a 12 15\nclick browse file\nclick file name\nkey ctrl+a\ntype ";
  const std::string path = folder_ + "/mine.txt\n";
  const auto text = [this] {
    std::ifstream in(folder_ + "/mine.txt");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  ASSERT_EQ(RunScript(open + path + "click Save\nclick Cancel\nget unsaved\nquit\n"), 0)
      << program_->ErrorText();
  EXPECT_EQ(Output(), "mouth\n");
  EXPECT_EQ(text(), "mine");
  ASSERT_EQ(RunScript(open + path + "click Save\nclick Save\nget unsaved\nmessage\nquit\n"), 0)
      << program_->ErrorText();
  EXPECT_EQ(Output(), "nothing\nWritten " + path);
  EXPECT_NE(text().find("\na "), std::string::npos);
}

TEST_F(EditorFilesTest, DamagedFilesAreToldInOneLineAndNothingIsLost) {
  const std::string photo = DrawnPhoto();
  std::filesystem::resize_file(DrawnPhoto(), 3000);
  std::filesystem::rename(photo, folder_ + "/cut.png");
  std::ofstream(folder_ + "/empty.jpg");
  std::ofstream(folder_ + "/broken.glb") << "glTF and then nothing";
  std::ofstream(folder_ + "/flat.obj") << "v 0 0 zero\n";
  std::ofstream(folder_ + "/config.txt") << "MaskFile anna\n";
  std::ofstream(folder_ + "/emotions.txt") << "HAPPY 1 12:3\n";
  std::ofstream(folder_ + "/action_units.txt") << "jaw 26 wide 1\n";
  std::ofstream(folder_ + "/tables.txt", std::ios::binary) << "\xff\xfe\x00\x01";
  program_ = Start({DrawnPhoto(), "--networks", "/nowhere", "--script", "-"});
  Ask("drag chin 0 9");
  Ask("set expression HAPPY 1 12 0.5");
  Ask("set row 29 1 degrees 9");
  const std::string chin = Ask("get point chin");
  for (const auto& [command, words] :
       {std::pair("open cut.png", "cut.png': the PNG file cannot be read"),
        {"open empty.jpg", "empty.jpg"},
        {"open none.png", "none.png"},
        {"open .", "'.'"},
        {"head broken.glb", "broken.glb: byte 4: version 2"},
        {"head flat.obj", "flat.obj:1: "},
        {"head none.vrm", "none.vrm"},
        {"head config.txt", "config.txt:1: "},
        {"head photo.png", "is no head's name"},
        {"load emotions emotions.txt", "emotions.txt:1: "},
        {"load units action_units.txt", "action_units.txt:1: 'wide' found"},
        {"load units tables.txt", "tables.txt:1: "},
        {"load mouth emotions.txt", "emotions.txt:1: "},
        {"load points emotions.txt", "emotions.txt:1: "},
        {"load tables .", "emotions.txt:1: "},
        {"load tables none", "'none' is not a folder of tables"}}) {
    EXPECT_EQ(Ask(command), "") << command;
    const std::string message = Ask("message");
    EXPECT_NE(message.find(words), std::string::npos) << command << " -> " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << command;
  }
  EXPECT_EQ(Ask("get point chin"), chin);
  EXPECT_EQ(Ask("get expression HAPPY 1"), "12:0.5");
  EXPECT_EQ(Ask("get rows 29"), "1: jaw 29 9 9");
  EXPECT_EQ(Ask("get unsaved"), "points emotions units");
  program_->WriteLine("quit");
  EXPECT_EQ(program_->Wait(kLong), 0) << program_->ErrorText();
}

TEST_F(EditorFilesTest, PhotosFromTheSideAreLookedAtAndUsed) {
  if (const auto networks = facefit::FaceNetworks::Load(""); !networks) {
    GTEST_SKIP() << networks.error().text;
  }
  const std::string front = DrawnPhoto();
  DrawnPhoto("side.png", 35);
  program_ = Start({"--script", "-"});
  EXPECT_NE(Refusal("view side.png").find("from the front first"), std::string::npos);
  Ask("open " + front);
  EXPECT_NE(Refusal("view photo.png").find("photo.png: "), std::string::npos) << "the front again";
  EXPECT_EQ(Ask("build plain"), folder_ + "/faces/plain");
  EXPECT_EQ(Ask("view side.png"), "");
  EXPECT_EQ(Ask("get views"), "side.png");
  EXPECT_EQ(Ask("build deep"), folder_ + "/faces/deep");
  EXPECT_EQ(Ask("view none"), "");
  EXPECT_EQ(Ask("get views"), "nothing");
  program_->WriteLine("quit");
  EXPECT_EQ(program_->Wait(kLong), 0) << program_->ErrorText();
  const auto set = [this](const std::string& name) {
    std::ifstream in(folder_ + "/faces/" + name + "/face.txt");
    return fsm::ReadPhotoHead(name, std::string(std::istreambuf_iterator<char>(in), {}));
  };
  EXPECT_EQ(set("plain").also_seen.size(), 0U);
  EXPECT_EQ(set("deep").also_seen.size(), 1U);
}

TEST_F(EditorFilesTest, AMouseAndKeyboardOfTheWindowSystemChooseAFile) {
  Process present({"xdotool", "version"}, {"", screen_.env()});
  if (present.Wait() != 0) GTEST_SKIP() << "needs xdotool (Debian: xdotool)";
  DrawnPhoto();
  program_ = Start({"--networks", "/nowhere", "--script", "-"});
  const auto xdo = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "xdotool");
    Process tool(words, {"", env_});
    ASSERT_EQ(tool.Wait(), 0) << tool.ErrorText();
    TakeEvents();
  };
  const auto press = [&](const std::string& label) {
    const glm::vec2 at = PlaceIn(Ask("where " + label));
    xdo({"mousemove", std::to_string(std::lround(at.x)), std::to_string(std::lround(at.y))});
    xdo({"mousedown", "1"});
    xdo({"mouseup", "1"});
  };
  Ask("wait");  // there is a window then
  // Without a window manager nobody gives the window the keyboard.
  xdo({"search", "--name", "Galatea face editor", "windowfocus"});
  press("browse photo");
  press("photo.png");
  press("file name");
  xdo({"keydown", "Return"});
  xdo({"keyup", "Return"});
  EXPECT_NE(Ask("get point chin").find("chin "), std::string::npos) << Ask("message");
  program_->WriteLine("quit");
  EXPECT_EQ(program_->Wait(kLong), 0) << program_->ErrorText();
}

}  // namespace
