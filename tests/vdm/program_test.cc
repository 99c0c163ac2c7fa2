// The real program: tracks, bad input, and a pipe in real time.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/support/process.h"

namespace {

std::string Bytes(std::uint32_t value, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += static_cast<char>(value >> (8 * i) & 0xFF);
  return text;
}

/// A WAV header for `promised` bytes, and `given` behind it.
std::string Wav(std::uint32_t rate, std::uint32_t channels, std::uint32_t promised,
                const std::string& given) {
  return "RIFF" + Bytes(promised + 36, 4) + "WAVEfmt " + Bytes(16, 4) + Bytes(1, 2) +
         Bytes(channels, 2) + Bytes(rate, 4) + Bytes(rate * channels * 2, 4) +
         Bytes(2 * channels, 2) + Bytes(16, 2) + "data" + Bytes(promised, 4) + given;
}

/// Syllables of a kind: harmonics of 120 Hz round 700 and 1200 Hz, swelling 4 times a second.
std::string Syllables(double seconds, std::uint32_t rate, std::uint32_t channels, double gain,
                      double dc = 0) {
  std::string bytes;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(seconds * rate); ++i) {
    const double t = static_cast<double>(i) / rate;
    double x = 0;
    for (int k = 1; k <= 28; ++k) {
      const double hz = 120 * k;
      x += (1 / (1 + std::pow((hz - 700) / 90, 2)) + 1 / (1 + std::pow((hz - 1200) / 90, 2))) *
           std::sin(6.2831853 * hz * t);
    }
    const double y = dc + gain * 4000 * std::pow(std::sin(3.14159265 * 4 * t), 2) * x;
    const auto sample = static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::lround(std::clamp(y, -32768.0, 32767.0))));
    for (std::uint32_t c = 0; c < channels; ++c) bytes += Bytes(sample, 2);
  }
  return bytes;
}

struct Track {
  int code = -1;
  std::vector<double> opening;
  std::string error;
};

class VdmProgramTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  static Track TrackOf(const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> argv = {GALATEA_BIN_DIR "/vdm", file};
    argv.insert(argv.end(), more.begin(), more.end());
    argv.emplace_back("--no-words");
    support::Process program(argv);
    Track track;
    for (const std::string& line : program.ReadAll()) {
      std::istringstream cells(line);
      std::string ms, sound, opening;
      std::getline(cells, ms, ',') && std::getline(cells, sound, ',') &&
          std::getline(cells, opening, ',');
      if (!opening.empty() && ms != "ms") track.opening.push_back(std::stod(opening));
    }
    track.code = program.Wait().value_or(-1);
    program.ExpectError("vdm:", support::Millis{100});
    track.error = program.ErrorText();
    return track;
  }
  /// A model of one leaf a state: the jaw at 5 degrees, the lips 3 mm apart.
  static std::string OneLeafTriphones() {
    std::string leaf = "leaf\nmeans", text = "step 10\n";
    for (int i = 0; i < 57; ++i) leaf += i == 2 ? " 3" : i == 11 ? " 5" : " 0";
    leaf += "\nvariances";
    for (int i = 0; i < 57; ++i) leaf += " 1";
    for (const char* state : {"beginning", "middle", "end"})
      text += std::string("state ") + state + "\n" + leaf + "\n";
    return text;
  }
  static double Widest(const Track& track) {
    return track.opening.empty() ? -1 : *std::ranges::max_element(track.opening);
  }
  const support::TempDir folder_;
};

TEST_F(VdmProgramTest, ARecordingsTrackHasALineEach10Ms) {
  const std::string sound = Syllables(2, 16000, 1, 1);
  const Track track =
      TrackOf(Write("a.wav", Wav(16000, 1, static_cast<std::uint32_t>(sound.size()), sound)));
  EXPECT_EQ(track.code, 0) << track.error;
  EXPECT_EQ(track.opening.size(), 200U);
  EXPECT_GT(Widest(track), 4);
}

TEST_F(VdmProgramTest, PhonemesWithTimesMoveTheMouthByTriphones) {
  const std::string triphones = Write("a.tri", OneLeafTriphones());
  const Track track =
      TrackOf("--phonemes", {Write("a.pho", "pau[50] aa[100]\nm[50]\n"), "--triphones", triphones});
  EXPECT_EQ(track.code, 0) << track.error;
  EXPECT_EQ(track.opening.size(), 20U);
  EXPECT_NEAR(Widest(track), 10, 0.01);
}

