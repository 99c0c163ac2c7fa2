// The program itself, with films in place of cameras, as its user has it.

#include <gtest/gtest.h>

#include <fstream>

#include "fsm/image/image_file.h"
#include "hypermask/sim/movement.h"
#include "hypermask/sim/stage.h"
#include "tests/support/process.h"

namespace {

using hypermask::Movement;

const std::string kProgram = GALATEA_BIN_DIR "/hypermask";

/// What the simulated camera sees of a mask that sways, as a folder of pictures.
void MakeFolder(const support::TempDir& folder, const std::string& name, int pictures,
                bool covered) {
  ASSERT_EQ(mkdir((folder / name).c_str(), 0700), 0);
  const hypermask::Stage stage;
  const hypermask::StageCamera camera(stage);
  const Movement movement(Movement::Kind::kSway, 2);
  hypermask::Grey grey;
  for (int i = 0; i < pictures; ++i) {
    const auto pose = movement.At(i / 25.0);
    camera.See(pose, pose, static_cast<std::uint32_t>(i), covered ? ~0u : 0, nullptr, grey);
    fsm::Image image = fsm::FilledImage(grey.width, grey.height);
    for (std::size_t p = 0; p < grey.pixels.size(); ++p) {
      image.rgba[4 * p] = image.rgba[4 * p + 1] = image.rgba[4 * p + 2] = grey.pixels[p];
    }
    ASSERT_TRUE(fsm::WriteImage(image, folder / (name + "/" + std::to_string(100 + i) + ".png")));
  }
}

TEST(HypermaskProgramTest, AFilmOfAMaskIsFollowedAndOneWithoutIsAnError) {
  support::TempDir folder;
  MakeFolder(folder, "mask", 20, false);
  MakeFolder(folder, "none", 5, true);
  support::Process program({kProgram});
  program.WriteLine("prop Error = AutoOutput");
  program.WriteLine("prop Track = AutoOutput");
  program.WriteLine("set Run = START");
  program.WriteLine("set Input = " + (folder / "mask"));
  EXPECT_TRUE(program.Expect("Track.stat = FOLLOWING")) << program.Seen();
  EXPECT_TRUE(program.Expect("\"seen\":5")) << program.Seen();
  EXPECT_TRUE(program.Expect("rep Input = NONE")) << program.Seen();
  EXPECT_EQ(program.Seen().find("Input.error"), std::string::npos) << program.Seen();
  program.WriteLine("set Input = " + (folder / "none"));
  EXPECT_TRUE(program.Expect("Input.error = UNAVAILABLE no mask is seen in")) << program.Seen();
  EXPECT_TRUE(program.Expect("rep Input = NONE"));
  program.CloseInput();
  program.ReadAll();
  EXPECT_EQ(program.Wait(), 0) << program.ErrorText();
}

TEST(HypermaskProgramTest, WhatIsNoFilmIsAnError) {
  support::TempDir folder;
  std::ofstream(folder / "text.mp4") << "this is no film";
  support::Process program({kProgram});
  program.WriteLine("prop Error = AutoOutput");
  program.WriteLine("set Run = START");
  program.WriteLine("set Input = " + (folder / "text.mp4"));
  EXPECT_TRUE(program.Expect("Input.error = BAD_VALUE")) << program.Seen();
  program.WriteLine("set Input = /nothing/here.mp4");
  EXPECT_TRUE(program.Expect("there is no '/nothing/here.mp4'")) << program.Seen();
  program.WriteLine("set Input = v4l2:/dev/no_camera");
  EXPECT_TRUE(program.Expect("/dev/no_camera")) << program.Seen();
  program.WriteLine("set Input = -");
  EXPECT_TRUE(program.Expect("standard input brings the commands")) << program.Seen();
  program.CloseInput();
  program.ReadAll();
  EXPECT_EQ(program.Wait(), 0) << program.ErrorText();
}

TEST(HypermaskProgramTest, WithoutADisplayThereIsNoWindowToProjectIn) {
  support::TempDir folder;
  MakeFolder(folder, "mask", 2, false);
  support::Process program({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", kProgram});
  program.WriteLine("prop Error = AutoOutput");
  program.WriteLine("set Input = " + (folder / "mask"));
  program.WriteLine("set Projector = WINDOW");
  program.WriteLine("set#1 Run = START");
  const auto answer = program.Expect("rep#1 Run.error = UNAVAILABLE");
  ASSERT_TRUE(answer) << program.Seen();
  EXPECT_NE(answer->find("display"), std::string::npos) << *answer;
}

TEST(HypermaskProgramTest, AFilmNeedsAFaceAndDoesNotOverwriteIt) {
  support::Process none({kProgram, "--film", "x.mp4"});
  EXPECT_NE(none.Wait(), 0);
  EXPECT_NE(none.ErrorText().find("--film needs a --face"), std::string::npos) << none.ErrorText();
  support::Process same({kProgram, "--film", "x.mp4", "--face", "x.mp4"});
  EXPECT_NE(same.Wait(), 0);
  EXPECT_NE(same.ErrorText().find("not overwritten"), std::string::npos) << same.ErrorText();
}

TEST(HypermaskProgramTest, AFilmOfTheStageIsMade) {
  support::TempDir folder;
  ASSERT_EQ(mkdir((folder / "face").c_str(), 0700), 0);
  ASSERT_TRUE(
      fsm::WriteImage(fsm::FilledImage(64, 64, {220, 180, 160, 255}), folder / "face/1.png"));
  support::Process program({kProgram, "--film", folder / "out.mp4", "--face", folder / "face",
                            "--scene", "sway delay=50", "--seconds", "2"});
  program.ReadAll(std::chrono::seconds(120));
  ASSERT_EQ(program.Wait(), 0) << program.ErrorText();
  std::ifstream film(folder / "out.mp4", std::ios::binary | std::ios::ate);
  EXPECT_GT(film.tellg(), 10'000);
}

}  // namespace
