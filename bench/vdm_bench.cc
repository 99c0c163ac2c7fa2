// How near the voice-driven mouth comes to the text-driven one, in mm on the built-in head as it
// speaks (MouthScale 30): for voices of a training (--takes), for the people of Debian's
// pocketsphinx-testdata (truth by our aligner, with the text), and for what is no speech.
//   vdm_bench NET --words NET --takes FILE --voices rms,british-f3
// With --triphones FILE the mouth is that of the triphones in place of NET's; for takes by the
// times of the engine and, for a voice that NET and the triphones have not learned, by those that
// the aligner finds with the text. With --whole the words of each recording are recognised first,
// as vdm does with files.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>

#include "bench/speech_material.h"
#include "fsm/head/make_head.h"
#include "sound/sound_file.h"
#include "srm/align/phone_aligner.h"
#include "ssm/flite/flite_engine.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/mouth/speaker_learner.h"
#include "vdm/net/sound_classes.h"
#include "vdm/recording/recording_reader.h"
#include "vdm/train/corpus.h"
#include "vdm/train/distortion.h"
#include "vdm/train/score.h"
#include "vdm/train/truth.h"
#include "vdm/triphone/triphone_model.h"

namespace {

constexpr const char* kPeople = "/usr/share/pocketsphinx/test/data/";
constexpr float kSpoken = 0.75F;  // MouthScale 30 of the 40 of full articulation

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return std::move(*result);
}

struct Bench {
  vdm::MouthNet net;
  std::optional<vdm::MouthNet> words{};  // heard beside it
  std::optional<vdm::TriphoneModel> triphones{};
  std::unique_ptr<vdm::RecordingReader> reader{};  // of words, before a sound is heard; or none
  fsm::MotionTables tables;
  std::unique_ptr<fsm::Head> head;
  double work_s = 0, sound_s = 0;
  float warp = 1;         // of the speaker
  std::size_t every = 1;  // of the takes, so many-th

  double GapMm(const std::array<float, 17>& mouth, float seal, float tongue) const {
    fsm::FaceState state;
    for (std::size_t i = 0; i < mouth.size(); ++i) state.mouth[i] = kSpoken * mouth[i];
    state.seal = seal;
    state.tongue = tongue;
    return static_cast<double>(head->MeasureMouth(state).gap_mm);
  }

  /// The gap at each hop of a sound with these phonemes.
  std::vector<double> Gaps(const std::vector<std::int16_t>& samples,
                           const vm::PhonemeList& phonemes) {
    if (!triphones) return Gaps(samples);
    std::vector<double> gaps;
    for (const vdm::MouthFrame& frame : OrThrow(MouthOf(*triphones, phonemes)))
      gaps.push_back(GapMm(frame.mouth, frame.seal, frame.tongue));
    return gaps;
  }

  /// The gap at each hop of a sound, as it comes out of a stream.
  std::vector<double> Gaps(std::vector<std::int16_t> samples) {
    const auto recorded = reader ? reader->Read(samples) : vdm::RecordedMouth{};
    const std::clock_t start = std::clock();
    vdm::MouthTracker tracker(net, warp, words ? &*words : nullptr);
    samples.resize(samples.size() + tracker.ahead_samples() + tracker.hop_samples());
    std::vector<vdm::MouthTracker::Moment> moments;
    for (std::size_t at = 0; at < samples.size(); at += 320) {
      const std::size_t count = std::min<std::size_t>(320, samples.size() - at);
      std::ranges::move(tracker.Add(std::span(samples).subspan(at, count)),
                        std::back_inserter(moments));
    }
    work_s += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    sound_s += static_cast<double>(samples.size()) / 16000;
    std::vector<double> gaps;
    for (auto& [sample, frame] : moments) {
      recorded.Blend(sample, frame);
      gaps.push_back(GapMm(frame.mouth, frame.seal, frame.tongue));
    }
    return gaps;
  }
  double HopMs() const {
    return static_cast<double>(vdm::MakeFeatures(net.features)->hop_samples()) / 16;
  }

  std::vector<double> TrueGaps(const vm::PhonemeList& phonemes, std::size_t count) const {
    const vdm::TextDrivenMouth mouth(phonemes, tables);
    std::vector<double> gaps;
    for (std::size_t k = 0; k < count; ++k) {
      const fsm::MouthPose pose = mouth.At(static_cast<double>(k) * HopMs());
      gaps.push_back(GapMm(pose.mouth, pose.seal, pose.tongue));
    }
    return gaps;
  }
};

