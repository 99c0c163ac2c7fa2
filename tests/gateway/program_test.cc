// The gateway as its clients see it: a client of its own kind in Python (client.py) beside it.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "tests/support/process.h"

namespace {

using nlohmann::json;
using support::Process;
using support::SocketClient;
using Lines = std::vector<std::string>;

const std::string kToken = "sixteen-bytes-or-more";

class GatewayTest : public testing::Test {
 protected:
  void Start(Lines more = {}) {
    std::ofstream(folder_ / "token") << kToken << "\n";
    ::chmod((folder_ / "token").c_str(), 0600);
    Lines command{GALATEA_BIN_DIR "/gateway", "--at", "tcp:127.0.0.1:0", "--token-file",
                  folder_ / "token"};
    command.insert(command.end(), more.begin(), more.end());
    gateway_ = std::make_unique<Process>(command);
    const std::string url = gateway_->ReadLine().value_or("");
    ASSERT_TRUE(url.ends_with("/v1/mouth?token=" + kToken)) << url << gateway_->ErrorText();
    host_ = url.substr(5, url.find('/', 5) - 5);
    port_ = static_cast<unsigned short>(std::atoi(host_.substr(host_.find(':') + 1).c_str()));
  }
  Lines Client(Lines steps, const std::string& query = "&set=oculus15") {
    Lines command{"python3", GALATEA_SOURCE_DIR "/tests/gateway/client.py",
                  "ws://" + host_ + "/v1/mouth?token=" + kToken + query};
    command.insert(command.end(), steps.begin(), steps.end());
    Process client(command);
    client.CloseInput();
    auto lines = client.ReadAll(std::chrono::seconds(60));
    EXPECT_EQ(client.Wait(), 0) << client.ErrorText();
    return lines;
  }
  /// Posts to /v1/audio/speech; the status line and the answer.
  std::pair<std::string, std::string> Post(const std::string& body,
                                           Lines headers = {"Authorization: Bearer " + kToken}) {
    Lines command{"python3", GALATEA_SOURCE_DIR "/tests/gateway/client.py",
                  "http://" + host_ + "/v1/audio/speech", body};
    command.insert(command.end(), headers.begin(), headers.end());
    Process client(command);
    client.CloseInput();
    const auto lines = client.ReadAll(std::chrono::seconds(60));
    EXPECT_EQ(client.Wait(), 0) << client.ErrorText();
    return lines.size() < 2 ? std::pair<std::string, std::string>() : std::pair(lines[0], lines[1]);
  }
  std::string StatusOf(const std::string& target, const std::string& headers) {
    auto client = SocketClient::Tcp(port_);
    client->Write("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n");
    const auto line = client->ReadLine();
    return line && line->size() > 12 ? line->substr(9, 3) : "nothing";
  }
  /// Speech of flite at 16 kHz, without a header.
  std::string Speech() {
    Process voice({GALATEA_BIN_DIR "/ssm", "--sink", "null", "--clock", "virtual"});
    voice.WriteLine("set Text = Mama bought a piano.");
    voice.WriteLine("set#1 SaveWAV = " + (folder_ / "said.wav"));
    phonemes_ = voice.Expect("rep Text.pho = ").value_or("");
    EXPECT_TRUE(voice.Expect("rep#1 "));
    std::ifstream wav(folder_ / "said.wav", std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(wav), {});
    const std::string raw = folder_ / "said.raw";
    std::ofstream(raw, std::ios::binary) << bytes.substr(44);
    seconds_ = static_cast<double>(bytes.size() - 44) / 32000;
    return raw;
  }

  /// When a phoneme of the speech is said, the nth of its name: seconds, first and last.
  std::pair<double, double> Said(const std::string& phoneme, int nth) const {
    double from = 0;
    std::istringstream words(phonemes_.substr(std::min(phonemes_.find("= "), phonemes_.size())));
    for (std::string word; words >> word;) {
      const std::size_t bracket = word.find('[');
      if (bracket == word.npos) continue;
      const double until = from + std::stod(word.substr(bracket + 1)) / 1000;
      if (word.substr(0, bracket) == phoneme && nth-- == 0) return {from, until};
      from = until;
    }
    ADD_FAILURE() << phoneme << " is not in " << phonemes_;
    return {};
  }

