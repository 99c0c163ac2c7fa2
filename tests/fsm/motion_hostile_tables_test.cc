// Folders of tables that are damaged by accident or on purpose: one clear error, whatever is in
// them.

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "tests/fsm/motion_support.h"
#include "vm_protocol/core/utf8.h"

namespace fsm {
namespace {

constexpr const char* kTables[] = {
    "mouth_shapes.txt", "mouth_shapes_28.txt", "dominance.txt",        "phonemes_ja.txt",
    "phonemes_en.txt",  "phonemes28_ja.txt",   "phonemes28_en.txt",    "phoneme_names.txt",
    "emotions.txt",     "motions.txt",         "action_unit_list.txt", "action_unit_names.txt",
    "arkit.txt",        "mixing.txt",          "gestures.txt"};

struct HostileTablesTest : testing::TestWithParam<const char*> {
  HostileTablesTest() {
    char name[] = "/tmp/galatea_hostile_XXXXXX";
    EXPECT_NE(mkdtemp(name), nullptr);
    folder = name;
    path = (folder / GetParam()).string();
  }
  ~HostileTablesTest() override { std::filesystem::remove_all(folder); }

  /// The error of loading the folder with this text in the table's place; "" if it is taken.
  std::string ErrorOf(const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    const auto tables = MotionTables::Load(folder.string());
    if (tables) return "";
    const std::string error = tables.error().text;
    EXPECT_FALSE(error.empty());
    EXPECT_LT(error.size(), 1000u) << error;
    EXPECT_FALSE(vm::FirstBadUtf8(error)) << error;
    for (const char c : error) EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20) << error;
    // Tables refer to each other: what one lacks is missed in another.
    EXPECT_TRUE(error.contains(folder.string()) || error.contains(".txt:")) << error;
    return error;
  }

  std::filesystem::path folder;
  std::string path;
};

TEST_P(HostileTablesTest, BytesThatAreNoTextAreNamedByTheirLine) {
  std::mt19937 random(17);
  std::string bytes(20000, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  EXPECT_TRUE(ErrorOf(bytes).starts_with(path + ":")) << ErrorOf(bytes);
  const std::string text = TableText(GetParam());
  EXPECT_EQ(ErrorOf("# one\n# two\n\xff\n" + text),
            path + ":3: a byte that is not UTF-8 found, text expected");
}

TEST_P(HostileTablesTest, ALineOfAMegabyteIsShortenedInTheError) {
  EXPECT_TRUE(ErrorOf(std::string(1000000, 'a')).starts_with(path + ":1: "));
  std::string wide;
  while (wide.size() < 1000000) wide += "\xE3\x81\x82";  // of three bytes each
  EXPECT_TRUE(ErrorOf(wide + " 1").starts_with(path + ":1: "));
  std::string words;
  while (words.size() < 1000000) words += "1e9 nan ";
  EXPECT_TRUE(ErrorOf(words).starts_with(path + ":1: "));
  EXPECT_TRUE(
      ErrorOf(std::string(kMaxTableBytes + 1, '\n')).starts_with("file '" + path + "' is over"));
}

TEST_P(HostileTablesTest, NumbersBeyondReasonAreRefusedWhereTheyStand) {
  const std::string text = TableText(GetParam());
  ASSERT_FALSE(text.empty());
  EXPECT_EQ(ErrorOf(text), "");
  int line = 1;
  int tried = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '\n') ++line;
    if (text[at] == '#') at = text.find('\n', at) - 1;
    if (at == 0 || std::isspace(static_cast<unsigned char>(text[at - 1])) == 0) continue;
    const std::size_t end = text.find_first_of(" \t\n", at);
    const std::string word = text.substr(at, end - at);
    // A number with a fraction is a size for sure, not a name or a count.
    if (word.find('.') == word.npos || !ParseNumber(word)) continue;
    if (++tried > 25) break;
    for (const char* bad : {"nan", "1e9", "-1e9", "inf", "1e999", "0x10"}) {
      std::string damaged = text;
      damaged.replace(at, word.size(), bad);
      EXPECT_TRUE(ErrorOf(damaged).starts_with(path + ":" + std::to_string(line) + ": "))
          << bad << " for " << word << ": " << ErrorOf(damaged);
    }
  }
}

TEST_P(HostileTablesTest, AnyDamageGivesOneWellFormedErrorOrNone) {
  const std::string text = TableText(GetParam());
  std::mt19937 random(3);
  int refused = 0;
  for (int run = 0; run < 60; ++run) {
    std::string damaged = text;
    if (run % 3 == 0) damaged.resize(random() % damaged.size());
    for (int k = 0; k < run % 7; ++k) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    if (!ErrorOf(damaged).empty()) ++refused;
  }
  EXPECT_GT(refused, 10);
}

TEST_P(HostileTablesTest, AFolderInThePlaceOfATableIsNoTable) {
  std::filesystem::create_directory(path);
  const auto tables = MotionTables::Load(folder.string());
  ASSERT_FALSE(tables);
  EXPECT_EQ(tables.error().text, "cannot read '" + path + "': Is a directory");
  EXPECT_EQ(MotionTables::Load(folder.string() + "/nowhere").error().text,
            "'" + folder.string() + "/nowhere' is not a folder of tables");
}

INSTANTIATE_TEST_SUITE_P(HostileTablesTest, HostileTablesTest, testing::ValuesIn(kTables),
                         [](const auto& test) {
                           std::string name = test.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace fsm
