// Heads moved by a table of units of one's own.

#include <gtest/gtest.h>

#include "fsm/head/face_channels.h"
#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"
#include "fsm/rig/unit_table.h"
#include "tests/fsm/head_fixture.h"

namespace fsm {
namespace {

using testing::GenericHead;
using testing::SkinAt;
using testing::WithUnit;

UnitTable TableOf(std::string_view text) { return UnitTable(Table("own.txt", text)); }

TEST(OwnUnitsTest, AUnitMovesTheSkinAsItsOwnTableSays) {
  const auto own = GenericHead().WithUnits(TableOf("field 2 43 47 20 20 both 0 3 0\n"));
  ASSERT_NE(own, nullptr);
  EXPECT_EQ(own->surface().indices, GenericHead().surface().indices);
  HeadVertices rest, moved;
  own->Evaluate({}, rest);
  EXPECT_EQ(rest.position, testing::Vertices({}).position) << "at rest nothing differs";
  own->Evaluate(WithUnit(2, 1), moved);
  const std::size_t brow = SkinAt(43, 47);
  EXPECT_NEAR(moved.position[brow].y - rest.position[brow].y, 3, 0.4F);
  own->Evaluate(WithUnit(12, 1), moved);
  EXPECT_EQ(moved.position, rest.position) << "what the table does not say does not happen";
}

TEST(OwnUnitsTest, AUnitBeyondFacsMovesTheSkinToo) {
  const auto own = GenericHead().WithUnits(
      TableOf("field 151 43 47 20 20 both 0 3 0\nfield 2 43 47 20 20 both 0 3 0\n"
              "damp 151 2 0.5\n"));
  HeadVertices rest, moved;
  own->Evaluate({}, rest);
  FaceState twitch;
  twitch.au.left[151] = 1;
  own->Evaluate(twitch, moved);
  const std::size_t left = SkinAt(43, 47), right = SkinAt(-43, 47);
  EXPECT_NEAR(moved.position[left].y - rest.position[left].y, 3, 0.4F);
  EXPECT_EQ(moved.position[right], rest.position[right]);
  twitch.au.left[2] = 1;
  own->Evaluate(twitch, moved);
  EXPECT_NEAR(moved.position[left].y - rest.position[left].y, 4.5F, 0.6F) << "rules know it";
}

TEST(OwnUnitsTest, TheJawOpensAsFarAsTheTableSays) {
  const auto own = GenericHead().WithUnits(TableOf("jaw 26 20 0\n"));
  EXPECT_NEAR(own->MeasureMouth(WithUnit(26, 1)).jaw_degrees, 20, 0.01F);
  EXPECT_NEAR(GenericHead().MeasureMouth(WithUnit(26, 1)).jaw_degrees, 12, 0.5F);
}

TEST(OwnUnitsTest, RowsOfAnIdentityAddToWhatAllFacesDo) {
  const std::string base = "base galatea\n";
  const auto same = MakeSymmetricHead(ReadOwnIdentity("own.txt", base));
  const auto own =
      MakeSymmetricHead(ReadOwnIdentity("own.txt", base + "field 2 43 47 20 20 both 0 3 0\n"));
  const std::size_t brow = SkinAt(43, 47);
  for (const float strength : {0.0f, 0.5f, 1.0f}) {
    HeadVertices before, after;
    same->Evaluate(WithUnit(2, strength), before);
    own->Evaluate(WithUnit(2, strength), after);
    EXPECT_NEAR(after.position[brow].y - before.position[brow].y, 3 * strength,
                0.5f * strength + 1e-4f);
  }
  EXPECT_THROW(ReadOwnIdentity("own.txt", base + "field 3 43 47 20 20 both 0 3 0\n"),
               std::runtime_error);
}

TEST(OwnUnitsTest, AHeadKeepsItsOwnAsymmetry) {
  const auto head = MakeHead("galatea");
  const auto same = head->WithUnits(BuiltInUnits());
  HeadVertices before, after;
  head->Evaluate(WithUnit(12, 1), before);
  same->Evaluate(WithUnit(12, 1), after);
  EXPECT_EQ(after.position, before.position);
  GenericHead().Evaluate(WithUnit(12, 1), after);
  EXPECT_NE(after.position, before.position) << "else this would say nothing";
}

}  // namespace
}  // namespace fsm