  support::TempDir folder_;
  std::string phonemes_;
  std::unique_ptr<Process> gateway_;
  std::string host_;
  unsigned short port_ = 0;
  double seconds_ = 0;
};

TEST_F(GatewayTest, SoundGoesInAndFramesComeOut) {
  Start({"--no-voice"});
  const auto lines =
      Client({"until:ready", "sound:" + Speech(), "text:{\"type\": \"end\"}", "until:end"});
  ASSERT_GT(lines.size(), 10u);
  const json ready = json::parse(lines.front()), end = json::parse(lines.back());
  EXPECT_EQ(ready["names"].size(), 15u);
  EXPECT_EQ(ready["ahead"], 0.06);
  EXPECT_NEAR(end["t"].get<double>(), seconds_, 0.001);
  EXPECT_NEAR(static_cast<double>(lines.size() - 2), seconds_ * 50, 2);
  std::vector<double> shut;
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    const json frame = json::parse(lines[i]);
    ASSERT_EQ(frame["type"], "frame");
    ASSERT_NEAR(frame["t"].get<double>(), 0.02 * static_cast<double>(i - 1), 1e-6);
    if (frame["viseme"] == "PP") shut.push_back(frame["t"]);
  }
  // To 20 ms.
  const auto shut_in = [&](std::pair<double, double> said) {
    return std::ranges::count_if(
        shut, [&](double t) { return t >= said.first - 0.02 && t <= said.second + 0.02; });
  };
  const auto in_m = shut_in(Said("m", 1)), in_b = shut_in(Said("b", 0));
  const auto elsewhere = std::ssize(shut) - in_m - in_b - shut_in(Said("m", 0));
  EXPECT_GE(in_m, 2) << "the second m of Mama";
  EXPECT_GE(in_b, 1) << "the b of bought";
  EXPECT_EQ(elsewhere, 0) << "but for the first m, which is short";
}

TEST_F(GatewayTest, FramesComeWhileTheSoundStillDoes) {
  Start({"--no-voice"});
  const auto lines = Client({"until:ready", "sound:" + Speech(), "until:frame"}, "&set=arkit52");
  EXPECT_EQ(json::parse(lines.back())["weights"].size(), 52u);
}

TEST_F(GatewayTest, ClearBeginsAnewAndWhatIsNoMessageIsAnswered) {
  Start({"--no-voice"});
  const std::string speech = Speech();
  const auto lines = Client({"until:ready", "sound:" + speech, "text:{\"type\":\"clear\"}",
                             "until:cleared", "text:nonsense", "until:error", "sound:" + speech,
                             "text:{\"type\": \"end\"}", "until:end"});
  const auto cleared = std::ranges::find(lines, R"({"type":"cleared"})");
  ASSERT_NE(cleared, lines.end());
  EXPECT_TRUE((cleared + 1)->contains("found 'nonsense'")) << *(cleared + 1);
  EXPECT_EQ(json::parse(*(cleared + 2))["t"], 0) << "time counts from the new sound";
  EXPECT_NEAR(static_cast<double>(lines.end() - cleared - 3), seconds_ * 50, 2);
}

/// The pictures among these lines, of one sound.
std::vector<json> PicturesOf(const Lines& lines, int sound) {
  std::vector<json> pictures;
  for (const std::string& line : lines) {
    const json message = json::parse(line);
    if (message["type"] == "picture" && message["sound"] == sound) pictures.push_back(message);
  }
  return pictures;
}

