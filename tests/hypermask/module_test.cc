// The module on the simulated stage and the virtual clock: what its slots do, start to end.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fsm/image/image_file.h"
#include "hypermask/live/mask_module.h"
#include "hypermask/sim/sim_rig.h"
#include "tests/support/process.h"

namespace hypermask {
namespace {

/// A rig whose events the test gives.
class HandRig final : public Rig {
 public:
  vm::Result<void> Show(const fsm::Image& frame) override {
    if (gone) return vm::Fail(vm::Errc::kUnavailable, "the projector's window was closed");
    shown = frame;
    return {};
  }
  int projector_width() const override { return 320; }
  int projector_height() const override { return 240; }
  bool gone = false;
  fsm::Image shown;
};

class MaskModuleTest : public testing::Test {
 protected:
  MaskModuleTest() {
    const auto open = [this](const MaskModule::RigWish& wish,
                             Rig::Events events) -> vm::Result<std::unique_ptr<Rig>> {
      if (wish.input == "hand") {
        hand_events_ = std::move(events);
        auto rig = std::make_unique<HandRig>();
        hand_ = rig.get();
        return rig;
      }
      auto settings = SimSettings::Parse(wish.input.substr(4));
      if (!settings) return std::unexpected(settings.error());
      return std::make_unique<SimRig>(scheduler_, wish.layout, *settings, std::move(events));
    };
    module_ = std::make_unique<MaskModule>(
        scheduler_, MaskModule::Options{.module_version = "test", .open = open});
    module_->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      lines_.push_back(vm::FormatMessage(message));
    });
    Say("prop Error = AutoOutput");
    Say("prop Track.miss = AutoOutput");
  }
  void Say(const std::string& line) { module_->slots().HandleLine(line); }
  void Run(double seconds) {
    scheduler_.RunUntil(scheduler_.Now() + vm::Time(static_cast<long>(1e6 * seconds)));
  }
  /// The last line that begins so; "" if none does.
  std::string Last(const std::string& beginning) const {
    for (auto line = lines_.rbegin(); line != lines_.rend(); ++line) {
      if (line->starts_with(beginning)) return *line;
    }
    return "";
  }
  std::size_t Count(const std::string& part) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        lines_, [&](const std::string& line) { return line.find(part) != std::string::npos; }));
  }
  double Number(const std::string& beginning) const {
    const std::string line = Last(beginning);
    const auto equals = line.find("= ");
    return equals == std::string::npos ? -1 : std::stod(line.substr(equals + 2));
  }
  /// The stage calibrated by the module itself, its delay measured.
  void CalibrateIt(const std::string& file) {
    Say("set Field = 33");
    Say("set Input = sim:places delay=120 rate=20");
    Say("set Run = START");
    Say("set#d Delay = MEASURE");
    EXPECT_TRUE(module_->Busy());
    Run(9);
    EXPECT_FALSE(module_->Busy());
    for (int place = 1; place <= 4; ++place) {
      Run(place == 1 ? 3.5 : Movement::kHoldSeconds - 9);
      Say(fmt::format("set#p{} Calibrate = PLACE", place));
      Run(9);
      EXPECT_EQ(Last(fmt::format("rep#p{}", place)),
                fmt::format("rep#p{} Calibrate = PLACE", place));
    }
    Say("set#done Calibrate = DONE " + file);
  }

  vm::VirtualScheduler scheduler_;
  HandRig* hand_ = nullptr;
  Rig::Events hand_events_;
  std::vector<std::string> lines_;
  std::unique_ptr<MaskModule> module_;  // last: it uses the above
};