struct Row {
  vdm::Score score;
  std::vector<std::vector<double>> ours, truth;

  void Add(std::vector<double> gaps, std::vector<double> true_gaps, double hop_ms,
           const vm::PhonemeList& phonemes) {
    score.Add(gaps, true_gaps, hop_ms, phonemes);
    ours.push_back(std::move(gaps));
    truth.push_back(std::move(true_gaps));
  }
  /// By how many ms ours is late where both are most alike, of -100 to 100.
  double LagMs(double hop_ms) const {
    const auto reach = static_cast<std::ptrdiff_t>(100 / hop_ms);
    double best = -1, at = 0;
    for (std::ptrdiff_t lag = -reach; lag <= reach; ++lag) {
      vdm::Score shifted;
      for (std::size_t n = 0; n < ours.size(); ++n) {
        std::vector<double> a, b;
        const auto size = static_cast<std::ptrdiff_t>(ours[n].size());
        for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag); i < std::min(size, size - lag);
             ++i) {
          a.push_back(ours[n][static_cast<std::size_t>(i + lag)]);
          b.push_back(truth[n][static_cast<std::size_t>(i)]);
        }
        shifted.Add(a, b, hop_ms, {});
      }
      if (shifted.correlation() > best)
        best = shifted.correlation(), at = static_cast<double>(lag) * hop_ms;
    }
    return at;
  }
  void Print(const std::string& who, double hop_ms) const {
    std::cout << fmt::format(
                     "| {} | {:.3f} | {:.2f} | {:.2f} | {:.0f} % of {} | {:.1f} % | {:+.0f} |\n",
                     who, score.correlation(), score.rms_mm(), score.size(),
                     100 * score.closures_seen(), score.closures(), 100 * score.shut_by_mistake(),
                     LagMs(hop_ms))
              << std::flush;
  }
};

void TestVoices(Bench& bench, const std::string& takes, const std::vector<std::string>& voices) {
  std::map<std::string, Row> rows;
  std::size_t number = 0;
  for (const vdm::Take& take : OrThrow(vdm::LoadCorpus(takes))) {
    if (std::ranges::find(voices, take.voice) == voices.end()) continue;
    if (number++ % bench.every != 0) continue;
    auto gaps = bench.Gaps(take.samples, take.phonemes);
    auto truth = bench.TrueGaps(take.phonemes, gaps.size());
    for (Row* row : {&rows[take.voice], &rows["~ all of these voices"]}) {
      row->Add(gaps, truth, bench.HopMs(), take.phonemes);
    }
  }
  for (const auto& [voice, row] : rows) row.Print(voice, bench.HopMs());
}

/// A voice says the vowels of the table: cut from what it said in `takes`, so much of each as to
/// make about 300 ms. Empty if it did not say all of them at length.
std::vector<std::int16_t> VowelsOf(const std::vector<vdm::Take>& takes) {
  std::vector<std::int16_t> sound(8000);
  for (const std::string& vowel : vdm::BuiltVowels().vowels) {
    std::size_t length = 0;
    for (const vdm::Take& take : takes) {
      std::size_t at = 0;
      for (const vm::Phoneme& phoneme : take.phonemes) {
        const auto samples = static_cast<std::size_t>(16 * phoneme.duration.count());
        const auto& sounds = vdm::SoundClasses::Built();
        if (sounds.names()[sounds.Of(phoneme.name)] == vowel && samples >= 16 * 90 &&
            length < 4800 && at + samples <= take.samples.size()) {
          const auto begin = take.samples.begin() + static_cast<std::ptrdiff_t>(at + samples / 8);
          sound.insert(sound.end(), begin, begin + static_cast<std::ptrdiff_t>(samples * 3 / 4));
          length += samples * 3 / 4;
        }
        at += samples;
      }
    }
    if (length < 3200) return {};
    sound.resize(sound.size() + 6400);
  }
  return sound;
}