TEST_F(GatewayTest, PicturesOfAFaceThatSaysTheSoundComeBesideTheWeights) {
  Start({"--no-voice"});
  const std::string speech = Speech();
  const auto lines =
      Client({"until:ready", "sound:" + speech, "text:{\"type\": \"end\"}", "until:end",
              "sound:" + speech, "text:{\"type\": \"end\"}", "until:end"},
             "&set=arkit52&pictures=96x96&picture_fps=20");
  const json ready = json::parse(lines.front());
  EXPECT_EQ(ready["pictures"], (json{{"width", 96}, {"height", 96}, {"fps", 20}}));
  for (const int sound : {0, 1}) {
    const auto pictures = PicturesOf(lines, sound);
    ASSERT_GE(pictures.size(), 1u) << sound << ": a busy machine may leave some out";
    EXPECT_LE(static_cast<double>(pictures.size()), seconds_ * 20 + 1) << sound;
    double before = 0;
    for (const json& picture : pictures) {
      EXPECT_TRUE(picture["jpeg"]) << picture;
      EXPECT_GT(picture["t"], before) << "in order, and counted from the sound's beginning";
      before = picture["t"].get<double>();
      EXPECT_NEAR(std::remainder(before, 0.05), 0, 1e-6);
    }
    EXPECT_LE(before, seconds_);
  }
}

TEST_F(GatewayTest, AfterClearNoPictureOfTheSoundBeforeComes) {
  Start({"--no-voice"});
  const auto lines = Client(
      {"until:ready", "sound:" + Speech(), "until:picture", "text:{\"type\": \"clear\"}",
       "until:cleared", "sound:" + folder_ / "said.raw", "text:{\"type\": \"end\"}", "until:end"},
      "&pictures=64x64&picture_fps=10");
  const auto cleared = std::ranges::find(lines, R"({"type":"cleared"})");
  ASSERT_NE(cleared, lines.end());
  EXPECT_TRUE(PicturesOf({cleared, lines.end()}, 0).empty());
  EXPECT_FALSE(PicturesOf({cleared, lines.end()}, 1).empty());
}

TEST_F(GatewayTest, PicturesAreForSoManyAndWithinBounds) {
  Start({"--no-voice", "--faces", "1"});
  for (const char* wish : {"&pictures=huge", "&pictures=63x64", "&pictures=64x1025",
                           "&pictures=64x64x64", "&pictures=64x64&picture_fps=30"})
    EXPECT_EQ(Client({"until:ready"}, wish), Lines{"status 400"}) << wish;
  EXPECT_TRUE(gateway_->ErrorText().contains(
      "pictures: found 'huge', expected WIDTHxHEIGHT, each from 64 to 1024"));
  Process first({"python3", GALATEA_SOURCE_DIR "/tests/gateway/client.py",
                 "ws://" + host_ + "/v1/mouth?pictures=64x64&token=" + kToken, "until:ready",
                 "end"});
  ASSERT_TRUE(first.Expect("ready"));
  EXPECT_EQ(Client({"until:ready"}, "&pictures=64x64"), Lines{"status 503"});
  EXPECT_EQ(Client({"until:ready"}).size(), 1u) << "weights alone need no face";
  first.Kill();
  first.Wait();
}

TEST_F(GatewayTest, AFaceThatCannotBeHadIsToldAndTheWeightsGoOn) {
  std::filesystem::create_directories(folder_ / "faces/berta");
  std::ofstream(folder_ / "faces/berta/identity.txt") << "base galatea\n";
  ASSERT_EQ(::setenv("GALATEA_FACES", (folder_ / "faces").c_str(), 1), 0);
  Start({"--no-voice", "--mask", "berta"});
  std::filesystem::remove_all(folder_ / "faces/berta");
  const auto lines = Client(
      {"until:ready", "until:error", "sound:" + Speech(), "text:{\"type\": \"end\"}", "until:end"},
      "&pictures=64x64");
  ASSERT_GT(lines.size(), 10u);
  EXPECT_TRUE(lines[1].contains("the face: ")) << lines[1];
  EXPECT_EQ(json::parse(lines.back())["type"], "end");
  ::unsetenv("GALATEA_FACES");
}

