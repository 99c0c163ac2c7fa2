// How sources of movement become one face: the mixer's table, sources and units from outside.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "fsm/base/table_reader.h"
#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/face_motion.h"
#include "tests/fsm/motion_support.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

/// Turns the head 10 degrees to the viewer's right from the first second to the second.
class Turning : public MotionSource {
 public:
  void Contribute(vm::Time t, MotionLayers& layers) const override {
    if (t >= 1s && t < 2s) layers.Layer("turning").head_rotation[1] += 10;
  }
  std::optional<vm::Time> NextMotion(vm::Time t) const override {
    if (t >= 2s) return std::nullopt;
    return std::max(t, vm::Time(1s));
  }
  vm::Time EndsAt(vm::Time t) const override { return std::max(t, vm::Time(2s)); }
};

MotionTables With(const std::string& file, const std::string& rows) {
  char name[] = "/tmp/galatea_mixing_XXXXXX";
  EXPECT_NE(mkdtemp(name), nullptr);
  std::ofstream(std::filesystem::path(name) / file) << TableText(file) << rows;
  auto tables = MotionTables::Load(std::string(name));
  std::filesystem::remove_all(name);
  EXPECT_TRUE(tables) << (tables ? "" : tables.error().text);
  return tables ? *tables : MotionTables::Load().value();
}

TEST(MotionLayersTest, ALayerStaysWhereItIsWhileOthersCome) {
  std::vector<std::string> names;
  for (int i = 0; i < 100; ++i) names.push_back("layer" + std::to_string(i));
  MotionLayers layers;
  MotionLayer* const first = &layers.Layer("first");
  for (const std::string& name : names) layers.Layer(name);
  EXPECT_EQ(&layers.Layer("first"), first);
}

/// Returns the names that rows of a kind declare in the built-in mixing.txt.
std::set<std::string_view> Declared(std::string_view kind) {
  static const Table table("mixing.txt", TableText("mixing.txt"));
  std::set<std::string_view> names;
  for (const TableRow& row : table.rows()) {
    if (row.key() == kind) names.insert(row.Word(1));
  }
  return names;
}

TEST(LayerNameTest, TheTableOfTheMixerDeclaresTheLayersAndSignalsThatTheSourcesHave) {
  using L = LayerName;
  EXPECT_EQ(Declared("layer"),
            (std::set{L::kBlendShapes, L::kEmotions, L::kExpression, L::kEyes, L::kGestures,
                      L::kHead, L::kIdle, L::kIdleFace, L::kMood, L::kMouth, L::kMouthStream,
                      L::kNods, L::kStreamGestures, L::kSpeech, L::kText, L::kUnits}));
  using S = SignalName;
  EXPECT_EQ(Declared("signal"), (std::set{S::kSpeaking, S::kLipsTaken, S::kStreamTaken,
                                          S::kHeadTaken, S::kContact, S::kExpression, S::kAtUser}));
}

TEST(MotionSourceTest, ASourceFromOutsideIsMixedWithTheOthersWithoutARowOfItsOwn) {
  FaceMotion motion(MotionTables::Load().value(), 1);
  motion.Add(std::make_unique<Turning>());
  EXPECT_EQ(motion.NextMotion(0s), vm::Time(1s));
  EXPECT_EQ(motion.EndsAt(0s), vm::Time(2s));
  motion.head.TurnTo(0s, {0, 5, 0});
  EXPECT_FLOAT_EQ(motion.StateAt(900ms).head_rotation[1], 5);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).head_rotation[1], 15);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).gaze.left[kToRight], 0) << "nothing keeps the eyes";
  EXPECT_FLOAT_EQ(motion.StateAt(2s).head_rotation[1], 5);
  EXPECT_EQ(motion.NextMotion(2s), std::nullopt);
}

TEST(MotionSourceTest, ARowOfTheTableKeepsTheEyesOnTheirTarget) {
  FaceMotion motion(With("mixing.txt", "layer turning\nsteady turning 8\n"), 1);
  motion.Add(std::make_unique<Turning>());
  EXPECT_FLOAT_EQ(motion.StateAt(1s).head_rotation[1], 10);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).gaze.left[kToRight], -8) << "no further than its limit";
}

TEST(MixerTest, ALayerIsWeighedBySignalsAndLimitedByItsChannel) {
  const auto mixer =
      Mixer::Read("m.txt",
                  "channel units sum 0 2\nchannel mouth sum\nchannel head sum\n"
                  "channel gaze sum\nchannel lids greatest\n"
                  "layer a\nsignal loud\nweight a head loud 0.25\n"
                  "weight a brow_units loud 0\nweight result opening_units loud 0\n");
  ASSERT_TRUE(mixer) << mixer.error().text;
  const UnitRegions regions =
      ReadUnitList("l.txt", "region brow 1\nopens 25\n", UnitNames::BuiltIn()).value().regions;
  MotionLayers layers;
  MotionLayer& a = layers.Layer("a");
  a.head_rotation[0] = 8;
  a.blink.left = a.blink.right = 0.4f;
  a.look.au.left[1] = a.look.au.left[25] = 1;
  a.look.au.left[12] = 1.5f;
  MotionLayer& b = layers.Layer("b");
  b.blink.left = b.blink.right = 0.7f;
  b.look.au.left[12] = 1.5f;
  b.head_rotation[0] = 1;
  FaceState quiet, loud;
  mixer->Mix(layers, regions, quiet);
  EXPECT_FLOAT_EQ(quiet.head_rotation[0], 9);
  EXPECT_FLOAT_EQ(quiet.blink.left, 0.7f) << "the greatest";
  EXPECT_FLOAT_EQ(quiet.au.left[12], 2) << "the limit";
  EXPECT_FLOAT_EQ(quiet.au.left[1], 1);
  layers.AddSignal("loud", 1);
  mixer->Mix(layers, regions, loud);
  EXPECT_FLOAT_EQ(loud.head_rotation[0], 3);
  EXPECT_FLOAT_EQ(loud.au.left[1], 0);
  EXPECT_FLOAT_EQ(loud.au.left[25], 0);
}