/// What meeting a speaker by five vowels brings: vowels from the first half of what each voice
/// said, the second half by the vocal tract that was chosen and without.
void TestSpeakers(Bench& bench, const std::string& takes, const std::vector<std::string>& voices) {
  for (const std::string& voice : voices) {
    std::vector<vdm::Take> first, second;
    for (vdm::Take& take : OrThrow(vdm::LoadCorpus(takes))) {
      if (take.voice == voice) second.push_back(std::move(take));
    }
    const auto half = second.begin() + static_cast<std::ptrdiff_t>(second.size() / 2);
    first.assign(second.begin(), half);
    second.erase(second.begin(), half);
    vdm::SpeakerLearner learner(bench.net, vdm::BuiltVowels());
    auto met = learner.Add(VowelsOf(first));
    const auto speaker = met ? *met : learner.Finish();
    std::cout << fmt::format(
        "{}: {}\n", voice,
        speaker ? fmt::format("warp {:.2f}", speaker->warp) : speaker.error().text);
    if (!speaker) continue;
    for (const float warp : {1.0F, speaker->warp}) {
      Row row;
      bench.warp = warp;
      for (const vdm::Take& take : second) {
        auto gaps = bench.Gaps(take.samples);
        auto truth = bench.TrueGaps(take.phonemes, gaps.size());
        row.Add(std::move(gaps), std::move(truth), bench.HopMs(), take.phonemes);
      }
      bench.warp = 1;
      row.Print(fmt::format("{}, warp {:.2f}", voice, warp), bench.HopMs());
    }
  }
}

/// "<s> TEXT </s> (NAME)" of each line.
std::vector<std::pair<std::string, std::string>> Transcription(const std::string& path) {
  std::vector<std::pair<std::string, std::string>> texts;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t begin = line.find("<s>"), end = line.find("</s>"), open = line.find('(');
    if (open == std::string::npos || begin == std::string::npos || end == std::string::npos)
      continue;
    texts.emplace_back(line.substr(open + 1, line.find(')') - open - 1),
                       line.substr(begin + 3, end - begin - 3));
  }
  return texts;
}

std::unique_ptr<srm::PhoneAligner> Aligner() {
  auto aligner = srm::PhoneAligner::Open(srm::PocketsphinxOptions().model);
  if (aligner) return std::move(*aligner);
  std::cerr << "vdm_bench: no people and no texts: " << aligner.error().text << std::endl;
  return nullptr;
}

/// A voice of flite whose phonemes the aligner finds; the truth has the engine's own times.
void TestAlignedVoice(Bench& bench, const std::string& voice) {
  const auto aligner = Aligner();
  if (!aligner) return;
  const auto engine = ssm::MakeFliteEngine();
  Row row;
  for (const std::string& text : speech_bench::OtherSentences()) {
    const speech_bench::Speech speech = speech_bench::Say(*engine, text, voice);
    const auto aligned = aligner->Align(speech.samples, text);
    if (!aligned) {
      std::cerr << "vdm_bench: '" << text << "': " << aligned.error().text << std::endl;
      continue;
    }
    auto gaps = bench.Gaps(speech.samples, aligned->phonemes);
    auto truth = bench.TrueGaps(speech.plan.phonemes, gaps.size());
    row.Add(std::move(gaps), std::move(truth), bench.HopMs(), speech.plan.phonemes);
  }
  row.Print(voice + ", everyday sentences", bench.HopMs());
}

void TestPeople(Bench& bench) {
  const auto aligner = Aligner();
  if (!aligner) return;
  Row all;
  for (const auto& [folder, file] :
       {std::pair("librivox/", "transcription"), std::pair("cards/", "cards.transcription")}) {
    Row row;
    for (const auto& [name, text] : Transcription(std::string(kPeople) + folder + file)) {
      const auto samples = OrThrow(sound::ReadSound(kPeople + std::string(folder) + name + ".wav"));
      const auto aligned = aligner->Align(samples, text);
      if (!aligned) {
        std::cerr << "vdm_bench: " << name << ": " << aligned.error().text << std::endl;
        continue;
      }
      auto gaps = bench.Gaps(samples, aligned->phonemes);
      auto truth = bench.TrueGaps(aligned->phonemes, gaps.size());
      row.Add(gaps, truth, bench.HopMs(), aligned->phonemes);
      all.Add(std::move(gaps), std::move(truth), bench.HopMs(), aligned->phonemes);
    }
    if (row.score.instants() > 0) row.Print(std::string("people, ") + folder, bench.HopMs());
  }
  if (all.score.instants() > 0) all.Print("people, all", bench.HopMs());
}

