// Contact sheets: what stands below the pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "fsm/app/contact_sheet.h"
#include "fsm/app/contact_sheet_font.h"

namespace fsm {
namespace {

std::vector<std::uint8_t> Drawn(std::string_view text) {
  Image image;
  image.width = 24;
  image.height = 8;
  image.rgba.assign(std::size_t{4} * 24 * 8, 255);
  DrawText(image, 0, 0, 1, text);
  return image.rgba;
}

TEST(SheetTest, LettersOfBothCasesLookDifferentFromAllOthers) {
  std::set<std::vector<std::uint8_t>> seen{Drawn("\x7f"), Drawn(" ")};
  std::size_t letters = seen.size();
  for (char c = 'a'; c <= 'z'; ++c) {
    for (const char letter : {c, static_cast<char>(c - 'a' + 'A')}) {
      seen.insert(Drawn(std::string(1, letter)));
      EXPECT_EQ(seen.size(), ++letters) << letter;
    }
  }
  EXPECT_NE(Drawn("58b"), Drawn("58B"));
}

TEST(SheetTest, UnitsAreSpelledAsTheirTableSpellsThem) {
  MotionTables tables = MotionTables::Load().value();
  tables.unit_names =
      ReadUnitNames("n.txt", "unit 12 LipCornerPuller\ncode 158 58b 9 0 0 -9 0 -9 0 -8\n").value();
  const auto sheet = MakeSheet("aus", tables, {"galatea"}, "");
  ASSERT_TRUE(sheet) << sheet.error().text;
  std::vector<std::string> labels;
  for (const ContactSheetCell& cell : sheet->cells) labels.push_back(cell.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"NEUTRAL", "12 LipCornerPuller", "158 58b"}));
}

}  // namespace
}  // namespace fsm