TEST_F(VdmProgramTest, BadPhonemesAndTriphonesAreOneErrorThatNamesThem) {
  const std::string triphones = Write("a.tri", OneLeafTriphones());
  const std::string phonemes = Write("a.pho", "aa[50]");
  const auto error = [&](const std::string& pho, const std::string& tri) {
    const Track track = TrackOf("--phonemes", {pho, "--triphones", tri});
    EXPECT_EQ(track.code, 1);
    EXPECT_EQ(std::ranges::count(track.error, '\n'), 1) << track.error;
    return track.error;
  };
  EXPECT_NE(error(Write("b.pho", "aa[x]"), triphones).find("b.pho: "), std::string::npos);
  EXPECT_NE(error(folder_ / "none", triphones).find("none"), std::string::npos);
  EXPECT_NE(error(phonemes, Write("b.tri", "step 10\nleaf\n")).find("b.tri:2: 'leaf' found"),
            std::string::npos);
}

TEST_F(VdmProgramTest, HeadAndProsodyArePrintedWhereTheyAreAskedFor) {
  const std::string sound = Syllables(2, 16000, 1, 1);
  const auto file = Write("a.wav", Wav(16000, 1, static_cast<std::uint32_t>(sound.size()), sound));
  const auto lines = [&](const std::vector<std::string>& more) {
    std::vector<std::string> argv = {GALATEA_BIN_DIR "/vdm", file};
    argv.insert(argv.end(), more.begin(), more.end());
    support::Process program(argv);
    return program.ReadAll();
  };
  const auto head = lines({"--head"});
  ASSERT_EQ(head.size(), 201U);
  EXPECT_TRUE(head[0].ends_with(",m17,down,right,tilt,brow")) << head[0];
  EXPECT_EQ(std::ranges::count(head[100], ','), std::ranges::count(head[0], ','));
  const auto prosody = lines({"--print", "prosody"});
  ASSERT_GT(prosody.size(), 190U);
  EXPECT_TRUE(prosody[0].starts_with("ms,hz,voicing,")) << prosody[0];
  EXPECT_EQ(std::ranges::count(prosody[100], ','), std::ranges::count(prosody[0], ','));
}

TEST_F(VdmProgramTest, ADamagedNetworkOfHeadsIsNamedWithItsLine) {
  const std::string net = Write("bad.net", "# mine\nsounds x\n");
  const Track track = TrackOf("none.wav", {"--head-net", net});
  EXPECT_NE(track.code, 0);
  EXPECT_NE(track.error.find("bad.net:2: 'x' found"), std::string::npos) << track.error;
}

TEST_F(VdmProgramTest, RateChannelsLevelConstantsAndClippingDoNotMatterMuch) {
  struct Case {
    std::uint32_t rate, channels;
    double gain, dc;
  };
  for (const Case& one : {Case{44100, 2, 1, 0}, Case{8000, 1, 1, 0}, Case{16000, 1, 0.05, 0},
                          Case{16000, 1, 1, 9000}, Case{16000, 1, 20, 0}}) {
    const std::string sound = Syllables(2, one.rate, one.channels, one.gain, one.dc);
    const Track track = TrackOf(Write(
        "b.wav", Wav(one.rate, one.channels, static_cast<std::uint32_t>(sound.size()), sound)));
    EXPECT_EQ(track.code, 0) << track.error;
    EXPECT_NEAR(static_cast<double>(track.opening.size()), 200, 2);
    EXPECT_GT(Widest(track), 3) << one.rate << " Hz, gain " << one.gain << ", constant " << one.dc;
  }
}

TEST_F(VdmProgramTest, HalfAWavIsReadAsFarAsItGoes) {
  const std::string sound = Syllables(1, 16000, 1, 1);
  const Track track = TrackOf(Write("half.wav", Wav(16000, 1, 64000, sound)));
  EXPECT_EQ(track.code, 0) << track.error;
  EXPECT_EQ(track.opening.size(), 100U);
}