TEST_F(MaskModuleTest, ItMeasuresCalibratesAndPutsTheFaceOnTheMask) {
  support::TempDir folder;
  CalibrateIt(folder / "room.txt");
  EXPECT_NEAR(Number("rep#d Delay"), 120, 12);
  EXPECT_EQ(Last("rep#done"), "rep#done Calibrate = DONE " + (folder / "room.txt"));
  EXPECT_EQ(Last("rep Calibrate.places"), "rep Calibrate.places = 4");
  const auto written = ReadCalibration(folder / "room.txt");
  ASSERT_TRUE(written) << written.error().text;
  EXPECT_LT(written->space_rms, 1);
  EXPECT_NEAR(written->delay_ms.value_or(0), 120, 12);

  // A picture for a face.
  ASSERT_TRUE(fsm::WriteImage(fsm::FilledImage(60, 80, {200, 150, 120, 255}), folder / "face.png"));
  Say("set#f Face = " + (folder / "face.png"));
  EXPECT_TRUE(Last("rep#f Face =").ends_with("face.png"));
  Say("set Input = NONE");
  Say("set Calibration = NONE");
  Say("set#c Calibration = " + (folder / "room.txt"));
  EXPECT_TRUE(Last("rep#c Calibration").ends_with("room.txt"));
  Say("set Input = sim:walk delay=120");
  Run(4);
  EXPECT_EQ(Last("rep Track.stat"), "rep Track.stat = FOLLOWING");
  const double foretold = Number("rep Track.miss");
  EXPECT_GT(foretold, 0);
  Say("set Predict = OFF");
  Run(2);
  Say("set Input = sim:walk delay=120");  // the same steps again
  Run(4);
  const double late = Number("rep Track.miss");
  EXPECT_LT(foretold, 0.7 * late);
  // While there was no calibration it said so.
  EXPECT_EQ(Count(".error"), Count("nothing is projected before"));
}

TEST_F(MaskModuleTest, TwoRunsAreTheSame) {
  Say("prop Track = AutoOutput");
  const auto run = [&] {
    lines_.clear();
    Say("set Input = sim:shake cover=1");
    Say("set Run = START");
    Run(2.5);
    Say("set Run = STOP");
    Run(0.1);
    auto lines = lines_;
    // The clock has gone on.
    for (std::string& line : lines) {
      const auto ms = line.find("\"ms\":");
      if (ms != std::string::npos) line.erase(ms, line.find(',', ms) - ms);
    }
    return lines;
  };
  const auto first = run();
  EXPECT_GT(first.size(), 140U);
  EXPECT_EQ(run(), first);
}

TEST_F(MaskModuleTest, WithoutACalibrationItFollowsAndSaysOnceThatNothingIsProjected) {
  Say("set Input = sim:sway");
  EXPECT_EQ(Last("rep Track.stat"), "");
  Say("set Run = START");
  Run(1);
  EXPECT_EQ(Last("rep Track.stat"), "rep Track.stat = FOLLOWING");
  EXPECT_EQ(Count("rep Calibration.error = UNAVAILABLE nothing is projected before there is a"),
            1U);
  Say("set Run = STOP");
  EXPECT_EQ(Last("rep Track.stat"), "rep Track.stat = OFF");
  scheduler_.RunReady();
  EXPECT_EQ(scheduler_.pending(), 0U);
}

TEST_F(MaskModuleTest, BadValuesAreRefusedWithWhatWasExpected) {
  Say("set Input = sim:dance");
  Say("set#2 Run = START");
  EXPECT_NE(Last("rep#2").find("'dance' is no movement, expected one of: still, places, sway"),
            std::string::npos);
  Say("set Input = sim:sway delay=9999");
  Say("set#3 Run = START");
  EXPECT_NE(Last("rep#3").find("found 'delay=9999', expected delay=0..1000"), std::string::npos);
  Say("set#4 Calibration = /nothing/room.txt");
  EXPECT_NE(Last("rep#4 Calibration.error").find("/nothing/room.txt"), std::string::npos);
  Say("set#5 Mask = /nothing/mask.txt");
  EXPECT_NE(Last("rep#5 Mask.error").find("/nothing/mask.txt"), std::string::npos);
  Say("set#6 Face = /nothing/face.png");
  EXPECT_NE(Last("rep#6 Face.error").find("/nothing/face.png"), std::string::npos);
  Say("set#7 Delay = MEASURE");
  EXPECT_EQ(Last("rep#7"), "rep#7 Delay.error = UNAVAILABLE set Input and Run = START before");
  Say("set#8 Calibrate = PLACE");
  EXPECT_EQ(Last("rep#8"), "rep#8 Calibrate.error = UNAVAILABLE set Input and Run = START before");
  Say("set#9 Calibrate = DONE /nothing/room.txt");
  EXPECT_NE(Last("rep#9").find("UNAVAILABLE"), std::string::npos);
  Say("set#10 Predict = MAYBE");
  EXPECT_NE(Last("rep#10").find("BAD_VALUE"), std::string::npos);
}

TEST_F(MaskModuleTest, WhatIsBeingMeasuredEndsWithTheRun) {
  Say("set Input = sim:still");
  Say("set Run = START");
  Say("set#a Delay = MEASURE");
  Run(1);
  Say("set#b Calibrate = PLACE");
  EXPECT_NE(Last("rep#b").find("BUSY"), std::string::npos);
  Say("set Run = STOP");
  EXPECT_NE(Last("rep#a").find("Delay.error = STOPPED"), std::string::npos) << Last("rep#a");
  EXPECT_FALSE(module_->Busy());
  Run(20);
  EXPECT_EQ(Last("rep Track.stat"), "rep Track.stat = OFF");
}

