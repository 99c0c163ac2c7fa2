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
           {"--head", {"photo.png"}},
           {"--head", {"--name", "anna"}},
           {"--head", {"--galatea", "config.txt"}},
           {"--head", {"--face", "2"}},
           {"--head", {"--view", "side.png"}},
           {"--head", {"--points", "points.txt"}},
           {"--head", {"--tables", "tables"}},
           {"--head", {"--glasses", "no"}},
           {"--galatea", {"photo.png"}},
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

}  // namespace
}  // namespace facefit
