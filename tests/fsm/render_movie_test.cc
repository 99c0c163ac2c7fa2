#include <signal.h>
#include <sys/stat.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "fsm/film/film_writer.h"
#include "fsm/image/byte_order.h"
#include "fsm/image/image.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

constexpr int kFps = 25;

std::string OutputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> block;
  for (std::size_t got = 0; (got = fread(block.data(), 1, block.size(), pipe)) > 0;) {
    text.append(block.data(), got);
  }
  pclose(pipe);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string Probe(const std::string& path, const std::string& stream, const std::string& entry) {
  return OutputOf("ffprobe -v error -count_packets -select_streams " + stream +
                  " -show_entries stream=" + entry + " -of csv=p=0 '" + path + "'");
}

/// Runs a film of `frames` pictures through to its end.
vm::Result<void> MakeFilm(const std::string& path, int width, int height, int frames,
                          const std::string& sound = "") {
  auto movie = FilmWriter::Open(path, width, height, kFps);
  if (!movie) return std::unexpected(movie.error());
  for (int i = 0; i < frames; ++i) {
    if (auto added = (*movie)->Add(Pattern(width, height, i * 5)); !added) return added;
  }
  return (*movie)->Finish(sound);
}

/// 16 kHz, one channel, 16 bit: silence, with a tone from `from` to `to` seconds.
void WriteWav(const std::string& path, double seconds, double from, double to) {
  constexpr std::uint32_t kRate = 16000;
  const auto samples = static_cast<std::uint32_t>(seconds * kRate);
  std::vector<std::uint8_t> bytes;
  const auto word = [&bytes](const char* text) { bytes.insert(bytes.end(), text, text + 4); };
  word("RIFF");
  AppendLittleEndian(bytes, 36 + samples * 2, 4);
  word("WAVE");
  word("fmt ");
  AppendLittleEndian(bytes, 16, 4);
  AppendLittleEndian(bytes, 1, 2);
  AppendLittleEndian(bytes, 1, 2);
  AppendLittleEndian(bytes, kRate, 4);
  AppendLittleEndian(bytes, kRate * 2, 4);
  AppendLittleEndian(bytes, 2, 2);
  AppendLittleEndian(bytes, 16, 2);
  word("data");
  AppendLittleEndian(bytes, samples * 2, 4);
  for (std::uint32_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / kRate;
    const double value = t >= from && t < to ? std::sin(t * 440 * 2 * std::numbers::pi) : 0;
    AppendLittleEndian(bytes, static_cast<std::uint32_t>(std::lround(value * 20000)) & 0xffff, 2);
  }
  WriteBytes(path, bytes);
}

/// Replaces ffmpeg by a shell script for the length of a test.
class FakeFfmpeg {
 public:
  explicit FakeFfmpeg(const std::string& script) {
    const std::string path = folder_ / "ffmpeg";
    WriteBytes(path, std::vector<std::uint8_t>(script.begin(), script.end()));
    chmod(path.c_str(), 0755);
    const char* old = std::getenv("PATH");
    kept_ = old ? old : "";
    setenv("PATH", ((folder_ / "") + ":" + kept_).c_str(), 1);
  }
  ~FakeFfmpeg() { setenv("PATH", kept_.c_str(), 1); }

 private:
  TemporaryFolder folder_;
  std::string kept_;
};

class MovieTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string film_ = folder_ / "film.mp4";
};

TEST_F(MovieTest, TenPicturesMakeTenFrames) {
  ASSERT_TRUE(MakeFilm(film_, 64, 48, 10));
  EXPECT_EQ(Probe(film_, "v", "codec_name,width,height,pix_fmt,r_frame_rate,nb_read_packets"),
            "h264,64,48,yuv420p,25/1,10");
  EXPECT_EQ(Probe(film_, "a", "codec_name"), "");
  EXPECT_EQ(folder_.files(), 1U) << "drafts are left behind";
}

TEST_F(MovieTest, SamePicturesMakeTheSameBytes) {
  const std::string sound = folder_ / "sound.wav";
  WriteWav(sound, 0.5, 0.1, 0.3);
  ASSERT_TRUE(MakeFilm(film_, 64, 48, 12, sound));
  ASSERT_TRUE(MakeFilm(folder_ / "again.mp4", 64, 48, 12, sound));
  EXPECT_EQ(FileBytes(film_), FileBytes(folder_ / "again.mp4"));
}