TEST(MixerTest, WrongRowsAreNamedByFileAndLine) {
  const auto error = [](const std::string& rows) {
    const auto mixer = Mixer::Read("m.txt", rows);
    return mixer ? "taken" : mixer.error().text;
  };
  EXPECT_EQ(error(""), "m.txt: no row says how channel 'units' is mixed");
  EXPECT_TRUE(error("channel hair sum\n").starts_with("m.txt:1: 'hair sum' found; units, mouth"));
  EXPECT_TRUE(error("channel head mean\n").starts_with("m.txt:1: 'head mean' found"));
  EXPECT_TRUE(error("channel head sum 2 1\n").starts_with("m.txt:1: '1' found, the highest"));
  EXPECT_TRUE(error("\nweight a head loud 1\n").starts_with("m.txt:2: 'a' is no layer"));
  EXPECT_TRUE(error("layer a\nweight a head loud 1\n").starts_with("m.txt:2: 'loud' is no signal"));
  EXPECT_TRUE(error("layer a\nsignal s\nweight a nose s 1\n").starts_with("m.txt:3: 'nose' found"));
  EXPECT_TRUE(error("layer a\nsignal s\nweight a head s x\n").starts_with("m.txt:3: 'x' found"));
  EXPECT_TRUE(error("layer a\nsteady a 181\n").starts_with("m.txt:2: '181' found, a limit"));
  EXPECT_EQ(error("layer a\nlayer a\n"), "m.txt:2: the layer 'a' is here twice");
  EXPECT_TRUE(error("steady\n").starts_with("m.txt:1: 'steady' found; channel NAME"));
}

TEST(UnitValuesTest, GrowsWhenAHighNumberIsWrittenAndReadsZeroBeyondItsSize) {
  UnitValues values;
  const UnitValues& read = values;
  EXPECT_EQ(values.size(), kActionUnits);
  EXPECT_EQ(read[500], 0);
  values[12] = 0.5f;
  values[500] = 0.25f;
  EXPECT_EQ(values.size(), 501u);
  EXPECT_EQ(read[12], 0.5f);
  EXPECT_EQ(read[500], 0.25f);
  UnitValues same;
  same[12] = 0.5f;
  EXPECT_FALSE(same == values);
  same[500] = 0.25f;
  same[700] = 0;
  EXPECT_TRUE(same == values);
  EXPECT_THROW(values[UnitValues::kMax + 1] = 1, std::out_of_range);
}

TEST(NewUnitTest, OneRowMakesACodeOfTheHead) {
  FaceMotion motion(With("action_unit_names.txt", "code 158 58b 9 0 0 -9 0 -9 0 -8\n"), 1);
  ASSERT_TRUE(motion.action_units.Set(0s, "58b 0.5"));
  EXPECT_FLOAT_EQ(motion.StateAt(1s).head_rotation[0], 4.5f);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).head_forward_mm, -4);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).gaze.left[kDown], -4.5f);
}

TEST(NewUnitTest, OneRowMakesAUnitThatExpressionsAndCommandsKnow) {
  FaceMotion motion(With("action_unit_names.txt", "unit 151 12b\nunit 152 Ear one-sided\n"), 1);
  ASSERT_TRUE(motion.action_units.Set(0s, "12bL 0.5 Ear 1"));
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.left[151], 0.5f);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.right[151], 0);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.left[152], 1);
  EXPECT_FLOAT_EQ(motion.StateAt(1s).au.right[152], 0);
  ASSERT_TRUE(motion.expressions().Define("ODD", 1, "12b 0.4 152R:0.2"));
  ASSERT_TRUE(motion.expression.Show(1s, "ODD", 1, 1, 0ms));
  const FaceState state = motion.StateAt(3s);
  EXPECT_FLOAT_EQ(state.au.right[151], 0.4f);
  EXPECT_FLOAT_EQ(state.au.left[151], 0.9f);
  EXPECT_FLOAT_EQ(state.au.right[152], 0.2f);
  const UnitNames& names = motion.tables().unit_names;
  const FaceLook& look = motion.expressions().all().at("ODD").patterns[0];
  EXPECT_EQ(FormatLook(look, names), "151:0.4 152R:0.2");
  EXPECT_TRUE(ReadExpressions("e.txt", "ODD 1 151:1 12b:0.5\n", names));
  EXPECT_FALSE(ReadExpressions("e.txt", "ODD 1 151:1\n", UnitNames::BuiltIn()));
}

TEST(NewUnitTest, ANameThatReadsAsANumberIsRefused) {
  for (const char* name : {"12", "12L", "R7", "12C"}) {
    const auto names = ReadUnitNames("n.txt", std::string("unit 151 ") + name + "\n");
    ASSERT_FALSE(names) << name;
    EXPECT_TRUE(names.error().text.starts_with("n.txt:1: '")) << names.error().text;
  }
  EXPECT_FALSE(ReadUnitNames("n.txt", "unit 1000 Ear\n"));
}

}  // namespace
}  // namespace fsm
