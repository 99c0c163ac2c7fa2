// Weights of a mouth: the sets, the stream, the messages. No network but the mouth's.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gateway/face/face_messages.h"
#include "gateway/face/live_face.h"
#include "gateway/face/weight_sets.h"
#include "gateway/speech/speech_request.h"
#include "sound/sound_file.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/voice/resample.h"
#include "tests/ssm/spoken.h"
#include "vdm/net/sound_classes.h"

namespace gateway {
namespace {

using nlohmann::json;
using Samples = std::vector<std::int16_t>;

const WeightSet& Set(const std::string& name) {
  const auto set = WeightSets::Built().Find(name);
  if (!set) throw std::runtime_error(set.error().text);
  return **set;
}

vdm::MouthFrame Frame(const std::string& sound, std::array<float, vdm::kMouthParameters> mouth = {},
                      float seal = 0) {
  const auto& names = vdm::SoundClasses::Built().names();
  vdm::MouthFrame frame;
  frame.mouth = mouth;
  frame.seal = seal;
  for (const std::string& name : names) frame.sounds.push_back(name == sound ? 1.0F : 0.0F);
  return frame;
}

float WeightOf(const WeightSet& set, const vdm::MouthFrame& frame, const std::string& name) {
  const auto at = std::ranges::find(set.names(), name);
  EXPECT_NE(at, set.names().end()) << name;
  return set.Of(frame)[static_cast<std::size_t>(at - set.names().begin())];
}

TEST(WeightSetsTest, TheSetsHaveTheirNamesInTheOrderOfTheirMakers) {
  EXPECT_EQ(Set("visemes22").names().size(), 22u);
  EXPECT_EQ(Set("oculus15").names().size(), 15u);
  EXPECT_EQ(Set("oculus15").names()[10], "aa");
  EXPECT_EQ(Set("arkit52").names().size(), 52u);
  EXPECT_EQ(Set("arkit52").names()[17], "jawOpen");
  EXPECT_EQ(WeightSets::Built().Find("vrm").error().text,
            "there is no set 'vrm', expected visemes22, oculus15, arkit52");
}

TEST(WeightSetsTest, ASoundIsItsVisemeAlone) {
  EXPECT_EQ(WeightOf(Set("visemes22"), Frame("pbm"), "21"), 1);
  EXPECT_EQ(WeightOf(Set("oculus15"), Frame("fv"), "FF"), 1);
  vdm::MouthFrame unsure = Frame("aa");
  for (float& sound : unsure.sounds) sound = 1 / static_cast<float>(unsure.sounds.size());
  float sum = 0;
  for (const float weight : Set("oculus15").Of(unsure)) sum += weight;
  EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(WeightSetsTest, BlendShapesFollowTheMouth) {
  const WeightSet& arkit = Set("arkit52");
  std::array<float, vdm::kMouthParameters> open{};
  open[11] = 25.3F;
  EXPECT_NEAR(WeightOf(arkit, Frame("aa", open), "jawOpen"), 1, 0.01);
  EXPECT_EQ(WeightOf(arkit, Frame("aa", open), "mouthClose"), 0);
  EXPECT_NEAR(WeightOf(arkit, Frame("pbm", open, 1), "mouthClose"), 1, 0.01)
      << "lips closed over an open jaw, as ARKit means it";
  std::array<float, vdm::kMouthParameters> round{};
  round[8] = -8;
  EXPECT_NEAR(WeightOf(arkit, Frame("uw", round), "mouthPucker"), 0.8, 0.01);
  EXPECT_EQ(WeightOf(arkit, Frame("uw", round), "mouthStretchLeft"), 0);
  std::array<float, vdm::kMouthParameters> parted{};
  parted[2] = 2;
  EXPECT_NEAR(WeightOf(arkit, Frame("s", parted), "mouthUpperUpLeft"), 0.5, 0.01);
  EXPECT_EQ(WeightOf(arkit, Frame("pbm", parted, 1), "mouthUpperUpLeft"), 0) << "sealed";
}

TEST(WeightSetsTest, DamagedTablesAreNamedWithTheirLine) {
  const auto visemes = [](const char* text) {
    auto read = WeightSets::Read(text, "");
    return read ? "" : read.error().text;
  };
  EXPECT_EQ(visemes("set a"), "visemes.txt:1: expected set NAME VISEME...");
  EXPECT_EQ(visemes("set a x\nnone x"), "visemes.txt:2: 'none' is no class of sounds");
  EXPECT_EQ(visemes("set a x\nsil y"), "visemes.txt:2: 'y' is not in a");
  EXPECT_EQ(visemes("set a x\nsil x x"), "visemes.txt:2: expected a viseme for each set");
  EXPECT_TRUE(visemes("set a x\nsil x").ends_with("no row for 'pbm'"));
  const auto arkit = [](const char* text) {
    auto read = WeightSets::Read("", text);
    return read ? "" : read.error().text;
  };
  EXPECT_EQ(arkit("jawOpen chin:1"), "arkit52.txt:1: 'chin:1' found, NUMBER:FACTOR expected");
  EXPECT_TRUE(arkit("jawOpen jaw:x").starts_with("arkit52.txt:1: 'x' found"));
  EXPECT_EQ(arkit("a\na"), "arkit52.txt:2: 'a' is here twice");
}

/// A sentence with closures, its sound at 16 kHz.
const ssm_test::Spoken& Sentence() {
  static const ssm_test::Spoken spoken =
      ssm_test::Speak(*ssm::MakeFliteEngine(), {{.text = "Mama bought a piano."}});
  return spoken;
}

const vdm::MouthNet& Net() { return vdm::ShippedNet(vdm::FeatureKind::kMel); }

std::string Bytes(const Samples& samples) {
  return {reinterpret_cast<const char*>(samples.data()), samples.size() * 2};
}

std::vector<LiveFace::Moment> Hear(const std::string& pcm, LiveFace::Settings settings,
                                   std::size_t piece) {
  LiveFace face(Net(), settings);
  std::vector<LiveFace::Moment> all;
  for (std::size_t at = 0; at < pcm.size(); at += piece) {
    for (auto& moment : face.Add(std::string_view(pcm).substr(at, piece))) {
      all.push_back(std::move(moment));
    }
  }
  for (auto& moment : face.End()) all.push_back(std::move(moment));
  return all;
}

TEST(LiveFaceTest, TheSameSoundGivesTheSameWeightsHoweverItComes) {
  const std::string pcm = Bytes(Sentence().samples);
  const LiveFace::Settings settings{.set = &Set("arkit52")};
  const auto whole = Hear(pcm, settings, pcm.size());
  const double length_s = static_cast<double>(Sentence().samples.size()) / 16000;
  EXPECT_NEAR(static_cast<double>(whole.size()), length_s * 50, 2);
  EXPECT_NEAR(whole.back().at_s, length_s, 0.021) << "to the end of the sound";
  for (const std::size_t piece : {1u, 641u, 3200u}) {  // also halves of samples
    const auto pieces = Hear(pcm, settings, piece);
    ASSERT_EQ(pieces.size(), whole.size()) << piece;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(pieces[i].at_s, whole[i].at_s);
      EXPECT_EQ(pieces[i].weights, whole[i].weights) << piece << " " << i;
    }
  }
}

TEST(LiveFaceTest, OtherRatesGiveTheSameMouthAtTheSameTime) {
  const auto whole =
      Hear(Bytes(Sentence().samples), {.set = &Set("arkit52")}, std::size_t{1} << 20);
  const auto jaw = [](const LiveFace::Moment& moment) { return moment.weights[17]; };
  for (const unsigned rate : {24'000u, 48'000u}) {
    const auto other = Hear(Bytes(ssm::Resample(Sentence().samples, 16'000, rate)),
                            {.set = &Set("arkit52"), .rate_hz = rate}, 4800);
    ASSERT_NEAR(static_cast<double>(other.size()), static_cast<double>(whole.size()), 1);
    double most = 0;
    for (std::size_t i = 0; i < std::min(whole.size(), other.size()); ++i) {
      most = std::max(most, static_cast<double>(std::abs(jaw(whole[i]) - jaw(other[i]))));
    }
    EXPECT_LT(most, 0.12) << rate;
  }
}

TEST(LiveFaceTest, LipsCloseWhereTheVoiceClosesThem) {
  const WeightSet& set = Set("oculus15");
  const auto moments = Hear(Bytes(Sentence().samples), {.set = &set, .fps = 100}, 3200);
  double begin_s = 0;
  int closures = 0, seen = 0;
  for (const vm::Phoneme& phoneme : Sentence().plan.phonemes) {
    const double end_s = begin_s + static_cast<double>(phoneme.duration.count()) / 1000;
    if (phoneme.name == "m" || phoneme.name == "b" || phoneme.name == "p") {
      ++closures;
      float most = 0;
      for (const auto& moment : moments) {
        if (moment.at_s >= begin_s && moment.at_s <= end_s)
          most = std::max(most, moment.weights[1]);
      }
      seen += most > 0.5F ? 1 : 0;
    }
    begin_s = end_s;
  }
  EXPECT_EQ(closures, 4);
  EXPECT_GE(seen, 3);
}

TEST(LiveFaceTest, ClearBeginsAnew) {
  LiveFace face(Net(), {.set = &Set("arkit52")});
  const std::string pcm = Bytes(Sentence().samples);
  const auto first = face.Add(pcm);
  face.Add(std::string_view("x"));
  face.Clear();
  EXPECT_EQ(face.heard_s(), 0);
  const auto again = face.Add(pcm);
  ASSERT_EQ(again.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(again[i].weights, first[i].weights);
}

TEST(LiveFaceTest, OddRatesAndPacesAreRefused) {
  const auto live = ReadLive("24000", "50");
  ASSERT_TRUE(live);
  EXPECT_EQ(live->rate_hz, 24'000u);
  EXPECT_EQ(live->fps, 50u);
  EXPECT_EQ(ReadLive("22050", "50").error().text,
            "rate: found '22050', expected one of 8000, 16000, 24000, 44100, 48000");
  EXPECT_EQ(ReadLive("huge", "50").error().text,
            "rate: found 'huge', expected one of 8000, 16000, 24000, 44100, 48000");
  EXPECT_EQ(ReadLive("16000", "30").error().text,
            "fps: found '30', expected one of 20, 25, 50, 100");
  EXPECT_FALSE(ReadLive("16000", "50 "));
  EXPECT_FALSE(ReadLive("", "50"));
}

TEST(FaceMessagesTest, FramesAreJsonWithTimeAndWeights) {
  const json frame = json::parse(
      FrameText(Set("visemes22"), {.at_s = 1.24, .weights = Set("visemes22").Of(Frame("pbm"))}));
  EXPECT_EQ(frame["type"], "frame");
  EXPECT_EQ(frame["t"], 1.24);
  EXPECT_EQ(frame["viseme"], 21);
  EXPECT_EQ(frame["weights"].size(), 22u);
  EXPECT_EQ(frame["weights"][21], 1);
  const json shapes = json::parse(
      FrameText(Set("arkit52"), {.at_s = 0, .weights = Set("arkit52").Of(Frame("aa"))}));
  EXPECT_FALSE(shapes.contains("viseme"));
  EXPECT_EQ(
      json::parse(FrameText(Set("oculus15"),
                            {.at_s = 0, .weights = Set("oculus15").Of(Frame("fv"))}))["viseme"],
      "FF");
}

TEST(FaceMessagesTest, WhatIsNoControlIsNamed) {
  EXPECT_EQ(ReadControl(R"({"type": "clear"})"), Control::kClear);
  EXPECT_EQ(ReadControl(R"({"type": "end", "more": 1})"), Control::kEnd);
  EXPECT_EQ(
      ReadControl("clear").error().text,
      "found 'clear', expected {\"type\": \"clear\"} or \"end\", or sound in a binary message");
  EXPECT_EQ(ReadControl(R"({"type": 3})").error().text, "type '' found, clear or end expected");
  EXPECT_FALSE(ReadControl(std::string(100'000, '[')));
  EXPECT_EQ(json::parse(ErrorText("\xff\"x"))["type"], "error");
}

TEST(SpeechRequestTest, WhatOpenAIsClientsSendIsRead) {
  const auto request = ReadSpeechRequest(
      R"({"model": "tts-1", "input": "Say <b>\n yes", "voice": "slt", "speed": 1.5,
          "visemes": "oculus15"})");
  ASSERT_TRUE(request) << request.error().text;
  EXPECT_EQ(request->text, "Say  b   yes") << "one line, no markup";
  EXPECT_EQ(request->format->name, "mp3") << "their default";
  EXPECT_EQ(request->set->name(), "oculus15");
  const auto error = [](const std::string& body) {
    auto read = ReadSpeechRequest(body);
    return read ? "" : read.error().text;
  };
  EXPECT_EQ(error("{"), "expected a JSON object with input, voice, response_format");
  EXPECT_EQ(error(R"({"input": " <> "})"), "input: expected the text to be spoken");
  EXPECT_EQ(error(R"({"input": "a", "response_format": "wma"})"),
            "response_format: 'wma' found, wav, pcm, mp3, opus, aac or flac expected");
  EXPECT_EQ(error(R"({"input": "a", "speed": 9})"), "speed: expected a number from 0.25 to 4");
  EXPECT_EQ(error(R"({"input": "a", "voice": "a b"})"), "voice: expected the name of a voice");
  EXPECT_EQ(error(R"({"input": "a", "visemes": 1})"),
            "visemes: there is no set '', expected visemes22, oculus15, arkit52");
  EXPECT_EQ(error(R"({"input": "a", "stream_format": "sse"})"),
            "stream_format: 'sse' found, audio expected; events are not sent");
  EXPECT_EQ(error("{\"input\": \"" + std::string(9000, 'a') + "\"}"),
            "input: more than 8192 bytes; send it in pieces");
}

}  // namespace
}  // namespace gateway