TEST_F(MovieTest, OddSizesAreMadeEvenByRepeatingTheEdge) {
  ASSERT_TRUE(MakeFilm(film_, 63, 47, 2));
  EXPECT_EQ(Probe(film_, "v", "width,height,nb_read_packets"), "64,48,2");
}

TEST_F(MovieTest, ColoursSurvive) {
  auto movie = FilmWriter::Open(film_, 32, 32, kFps);
  ASSERT_TRUE(movie);
  Image skin{32, 32, {}};
  for (int i = 0; i < 32 * 32; ++i) skin.rgba.insert(skin.rgba.end(), {224, 172, 140, 255});
  ASSERT_TRUE((*movie)->Add(skin));
  ASSERT_TRUE((*movie)->Finish(""));
  const std::string pixels =
      OutputOf("ffmpeg -v error -i '" + film_ + "' -f rawvideo -pix_fmt rgb24 -");
  ASSERT_EQ(pixels.size(), 32U * 32 * 3);
  const std::array<int, 3> wanted{224, 172, 140};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(static_cast<unsigned char>(pixels[c]), wanted[c], 4);
  }
}

/// The left half opaque skin, the right half clear.
Image HalfClear(int width, int height) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const bool clear = i % width >= width / 2;
    const std::array<std::uint8_t, 4> pixel = clear
                                                  ? std::array<std::uint8_t, 4>{0, 0, 0, 0}
                                                  : std::array<std::uint8_t, 4>{224, 172, 140, 255};
    image.rgba.insert(image.rgba.end(), pixel.begin(), pixel.end());
  }
  return image;
}

TEST_F(MovieTest, MovAndWebmKeepWhatIsTransparent) {
  const std::string sound = folder_ / "sound.wav";
  WriteWav(sound, 0.5, 0.1, 0.3);
  struct Kind {
    const char* file;
    const char* decoder;
    const char* video;
    const char* audio;
  };
  for (const Kind& kind : {Kind{"clear.mov", "prores", "prores,64,48,5", "pcm_s16le"},
                           // ffmpeg's own decoder of VP9 passes over the transparency.
                           Kind{"clear.webm", "libvpx-vp9", "vp9,64,48,5", "opus"}}) {
    const std::string film = folder_ / kind.file;
    auto movie = FilmWriter::Open(film, 63, 47, kFps);
    ASSERT_TRUE(movie) << movie.error().text;
    for (int i = 0; i < 5; ++i) ASSERT_TRUE((*movie)->Add(HalfClear(63, 47)));
    const auto finished = (*movie)->Finish(sound);
    ASSERT_TRUE(finished) << finished.error().text;
    EXPECT_EQ(Probe(film, "v", "codec_name,width,height,nb_read_packets"), kind.video);
    EXPECT_EQ(Probe(film, "a", "codec_name"), kind.audio);
    const std::string pixels = OutputOf(
        "ffmpeg -v error -c:v " + std::string(kind.decoder) + " -i '" + film +
        "' -f rawvideo -pix_fmt rgba - | tail -c " + std::to_string(64 * 48 * 4) + "; echo .");
    ASSERT_EQ(pixels.size(), 64U * 48 * 4 + 1) << film;
    const auto at = [&](int x, int y, int channel) {
      return static_cast<unsigned char>(
          pixels[static_cast<std::size_t>((y * 64 + x) * 4 + channel)]);
    };
    EXPECT_NEAR(at(8, 20, 0), 224, 6) << film;
    EXPECT_NEAR(at(8, 20, 2), 140, 6) << film;
    EXPECT_GE(at(8, 20, 3), 253) << film;
    EXPECT_LE(at(50, 20, 3), 2) << film;
    EXPECT_LE(at(63, 47, 3), 2) << film << ": what is added to an odd size";
  }
}

