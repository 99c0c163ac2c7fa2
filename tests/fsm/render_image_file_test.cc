#include <random>

#include "fsm/image/image_codec.h"
#include "fsm/image/image_file.h"
#include "fsm/image/shrink.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

class PictureFormat : public ::testing::TestWithParam<const char*> {
 protected:
  std::string Path(const std::string& name = "picture") const {
    return folder_ / (name + GetParam());
  }
  TemporaryFolder folder_;
};

TEST_P(PictureFormat, ComesBackAsWritten) {
  // Widths of every remainder by four, for formats that pad their rows.
  for (const int width : {1, 2, 3, 4, 5, 17}) {
    const Image image = Pattern(width, 6);
    ASSERT_TRUE(WriteImage(image, Path()));
    const auto read = ReadImage(Path());
    ASSERT_TRUE(read) << read.error().text;
    EXPECT_EQ(read->width, width);
    EXPECT_EQ(read->height, 6);
    EXPECT_EQ(read->rgba, image.rgba);
  }
  EXPECT_EQ(folder_.files(), 1U) << "drafts are left behind";
}

TEST_P(PictureFormat, EveryTruncationIsAnError) {
  ASSERT_TRUE(WriteImage(Pattern(5, 4), Path()));
  auto bytes = FileBytes(Path());
  while (!bytes.empty()) {
    bytes.pop_back();
    WriteBytes(Path("cut"), bytes);
    const auto read = ReadImage(Path("cut"));
    // A PNG is whole before its closing chunks; all the others need their last byte.
    if (read && std::string(GetParam()) == ".png") continue;
    ASSERT_FALSE(read) << bytes.size();
    EXPECT_EQ(read.error().code, vm::Errc::kBadValue);
    EXPECT_NE(read.error().text.find("cut"), std::string::npos);
  }
}

TEST_P(PictureFormat, DamagedBytesNeverCrash) {
  ASSERT_TRUE(WriteImage(Pattern(9, 7), Path()));
  const auto whole = FileBytes(Path());
  std::mt19937 random(7);
  for (int round = 0; round < 3000; ++round) {
    auto bytes = whole;
    for (int hit = 0; hit < 4; ++hit) {
      // Headers are where the interesting damage is.
      const auto place =
          random() % (hit < 3 ? std::min<std::size_t>(64, bytes.size()) : bytes.size());
      bytes[place] = static_cast<std::uint8_t>(random());
    }
    const std::string format = GetParam();
    const auto decoded = format == ".png"   ? DecodePng(bytes)
                         : format == ".bmp" ? DecodeBmp(bytes)
                                            : DecodeSgi(bytes);
    if (!decoded) {
      EXPECT_FALSE(decoded.error().text.empty());
    } else {
      EXPECT_EQ(decoded->rgba.size(), static_cast<std::size_t>(decoded->width) *
                                          static_cast<std::size_t>(decoded->height) * 4);
    }
  }
}

TEST_P(PictureFormat, UnwritablePlaceIsUnavailable) {
  const auto written =
      WriteImage(Pattern(2, 2), folder_ / (std::string("no/such/folder") + GetParam()));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, vm::Errc::kUnavailable);
}

TEST_P(PictureFormat, MissingFileAndFolderAreUnavailable) {
  ASSERT_FALSE(ReadImage(Path("missing")));
  EXPECT_EQ(ReadImage(Path("missing")).error().code, vm::Errc::kUnavailable);
  std::filesystem::create_directory(Path("folder"));
  ASSERT_FALSE(ReadImage(Path("folder")));
  EXPECT_EQ(ReadImage(Path("folder")).error().code, vm::Errc::kUnavailable);
}

INSTANTIATE_TEST_SUITE_P(All, PictureFormat, ::testing::Values(".png", ".bmp", ".rgb"),
                         [](const auto& test) { return std::string(test.param + 1); });

