// What draws off screen, and in which order ways to it are tried.

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "fsm/render/off_screen.h"
#include "fsm/render/renderer.h"
#include "tests/fsm/ball_head.h"

namespace fsm {
namespace {

constexpr int kWide = 160, kHigh = 120;

Image Drawn(RenderContext& context) {
  const BallHead head;
  HeadVertices vertices;
  head.Evaluate({}, vertices);
  const auto renderer = Renderer::Make(context);
  renderer->DrawVertices(head, vertices, {}, {});
  Image image;
  renderer->Read(image);
  return image;
}

/// The context, or nothing and the reason.
template <typename Make>
std::unique_ptr<RenderContext> Try(Make make, std::string& why) {
  try {
    return make();
  } catch (const std::runtime_error& error) {
    why = error.what();
    return nullptr;
  }
}

TEST(OffScreenTest, SoftwareIsWhatIsMadeWhenNothingIsSaid) {
  const auto context = RenderContext::MakeHeadless(kWide, kHigh);
  const std::string way = context->description();
  EXPECT_TRUE(way == "OSMesa" || way.ends_with(", software")) << way;
  EXPECT_NE(DescribeOffScreen(OffScreenDriver::kOsMesa).find("by " + way), std::string::npos);
  EXPECT_NE(DescribeOffScreen(OffScreenDriver::kOsMesa).find("OpenGL "), std::string::npos);
}

TEST(OffScreenTest, EglIsGraphicsCardsFirstAndThenMesaWithoutASurface) {
  std::string why, no_gpu;
  const auto gpu = Try([] { return MakeEglDeviceContext(kWide, kHigh, false); }, no_gpu);
  const auto chosen =
      Try([] { return RenderContext::MakeHeadless(kWide, kHigh, OffScreenDriver::kEgl); }, why);
  if (!chosen) GTEST_SKIP() << "needs EGL (Debian: libegl1, libegl-dev): " << why;
  EXPECT_EQ(chosen->description(), gpu ? gpu->description() : "EGL, Mesa without a surface");
  EXPECT_TRUE(gpu || no_gpu.starts_with("EGL: ")) << no_gpu;
  const auto any = RenderContext::MakeHeadless(kWide, kHigh, OffScreenDriver::kAny);
  EXPECT_EQ(any->description(), chosen->description());
}

TEST(OffScreenTest, MesasSoftwareDeviceDrawsWhatOsMesaDraws) {
  std::string why;
  const auto device = Try([] { return MakeEglDeviceContext(kWide, kHigh, true); }, why);
  if (!device) GTEST_SKIP() << "needs Mesa's EGL (Debian: libegl-mesa0): " << why;
  EXPECT_TRUE(device->description().ends_with(", software")) << device->description();
  const Image by_device = Drawn(*device);
  const auto software = RenderContext::MakeHeadless(kWide, kHigh);
  const Image image = Drawn(*software);
  int different = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    different += std::abs(image.rgba[i] - by_device.rgba[i]) > 4;
  }
  EXPECT_LE(different, kWide * kHigh / 200);
}

TEST(OffScreenTest, SizesThatNoPictureHasAreRefusedByEveryWay) {
  EXPECT_THROW(RenderContext::MakeHeadless(0, 4, OffScreenDriver::kAny), std::runtime_error);
  EXPECT_THROW(RenderContext::MakeHeadless(4, kMaxImageSide + 1, OffScreenDriver::kEgl),
               std::runtime_error);
}

}  // namespace
}  // namespace fsm