TEST_F(MovieTest, SoundStartsWithTheFirstPicture) {
  const std::string sound = folder_ / "sound.wav";
  WriteWav(sound, 1.0, 0.4, 0.6);
  ASSERT_TRUE(MakeFilm(film_, 64, 48, 25, sound));
  EXPECT_EQ(Probe(film_, "a", "codec_name,start_time"), "aac,0.000000");
  EXPECT_EQ(Probe(film_, "v", "start_time,nb_read_packets"), "0.000000,25");
  const std::string samples =
      OutputOf("ffmpeg -v error -i '" + film_ + "' -ar 16000 -ac 1 -f s16le -");
  std::size_t onset = 0;
  for (std::size_t i = 0; i + 1 < samples.size() && onset == 0; i += 2) {
    const auto value = static_cast<std::int16_t>(static_cast<unsigned char>(samples[i]) |
                                                 static_cast<unsigned char>(samples[i + 1]) << 8);
    if (std::abs(value) > 5000) onset = i / 2;
  }
  EXPECT_NEAR(static_cast<double>(onset) / 16000, 0.4, 0.004);
}

TEST_F(MovieTest, WithoutItsSoundTheSilentFilmIsKept) {
  const auto finished = MakeFilm(film_, 64, 48, 3, folder_ / "missing.wav");
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, vm::Errc::kUnavailable);
  EXPECT_NE(finished.error().text.find("missing.wav"), std::string::npos) << finished.error().text;
  EXPECT_EQ(Probe(film_, "v", "nb_read_packets"), "3");
  EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(MovieTest, RawFramesFollowEachOther) {
  const TemporaryFolder folder;
  auto writer = FilmWriter::Open(folder / "film.rgba", 5, 3, 30);
  ASSERT_TRUE(writer) << writer.error().text;
  const Image frames[] = {Pattern(5, 3), Pattern(5, 3, 40)};
  for (const Image& frame : frames) ASSERT_TRUE((*writer)->Add(frame));
  ASSERT_TRUE((*writer)->Finish(""));
  auto expected = frames[0].rgba;
  expected.insert(expected.end(), frames[1].rgba.begin(), frames[1].rgba.end());
  EXPECT_EQ(FileBytes(folder / "film.rgba"), expected);
}

TEST_F(MovieTest, AMatroskaFilmKeepsEveryPixelItsRateAndWhatIsSaidOfIt) {
  const std::string path = folder_ / "film.mkv";
  auto movie = FilmWriter::Open(path, 31, 17, 30000.0 / 1001, "altered: yes");
  ASSERT_TRUE(movie) << movie.error().text;
  const Image frames[] = {Pattern(31, 17), Pattern(31, 17, 40)};
  std::vector<std::uint8_t> expected;
  for (const Image& frame : frames) {
    ASSERT_TRUE((*movie)->Add(frame));
    for (std::size_t i = 0; i < frame.rgba.size(); ++i) {
      if (i % 4 != 3) expected.push_back(frame.rgba[i]);
    }
  }
  ASSERT_TRUE((*movie)->Finish(""));
  EXPECT_EQ(Probe(path, "v", "r_frame_rate"), "30000/1001");
  EXPECT_EQ(
      OutputOf("ffprobe -v error -show_entries format_tags=comment -of csv=p=0 '" + path + "'"),
      "altered: yes");
  ASSERT_EQ(OutputOf("ffmpeg -v error -y -i '" + path + "' -f rawvideo -pix_fmt rgb24 '" +
                     (folder_ / "raw") + "' 2>&1"),
            "");
  EXPECT_EQ(FileBytes(folder_ / "raw"), expected);
}

TEST_F(MovieTest, PipeWithoutAReaderIsRefused) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.rgba").c_str(), 0600), 0);
  const auto writer = FilmWriter::Open(folder / "pipe.rgba", 4, 4, 30);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().text.find("nobody reads"), std::string::npos) << writer.error().text;
}

TEST_F(MovieTest, AFrameOfAnotherSizeIsRefusedAndLeftOut) {
  for (const char* name : {"film.mp4", "film.rgba"}) {
    auto writer = FilmWriter::Open(folder_ / name, 64, 48, kFps);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->Add(Pattern(64, 48, 0)));
    const auto added = (*writer)->Add(Pattern(48, 64, 0));
    ASSERT_FALSE(added) << name;
    EXPECT_EQ(added.error().code, vm::Errc::kBadValue);
    EXPECT_NE(added.error().text.find("a frame of 48x64"), std::string::npos) << added.error().text;
    EXPECT_TRUE((*writer)->Add(Pattern(64, 48, 5)));
    EXPECT_TRUE((*writer)->Finish(""));
  }
  EXPECT_EQ(std::filesystem::file_size(folder_ / "film.rgba"), 2U * 64 * 48 * 4);
}