/// Lines of FILE, LANGUAGE and TEXT with tabs between, files beside the list, as vdm_train --people
/// reads; the English ones.
void TestRecordings(Bench& bench, const std::string& list) {
  const auto aligner = Aligner();
  if (!aligner) return;
  Row row;
  std::ifstream file(list);
  for (std::string line; std::getline(file, line);) {
    const std::size_t tab = line.find('\t'), second = line.find('\t', tab + 1);
    if (second == std::string::npos || line.substr(tab + 1, second - tab - 1) != "en") continue;
    const auto folder = std::filesystem::path(list).parent_path();
    const auto samples = OrThrow(sound::ReadSound((folder / line.substr(0, tab)).string()));
    const auto aligned = aligner->Align(samples, line.substr(second + 1));
    if (!aligned) {
      std::cerr << "vdm_bench: " << line << ": " << aligned.error().text << std::endl;
      continue;
    }
    auto gaps = bench.Gaps(samples, aligned->phonemes);
    auto truth = bench.TrueGaps(aligned->phonemes, gaps.size());
    row.Add(std::move(gaps), std::move(truth), bench.HopMs(), aligned->phonemes);
  }
  row.Print(list, bench.HopMs());
}

void TestNoSpeech(Bench& bench) {
  std::size_t open = 0, all = 0, sounds = 0, moved = 0;
  // Words of noise take the recogniser long.
  for (std::uint64_t n = 0; n < (bench.reader ? 25 : 100); ++n, ++sounds) {
    const auto gaps = bench.Gaps(vdm::NoSpeech(vdm::Dice(0xBE4C).For(n)));
    const auto now =
        static_cast<std::size_t>(std::ranges::count_if(gaps, [](double mm) { return mm >= 1; }));
    open += now;
    all += gaps.size();
    moved += now > 0;
  }
  std::cout << fmt::format(
      "\n{} sounds of noise, music and silence: lips open {:.2f} % of the time, in {} of them\n",
      sounds, 100.0 * static_cast<double>(open) / static_cast<double>(all), moved);
}

}  // namespace

int main(int argc, char** argv) {
  std::string net, words, takes, triphones;
  std::vector<std::string> voices;
  bool speakers = false;
  CLI::App app("How near the voice-driven mouth comes to the text-driven one");
  app.add_option("net", net, "A network's file")->required();
  app.add_option("--words", words, "A network of words, heard beside it");
  app.add_option("--takes", takes, "Speech of a training (the file takes of vdm_train --work)");
  app.add_option("--voices", voices, "Which of its voices")->delimiter(',');
  app.add_option("--triphones", triphones,
                 "Triphones of vdm_train --triphones, in place of the net");
  bool whole = false;
  std::size_t every = 1;
  app.add_option("--every", every, "Only each so many-th of the takes")->check(CLI::PositiveNumber);
  app.add_flag("--whole", whole, "The words of each recording are recognised before it is heard");
  app.add_flag("--speakers", speakers, "Only what meeting each of these voices first brings");
  std::string recordings;
  app.add_option("--recordings", recordings,
                 "Recordings of people with their text (a list as for vdm_train --people)");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto read = [](const std::string& path) {
      std::ifstream file(path);
      const std::string text(std::istreambuf_iterator<char>(file), {});
      return OrThrow(vdm::ParseMouthNet(path, text));
    };
    Bench bench{.net = read(net),
                .tables = OrThrow(fsm::MotionTables::Load()),
                .head = fsm::MakeHead("galatea")};
    if (!triphones.empty()) {
      std::ifstream model(triphones);
      const std::string said(std::istreambuf_iterator<char>(model), {});
      bench.triphones = OrThrow(vdm::ParseTriphones(triphones, said));
    }
    bench.every = every;
    if (!words.empty()) bench.words = read(words);
    if (whole) bench.reader = OrThrow(vdm::RecordingReader::Open());
    std::cout
        << "| voice | r of the gap | rms mm | size | closures seen | shut by mistake | lag ms |\n"
           "| --- | --- | --- | --- | --- | --- | --- |\n";
    if (speakers) {
      TestSpeakers(bench, takes, voices);
      return 0;
    }
    if (!takes.empty()) TestVoices(bench, takes, voices);
    if (!recordings.empty()) TestRecordings(bench, recordings);
    TestAlignedVoice(bench, "rms");
    TestPeople(bench);
    if (bench.triphones) return 0;
    TestNoSpeech(bench);
    std::cout << fmt::format("real-time factor {:.4f}\n", bench.work_s / bench.sound_s);
  } catch (const std::exception& error) {
    std::cerr << "vdm_bench: " << error.what() << std::endl;
    return 1;
  }
}