TEST_F(VdmProgramTest, SilenceKeepsTheLipsClosed) {
  const Track track = TrackOf(Write("s.wav", Wav(16000, 1, 64000, std::string(64000, '\0'))));
  EXPECT_EQ(track.opening.size(), 200U);
  EXPECT_EQ(Widest(track), 0);
}

TEST_F(VdmProgramTest, BadFilesAreOneErrorThatNamesThem) {
  const auto error = [&](const std::string& file, const std::vector<std::string>& more = {}) {
    const Track track = TrackOf(file, more);
    EXPECT_EQ(track.code, 1);
    EXPECT_EQ(std::ranges::count(track.error, '\n'), 1) << track.error;
    return track.error;
  };
  EXPECT_NE(error("/nowhere.wav").find("cannot read '/nowhere.wav'"), std::string::npos);
  const std::string garbage = Write("garbage.wav", std::string(5000, 'x'));
  EXPECT_NE(error(garbage).find("cannot read '" + garbage), std::string::npos);
  const std::string empty = Write("empty.wav", Wav(16000, 1, 0, ""));
  EXPECT_NE(error(empty).find("has no sound in it"), std::string::npos);
  const std::string net = Write("bad.net", "features mel\nsounds sil\nmeans 1 2\n");
  EXPECT_NE(
      error(empty, {"--net", net}).find("bad.net:3: 2 values after 'means' found, 18 expected"),
      std::string::npos);
}

TEST_F(VdmProgramTest, BadSourcesAreNamedAndTheNextWorks) {
  support::Process program({GALATEA_BIN_DIR "/vdm", "--clock", "virtual"});
  program.WriteLine("prop Error = AutoOutput");
  const auto error = [&](const std::string& line) {
    program.WriteLine(line);
    return program.Expect(".error = ").value_or("(none)\n" + program.Seen());
  };
  EXPECT_NE(error("set Input = wav:/nowhere.wav").find("cannot read '/nowhere.wav'"),
            std::string::npos);
  EXPECT_NE(error("set Input = portaudio").find("needs the real clock"), std::string::npos);
  EXPECT_NE(error("set Input = telephone").find("expected NONE, wav:PATH"), std::string::npos);
  EXPECT_NE(error("set Delay = 5").find("at least 100 expected"), std::string::npos);
  const std::string sound = Syllables(1, 16000, 1, 1);
  program.WriteLine("set Input = wav:" +
                    Write("a.wav", Wav(16000, 1, static_cast<std::uint32_t>(sound.size()), sound)));
  program.WriteLine("set Run = START");
  program.WriteLine("set Wait = IDLE");
  EXPECT_TRUE(program.Expect("to @FSM set MouthFrame.start = @"));
  EXPECT_TRUE(program.Expect("to @FSM set MouthFrame = "));
  EXPECT_TRUE(program.Expect("rep Mouth.stat = LISTENING"));
}

TEST_F(VdmProgramTest, APipeThatBringsGarbageAndStopsIsOneErrorAndSpeechAfterItMoves) {
  const std::string pipe = folder_ / "sound";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  support::Process program({GALATEA_BIN_DIR "/vdm", "--clock", "real"});
  program.WriteLine("prop Error = AutoOutput");
  program.WriteLine("set Input = raw:" + pipe);
  program.WriteLine("set#1 Run = START");
  ASSERT_TRUE(program.Expect("rep#1 Run = START"));
  const int fd = open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
  ASSERT_GE(fd, 0);
  const std::string garbage = "half a sample and text" + std::string(301, '\x7f');
  ASSERT_GT(write(fd, garbage.data(), garbage.size()), 0);
  EXPECT_TRUE(program.Expect("Input.error = TIMEOUT no sound has come from 'raw:" + pipe));
  // One byte more makes whole samples again of what follows.
  const std::string sound = "x" + Syllables(1, 16000, 1, 1);
  ASSERT_EQ(write(fd, sound.data(), sound.size()), static_cast<ssize_t>(sound.size()));
  EXPECT_TRUE(program.Expect("rep Mouth.stat = MOVING"));
  EXPECT_TRUE(program.Expect("to @FSM set MouthFrame = "));
  close(fd);
}

}  // namespace