TEST(ImageFileTest, OtherEndingIsABadValue) {
  TemporaryFolder folder;
  EXPECT_EQ(WriteImage(Pattern(2, 2), folder / "a.jpg").error().code, vm::Errc::kBadValue);
  for (const char* name : {"a.gif", "png", "a.png.gz", ""}) {
    EXPECT_EQ(WriteImage(Pattern(2, 2), folder / name).error().code, vm::Errc::kBadValue) << name;
    EXPECT_EQ(ReadImage(folder / name).error().code, vm::Errc::kBadValue) << name;
  }
}

TEST(ImageFileTest, EndingMayBeInCapitals) {
  TemporaryFolder folder;
  ASSERT_TRUE(WriteImage(Pattern(3, 3), folder / "A.PNG"));
  EXPECT_TRUE(ReadImage(folder / "A.PNG"));
}

TEST(ImageFileTest, PngKeepsOpacity) {
  TemporaryFolder folder;
  Image image = Pattern(4, 4);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    image.rgba[i] = static_cast<std::uint8_t>(i);
  ASSERT_TRUE(WriteImage(image, folder / "a.png"));
  EXPECT_EQ(ReadImage(folder / "a.png")->rgba, image.rgba);
}

TEST(ImageFileTest, BmpOf32BitsAndDownwardRowsIsRead) {
  // One red pixel above one blue, by the file format's own definition.
  const std::vector<std::uint8_t> bytes{
      'B', 'M',  62,   0,    0,    0, 0, 0,  0, 0, 54, 0, 0, 0, 40,  0, 0,   0, 1, 0, 0,
      0,   0xfe, 0xff, 0xff, 0xff, 1, 0, 32, 0, 0, 0,  0, 0, 8, 0,   0, 0,   0, 0, 0, 0,
      0,   0,    0,    0,    0,    0, 0, 0,  0, 0, 0,  0, 0, 0, 255, 0, 255, 0, 0, 0};
  const auto image = DecodeBmp(bytes);
  ASSERT_TRUE(image) << image.error().text;
  EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 255}));
}

TEST(ImageFileTest, PackedSgiIsRead) {
  // 4 x 1, grey: a run of three 9s and a literal 5.
  std::vector<std::uint8_t> bytes(512, 0);
  const std::vector<std::uint8_t> start{1, 0xda, 1, 1, 0, 2, 0, 4, 0, 1, 0, 1};
  std::copy(start.begin(), start.end(), bytes.begin());
  for (const int b : {0, 0, 2, 8, 0, 0, 0, 5, 3, 9, 0x81, 5, 0}) {
    bytes.push_back(static_cast<std::uint8_t>(b));
  }
  const auto image = DecodeSgi(bytes);
  ASSERT_TRUE(image) << image.error().text;
  EXPECT_EQ(image->rgba,
            (std::vector<std::uint8_t>{9, 9, 9, 255, 9, 9, 9, 255, 9, 9, 9, 255, 5, 5, 5, 255}));
}

TEST(ImageFileTest, HugeSizesAreRefusedBeforeTheyAreBelieved) {
  auto bmp = EncodeBmp(Pattern(2, 2));
  for (const std::size_t i : {18U, 22U}) {
    auto huge = bmp;
    huge[i + 2] = 0x7f;
    const auto read = DecodeBmp(huge);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().text.find("size"), std::string::npos);
    huge[i + 3] = 0x80;
    EXPECT_FALSE(DecodeBmp(huge));
  }
}

TEST(ShrunkTest, EveryPixelIsTheMeanOfWhatItCovers) {
  Image row{3, 1, {}};
  for (const int grey : {30, 60, 120})
    row.rgba.insert(row.rgba.end(), 4, static_cast<std::uint8_t>(grey));
  const Image two = Shrunk(row, 2, 1);  // a pixel and a half each
  EXPECT_EQ(two.rgba, (std::vector<std::uint8_t>{40, 40, 40, 40, 100, 100, 100, 100}));
  const Image plain = FilledImage(7, 5, {10, 20, 30, 255});
  EXPECT_EQ(Shrunk(plain, 3, 2).rgba, FilledImage(3, 2, {10, 20, 30, 255}).rgba);
  EXPECT_EQ(Shrunk(row, 3, 1).rgba, row.rgba);
}

}  // namespace
}  // namespace fsm
