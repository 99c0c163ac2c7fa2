#include "face_fit/tables/photo_look.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace facefit {
namespace {

TEST(PhotoLookTest, NumbersBeyondTheLimitsOfTheirRowAreRefused) {
  const std::string text =
      vm::OrThrow(vm::ReadTextFile(GALATEA_SOURCE_DIR "/face_fit/tables/photo_look.txt", 1U << 20));
  const fsm::NumberTable built_in("built-in", text);
  const auto refusal = [&](const char* row) -> std::string {
    try {
      fsm::NumberTable("own", row, &built_in);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal("light_gain 0.4 2.5"), "");
  for (const char* row : {"light_gain 2.5 0.4", "other_side darkest 1.2",
                          "other_side brightest 0.9", "bust most_width_ratio 0.9",
                          "bust least_width_ratio 1.1", "hair dome_of_whole_edge 0.31"}) {
    EXPECT_TRUE(refusal(row).starts_with("own:1")) << row << ": " << refusal(row);
  }
}

}  // namespace
}  // namespace facefit