TEST_F(GatewayTest, OnlyWhoeverShowsTheTokenMayCome) {
  Start();
  const std::string host = "Host: " + host_ + "\r\n";
  const std::string bearer = "Authorization: Bearer " + kToken + "\r\n";
  const std::string socket =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";
  EXPECT_EQ(StatusOf("/v1/mouth", host + socket), "401");
  EXPECT_EQ(StatusOf("/v1/mouth?token=wrong", host + socket), "401");
  EXPECT_EQ(StatusOf("/v1/mouth", host + bearer + socket), "101");
  EXPECT_EQ(StatusOf("/v1/mouth", host + bearer), "426");
  EXPECT_EQ(StatusOf("/v1/mouth", host + "Authorization: bEARER " + kToken + "\r\n"), "426")
      << "the scheme's case does not count";
  EXPECT_EQ(StatusOf("/v1/mouth", "Host: LocalHost:" + std::to_string(port_) + "\r\n" + bearer),
            "426")
      << "nor a host's";
  EXPECT_EQ(StatusOf("/v1/mouth?set=x", host + bearer + socket), "400");
  EXPECT_EQ(StatusOf("/v1/mouth?rate=1e9", host + bearer + socket), "400");
  EXPECT_TRUE(gateway_->ExpectError("rate: found '1e9', expected one of 8000, 16000"));
  EXPECT_EQ(StatusOf("/etc/passwd", host + bearer), "404");
  EXPECT_EQ(StatusOf("/v1/audio/speech", host + bearer), "405");
  EXPECT_EQ(StatusOf("/v1/mouth", "Host: evil.example\r\n" + bearer + socket), "421");
  EXPECT_EQ(StatusOf("/v1/mouth", host + "Origin: http://evil.example\r\n" + bearer + socket),
            "403");
  EXPECT_EQ(StatusOf("/v1/mouth", host + "X: " + std::string(20'000, 'x') + "\r\n"), "413");
  EXPECT_TRUE(Post("{}", {}).first.starts_with("status 401 ")) << "the voice is no one's either";
  auto stranger = SocketClient::Tcp(port_);
  stranger->Write("GET /v1/mouth HTTP/1.1\r\n" + host + "\r\n");
  EXPECT_TRUE(
      stranger->Expect("\"message\":\"a request without the token; the program that serves "
                       "this prints its address, which ends in ?token=TOKEN"))
      << stranger->Seen();
}

TEST_F(GatewayTest, WhoAsksBeforeItSendsIsTold) {
  Start({"--no-voice"});
  const std::string head = "POST /v1/audio/speech HTTP/1.1\r\nHost: " + host_ +
                           "\r\nExpect: 100-Continue\r\nContent-Length: 2\r\nAuthorization: "
                           "Bearer ";
  auto client = SocketClient::Tcp(port_);
  client->Write(head + kToken + "\r\n\r\n");
  EXPECT_EQ(client->ReadLine(), "HTTP/1.1 100 Continue\r");
  client->Write("{}");
  EXPECT_TRUE(client->Expect("HTTP/1.1 404")) << client->Seen();
  auto stranger = SocketClient::Tcp(port_);
  stranger->Write(head + "wrong\r\n\r\n");
  EXPECT_TRUE(stranger->Expect("HTTP/1.1 401")) << stranger->Seen();
  EXPECT_FALSE(stranger->Seen().contains("100 Continue"));
}

TEST_F(GatewayTest, AClientThatGoesIsNotSpokenFor) {
  // The voice answers nothing: one text is with it, eight may wait.
  Start({"--voice", "sleep", "1000"});
  const std::string request = "POST /v1/audio/speech HTTP/1.1\r\nHost: " + host_ +
                              "\r\nContent-Length: 15\r\nAuthorization: Bearer " + kToken +
                              "\r\n\r\n{\"input\": \"Hi\"}";
  for (int i = 0; i < 20; ++i) SocketClient::Tcp(port_)->Write(request);
  std::vector<std::unique_ptr<SocketClient>> waiting;
  for (int i = 0; i < 7; ++i) {
    waiting.push_back(SocketClient::Tcp(port_));
    waiting.back()->Write(request);
  }
  EXPECT_EQ(
      StatusOf("/v1/mouth", "Host: " + host_ + "\r\nAuthorization: Bearer " + kToken + "\r\n"),
      "426");
  EXPECT_FALSE(gateway_->ErrorText().contains("texts wait")) << gateway_->ErrorText();
}

TEST_F(GatewayTest, PagesOfNamedSitesMayCome) {
  Start({"--no-voice", "--origin", "https://bot.example"});
  auto client = SocketClient::Tcp(port_);
  client->Write("OPTIONS /v1/audio/speech HTTP/1.1\r\nHost: " + host_ +
                "\r\nOrigin: https://bot.example\r\n\r\n");
  EXPECT_TRUE(client->Expect("Access-Control-Allow-Origin: https://bot.example"));
}

TEST_F(GatewayTest, SilentConnectionsTakeNobodysPlace) {
  Start({"--no-voice"});
  std::vector<std::unique_ptr<SocketClient>> silent;
  for (int i = 0; i < 70; ++i) silent.push_back(SocketClient::Tcp(port_));
  EXPECT_EQ(
      StatusOf("/v1/mouth", "Host: " + host_ + "\r\nAuthorization: Bearer " + kToken + "\r\n"),
      "426");
}

TEST_F(GatewayTest, MoreClientsThanAllowedAreTurnedAway) {
  Start({"--no-voice", "--clients", "1"});
  Process first({"python3", GALATEA_SOURCE_DIR "/tests/gateway/client.py",
                 "ws://" + host_ + "/v1/mouth?token=" + kToken, "until:ready", "end"});
  ASSERT_TRUE(first.Expect("ready"));
  EXPECT_EQ(Client({"until:ready"}), (Lines{"status 503"}));
  first.Kill();
  first.Wait();
}

TEST_F(GatewayTest, TooLongAMessageEndsTheConnectionAndNoOthers) {
  Start({"--no-voice"});
  const std::string big = folder_ / "big.raw";
  std::ofstream(big) << std::string(2'000'000, '\0');
  const auto lines = Client({"until:ready", "sound:" + big + ":2000000", "end"});
  EXPECT_EQ(lines.back(), "closed");
  EXPECT_EQ(Client({"until:ready"}).size(), 1u);
}

TEST_F(GatewayTest, ATextIsSpokenInTheFormatAskedFor) {
  Start();
  const auto wav = Post(R"({"model": "any", "input": "Good morning.", "response_format": "wav"})");
  EXPECT_EQ(wav.first, "status 200 audio/wav");
  EXPECT_TRUE(wav.second.ends_with(" b'RIFF'")) << wav.second;
  const long wav_bytes = std::atol(wav.second.c_str());
  const auto pcm = Post(R"({"input": "Good morning.", "response_format": "pcm"})");
  EXPECT_EQ(pcm.first, "status 200 audio/pcm");
  EXPECT_NEAR(static_cast<double>(std::atol(pcm.second.c_str())),
              1.5 * static_cast<double>(wav_bytes - 44), 4)
      << "24 kHz, as clients of this API take it";
  const auto mp3 = Post(R"({"input": "Good morning."})");
  EXPECT_EQ(mp3.first, "status 200 audio/mpeg");
  const auto slow =
      Post(R"({"input": "Good morning.", "response_format": "wav", "speed": 0.5, "voice": "awb"})");
  EXPECT_GT(std::atol(slow.second.c_str()), 1.5 * static_cast<double>(wav_bytes));
}

TEST_F(GatewayTest, VisemesComeBesideTheSound) {
  Start();
  const auto [status, body] =
      Post(R"({"input": "Mama.", "response_format": "wav", "visemes": "visemes22", "fps": 25})");
  EXPECT_EQ(status, "status 200 application/json");
  const json answer = json::parse(body, nullptr, false);
  ASSERT_TRUE(answer.is_object()) << body.substr(0, 200);
  EXPECT_EQ(answer["media_type"], "audio/wav");
  EXPECT_TRUE(answer["audio"].get<std::string>().starts_with("UklGR")) << "RIFF in base64";
  const double duration = answer["duration"].get<double>();
  EXPECT_NEAR(static_cast<double>(answer["frames"].size()), duration * 25, 2);
  std::string phonemes;
  for (const json& phoneme : answer["phonemes"]) {
    phonemes += phoneme["name"].get<std::string>() + " ";
  }
  EXPECT_EQ(phonemes, "pau m aa m ax pau ");
  EXPECT_EQ(answer["visemes"][0],
            (json{{"viseme", "0"}, {"start", 0.0}, {"end", answer["phonemes"][0]["end"]}}));
  EXPECT_EQ(answer["visemes"][1]["viseme"], "21");
  EXPECT_NEAR(answer["visemes"].back()["end"].get<double>(), duration, 0.002);
}

TEST_F(GatewayTest, MistakesAreToldAsOpenAIsApiTellsThem) {
  Start();
  const auto wrong = Post(R"({"input": ""})");
  EXPECT_EQ(wrong.first, "status 400 application/json");
  EXPECT_EQ(
      wrong.second,
      R"({"error":{"message":"input: expected the text to be spoken","type":"invalid_request_error"}})");
  const auto voice = Post(R"({"input": "Hello.", "voice": "siri"})");
  EXPECT_EQ(voice.first, "status 400 application/json");
  EXPECT_TRUE(voice.second.contains("siri")) << voice.second;
  EXPECT_EQ(Post(R"({"input": "Hello.", "response_format": "wav"})").first, "status 200 audio/wav");
}

TEST_F(GatewayTest, AVoiceOfOpenAisServiceIsTheVoiceItBeginsWith) {
  Start();
  const auto ask = [this](const std::string& voice) {
    return Post(R"({"input": "Good morning.", "response_format": "wav", "voice": ")" + voice +
                "\"}");
  };
  const auto unnamed = ask("");
  EXPECT_EQ(ask("rms").first, "status 200 audio/wav");
  for (const char* voice : {"alloy", "nova"}) EXPECT_EQ(ask(voice), unnamed) << voice;
}

TEST_F(GatewayTest, AVoiceOrAFaceThatIsNotThereIsRefusedAtTheStart) {
  const auto refused = [](const Lines& options) {
    Lines command{GALATEA_BIN_DIR "/gateway", "--at", "tcp:127.0.0.1:0"};
    command.insert(command.end(), options.begin(), options.end());
    Process gateway(command);
    EXPECT_EQ(gateway.Wait(), 1);
    return gateway.ErrorText();
  };
  EXPECT_TRUE(refused({"--voice", "nope", "--at", "tcp:127.0.0.1:0"})
                  .contains("--voice: there is no program 'nope'"));
  EXPECT_TRUE(refused({"--mask", "nope"}).contains("--mask: fsm has no such face: 'nope'"));
}

TEST_F(GatewayTest, OptionsBehindVoiceAreTheVoices) {
  Start({"--voice", GALATEA_BIN_DIR "/ssm", "--sink", "null", "--clock", "virtual", "--speaker",
         "rms"});
  const auto ask = [this](const std::string& voice) {
    return Post(R"({"input": "Good morning.", "response_format": "wav")" + voice + "}");
  };
  const auto unnamed = ask("");
  EXPECT_TRUE(unnamed.first.starts_with("status 200")) << unnamed.first;
  EXPECT_EQ(unnamed.second, ask(R"(, "voice": "rms")").second);
  EXPECT_NE(unnamed.second, ask(R"(, "voice": "slt")").second);
}

TEST_F(GatewayTest, AVoiceThatCannotBeHadIsOneErrorEachTime) {
  const std::string voice = folder_ / "ssm";
  std::filesystem::create_symlink(GALATEA_BIN_DIR "/ssm", voice);
  Start({"--voice", voice});
  std::filesystem::remove(voice);
  for (int i = 0; i < 2; ++i) {
    const auto answer = Post(R"({"input": "Hello."})");
    EXPECT_EQ(answer.first, "status 503 application/json");
    EXPECT_TRUE(answer.second.contains(voice)) << answer.second;
  }
}

TEST_F(GatewayTest, AVoiceThatHangsIsEndedAtItsLimit) {
  Start({"--speech-seconds", "1", "--voice", "sleep", "1000"});
  EXPECT_EQ(Post(R"({"input": "Hello."})").first, "status 504 application/json");
}

TEST_F(GatewayTest, APlaceOtherMachinesReachNeedsATokenOfOnesOwn) {
  Process gateway({GALATEA_BIN_DIR "/gateway", "--at", "tcp:0.0.0.0:0"});
  EXPECT_EQ(gateway.Wait(), 1);
  EXPECT_TRUE(gateway.ErrorText().contains("--at: ")) << gateway.ErrorText();
}

}  // namespace
