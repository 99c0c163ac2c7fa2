#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/process.h"

namespace {

std::string Text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(SlotsDocsTest, TheDocumentedSlotsAreThoseOfThePrograms) {
  const support::TempDir folder;
  support::Process script(
      {GALATEA_SOURCE_DIR "/scripts/slots_docs.sh", GALATEA_BIN_DIR, folder / "slots.md"});
  script.CloseInput();
  ASSERT_EQ(script.Wait(), 0) << script.ErrorText();
  EXPECT_EQ(Text(folder / "slots.md"), Text(GALATEA_SOURCE_DIR "/docs/reference/slots.md"))
      << "run: cmake --build build --target slots_docs";
}

}  // namespace