TEST_F(MaskModuleTest, ACameraThatGoesIsOneErrorAndTheEndOfTheRun) {
  Say("set Input = hand");
  Say("set Run = START");
  hand_events_.picture(Grey(640, 480, 20), scheduler_.Now());
  hand_events_.over(vm::Error{vm::Errc::kUnavailable, "'hand' ended early, after 1 pictures"});
  EXPECT_EQ(Last("rep Input.error"),
            "rep Input.error = UNAVAILABLE 'hand' ended early, after 1 pictures");
  EXPECT_EQ(Last("rep Input ="), "rep Input = NONE");
  EXPECT_EQ(Last("rep Track.stat"), "rep Track.stat = OFF");
  // A late picture of it is of no one.
  hand_events_.picture(Grey(640, 480, 20), scheduler_.Now());
  Run(1);
}

TEST_F(MaskModuleTest, PicturesWithoutAMaskAreOneErrorAfterThreeSeconds) {
  Say("set Input = hand");
  Say("set Run = START");
  for (int i = 0; i < 60; ++i) {
    Run(0.1);
    hand_events_.picture(Grey(640, 480, 20), scheduler_.Now());
  }
  EXPECT_EQ(Count("Input.error"), 1U);
  EXPECT_EQ(
      Last("rep Input.error"),
      "rep Input.error = UNAVAILABLE no mask is seen in 'hand': there are 0 bright spots, its "
      "5 markers are looked for");
}

TEST_F(MaskModuleTest, AProjectorThatIsClosedStopsTheRun) {
  Say("set Input = hand");
  Say("set Run = START");
  hand_->gone = true;
  hand_events_.picture(Grey(640, 480, 20), scheduler_.Now());
  EXPECT_EQ(Last("rep Projector.error"),
            "rep Projector.error = UNAVAILABLE the projector's window was closed");
  EXPECT_EQ(Last("rep Run"), "rep Run = STOP");
  Run(1);
}

TEST_F(MaskModuleTest, ACalibrationOfAnotherCameraIsSaidOnce) {
  support::TempDir folder;
  Calibration other{
      .camera = Pinhole::OfField(320, 240, 40), .projector_width = 800, .projector_height = 600};
  other.space << 1500, 0, 640, 10, 0, 1500, 360, 20, 0, 0, 1, 0;
  ASSERT_TRUE(WriteCalibration(other, folder / "other.txt"));
  Say("set Calibration = " + (folder / "other.txt"));
  Say("set Input = sim:sway");
  Say("set Run = START");
  Run(0.5);
  EXPECT_EQ(Count("Calibration.error"), 1U);
  EXPECT_NE(Last("rep Calibration.error")
                .find("a camera of 320 x 240 and a projector of 800 x 600, "
                      "here they have 640 x 480 and 1280 x 720"),
            std::string::npos);
}

TEST(PictureRecordsTest, RecordsInPiecesAreWhole) {
  const std::string stream = "picture 12.5 3\nabcpicture 20 4\ndefg";
  for (std::size_t size = 1; size <= stream.size(); ++size) {
    PictureRecords records;
    std::string why, all;
    for (std::size_t at = 0; at < stream.size(); at += size) {
      ASSERT_TRUE(records.Add(std::string_view(stream).substr(at, size), why)) << why;
      all += records.TakeNewest();
    }
    EXPECT_TRUE(all == "abcdefg" || all == "defg") << size << " " << all;
  }
}

TEST(PictureRecordsTest, WhatIsNoRecordIsRefused) {
  for (const std::string bad :
       {"picture 1 \n", "picture 1 -3\n", "picture 1 99999999999\n", "picture 1 0\n",
        "sound 1 2 3\n", "picture\n", "picture 5\n", "picture 1 3x\n", "\n"}) {
    PictureRecords records;
    std::string why;
    EXPECT_FALSE(records.Add(bad, why)) << bad;
    EXPECT_FALSE(why.empty());
  }
  PictureRecords endless;
  std::string why;
  EXPECT_FALSE(endless.Add(std::string(200, 'p'), why));
  EXPECT_EQ(why, "sent a record whose first line has no end");
}

}  // namespace
}  // namespace hypermask