TEST_F(MovieTest, UnfinishedFilmLeavesNoFile) {
  {
    auto movie = FilmWriter::Open(film_, 64, 48, kFps);
    ASSERT_TRUE(movie);
    ASSERT_TRUE((*movie)->Add(Pattern(64, 48)));
  }
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MovieTest, EmptyFilmIsAnError) {
  EXPECT_FALSE(MakeFilm(film_, 64, 48, 0));
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MovieTest, UnusableRequestsAreRefusedAtOnce) {
  EXPECT_EQ(FilmWriter::Open(folder_ / "a.avi", 64, 48, kFps).error().code, vm::Errc::kBadValue);
  EXPECT_EQ(FilmWriter::Open(film_, 0, 48, kFps).error().code, vm::Errc::kBadValue);
  EXPECT_EQ(FilmWriter::Open(film_, 64, 48, 0).error().code, vm::Errc::kBadValue);
  EXPECT_EQ(FilmWriter::Open(folder_ / "no/such/a.mp4", 64, 48, kFps).error().code,
            vm::Errc::kUnavailable);
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MovieTest, NamesThatLookLikeOptionsOrShellAreOnlyNames) {
  const std::string name = folder_ / "-y $(touch x) 'a' %d;.mp4";
  ASSERT_TRUE(MakeFilm(name, 64, 48, 2));
  EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(MovieTest, MissingFfmpegIsSaidClearly) {
  const std::string kept = std::getenv("PATH");
  setenv("PATH", (folder_ / "").c_str(), 1);
  const auto movie = FilmWriter::Open(film_, 64, 48, kFps);
  setenv("PATH", kept.c_str(), 1);
  ASSERT_FALSE(movie);
  EXPECT_EQ(movie.error().code, vm::Errc::kUnavailable);
  EXPECT_NE(movie.error().text.find("ffmpeg must be installed"), std::string::npos)
      << movie.error().text;
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MovieTest, ProcessKilledHalfWayIsAnErrorAndNoSignal) {
  const FakeFfmpeg fake("#!/bin/sh\nhead -c 100000 > /dev/null\nkill -KILL $$\n");
  const auto finished = MakeFilm(film_, 640, 480, 10);
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, vm::Errc::kUnavailable);
  EXPECT_NE(finished.error().text.find("signal 9"), std::string::npos) << finished.error().text;
  EXPECT_EQ(folder_.files(), 0U);
}

TEST_F(MovieTest, AfterAFaultEveryCallIsAnError) {
  const FakeFfmpeg fake("#!/bin/sh\nexit 1\n");
  auto movie = FilmWriter::Open(film_, 640, 480, kFps);
  ASSERT_TRUE(movie);
  while ((*movie)->Add(Pattern(640, 480))) {
  }
  EXPECT_FALSE((*movie)->Add(Pattern(640, 480)));
  EXPECT_FALSE((*movie)->Finish(""));
}

TEST_F(MovieTest, LastWordsOfTheProcessAreReported) {
  const FakeFfmpeg fake(
      "#!/bin/sh\necho first >&2\necho 'Unknown encoder libx264' >&2\necho >&2\nexit 1\n");
  const auto finished = MakeFilm(film_, 640, 480, 10);
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().text.find("Unknown encoder libx264"), std::string::npos)
      << finished.error().text;
}

TEST_F(MovieTest, FloodOfMessagesNeitherBlocksNorGrows) {
  const FakeFfmpeg fake(
      "#!/bin/sh\nhead -c 3000000 /dev/zero | tr '\\0' 'x' >&2\ncat > /dev/null\nexit 3\n");
  const auto finished = MakeFilm(film_, 640, 480, 10);
  ASSERT_FALSE(finished);
  EXPECT_LT(finished.error().text.size(), 1000U);
}

}  // namespace
}  // namespace fsm
