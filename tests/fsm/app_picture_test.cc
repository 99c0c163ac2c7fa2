// Pictures of the face for a program that looks on (Picture.to).

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "fsm/film/picture_sender.h"
#include "fsm/image/image_codec.h"
#include "tests/fsm/app_support.h"
#include "tests/fsm/onlooker.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

TEST(PictureStreamTest, AProgramThatLooksOnGetsPicturesWithTheirTimes) {
  Onlooker onlooker;
  FsmStage stage;
  EXPECT_EQ(stage.Say("inq Picture.to"), "rep Picture.to = NONE");
  stage.Until(100);
  stage.Say("set Picture.to = unix:" + onlooker.path());
  EXPECT_TRUE(stage.errors.empty()) << stage.errors.front();
  stage.Until(101);
  const auto first = onlooker.Next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->time, "100");
  const auto picture = DecodeJpeg(first->jpeg);
  ASSERT_TRUE(picture) << picture.error().text;
  EXPECT_EQ(picture->width, 1);
  stage.Say("set FaceExp = HAPPY 1 100 0");
  stage.Until(141);
  const auto second = onlooker.Next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->time, "140") << "25 a second";
  stage.Say("set Picture.to = NONE");
  EXPECT_FALSE(onlooker.Next()) << "no longer";
}

TEST(PictureStreamTest, AFilmGoesOnBesideIt) {
  Onlooker onlooker;
  FsmStage stage;
  stage.Say("set Picture.to = unix:" + onlooker.path());
  stage.Say("set Record = a.mp4");
  stage.Until(1000);
  stage.Say("set Record = STOP");
  EXPECT_EQ(stage.world.films["a.mp4"].jaws.size(), 31u) << "from 0 to 1000 ms";
  EXPECT_TRUE(onlooker.Next());
  EXPECT_TRUE(stage.errors.empty());
}

TEST(PictureStreamTest, AFaceThatStandsStillIsDrawnTwiceASecond) {
  Onlooker onlooker;
  FsmStage stage;
  stage.Until(1000);
  const int before = stage.world.draws;
  stage.Say("set Picture.to = unix:" + onlooker.path());
  stage.Until(6000);
  EXPECT_GE(stage.world.draws - before, 1);
  EXPECT_LE(stage.world.draws - before, 12);
}

TEST(PictureStreamTest, WhoDoesNotListenAndWhatIsNoPlaceAreErrors) {
  FsmStage stage;
  stage.Say("set Picture.to = unix:/nowhere/socket");
  stage.Say("set Picture.to = somewhere");
  ASSERT_EQ(stage.errors.size(), 2u);
  EXPECT_NE(stage.errors[0].find("nobody takes pictures at '/nowhere/socket'"), std::string::npos);
  EXPECT_NE(stage.errors[1].find("expected NONE or unix:PATH"), std::string::npos);
  EXPECT_EQ(stage.Say("inq Picture.to"), "rep Picture.to = NONE");
}

TEST(PictureStreamTest, OneWhoHasGoneIsForgotten) {
  Onlooker onlooker;
  FsmStage stage;
  stage.Say("set Picture.to = unix:" + onlooker.path());
  stage.Until(1);
  ASSERT_TRUE(onlooker.Next());
  onlooker.Close();
  EXPECT_EQ(stage.Say("inq Picture.to"), "rep Picture.to = NONE");
  const int before = stage.world.draws;
  stage.Until(2000);
  EXPECT_EQ(stage.world.draws, before) << "nothing is drawn for nobody";
}

TEST(PictureStreamTest, AFaceThatCannotBeDrawnSaysSoAndEndsIt) {
  Onlooker onlooker;
  FsmStage stage;
  stage.Say("set Picture.to = unix:" + onlooker.path());
  stage.world.no_drawing = "lost";
  stage.Until(1);
  ASSERT_EQ(stage.errors.size(), 1u);
  EXPECT_NE(stage.errors[0].find("lost"), std::string::npos);
  EXPECT_FALSE(onlooker.Next());
}

TEST(PictureSenderTest, AReceiverThatReadsNothingHoldsNobodyUp) {
  Onlooker onlooker;
  auto sender = PictureSender::Connect(onlooker.path(), 100ms);
  ASSERT_TRUE(sender);
  Image noise = FilledImage(512, 512);
  unsigned seed = 1;
  for (auto& byte : noise.rgba)
    byte = static_cast<std::uint8_t>((seed = seed * 1103515245u + 12345u) >> 16);
  // What the socket holds, the picture that is being sent and the one that waits.
  int sent = 0;
  while (!(*sender)->gone()) {
    if (!(*sender)->full()) (*sender)->Send(noise, vm::Time(sent++));
    std::this_thread::yield();
  }
  EXPECT_LT(sent, 10) << "then it is cut off";
}

}  // namespace
}  // namespace fsm
