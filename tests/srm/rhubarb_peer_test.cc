// The peer's column of the alignment bench: how the program is called and read, and how its closed
// mouths are counted, with a script for the program.

#include "bench/rhubarb_peer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace speech_bench {
namespace {

constexpr const char* kFake = GALATEA_SOURCE_DIR "/tests/srm/fake_rhubarb.sh";

class RhubarbPeerTest : public testing::Test {
 protected:
  RhubarbPeerTest() {
    std::filesystem::create_directories(folder_);
    std::ofstream(wav_) << "sound";
    std::ofstream(text_) << "text";
  }
  ~RhubarbPeerTest() override { std::filesystem::remove_all(folder_); }
  const std::string folder_ = testing::TempDir() + "rhubarb_peer_test";
  const std::string wav_ = folder_ + "/a.wav", text_ = folder_ + "/a.txt";
};

std::string ErrorOf(const vm::Result<std::vector<Interval>>& result) {
  return result ? "" : result.error().text;
}

TEST_F(RhubarbPeerTest, TheProgramIsCalledWithTheTextAndItsClosedMouthsAreRead) {
  Peer peer{.program = kFake};
  auto closed = peer.Closed(wav_, text_);
  ASSERT_TRUE(closed) << closed.error().text;
  ASSERT_EQ(closed->size(), 4u);
  EXPECT_EQ((*closed)[1].start, 100);
  EXPECT_EQ((*closed)[1].end, 200);
  EXPECT_EQ((*closed)[3].name, "X");
  EXPECT_GT(peer.work_s, 0);
}

TEST_F(RhubarbPeerTest, AProgramThatFailsOrIsNotThereIsAnError) {
  Peer peer{.program = kFake};
  EXPECT_EQ(ErrorOf(peer.Closed(wav_, folder_ + "/none.txt")),
            std::string("program '") + kFake + "' ended with status 3");
  EXPECT_FALSE(IsOnPath("/nowhere/rhubarb"));
  EXPECT_FALSE(IsOnPath("no-such-program-anywhere"));
  EXPECT_TRUE(IsOnPath(kFake));
  EXPECT_TRUE(IsOnPath("sh"));
}

TEST_F(RhubarbPeerTest, AnAnswerThatIsNoneIsAnError) {
  EXPECT_EQ(ErrorOf(ClosedMouths("Sorry.")), "the answer of rhubarb: no JSON");
  EXPECT_EQ(ErrorOf(ClosedMouths("{}")), "the answer of rhubarb: expected {\"mouthCues\": [...]}");
  EXPECT_EQ(ErrorOf(ClosedMouths(R"({"mouthCues": [{"start": 1}]})")),
            "the answer of rhubarb: expected {\"start\": S, \"end\": S, \"value\": SHAPE}, found "
            "{\"start\":1}");
}

TEST_F(RhubarbPeerTest, ClosuresAreHitInTheirMiddleAndMeasuredAtTheirBeginning) {
  const std::vector<Interval> phonemes = {
      {0, 80, "pau"}, {80, 180, "m"}, {180, 300, "aa"}, {300, 360, "b"}, {360, 500, "iy"}};
  Closures closures;
  closures.Add(phonemes, {{100, 200, "A"}, {600, 700, "A"}});
  EXPECT_EQ(closures.hit, 1);
  EXPECT_EQ(closures.all, 2);
  EXPECT_EQ(closures.mean_error(), (20 + 200) / 2.0);
  Closures none;
  none.Add(phonemes, {});
  EXPECT_EQ(none.hit, 0);
  EXPECT_EQ(none.mean_error(), 1000);
}

}  // namespace
}  // namespace speech_bench
