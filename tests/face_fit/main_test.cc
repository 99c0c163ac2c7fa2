// What the program face_fit says of options that do not go together.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.h"

namespace facefit {
namespace {

TEST(FaceFitProgramTest, OptionsThatWouldBeIgnoredAreRefused) {
  for (const auto& [first, other] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"--head", {"--name", "anna"}},
           {"--head", {"--face", "2"}},
           {"--head", {"--view", "side.png"}},
           {"--head", {"--points", "points.txt"}},
           {"--head", {"--tables", "tables"}},
           {"--head", {"--glasses", "no"}},
           {"--galatea", {"--face", "2"}},
           {"--galatea", {"--points", "points.txt"}},
           {"--face", {"--points", "points.txt"}}}) {
    std::vector<std::string> words{GALATEA_BIN_DIR "/face_fit", first, "1"};
    words.insert(words.end(), other.begin(), other.end());
    support::Process program(words);
    EXPECT_NE(program.Wait(), 0);
    EXPECT_TRUE(program.ExpectError(" excludes ", support::Millis{2000}))
        << first << " " << other[0] << ": " << program.ErrorText();
  }
}

TEST(FaceFitProgramTest, AFaceIsMadeFromOneThing) {
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {"--name", "anna"},
           {"--head", "a.obj", "photo.png"},
           {"--head", "a.obj", "--galatea", "config.txt"},
           {"--name", "anna", "--galatea", "config.txt", "photo.png"}}) {
    std::vector<std::string> words{GALATEA_BIN_DIR "/face_fit"};
    words.insert(words.end(), options.begin(), options.end());
    support::Process program(words);
    EXPECT_NE(program.Wait(), 0);
    EXPECT_TRUE(program.ExpectError("require", support::Millis{2000}))
        << options.back() << ": " << program.ErrorText();
  }
}

}  // namespace
}  // namespace facefit
